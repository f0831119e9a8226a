// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "sim/frame.hpp"

namespace sunder {

/// Members, slabs and walls that name a node, member, section, steel or material by a number beyond
/// the frame's. Nothing else may be asked of such a frame. O(parts).
std::vector<FrameDefect> dangling_numbers(const Frame& frame);

}  // namespace sunder
