// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "fracture/pattern.hpp"

namespace sunder {

/// Makes a pattern fit for float32 files by joining what they could not tell apart, for all cells
/// that meet there, so that neighbours go on sharing vertices and the partition stays exact:
/// * vertices of a cell not further apart than `length` (m; 0: only equal coordinates) become one;
/// * a vertex that near to another edge of its cell becomes a vertex of that edge, unless the edge
///   is on the border.
/// A vertex on the border moves along its boundary edge only, a corner of the region never. Cells
/// that shrink to nothing disappear, their neighbours then share the edge. O(corners log corners).
Pattern join_near_vertices(Pattern pattern, double length);

/// Cuts every cell that visits a vertex twice – its loop touches itself, or a hole touches it –
/// into convex cells of one origin, along diagonals between its own vertices. A solid whose faces
/// meet in one line from four sides is no manifold; its parts are. O(corners) when there is none.
Pattern split_pinches(Pattern pattern);

}  // namespace sunder
