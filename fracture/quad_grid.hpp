// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "fracture/pattern.hpp"
#include "fracture/sites.hpp"
#include "meshing/lattice.hpp"

namespace sunder {

/// The jittered points of a quad grid: (columns + 1) × (rows + 1) lattice points in raster order.
/// Point (i, j) lies in the half-open box of one grid cell's size centred on its grid node, border
/// points stay on their border, corners on their corner.
struct QuadPoints {
  GridShape grid;
  std::vector<LatticePoint> points;
};

/// Point k moves by up to `jitter` (0 … 1) half cells per axis; depends on (seed, k) only.
QuadPoints jittered_points(const GridShape& grid, double jitter, std::uint64_t seed);

/// A quad-grid pattern over the lattice's box: quads between cardinal neighbours. A quad is never
/// inverted (its points' boxes cannot interleave); one that is not convex is cut in two at its
/// reflex corner, decided exactly. Cells come from quads in raster order: `pattern.origin[c]` is
/// the quad. Border edges: 0 bottom, 1 right, 2 top, 3 left. Every cell has positive area.
struct QuadGrid {
  Pattern pattern;
  /// Lattice point of every pattern vertex (vertex v of the pattern is point v of the grid).
  std::vector<LatticePoint> points;
  std::uint32_t quads_split = 0;
};
QuadGrid quad_grid(const QuadPoints& points);

/// Cells that break when the given grid points are destroyed (all quads that use one), and the
/// intact points that have no intact quad left: the zero-thickness remains of the point mode.
/// `point_broken` and `cell_broken` carry the flags in and out; returns what changed, sorted.
/// Touches only quads next to the points.
struct PointBreak {
  std::vector<std::uint32_t> cells;      ///< cells that broke now
  std::vector<std::uint32_t> leftovers;  ///< points removed because nothing is left around them
};
PointBreak break_points(const QuadGrid& quads, const GridShape& grid,
                        const std::vector<std::uint32_t>& points,
                        std::vector<std::uint8_t>& point_broken,
                        std::vector<std::uint8_t>& cell_broken);

}  // namespace sunder
