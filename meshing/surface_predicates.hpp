// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "meshing/vec.hpp"

namespace sunder {

/// Corners of a triangle as indices of its mesh's vertices.
using Corners = std::array<std::uint32_t, 3>;

/// Whether the corners lie on one line, decided exactly on the coordinates.
bool is_flat(Vec3 a, Vec3 b, Vec3 c);

/// Whether two triangles have a point in common that is not of a corner or edge they share by
/// index, decided exactly. Both have an area and finite corners, and differ in at least one corner.
bool meet_apart(std::span<const Vec3> vertices, const Corners& a, const Corners& b);

/// How the ray from p along +x passes the triangle: +1 out of its front, -1 into it, 0 not at all.
/// Exact; p counts as moved by (0, e, e²) for a vanishing e > 0, so that a ray through an edge or
/// corner of a closed surface passes one of the triangles there and the sum over the surface is
/// whole. A triangle that p itself lies in is not passed.
int crossing(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

}  // namespace sunder
