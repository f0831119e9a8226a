// SPDX-License-Identifier: GPL-3.0-or-later
// Complexes of planes: grids by counting, arrangements by cutting all cells plane after plane.
#include <algorithm>
#include <cmath>
#include <map>

#include "fracture/solid_complex.hpp"
#include "fracture/solid_exact.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr double kFar = 2 * SolidFrame::kHalf;  // of the box around an arrangement

// ---------------------------------------------------------------------------------------------
// Grids

struct Grid {
  using Index = std::array<std::uint32_t, 3>;
  std::array<std::vector<double>, 3> at;  // with both far ends
  SolidComplex complex;

  std::uint32_t corner(const Index& i) const {
    const auto nx = static_cast<std::uint32_t>(at[0].size()),
               ny = static_cast<std::uint32_t>(at[1].size());
    return i[0] + nx * (i[1] + ny * i[2]);
  }
  std::uint32_t cell(const Index& i) const {
    const auto nx = static_cast<std::uint32_t>(at[0].size() - 1),
               ny = static_cast<std::uint32_t>(at[1].size() - 1);
    return i[0] + nx * (i[1] + ny * i[2]);
  }
  // The edge along an axis that starts at a corner.
  std::uint32_t edge(std::size_t axis, const Index& i) const {
    return 3 * corner(i) + static_cast<std::uint32_t>(axis);
  }
  static Index moved(Index i, std::size_t axis) { return ++i[axis], i; }

  template <class Visit>
  void for_range(const Index& begin, const Index& end, Visit visit) const {
    for (std::uint32_t k = begin[2]; k < end[2]; ++k)
      for (std::uint32_t j = begin[1]; j < end[1]; ++j)
        for (std::uint32_t i = begin[0]; i < end[0]; ++i) visit(Index{i, j, k});
  }

  void add_facet(std::size_t axis, const Index& i) {
    const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
    Index below = i;
    --below[axis];
    SolidComplex::Plane plane{{axis == 0 ? 1.0 : 0, axis == 1 ? 1.0 : 0, axis == 2 ? 1.0 : 0},
                              at[axis][i[axis]]};
    const auto f = static_cast<std::uint32_t>(complex.facets.size());
    complex.facets.push_back({cell(below), cell(i), plane});
    const std::uint32_t edges[4] = {edge(b, i), edge(c, moved(i, b)), edge(b, moved(i, c)),
                                    edge(c, i)};
    for (const Index& v : {i, moved(i, b), moved(moved(i, b), c), moved(i, c)})
      complex.facet_vertices.push_back(corner(v));
    for (const std::uint32_t e : edges) {
      complex.facet_edges.push_back(e);
      auto& known = complex.edges[e];
      if (known.f == kNone)
        known.f = f;
      else if (!(complex.facets[known.f].plane.n == plane.n))
        known.g = f;
    }
    complex.facet_begin.push_back(static_cast<std::uint32_t>(complex.facet_vertices.size()));
  }

  void build() {
    Index corners, cells;
    for (std::size_t a = 0; a < 3; ++a) {
      corners[a] = static_cast<std::uint32_t>(at[a].size());
      cells[a] = corners[a] - 1;
    }
    complex.cell_count = cells[0] * cells[1] * cells[2];
    for_range({0, 0, 0}, corners, [&](const Index& i) {
      complex.vertices.push_back({at[0][i[0]], at[1][i[1]], at[2][i[2]]});
      bool far = false;
      for (std::size_t a = 0; a < 3; ++a) far |= i[a] == 0 || i[a] == cells[a];
      complex.is_far.push_back(far);
      for (std::size_t a = 0; a < 3; ++a)  // those at the far end have no length and no facet
        complex.edges.push_back(
            {corner(i), i[a] < cells[a] ? corner(moved(i, a)) : corner(i), kNone, kNone});
    });
    for (std::size_t a = 0; a < 3; ++a) {
      Index begin{0, 0, 0};
      begin[a] = 1;
      for_range(begin, cells, [&](const Index& i) { add_facet(a, i); });
    }
  }
};

// ---------------------------------------------------------------------------------------------
// Arrangements

struct Arrangement {
  struct Corner {
    std::array<std::uint32_t, 3> planes;
  };
  struct Edge {
    std::uint32_t from, to;
    std::array<std::uint32_t, 2> planes;
  };
  struct Facet {
    std::uint32_t plane, below, above;  // cells; kNone: outside the box
    std::vector<std::uint32_t> edges;
  };
  std::vector<SolidComplex::Plane> planes;
  std::vector<Corner> corners;
  std::vector<Edge> edges;
  std::vector<Facet> facets;
  std::vector<std::vector<std::uint32_t>> cells;
  // Of the cut at work
  std::vector<int> side;                   // per corner
  std::vector<std::uint32_t> upper;        // per edge: the part above the plane
  std::vector<std::uint32_t> upper_facet;  // per facet
  std::vector<std::uint32_t> seam;         // per facet: the edge along the plane

