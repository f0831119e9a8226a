// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "fracture/pattern.hpp"
#include "fracture/sites.hpp"
#include "meshing/lattice.hpp"

namespace sunder {

/// How cells of gridded sites are proposed; the result does not depend on it.
enum class VoronoiKernel { automatic, portable, avx2 };

struct VoronoiParams {
  VoronoiKernel kernel = VoronoiKernel::automatic;
  int threads = 1;
};

/// Counters of one run.
struct VoronoiStats {
  std::uint64_t proposed = 0;   ///< cells a fast kernel proposed and the certificate accepted
  std::uint64_t exact = 0;      ///< cells computed in 128-bit arithmetic
  std::uint64_t merged_vertices = 0;  ///< vertices where four or more cells meet
  bool vectorised = false;
};

/// The Voronoi pattern of the sites, clipped to the lattice's bounding box: cell k is site k's.
///
/// The topology is exactly that of the lattice sites (ties included: where four or more cells meet
/// there is one vertex), certified or computed in exact arithmetic. Vertex coordinates are one pure
/// function of the generators that define them, error below 1e-13 of a cell, computed once. Cells
/// are strictly convex; an edge whose ends round to the same coordinates (possible only next to a
/// tie) is dropped like a tie. Border edges are 0 bottom, 1 right, 2 top, 3 left. A cell's corners
/// start with its smallest `across`; the bytes do not depend on kernel or threads.
/// Expected O(n). Throws Error{geometry} if two sites coincide.
/// Method: on a grid, stars completed by empty circles, each found once by its first site; else ring
/// search to the security radius (Rycroft 2009); then a 128-bit certificate and exact repair.
Pattern voronoi(const Sites& sites, VoronoiParams params = {}, VoronoiStats* stats = nullptr);

/// True when this processor can run the AVX2 kernel.
bool has_avx2();

/// One cell's edges in counter-clockwise order, exactly: neighbour site, or ~side for the box.
/// Brute force over every site; the definition the fast paths are tested against. O(n).
std::vector<std::int32_t> exact_cell(const Sites& sites, std::uint32_t site);

}  // namespace sunder
