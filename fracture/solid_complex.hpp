// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "meshing/vec.hpp"

namespace sunder {

/// Integer point of a solid's lattice.
struct LatticeSite {
  std::int64_t x = 0, y = 0, z = 0;
  friend bool operator==(const LatticeSite&, const LatticeSite&) = default;
  friend auto operator<=>(const LatticeSite&, const LatticeSite&) = default;
};

/// The frame in which a solid's pattern is decided: `centre + step · p` metres, step a power of
/// two, the solid's bounding box within ±kHalf in every axis. Everything that is computed in it is
/// moved by `shift` first (steps): some thousandth of a step when the solid has corners or edges on
/// the pattern's planes or within `near` of them, else 0.
struct SolidFrame {
  static constexpr double kHalf = 0x1p22;
  Vec3 centre;
  double step = 1;
  Vec3 shift;
  double near = 0x1p-20;  ///< steps
  Vec3 to_steps(Vec3 metres) const { return (1 / step) * (metres - centre) + shift; }
  Vec3 to_metres(Vec3 steps) const { return centre + step * (steps - shift); }
};
/// The frame of a box; its sizes are finite, one above 0. Its points are whole numbers of steps
/// from the origin.
SolidFrame make_solid_frame(Vec3 low, Vec3 high);

/// Space cut into convex cells, face to face: a facet is a whole face of both its cells, an edge
/// belongs to all facets around it. Lattice steps. What lies beyond three times the solid's
/// bounding box is left out: cells there have no facet towards it.
struct SolidComplex {
  /// n·x < d on the side of `a`. The coefficients are exact as they are.
  struct Plane {
    Vec3 n;
    double d = 0;
  };
  struct Facet {
    std::uint32_t a = 0, b = 0;
    Plane plane;
  };
  struct Edge {
    std::uint32_t from = 0, to = 0;
    std::uint32_t f = 0, g = 0;  ///< two facets whose planes cut in its line
  };
  std::uint32_t cell_count = 0;
  std::vector<Vec3> vertices;
  std::vector<std::uint8_t> is_far;  ///< per vertex: surely outside the bounding box
  std::vector<Edge> edges;
  std::vector<Facet> facets;
  /// Facet f's corners and edges are numbers facet_begin[f] …, counter-clockwise seen from b; edge
  /// k runs from corner k to the next.
  std::vector<std::uint32_t> facet_begin{0}, facet_vertices, facet_edges;
  /// Cell c's facets are cell_facets[cell_begin[c]] …
  std::vector<std::uint32_t> cell_begin, cell_facets;
  /// Chunk that a cell belongs to; empty: cell c to chunk c.
  std::vector<std::uint32_t> labels;

  std::span<const std::uint32_t> facets_of(std::uint32_t cell) const {
    return std::span(cell_facets)
        .subspan(cell_begin[cell], cell_begin[cell + 1] - cell_begin[cell]);
  }
  std::span<const std::uint32_t> vertices_of(std::uint32_t facet) const {
    return std::span(facet_vertices)
        .subspan(facet_begin[facet], facet_begin[facet + 1] - facet_begin[facet]);
  }
  std::span<const std::uint32_t> edges_of(std::uint32_t facet) const {
    return std::span(facet_edges)
        .subspan(facet_begin[facet], facet_begin[facet + 1] - facet_begin[facet]);
  }
  std::uint32_t across(std::uint32_t facet, std::uint32_t cell) const {
    return facets[facet].a ^ facets[facet].b ^ cell;
  }
};

/// Fills cell_begin and cell_facets from the facets.
void link_cells(SolidComplex& complex);

/// Voronoi cells of different sites, |coordinates| <= 2 kHalf; cospherical sites make corners where
/// more than four cells meet. CGAL's Delaunay triangulation; O(n log n) for sites spread in space.
SolidComplex voronoi_complex(std::span<const LatticeSite> sites);

/// Boxes between planes across x, y and z: ascending coordinates in lattice steps, within ±kHalf.
/// Cell (i, j, k) is number i + (xs + 1) (j + (ys + 1) k).
SolidComplex grid_complex(const std::array<std::vector<double>, 3>& planes);

/// The arrangement of planes (lattice steps). Throws Error{geometry} if four of them meet in a
/// point. O(planes × cells).
SolidComplex plane_complex(std::span<const SolidComplex::Plane> planes);

}  // namespace sunder
