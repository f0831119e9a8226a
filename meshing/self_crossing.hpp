// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "meshing/tri_mesh.hpp"

namespace sunder {

/// How far one triangle must be moved to part it from the other, m: 0 or less if they have no inner
/// point in common, as neighbours at a corner or edge and triangles in one plane have not. In
/// floating point, right to some roundings of the corners' distances (separating axes; Gottschalk,
/// Lin, Manocha 1996).
double crossing_depth(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Whether two triangles of a surface cross by more than `depth`, m. What crosses by less is
/// thinner than that. Coordinates must be finite. O((triangles + pairs with overlapping boxes)
/// log).
bool crosses_itself(const TriMesh& mesh, double depth);

/// What rounding to float32 may move corners of a mesh towards each other, m, with a margin of two.
double float_rounding(const TriMesh& mesh);

/// Whether a closed surface at float32 precision crosses itself by more than that rounding, or a
/// shell of it faces the wrong way, as a closed one inside another that is no cavity. What is not
/// finite is not: its volume tells. O(triangles log triangles).
bool is_tangled(const TriMesh& mesh);

}  // namespace sunder
