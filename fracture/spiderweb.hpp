// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "fracture/pattern.hpp"
#include "meshing/region.hpp"

namespace sunder {

/// Local damage around impact points, as glass and concrete show it. Lengths in metres.
struct SpiderwebParams {
  std::vector<Vec2> impacts;    ///< points inside the region
  std::int64_t min_points = 7;  ///< fewest corners of a damage polygon, >= 3
  std::int64_t max_points = 12;
  double min_radius = 0.25;     ///< of a damage polygon's corners
  double max_radius = 0.6;
  std::int64_t rings = 2;       ///< ring cracks inside the polygon; 0: none
  std::int64_t radial = 0;      ///< radial cracks that run on from the polygon; 0: none
  double reach = 2.0;           ///< how far radial cracks run from the impact point, m
  double rest_cell = 0.6;       ///< size of the cells outside the damage, m
};

/// Counters of one run.
struct SpiderwebStats {
  std::uint32_t polygons = 0;         ///< damage polygons after merging impacts that overlap
  std::uint32_t corners_filled = 0;   ///< triangles that fill concave corners
  std::uint32_t draws_repaired = 0;   ///< draws whose polygon would have missed its impact point
};

/// Pattern over the region around the impacts; `across` borders are the region's boundary edges.
///
/// Per impact the paper's polygon: n random corners at increasing angles; a gap of half a turn or
/// more between neighbouring corners is narrowed, so that the impact point is always strictly
/// inside. Its sectors from the impact point to each edge are cells, cut by the ring cracks;
/// concave corners are filled by triangles until the polygon is convex; polygons that overlap are
/// merged into one convex polygon (the gaps between become cells). The rest of the wall is a
/// constrained Delaunay triangulation against border and openings, gathered into cells of about
/// `rest_cell`. Every vertex and edge is carried from that one triangulation (CGAL, exact
/// predicates), so neighbours share vertices by construction.
/// Throws Error{geometry} when an impact lies outside the region or the radii are below what its
/// lattice resolves, Error{input} when parameters contradict each other.
Pattern spiderweb(const LatticeRegion& region, const SpiderwebParams& params, std::uint64_t seed,
                  SpiderwebStats* stats = nullptr);

}  // namespace sunder
