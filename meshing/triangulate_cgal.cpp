// SPDX-License-Identifier: GPL-3.0-or-later
// Constrained Delaunay triangulation by CGAL; convex parts after S. Hertel and K. Mehlhorn, "Fast
// triangulation of simple polygons", 1983.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cassert>
#include <optional>
#include <set>
#include <utility>

#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<bool, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::Exact_predicates_tag>;

using Triangle = std::array<std::uint32_t, 3>;
using Triangles = std::vector<Triangle>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;  // directed, by point index

// Calls visit(from, to) for every directed edge of the loops.
template <class Visit>
void for_edges(const IndexLoops& loops, Visit visit) {
  for (const auto& loop : loops)
    for (std::size_t k = 0; k < loop.size(); ++k) visit(loop[k], loop[(k + 1) % loop.size()]);
}

// ---------------------------------------------------------------------------------------------
// Constrained Delaunay triangulation

// The triangulation's vertices of the loops' corners; empty when two points coincide.
std::vector<std::vector<Cdt::Vertex_handle>> insert_corners(Cdt& cdt, std::span<const Vec2> points,
                                                            const IndexLoops& loops) {
  std::vector<std::vector<Cdt::Vertex_handle>> vertices;
  Cdt::Face_handle hint;
  for (const auto& loop : loops) {
    auto& row = vertices.emplace_back();
    for (const std::uint32_t index : loop) {
      const std::size_t before = cdt.number_of_vertices();
      const auto v = cdt.insert(Point(points[index].x, points[index].y), hint);
      if (cdt.number_of_vertices() == before && v->info() != index) return {};
      v->info() = index;
      hint = v->face();
      row.push_back(v);
    }
  }
  return vertices;
}

// Marks what lies left of the loop edges and all that is joined to it without crossing one.
// False when that does not describe an inside.
bool mark_inside(Cdt& cdt, const std::vector<std::pair<Cdt::Face_handle, int>>& edges) {
  for (const auto f : cdt.all_face_handles()) f->info() = false;
  std::vector<Cdt::Face_handle> queue;
  const auto mark = [&](Cdt::Face_handle f) {
    if (f->info()) return;
    f->info() = true;
    queue.push_back(f);
  };
  for (const auto& [face, k] : edges) mark(face);
  while (!queue.empty()) {
    const auto f = queue.back();
    queue.pop_back();
    if (cdt.is_infinite(f)) return false;
    for (int k = 0; k < 3; ++k)
      if (!f->is_constrained(k)) mark(f->neighbor(k));
  }
  return std::ranges::none_of(edges,
                              [](const auto& e) { return e.first->neighbor(e.second)->info(); });
}

// Nothing when rounding has moved a corner onto or across another edge, so that the coordinates no
// longer describe the loops' topology.
std::optional<Triangles> triangulate_delaunay(std::span<const Vec2> points,
                                              const IndexLoops& loops) {
  Cdt cdt;
  const auto vertices = insert_corners(cdt, points, loops);
  if (vertices.empty()) return {};
  const std::size_t corner_count = cdt.number_of_vertices();
  for (const auto& row : vertices)
    for (std::size_t k = 0; k < row.size(); ++k)
      cdt.insert_constraint(row[k], row[(k + 1) % row.size()]);
  if (cdt.number_of_vertices() != corner_count || cdt.dimension() != 2) return {};

  std::vector<std::pair<Cdt::Face_handle, int>> edges;  // the face left of each loop edge
  for (const auto& row : vertices)
    for (std::size_t k = 0; k < row.size(); ++k) {
      Cdt::Face_handle face;
      int opposite = 0;
      // is_edge answers with the face on the right of from → to reversed, that is on the left.
      if (!cdt.is_edge(row[(k + 1) % row.size()], row[k], face, opposite)) return {};
      if (face->vertex(Cdt::ccw(opposite)) != row[k]) {
        const auto other = face->neighbor(opposite);
        opposite = cdt.mirror_index(face, opposite);
        face = other;
      }
      edges.emplace_back(face, opposite);
    }
  if (!mark_inside(cdt, edges)) return {};

  Triangles triangles;
  for (const auto f : cdt.finite_face_handles())
    if (f->info())
      triangles.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  return triangles;
}

// ---------------------------------------------------------------------------------------------
// Ear clipping, for loops whose rounded coordinates touch where their topology does not. It keeps
// the topology whatever the coordinates are; triangles may then be flat.

struct EarClipper {
  std::span<const Vec2> points;
  std::vector<std::uint32_t> ring;
  std::set<Edge> used;  // undirected edges, smaller index first

  static Edge undirected(std::uint32_t a, std::uint32_t b) { return std::minmax(a, b); }

