// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "meshing/lattice.hpp"

namespace sunder {

/// A place on a lattice of some step, coordinates in ±2^24: as many as a float32 holds exactly, so
/// that what is decided here stays true in a file.
struct HullPoint {
  std::int32_t x = 0, y = 0, z = 0;
  friend auto operator<=>(const HullPoint&, const HullPoint&) = default;
};
constexpr std::int32_t kHullReach = 1 << 24;

/// A plane through `at`; its normal has coordinates below 2^52.
struct HullPlane {
  std::array<std::int64_t, 3> normal{};
  HullPoint at;
  /// Exact; > 0 on the normal's side. Divided by the normal's length: the distance in steps.
  Int128 side(HullPoint p) const {
    return Int128{normal[0]} * (p.x - at.x) + Int128{normal[1]} * (p.y - at.y) +
           Int128{normal[2]} * (p.z - at.z);
  }
  double size() const;  ///< of the normal
};
/// Normal (b - a) × (c - a).
HullPlane plane_through(HullPoint a, HullPoint b, HullPoint c);

/// A closed convex mesh: no vertex lies above a triangle's plane (exactly); triangles may be in one
/// plane, none is degenerate. Empty for points that all lie in a plane.
struct ConvexHull {
  std::vector<HullPoint> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise from outside
  /// Points that are outside since the hull would have had too many vertices.
  std::vector<HullPoint> missed;
  double volume() const;  ///< in cubic steps
};

/// The hull of the points, or of `most` of its vertices (4 at least) if it has more: always the one
/// farthest out next (Barber et al., "The quickhull algorithm", 1996). The same points in any order
/// give the same hull but for the order of its vertices. O(n log n) as a rule, O(n × most) at
/// worst.
ConvexHull convex_hull(std::span<const HullPoint> points, std::size_t most);

}  // namespace sunder
