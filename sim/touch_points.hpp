// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "meshing/vec.hpp"

namespace sunder {

/// Where two solids are close: between the surfaces, with the normal from the second to the first
/// and the distance, negative if they overlap. World.
struct TouchPoint {
  Vec3 at;
  Vec3 normal;
  double gap = 0;
};

/// Keeps at most four, so that they carry what all would: the deepest, then those that span the
/// largest area. What lies right behind a nearer one is dropped first. Stable.
void keep_four(std::vector<TouchPoint>& points);

/// Corners of a strictly convex counter-clockwise polygon whose sides are moved inwards by `by`.
std::vector<Vec2> inset(const std::vector<Vec2>& outline, double by);
/// Least distance of the sides from the centroid.
double inner_radius(const std::vector<Vec2>& outline);

}  // namespace sunder