  static constexpr std::uint32_t id(std::size_t n) { return static_cast<std::uint32_t>(n); }

  // The far box: planes 0 … 5 are x = ±, y = ±, z = ±; corner c's are 0 + bit, 2 + bit, 4 + bit.
  void start() {
    for (int k = 0; k < 6; ++k) {
      const double sign = k % 2 ? 1 : -1;
      planes.push_back(
          {{k / 2 == 0 ? sign : 0, k / 2 == 1 ? sign : 0, k / 2 == 2 ? sign : 0}, kFar});
    }
    for (std::uint32_t c = 0; c < 8; ++c)
      corners.push_back({{c & 1, 2 + (c >> 1 & 1), 4 + (c >> 2 & 1)}});
    for (std::uint32_t c = 0; c < 8; ++c)
      for (std::uint32_t a = 0; a < 3; ++a) {
        if (c >> a & 1) continue;
        const std::uint32_t b = (a + 1) % 3, d = (a + 2) % 3;
        edges.push_back({c, c | 1u << a, {2 * b + (c >> b & 1), 2 * d + (c >> d & 1)}});
      }
    for (std::uint32_t p = 0; p < 6; ++p) {
      facets.push_back({p, 0, kNone, {}});
      for (std::uint32_t e = 0; e < edges.size(); ++e)
        if (edges[e].planes[0] == p || edges[e].planes[1] == p) facets[p].edges.push_back(e);
    }
    cells.push_back({0, 1, 2, 3, 4, 5});
  }

  int side_of(const Corner& c, const SolidComplex::Plane& plane) const {
    const std::array<const SolidComplex::Plane*, 3> at{&planes[c.planes[0]], &planes[c.planes[1]],
                                                       &planes[c.planes[2]]};
    const auto value = corner_value<Bounded>(at, plane);
    if (value[0].is_certain() && value[1].is_certain())
      return (value[0].value > 0) == (value[1].value > 0) ? 1 : -1;
    const int sign = exact_corner_side(at, plane);
    if (sign == 0)
      throw Error(ErrorCode::geometry,
                  "solid pattern: four slices meet in a point; another seed moves them");
    return sign;
  }

  void split_edges(std::uint32_t plane) {
    upper.assign(edges.size(), kNone);
    const std::size_t count = edges.size();
    for (std::uint32_t e = 0; e < count; ++e) {
      if (side[edges[e].from] == side[edges[e].to]) continue;
      const std::uint32_t middle = id(corners.size());
      corners.push_back({{edges[e].planes[0], edges[e].planes[1], plane}});
      const bool rises = side[edges[e].to] > 0;
      upper[e] = id(edges.size());
      edges.push_back({middle, rises ? edges[e].to : edges[e].from, edges[e].planes});
      (rises ? edges[e].to : edges[e].from) = middle;
    }
  }

  // Whether what is left of an edge lies above the plane; those that are split lie below.
  bool is_above(std::uint32_t e) const {
    return upper[e] == kNone &&
           (edges[e].from < side.size() ? side[edges[e].from] : side[edges[e].to]) > 0;
  }

  void split_facets(std::uint32_t plane) {
    const std::size_t count = facets.size();
    upper_facet.assign(count, kNone);
    seam.assign(count, kNone);
    for (std::uint32_t f = 0; f < count; ++f) {
      std::vector<std::uint32_t> low, high, ends;
      for (const std::uint32_t e : facets[f].edges) {
        (is_above(e) ? high : low).push_back(e);
        if (upper[e] == kNone) continue;
        high.push_back(upper[e]);
        ends.push_back(edges[upper[e]].from);
      }
      if (ends.empty()) continue;
      seam[f] = id(edges.size());
      edges.push_back({ends[0], ends[1], {facets[f].plane, plane}});
      low.push_back(seam[f]);
      high.push_back(seam[f]);
      upper_facet[f] = id(facets.size());
      facets[f].edges = std::move(low);
      facets.push_back({facets[f].plane, facets[f].below, facets[f].above, std::move(high)});
    }
  }

