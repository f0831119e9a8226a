// SPDX-License-Identifier: GPL-3.0-or-later
// The Voronoi diagram as the dual of CGAL's Delaunay triangulation. Sites are integers, so that
// bisecting planes are exact in doubles and circumcentres are quotients of 128-bit integers.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "fracture/solid_complex.hpp"
#include "meshing/lattice.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
// Six sites of nobody, so far away that none of the bounding box is theirs: with them, every cell
// that matters is bounded.
constexpr std::int64_t kGhost = std::int64_t{1} << 25;

struct TetInfo {
  std::uint32_t id = kNone;
  std::array<std::uint32_t, 4> edge{kNone, kNone, kNone, kNone};  // dual of the side opposite i
};
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using CellBase =
    CGAL::Triangulation_cell_base_with_info_3<TetInfo, Kernel,
                                              CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Delaunay =
    CGAL::Delaunay_triangulation_3<Kernel,
                                   CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;
using Tet = Delaunay::Cell_handle;
using Point = Kernel::Point_3;

struct Builder {
  std::span<const LatticeSite> sites;
  std::uint32_t count;
  Delaunay delaunay;
  std::vector<Tet> tets;
  std::vector<std::uint32_t> vertex_of;  // per tetrahedron, after equal circumcentres are joined
  SolidComplex complex;
  std::vector<std::uint32_t> corners, edges;  // of the facet that is made

  explicit Builder(std::span<const LatticeSite> given)
      : sites(given), count(static_cast<std::uint32_t>(given.size())) {
    std::vector<std::pair<Point, std::uint32_t>> points;
    points.reserve(count + 6);
    for (std::uint32_t i = 0; i < count; ++i)
      points.emplace_back(Point(static_cast<double>(sites[i].x), static_cast<double>(sites[i].y),
                                static_cast<double>(sites[i].z)),
                          i);
    for (std::uint32_t k = 0; k < 6; ++k) {
      const double s = static_cast<double>(k % 2 == 0 ? kGhost : -kGhost);
      points.emplace_back(Point(k / 2 == 0 ? s : 0, k / 2 == 1 ? s : 0, k / 2 == 2 ? s : 0),
                          count + k);
    }
    delaunay.insert(points.begin(), points.end());
    complex.cell_count = count;
  }

  static LatticeSite site_of(Tet tet, int k) {
    const Point& p = tet->vertex(k)->point();
    return {static_cast<std::int64_t>(p.x()), static_cast<std::int64_t>(p.y()),
            static_cast<std::int64_t>(p.z())};
  }

  // Exact up to the last division.
  static Vec3 circumcentre(Tet tet) {
    const LatticeSite o = site_of(tet, 0);
    std::int64_t m[3][3];
    std::int64_t q[3];
    for (int k = 0; k < 3; ++k) {
      const LatticeSite s = site_of(tet, k + 1);
      m[k][0] = s.x - o.x, m[k][1] = s.y - o.y, m[k][2] = s.z - o.z;
      q[k] = m[k][0] * m[k][0] + m[k][1] * m[k][1] + m[k][2] * m[k][2];
    }
    const auto minor = [&](int a, int b, int i, int j) {
      return static_cast<Int128>(m[a][i]) * m[b][j] - static_cast<Int128>(m[a][j]) * m[b][i];
    };
    const auto solved = [&](int i, int j) {  // Σ q_k · cofactor of column (3 - i - j)
      return q[0] * minor(1, 2, i, j) + q[1] * minor(2, 0, i, j) + q[2] * minor(0, 1, i, j);
    };
    const Int128 det =
        m[0][0] * minor(1, 2, 1, 2) + m[1][0] * minor(2, 0, 1, 2) + m[2][0] * minor(0, 1, 1, 2);
    const double w = 2 * static_cast<double>(det);
    return {static_cast<double>(o.x) + static_cast<double>(solved(1, 2)) / w,
            static_cast<double>(o.y) + static_cast<double>(solved(2, 0)) / w,
            static_cast<double>(o.z) + static_cast<double>(solved(0, 1)) / w};
  }

