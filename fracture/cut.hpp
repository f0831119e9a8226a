// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fracture/pattern.hpp"
#include "meshing/region.hpp"

namespace sunder {

/// A convex cell (straight corners allowed) in exact arithmetic: edge k lies on lines[k] and starts
/// at vertices[k]; all relative to `base`. Same corners, in the same order, as in the pattern.
struct ExactCell {
  LatticePoint base;
  std::vector<LatticeLine> lines;
  std::vector<LatticeCrossing> vertices;
};

/// The exact form of a pattern's cells, made when asked for.
struct ExactCells {
  std::function<ExactCell(std::uint32_t cell)> cell;
  LatticePoint start;  ///< a lattice point of cell 0, its boundary included
};

struct CutStats {
  std::uint64_t cells_cut = 0;      ///< cells that a boundary edge of the region goes through
  std::uint64_t cells_outside = 0;  ///< cells that lie outside the region altogether
};

/// The part of a pattern of convex cells (over the lattice's box) that lies in the region. A cell
/// that the boundary cuts into several parts gives several cells with one origin; a part that is
/// not convex or has a hole is one cell. New vertices are *identified* – boundary corner k, or the
/// pair of cells and the boundary edge that cross – so every cell that meets there uses the same
/// one; all decisions, also where boundary and cell edges coincide, are exact. `across` borders
/// become boundary edges of the region. Only cells near the boundary are looked at, the rest is
/// copied. O(cells + cells met × edges met).
Pattern cut(const Pattern& pattern, const ExactCells& exact, const LatticeRegion& region,
            CutStats* stats = nullptr);

}  // namespace sunder
