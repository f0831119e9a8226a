// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fracture/wall.hpp"
#include "io/json_place.hpp"

namespace sunder {

/// Reads a pattern; its key "type" chooses the others. Throws as Place::fail.
PatternParams read_pattern(const Place& place);

}  // namespace sunder
