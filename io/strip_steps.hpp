// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "sim/recording.hpp"

namespace sunder {

/// Steps that a strip of at most `frames` pictures shows, ascending: the last before anything
/// breaks; one 0.09 s after each hit, a projectile's first break of a wall (hits less than 0.08 s
/// apart share one, and some are left out where frames are few); the others at intervals that grow
/// in proportion after the hit before; at the end the one at which nearly all chunks rest. A single
/// picture is that of the first hit. Where nothing breaks or moves, evenly over the recording.
/// Those of a building: see building_steps.
std::vector<std::uint32_t> strip_steps(const Recording& recording, int frames);

/// The first step at or after a time (s), or the last one.
std::uint32_t step_at(const Recording& recording, double time);

}  // namespace sunder
