// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "meshing/lattice.hpp"

namespace sunder {

/// A site on the wall's lattice; kMaxExtent fits 32 bits.
struct Site {
  std::int32_t x = 0, y = 0;
  friend bool operator==(const Site&, const Site&) = default;
  friend auto operator<=>(const Site&, const Site&) = default;
};

/// The generating points of a Voronoi pattern over the lattice's bounding box. All distinct.
/// With `columns` > 0 they are gridded: site j * columns + i lies in the half-open grid cell
/// [i, i+1) × [j, j+1) of `cell_width` × `cell_height` lattice units, which tile the lattice
/// exactly; cell_width, cell_height <= 2^20. Otherwise `columns` = 0 and the order is free.
struct Sites {
  Lattice lattice;
  std::vector<Site> points;
  std::int32_t columns = 0, rows = 0;
  std::int32_t cell_width = 0, cell_height = 0;
  std::uint32_t duplicates_dropped = 0;
};

/// Most cells a wall may have; more is refused instead of running out of memory.
constexpr std::uint32_t kMaxCells = 1u << 24;

/// Lattice of a grid of nearly square cells: columns × rows cells of about `cell` metres that tile
/// the box exactly. Throws Error{geometry} above kMaxCells (says the smallest cell that fits).
struct GridShape {
  Lattice lattice;
  std::int32_t columns = 1, rows = 1;
  std::int32_t cell_width = 1, cell_height = 1;  ///< lattice units
};
GridShape make_grid(Vec2 origin, Vec2 size, double cell);

/// One site per grid cell, uniform in the centred part of the cell that is `jitter` (0 … 1) wide;
/// 0 puts it at the centre. Site k depends on (seed, k) only.
Sites jittered_sites(const GridShape& grid, double jitter, std::uint64_t seed);

/// `count` independent uniform sites (Poisson-Voronoi). A draw that repeats a site is redrawn.
Sites random_sites(const Lattice& lattice, std::uint32_t count, std::uint64_t seed);

/// Given sites, snapped to the lattice; repeats are dropped and counted. Sites must lie in the box.
Sites given_sites(const Lattice& lattice, std::span<const Vec2> metres);

/// `count` sites that lie denser around the focus points: each is with probability `share` drawn
/// around a random focus at a uniform distance up to `radius` (density falls as 1/distance), else
/// uniform in the box. Draws outside the box are redrawn.
struct FocusParams {
  std::uint32_t count = 200;
  double radius = 1.0;  ///< m
  double share = 0.7;
};
Sites focused_sites(const Lattice& lattice, std::span<const Vec2> focus_points, FocusParams params,
                    std::uint64_t seed);

}  // namespace sunder
