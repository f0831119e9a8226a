// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fracture/pattern.hpp"

namespace sunder {

/// A triangulated region to be gathered into cells.
struct CrackedTriangles {
  std::vector<Vec2> vertices;                           ///< metres
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise
  /// Across edge k (from corner k to the next) of each triangle: a triangle or a boundary edge.
  std::vector<std::array<Across, 3>> across;
  std::vector<std::array<bool, 3>> is_crack;  ///< whether edge k is a crack, the same on both sides
  /// Whether a triangle lies in damage: there everything up to the next crack is one cell.
  std::vector<bool> is_damaged;
};

struct GatherParams {
  double cell_area = 1;  ///< of a cell outside the damage, about, m²
  /// Cells not wider than this (twice their area over their perimeter) join a neighbour even across
  /// a crack; m. For what rounding leaves between cracks that almost coincide.
  double least_width = 0;
  /// The same for cells outside the damage, whether they then join it or each other; m.
  double least_rest_width = 0;
  /// Vertices nearer than this along an edge become one, those of the border stay where they are;
  /// m.
  double least_edge = 0;
};

/// The triangles of each part that cracks and border bound, the largest first: it tells where the
/// part lies, far from the rounding of the cracks. `is_damaged` is not used.
std::vector<std::vector<std::uint32_t>> parts_between_cracks(const CrackedTriangles& triangles);

/// Gathers triangles into cells that are topological discs: greedily the pair whose union is most
/// compact, never across a crack. What stays far below `cell_area` joins the neighbour it has the
/// longest edge with. `is_damaged` gets a flag per cell. Deterministic. O(n log n).
Pattern gather(const CrackedTriangles& triangles, const GatherParams& params,
               std::vector<std::uint8_t>* is_damaged = nullptr);

}  // namespace sunder