  void split_cells(std::uint32_t plane) {
    const std::size_t count = cells.size();
    for (std::uint32_t c = 0; c < count; ++c) {
      std::vector<std::uint32_t> low, high;
      Facet wall{plane, c, id(cells.size()), {}};
      for (const std::uint32_t f : cells[c]) {
        const bool split = upper_facet[f] != kNone;
        (split || !is_above(facets[f].edges[0]) ? low : high).push_back(f);
        if (!split) continue;
        high.push_back(upper_facet[f]);
        wall.edges.push_back(seam[f]);
      }
      if (wall.edges.empty()) continue;
      for (const std::uint32_t f : high)
        (facets[f].below == c ? facets[f].below : facets[f].above) = wall.above;
      low.push_back(id(facets.size()));
      high.push_back(id(facets.size()));
      facets.push_back(std::move(wall));
      cells[c] = std::move(low);
      cells.push_back(std::move(high));
    }
  }

  void cut(const SolidComplex::Plane& plane) {
    side.clear();
    for (const Corner& c : corners) side.push_back(side_of(c, plane));
    const std::uint32_t p = id(planes.size());
    planes.push_back(plane);
    split_edges(p);
    split_facets(p);
    split_cells(p);
  }

  Vec3 place(const Corner& c) const {
    const auto &p = planes[c.planes[0]], &q = planes[c.planes[1]], &r = planes[c.planes[2]];
    const Vec3 qr = cross(q.n, r.n), rp = cross(r.n, p.n), pq = cross(p.n, q.n);
    return (1 / dot(p.n, qr)) * (p.d * qr + q.d * rp + r.d * pq);
  }

  // A facet's edges one after the other, counter-clockwise seen along its normal from above.
  void add_loop(const Facet& facet, SolidComplex& complex) const {
    std::vector<std::uint32_t> loop, order;
    std::vector<std::uint8_t> used(facet.edges.size());
    std::uint32_t at = edges[facet.edges[0]].from;
    do
      for (std::size_t k = 0; k < used.size(); ++k) {
        const Edge& e = edges[facet.edges[k]];
        if (used[k] || (e.from != at && e.to != at)) continue;
        used[k] = 1;
        loop.push_back(at);
        order.push_back(facet.edges[k]);
        at = e.from ^ e.to ^ at;
        break;
      }
    while (loop.size() < used.size());
    Vec3 sum;
    for (std::size_t k = 2; k < loop.size(); ++k)
      sum = sum + cross(complex.vertices[loop[k - 1]] - complex.vertices[loop[0]],
                        complex.vertices[loop[k]] - complex.vertices[loop[0]]);
    if (dot(sum, planes[facet.plane].n) < 0) {
      std::ranges::reverse(loop);
      std::ranges::reverse(order);
      std::ranges::rotate(order, order.begin() + 1);
    }
    const auto f = id(complex.facets.size());
    complex.facets.push_back({facet.below, facet.above, planes[facet.plane]});
    for (const std::uint32_t e : order) {
      auto& edge = complex.edges[e];
      if (edge.f == kNone)
        edge.f = f;
      else if (!(complex.facets[edge.f].plane.n == planes[facet.plane].n))
        edge.g = f;
    }
    complex.facet_vertices.insert(complex.facet_vertices.end(), loop.begin(), loop.end());
    complex.facet_edges.insert(complex.facet_edges.end(), order.begin(), order.end());
    complex.facet_begin.push_back(id(complex.facet_vertices.size()));
  }

  SolidComplex finish() const {
    SolidComplex complex;
    complex.cell_count = id(cells.size());
    for (const Corner& c : corners) {
      complex.vertices.push_back(place(c));
      complex.is_far.push_back(
          std::ranges::any_of(c.planes, [](std::uint32_t p) { return p < 6; }));
    }
    for (const Edge& e : edges) complex.edges.push_back({e.from, e.to, kNone, kNone});
    for (const Facet& facet : facets)
      if (facet.above != kNone) add_loop(facet, complex);
    return complex;
  }
};

}  // namespace

SolidComplex grid_complex(const std::array<std::vector<double>, 3>& planes) {
  Grid grid;
  for (std::size_t a = 0; a < 3; ++a) {
    grid.at[a] = {-kFar};
    grid.at[a].insert(grid.at[a].end(), planes[a].begin(), planes[a].end());
    grid.at[a].push_back(kFar);
  }
  grid.build();
  link_cells(grid.complex);
  return std::move(grid.complex);
}

SolidComplex plane_complex(std::span<const SolidComplex::Plane> planes) {
  Arrangement arrangement;
  arrangement.start();
  for (const auto& plane : planes) arrangement.cut(plane);
  SolidComplex complex = arrangement.finish();
  link_cells(complex);
  return complex;
}

}  // namespace sunder
