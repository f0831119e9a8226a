// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "fracture/wall.hpp"
#include "io/json_place.hpp"
#include "sim/projectile.hpp"

namespace sunder {

/// Reads a list of projectiles. Their names differ from each other's and from those of the walls
/// and their chunks: all become nodes of one file. Throws as Place::fail.
std::vector<Projectile> read_projectiles(const Place& list, std::span<const Wall> walls);

}  // namespace sunder