  // Joins a hole to the ring by the shortest bridge that crosses no edge of either.
  void bridge(const std::vector<std::uint32_t>& hole) {
    std::size_t ring_at = 0, hole_at = 0;
    double best = 0;
    bool best_crosses = true, found = false;
    for (std::size_t r = 0; r < ring.size(); ++r)
      for (std::size_t h = 0; h < hole.size(); ++h) {
        const Vec2 d = points[hole[h]] - points[ring[r]];
        const double distance = dot(d, d);
        if (found && !best_crosses && distance >= best) continue;
        const bool crosses = crosses_any(ring[r], hole[h], ring) ||
                             crosses_any(ring[r], hole[h], hole) || !opens_towards(r, hole[h]);
        if (found && (crosses > best_crosses || (crosses == best_crosses && distance >= best)))
          continue;
        std::tie(ring_at, hole_at, best, best_crosses, found) =
            std::tuple(r, h, distance, crosses, true);
      }
    std::vector<std::uint32_t> inserted;
    for (std::size_t k = 0; k < hole.size(); ++k)
      inserted.push_back(hole[(hole_at + k) % hole.size()]);
    if (ring[ring_at] != hole[hole_at]) {
      inserted.push_back(hole[hole_at]);
      inserted.push_back(ring[ring_at]);
      used.insert(undirected(ring[ring_at], hole[hole_at]));
    } else {
      std::rotate(inserted.begin(), inserted.begin() + 1, inserted.end());
    }
    ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(ring_at) + 1, inserted.begin(),
                inserted.end());
  }

  bool crosses_any(std::uint32_t a, std::uint32_t b, const std::vector<std::uint32_t>& loop) const {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const std::uint32_t p = loop[k], q = loop[(k + 1) % loop.size()];
      if (p == a || p == b || q == a || q == b) continue;
      if (orientation(points[a], points[b], points[p]) *
                  orientation(points[a], points[b], points[q]) <=
              0 &&
          orientation(points[p], points[q], points[a]) *
                  orientation(points[p], points[q], points[b]) <=
              0)
        return true;
    }
    return false;
  }

  // Whether `target` lies between the ring's edges at corner r, on the inside.
  bool opens_towards(std::size_t r, std::uint32_t target) const {
    const Vec2 at = points[ring[r]], to = points[target];
    const Vec2 before = points[ring[(r + ring.size() - 1) % ring.size()]];
    const Vec2 after = points[ring[(r + 1) % ring.size()]];
    const bool left_of_in = orientation(before, at, to) > 0;
    const bool left_of_out = orientation(at, after, to) > 0;
    return orientation(before, at, after) >= 0 ? left_of_in && left_of_out
                                               : left_of_in || left_of_out;
  }

  // 0 a proper ear; more the worse it is to cut corner k off.
  int badness(std::size_t k) const {
    const std::size_t n = ring.size();
    const std::uint32_t a = ring[(k + n - 1) % n], b = ring[k], c = ring[(k + 1) % n];
    if (n > 3 && used.contains(undirected(a, c))) return 4;
    const int turn = orientation(points[a], points[b], points[c]);
    if (turn < 0) return 3;
    if (turn == 0) return 2;
    for (const std::uint32_t p : ring)
      if (p != a && p != b && p != c && orientation(points[a], points[b], points[p]) >= 0 &&
          orientation(points[b], points[c], points[p]) >= 0 &&
          orientation(points[c], points[a], points[p]) >= 0)
        return 1;
    return 0;
  }

  Triangles clip() {
    Triangles triangles;
    std::size_t start = 0;
    while (ring.size() >= 3) {
      const std::size_t n = ring.size();
      std::size_t best = 0;
      for (int tier = 5, i = 0; i < static_cast<int>(n) && tier > 0; ++i) {
        const std::size_t k = (start + static_cast<std::size_t>(i)) % n;
        const int bad = badness(k);
        if (bad < tier) std::tie(tier, best) = std::tuple(bad, k);
      }
      const std::uint32_t a = ring[(best + n - 1) % n], b = ring[best], c = ring[(best + 1) % n];
      if (a != c) {
        triangles.push_back({a, b, c});
        used.insert(undirected(a, c));
      }
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(best));
      if (a == c) ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(best % ring.size()));
      if (n == 3) break;
      start = (best + 1) % ring.size();  // alternating ears make rounder triangles than a fan
    }
    return triangles;
  }
};

Triangles triangulate_ears(std::span<const Vec2> points, const IndexLoops& loops) {
  EarClipper clipper{points, loops.front(), {}};
  for_edges(loops, [&](std::uint32_t a, std::uint32_t b) {
    clipper.used.insert(EarClipper::undirected(a, b));
  });
  // From right to left, so that the bridges of later holes need not cross earlier ones.
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t h = 1; h < loops.size(); ++h) {
    double right = points[loops[h].front()].x;
    for (const std::uint32_t index : loops[h]) right = std::max(right, points[index].x);
    order.emplace_back(-right, h);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [right, h] : order) clipper.bridge(loops[h]);
  return clipper.clip();
}

