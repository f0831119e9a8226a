// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "fracture/pattern.hpp"
#include "meshing/vec.hpp"

namespace sunder {

/// Per cell a point (m, wall frame) such that the lines between the points of neighbours cross
/// their common edges at right angles, in the middle: of a Voronoi pattern its sites, of others the
/// best points in the sense of least squares, weighted with the lengths of the edges. Where that
/// leaves a point free it is the one nearest to the cells' centroids. A cell that has no neighbour,
/// and one whose point would lie further away than three times its size, keeps its centroid.
/// By conjugate gradients, O(edges) each step, to 1e-14 of the cells' size.
std::vector<Vec2> cell_sites(const Pattern& pattern, const std::vector<Vec2>& centroids);

}  // namespace sunder
