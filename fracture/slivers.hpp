// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "fracture/pattern.hpp"

namespace sunder {

/// Merges every cell whose area is below `min_area` (m²) into the neighbour it shares the longest
/// boundary with, smallest first, until none is left that has a neighbour. The partition stays
/// exact: vertices are only dropped where nothing but merged cells meets. `merged` counts the cells
/// that disappeared. `origin` is the neighbour's. O(corners) plus O(log) per merge.
Pattern merge_slivers(Pattern pattern, double min_area, std::uint64_t* merged = nullptr);

}  // namespace sunder
