// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "fracture/asset.hpp"
#include "sim/projectile.hpp"

namespace sunder {

/// What the wall costs when every chunk is an active body, joined to its neighbours by Bullet's
/// fixed constraints that break at area × strength × dt: milliseconds of processor time of each of
/// `steps` steps, or fewer when `seconds` are used up.
std::vector<double> step_jointed_wall(const WallAsset& wall, double tensile_strength,
                                      const Projectile& projectile, double dt, int iterations,
                                      int steps, double seconds);

/// All chunks of walls as active bodies without joints, where the walls stand; as above.
std::vector<double> step_chunks(std::span<const WallAsset> walls, double dt, int iterations,
                                int steps, double seconds);

}  // namespace sunder
