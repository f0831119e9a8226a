// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "meshing/region.hpp"
#include "meshing/vec.hpp"
#include "sim/pose.hpp"

namespace sunder {

/// A convex solid as a painter sees it: a prism in the frame of the wall it comes from, or a
/// sphere.
struct StripSolid {
  std::span<const Vec2> outline;  ///< counter-clockwise, extruded over z = ±half; empty: a sphere
  double half = 0;                ///< m; a sphere's radius
  Pose pose;
  Vec3 eye;                      ///< the camera's, in the solid's frame
  std::vector<Vec3> corners;     ///< world: at the back, then at the front; a sphere's centre
  std::vector<Vec2> silhouette;  ///< of its picture, convex, counter-clockwise
  Box screen;                    ///< around that
  double distance = 0;           ///< of its middle from the eye
  std::uint32_t body = 0;        ///< solids of one body do not move against each other
  bool is_flat = false;          ///< shows nothing but a cap, in the plane of its body's other caps
};

/// Convex hull, counter-clockwise.
std::vector<Vec2> convex_hull(std::vector<Vec2> points);

/// Order in which solids are painted so that what is in front comes later. Two disjoint convex
/// solids are separated by a plane (a face of either, or along an edge of each): the one on the
/// eye's side can only hide the other; of two that overlap a little, by the plane that comes
/// nearest to it. Flat solids of one body follow each other where that is allowed. Rings of solids
/// that each hide the next are cut: at the farthest solid left; or, if `cut` asks where, at the
/// farthest of the ring itself. Those that `cut` gets can be put in order once they are divided.
std::vector<std::uint32_t> painters_order(std::span<const StripSolid> solids,
                                          std::vector<std::uint32_t>* cut = nullptr);

}  // namespace sunder