// ---------------------------------------------------------------------------------------------
// Convex parts

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// Half-edges of a triangulation: 3 t + k runs from corner k of triangle t to the next.
struct HalfEdges {
  std::vector<std::uint32_t> from, next, before, twin;

  explicit HalfEdges(const Triangles& triangles) {
    const auto count = static_cast<std::uint32_t>(3 * triangles.size());
    from.resize(count);
    next.resize(count);
    before.resize(count);
    twin.assign(count, kNone);
    std::vector<std::pair<Edge, std::uint32_t>> directed(count);
    for (std::uint32_t h = 0; h < count; ++h) {
      const std::uint32_t t = h / 3, k = h % 3;
      from[h] = triangles[t][k];
      next[h] = 3 * t + (k + 1) % 3;
      before[h] = 3 * t + (k + 2) % 3;
      directed[h] = {{from[h], triangles[t][(k + 1) % 3]}, h};
    }
    std::sort(directed.begin(), directed.end());
    for (const auto& [edge, h] : directed) {
      const std::pair<Edge, std::uint32_t> reverse{{edge.second, edge.first}, 0};
      const auto found = std::lower_bound(directed.begin(), directed.end(), reverse);
      if (found != directed.end() && found->first == reverse.first) twin[h] = found->second;
    }
  }
  std::uint32_t to(std::uint32_t h) const { return from[next[h]]; }

  // Removes the edge between two parts.
  void join(std::uint32_t h) {
    const std::uint32_t g = twin[h];
    const auto link = [&](std::uint32_t a, std::uint32_t b) {
      next[a] = b;
      before[b] = a;
    };
    link(before[h], next[g]);
    link(before[g], next[h]);
    twin[h] = twin[g] = kNone;
    next[h] = next[g] = kNone;
  }
};

}  // namespace

int orientation(Vec2 a, Vec2 b, Vec2 c) {
  return CGAL::orientation(Point(a.x, a.y), Point(b.x, b.y), Point(c.x, c.y));
}

std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec2> points,
                                                      const IndexLoops& loops) {
  assert(!loops.empty() && loops.front().size() >= 3);
  if (loops.size() == 1 && loops[0].size() == 3) return {{loops[0][0], loops[0][1], loops[0][2]}};
  auto delaunay = triangulate_delaunay(points, loops);
  Triangles triangles = delaunay ? *std::move(delaunay) : triangulate_ears(points, loops);
  // An order of its own, whatever containers the triangulation uses.
  for (Triangle& t : triangles)
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

std::vector<std::vector<std::uint32_t>> convex_parts(std::span<const Vec2> points,
                                                     const IndexLoops& loops) {
  const Triangles triangles = triangulate(points, loops);
  HalfEdges edges(triangles);
  // Longest edges go first: parts come out rounder. Flat triangles of degenerate loops stay alone.
  std::vector<std::pair<double, std::uint32_t>> order;
  const auto is_flat = [&](std::uint32_t h) {
    const Triangle& t = triangles[h / 3];
    return orientation(points[t[0]], points[t[1]], points[t[2]]) <= 0;
  };
  for (std::uint32_t h = 0; h < edges.from.size(); ++h) {
    if (edges.twin[h] == kNone || edges.twin[h] < h || is_flat(h) || is_flat(edges.twin[h]))
      continue;
    const Vec2 d = points[edges.to(h)] - points[edges.from[h]];
    order.emplace_back(-dot(d, d), h);
  }
  std::sort(order.begin(), order.end());
  const auto stays_convex = [&](std::uint32_t h) {  // at the corner h starts from
    const std::uint32_t after = edges.next[edges.twin[h]];
    return orientation(points[edges.from[edges.before[h]]], points[edges.from[h]],
                       points[edges.to(after)]) >= 0;
  };
  for (const auto& [length, h] : order)
    if (stays_convex(h) && stays_convex(edges.twin[h])) edges.join(h);

  std::vector<std::vector<std::uint32_t>> parts;
  std::vector<bool> seen(edges.from.size());
  for (std::uint32_t start = 0; start < edges.from.size(); ++start) {
    if (seen[start] || edges.next[start] == kNone) continue;
    auto& part = parts.emplace_back();
    for (std::uint32_t h = start; !seen[h]; h = edges.next[h]) {
      seen[h] = true;
      part.push_back(edges.from[h]);
    }
  }
  return parts;
}

}  // namespace sunder