  bool is_far(Tet tet) const {
    for (int k = 0; k < 4; ++k)
      if (tet->vertex(k)->info() >= count) return true;
    return false;
  }

  // An order that does not depend on how the triangulation stores its cells.
  void number_tets() {
    std::vector<std::pair<std::array<std::uint32_t, 4>, Tet>> order;
    for (const Tet tet : delaunay.finite_cell_handles()) {
      std::array<std::uint32_t, 4> key;
      for (int k = 0; k < 4; ++k) key[k] = tet->vertex(k)->info();
      std::sort(key.begin(), key.end());
      order.emplace_back(key, tet);
    }
    std::sort(order.begin(), order.end(),
              [](const auto& p, const auto& q) { return p.first < q.first; });
    for (const auto& [key, tet] : order) {
      tet->info().id = static_cast<std::uint32_t>(tets.size());
      tets.push_back(tet);
    }
  }

  std::uint32_t root(std::uint32_t t) {
    while (vertex_of[t] != t) t = vertex_of[t] = vertex_of[vertex_of[t]];
    return t;
  }

  // Equal ones are neighbours', or joined by equal neighbours.
  void join_equal_centres(const std::vector<Vec3>& centres) {
    vertex_of.resize(tets.size());
    std::iota(vertex_of.begin(), vertex_of.end(), 0u);
    for (std::uint32_t t = 0; t < tets.size(); ++t)
      for (int k = 0; k < 4; ++k) {
        const Tet other = tets[t]->neighbor(k);
        if (other->info().id == kNone || other->info().id < t) continue;
        if (length(centres[t] - centres[other->info().id]) > 0x1p-10 * kGhost) continue;
        const Point& p = other->vertex(other->index(tets[t]))->point();
        if (CGAL::side_of_oriented_sphere(tets[t]->vertex(0)->point(), tets[t]->vertex(1)->point(),
                                          tets[t]->vertex(2)->point(), tets[t]->vertex(3)->point(),
                                          p) != CGAL::ON_ORIENTED_BOUNDARY)
          continue;
        const std::uint32_t a = root(t), b = root(other->info().id);
        vertex_of[std::max(a, b)] = std::min(a, b);
      }
  }

  void place_vertices() {
    std::vector<Vec3> centres;
    centres.reserve(tets.size());
    for (const Tet tet : tets) centres.push_back(circumcentre(tet));
    join_equal_centres(centres);
    std::vector<std::uint32_t> number(tets.size());
    for (std::uint32_t t = 0; t < tets.size(); ++t) {
      if (root(t) != t) continue;
      number[t] = static_cast<std::uint32_t>(complex.vertices.size());
      complex.vertices.push_back(centres[t]);
      complex.is_far.push_back(0);
    }
    for (std::uint32_t t = 0; t < tets.size(); ++t) {
      vertex_of[t] = root(t);
      if (is_far(tets[t])) complex.is_far[number[vertex_of[t]]] = 1;
    }
    for (std::uint32_t& v : vertex_of) v = number[v];
  }

  void make_edges() {
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> known;  // of joined vertices only
    const bool joined = complex.vertices.size() < tets.size();
    for (const Tet tet : tets)
      for (int k = 0; k < 4; ++k) {
        const Tet other = tet->neighbor(k);
        if (other->info().id == kNone || other->info().id < tet->info().id) continue;
        std::array<std::uint32_t, 2> ends{vertex_of[tet->info().id], vertex_of[other->info().id]};
        if (ends[0] == ends[1]) continue;
        std::uint32_t id = static_cast<std::uint32_t>(complex.edges.size());
        if (joined) {
          std::sort(ends.begin(), ends.end());
          id = known.try_emplace(ends, id).first->second;
        }
        if (id == complex.edges.size()) complex.edges.push_back({ends[0], ends[1], kNone, kNone});
        tet->info().edge[k] = other->info().edge[other->index(tet)] = id;
      }
  }

