// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fracture/spiderweb.hpp"
#include "meshing/region.hpp"

namespace sunder {

/// The cracks of a spiderweb before they are triangulated. Everything is in lattice units (metres
/// enter through the lattice's step), as doubles; corners of damage polygons are lattice points.
struct CrackWeb {
  struct Segment {
    Vec2 a, b;
  };
  /// Damage around one impact: what is nearer to it than to the group's other impacts and inside
  /// `hull`, its convex polygon, counter-clockwise.
  struct Zone {
    Vec2 impact;
    std::vector<Vec2> hull;
    std::uint32_t group = 0;
  };
  /// All cracks. They meet at shared end points, or one runs a little past the other, so that the
  /// triangulation finds their crossing; they may leave the region. First the edges of the hulls,
  /// then what is inside them, then the radial cracks, each segment by segment from a hull outward.
  std::vector<Segment> cracks;
  std::size_t inner_begin = 0, radial_begin = 0;
  /// Those of them that border on the rest of the wall: the groups' hulls and the radial cracks.
  std::vector<Segment> outer_cracks;
  std::vector<Zone> zones;
  std::vector<std::vector<Vec2>> hulls;  ///< convex polygon of each group of overlapping zones
};

/// Draws the damage around every impact. `spacing` is the distance of points along long edges,
/// lattice units. Throws Error{geometry} for an impact outside the region or radii below what the
/// lattice resolves, Error{input} for parameters that contradict each other.
CrackWeb plan_cracks(const LatticeRegion& region, const SpiderwebParams& params, double spacing,
                     std::uint64_t seed, SpiderwebStats& stats);

/// Whether a point lies in the damage of an impact (not in a gap between two).
bool is_damaged(const CrackWeb& web, Vec2 point);

/// Whether a point lies in a convex polygon or on its border, decided exactly.
bool is_in_convex(const std::vector<Vec2>& polygon, Vec2 point);

/// Jittered points about `spacing` apart on the rest of the wall, none near a crack or border.
struct RestPoints {
  std::vector<Vec2> inside;
  std::vector<std::vector<Vec2>> on_edge;  ///< per boundary edge, in its direction
};
RestPoints spread_rest_points(const LatticeRegion& region, const CrackWeb& web, double spacing,
                              std::uint64_t seed);

}  // namespace sunder
