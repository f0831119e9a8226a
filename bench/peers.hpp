// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "fracture/sites.hpp"

namespace sunder {

/// Cells as polygons in lattice units, corner after corner; what every peer has to produce.
struct Polygons {
  std::vector<Vec2> corners;
  std::vector<std::uint32_t> begin{0};
  std::vector<std::uint32_t> site;  ///< of each, by number
};

/// Delaunay triangulation with exact predicates, its dual, clipped to the box.
Polygons cgal_cells(const Sites& sites);
/// The container of voro++ with about four sites a block, as its author advises for speed.
Polygons voropp_cells(const Sites& sites);

}  // namespace sunder
