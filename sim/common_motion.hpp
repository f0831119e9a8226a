// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "sim/world_body.hpp"

// Internal to the rigid world.
namespace sunder {

/// Takes up to `energy` (J) from what moving bodies move against each other: their velocities
/// approach those of the rigid motion that has their momentum and angular momentum, which stay.
/// Returns the energy taken: less than asked for if all there is is less.
double approach_common_motion(std::span<Body* const> bodies, double energy);

}  // namespace sunder
