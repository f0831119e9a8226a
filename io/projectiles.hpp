// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "fracture/wall.hpp"
#include "io/json_place.hpp"
#include "sim/frame.hpp"
#include "sim/projectile.hpp"

namespace sunder {

/// Reads a list of projectiles. Their names differ from each other's, from those of the walls and
/// their chunks, and from those of the parts of the building, if there is one: all become nodes of
/// one file. Throws as Place::fail.
std::vector<Projectile> read_projectiles(const Place& list, std::span<const Wall> walls,
                                         const Frame* building);

}  // namespace sunder
