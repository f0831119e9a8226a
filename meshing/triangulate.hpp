// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "meshing/vec.hpp"

namespace sunder {

/// Polygon with holes as indices into `points`: the outer loop counter-clockwise, then holes
/// clockwise. Loops may touch themselves or each other at single points, may have straight corners
/// and may repeat a point (by index) where they touch; they do not cross.
using IndexLoops = std::vector<std::vector<std::uint32_t>>;

/// Triangles (indices into `points`, counter-clockwise) that tile the polygon; every loop edge is
/// an edge of exactly one triangle, no triangle is degenerate unless the loops themselves are.
/// Constrained Delaunay triangulation with exact predicates (CGAL). O(n log n).
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec2> points,
                                                      const IndexLoops& loops);

/// Convex polygons (indices into `points`, counter-clockwise, straight corners allowed) that tile
/// the polygon: its triangles, joined while they stay convex (Hertel and Mehlhorn 1983: at most
/// four times the least number). Convexity is decided exactly.
std::vector<std::vector<std::uint32_t>> convex_parts(std::span<const Vec2> points,
                                                     const IndexLoops& loops);

/// Sign of twice the area of (a, b, c), decided exactly on the coordinates: > 0 turns left.
int orientation(Vec2 a, Vec2 b, Vec2 c);

}  // namespace sunder
