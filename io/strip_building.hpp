// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "io/strip_scene.hpp"
#include "sim/recording.hpp"

namespace sunder {

/// Convex parts of a building's members (each its outline's bounding box: what a section is from
/// afar), slabs and walls. O(parts).
std::vector<StripPart> building_parts(const Recording& recording);

/// The two halves of a part, across its longest side.
std::array<StripPart, 2> halves_of(const StripPart& part);

/// Steps that a strip of a building shows, ascending: the first of all, that of the first broken
/// joint, the one at which nearly all parts rest, and between the last two those at which a weighed
/// sum of time and broken joints grew by equal shares. A single picture is the last one. Where no
/// joint breaks, evenly over the recording.
std::vector<std::uint32_t> building_steps(const Recording& recording, int frames);

}  // namespace sunder