  SolidComplex::Plane bisector(std::uint32_t a, std::uint32_t b) const {
    const auto square = [](const LatticeSite& s) { return s.x * s.x + s.y * s.y + s.z * s.z; };
    const LatticeSite p = sites[a], q = sites[b];
    return {{static_cast<double>(2 * (q.x - p.x)), static_cast<double>(2 * (q.y - p.y)),
             static_cast<double>(2 * (q.z - p.z))},
            static_cast<double>(square(q) - square(p))};
  }

  // The dual of the Delaunay edge between sites i and j of a tetrahedron.
  void add_facet(Tet start, int i, int j) {
    auto around = delaunay.incident_cells(start, i, j, start);
    const auto first = around;
    corners.clear();
    edges.clear();
    bool left = true;
    const auto u = start->vertex(i), v = start->vertex(j);
    do {
      const Tet tet = around;
      const Tet next = ++around;
      left = turns_left(tet, next, tet->index(u), tet->index(v));
      const std::uint32_t edge = tet->info().edge[tet->index(next)];
      if (edge == kNone) continue;  // of no length
      corners.push_back(vertex_of[tet->info().id]);
      edges.push_back(edge);
    } while (around != first);
    if (corners.size() < 3) return;
    const auto f = static_cast<std::uint32_t>(complex.facets.size());
    complex.facets.push_back({u->info(), v->info(), bisector(u->info(), v->info())});
    if (!left) {
      std::reverse(corners.begin(), corners.end());
      std::reverse(edges.begin(), edges.end());
      std::rotate(edges.begin(), edges.begin() + 1, edges.end());
    }
    complex.facet_vertices.insert(complex.facet_vertices.end(), corners.begin(), corners.end());
    complex.facet_edges.insert(complex.facet_edges.end(), edges.begin(), edges.end());
    complex.facet_begin.push_back(static_cast<std::uint32_t>(complex.facet_vertices.size()));
    for (const std::uint32_t e : edges) {
      auto& edge = complex.edges[e];
      if (edge.f == kNone)
        edge.f = f;
      else if (edge.g == kNone && share_cell(edge.f, f))  // else they may be in one plane
        edge.g = f;
    }
  }

  // Whether going from a tetrahedron to the next turns counter-clockwise seen from its vertex j;
  // CGAL's tetrahedra are positively oriented.
  static bool turns_left(Tet tet, Tet next, int i, int j) {
    const int w = tet->index(next), x = 6 - i - j - w;
    const int order[4] = {i, j, w, x};
    int inversions = 0;
    for (int p = 0; p < 4; ++p)
      for (int q = p + 1; q < 4; ++q) inversions += order[p] > order[q];
    return inversions % 2 == 0;
  }

  bool share_cell(std::uint32_t f, std::uint32_t g) const {
    const auto &p = complex.facets[f], &q = complex.facets[g];
    return p.a == q.a || p.a == q.b || p.b == q.a || p.b == q.b;
  }

  void make_facets() {
    for (const Tet tet : tets)
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
          const std::uint32_t a = tet->vertex(i)->info(), b = tet->vertex(j)->info();
          if (a >= b || b >= count || !is_first_around(tet, i, j)) continue;
          add_facet(tet, i, j);
        }
  }

  bool is_first_around(Tet tet, int i, int j) const {
    auto around = delaunay.incident_cells(tet, i, j, tet);
    const auto first = around;
    do
      if (around->info().id < tet->info().id) return false;
    while (++around != first);
    return true;
  }
};

}  // namespace

SolidComplex voronoi_complex(std::span<const LatticeSite> sites) {
  Builder builder(sites);
  builder.number_tets();
  builder.place_vertices();
  builder.make_edges();
  builder.make_facets();
  link_cells(builder.complex);
  return std::move(builder.complex);
}

}  // namespace sunder
