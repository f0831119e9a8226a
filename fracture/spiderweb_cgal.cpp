// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>

#include "fracture/crack_web.hpp"
#include "fracture/gather.hpp"
#include "fracture/spiderweb.hpp"
#include "meshing/error.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
// Distance of points on the rest of the wall, in rest_cell: a cell gathers about six triangles.
constexpr double kSpacing = 0.6;
// Most points on the rest of the wall: a triangulation of about a gigabyte.
constexpr double kMostPoints = 1 << 21;
// Lattice steps below which a cell is an artefact of rounding.
constexpr double kLeastWidth = 64;

struct VertexInfo {
  std::uint32_t id = kNone;      // by position
  std::uint32_t corner = kNone;  // of the region
  std::uint32_t edge = kNone;    // of the region's boundary that the vertex lies on
};
struct FaceInfo {
  std::uint32_t id = kNone;  // of the triangle; kNone outside the region
  int winding = 0;
  bool seen = false;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexInfo, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Plain = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::Exact_predicates_tag>;
using Cdt = CGAL::Constrained_triangulation_plus_2<Plain>;
using Vertex = Cdt::Vertex_handle;
using Face = Cdt::Face_handle;

Point as_point(Vec2 p) {
  return Point(p.x, p.y);
}
Vec2 as_vec(const Point& p) {
  return {p.x(), p.y()};
}

// The triangulation of the region with its cracks, and which boundary edge lies where.
class WebTriangulation {
 public:
  explicit WebTriangulation(const LatticeRegion& region) : region_(region) {}

  void insert_boundary(const RestPoints& points) {
    std::vector<Vertex> corners;
    for (std::uint32_t c = 0; c < region_.edge_count(); ++c) {
      const LatticePoint p = region_.corners[c];
      corners.push_back(cdt_.insert(Point(static_cast<double>(p.x), static_cast<double>(p.y))));
      if (corners.back()->info().corner == kNone) corners.back()->info().corner = c;
    }
    for (std::uint32_t e = 0; e < region_.edge_count(); ++e) {
      Vertex from = corners[e];
      const auto join = [&](Vertex to) {
        if (to != from) boundary_.emplace_back(cdt_.insert_constraint(from, to), e);
        from = to;
      };
      for (const Vec2 p : points.on_edge[e]) join(cdt_.insert(as_point(p), from->face()));
      join(corners[region_.next(e)]);
    }
  }

  // All end points first: what lies exactly on the boundary must split it before cracks that cross
  // it bend it by their rounded crossings.
  void insert_cracks(const CrackWeb& web) {
    std::vector<std::pair<Vertex, Vertex>> ends;
    Face hint;
    for (const CrackWeb::Segment& crack : web.cracks) {
      const Vertex a = cdt_.insert(as_point(crack.a), hint);
      const Vertex b = cdt_.insert(as_point(crack.b), a->face());
      ends.emplace_back(a, b);
      hint = b->face();
    }
    for (const auto& [a, b] : ends)
      if (a != b) cdt_.insert_constraint(a, b);
  }

  void insert_points(const RestPoints& points) {
    Face hint;
    for (const Vec2 p : points.inside) hint = cdt_.insert(as_point(p), hint)->face();
  }

  CrackedTriangles triangles(const CrackWeb& web) {
    find_boundary();
    wind_faces();
    number_vertices();
    CrackedTriangles result;
    for (const Vertex v : vertices_) result.vertices.push_back(place(v));
    collect_triangles(result);
    result.is_damaged.assign(result.triangles.size(), false);
    for (const auto& part : parts_between_cracks(result)) {
      const auto& [a, b, c] = result.triangles[part.front()];
      if (is_damaged(web, (1.0 / 3) * (position(a) + position(b) + position(c))))
        for (const std::uint32_t t : part) result.is_damaged[t] = true;
    }
    return result;
  }

 private:
  using DirectedEdge = std::pair<Vertex, Vertex>;

  // Which boundary edges run along each edge of the triangulation, in their direction.
  void find_boundary() {
    for (const auto& [constraint, edge] : boundary_) {
      Vertex from;
      for (const Vertex to : cdt_.vertices_in_constraint(constraint)) {
        if (from != Vertex()) along_[{from, to}].push_back(edge);
        for (std::uint32_t& known = to->info().edge; known == kNone;) known = edge;
        from = to;
      }
    }
  }
  int count_along(Vertex from, Vertex to) const {
    const auto found = along_.find({from, to});
    return found == along_.end() ? 0 : static_cast<int>(found->second.size());
  }

  // How often the boundary runs around each face: 1 in the region, 0 outside and in openings, also
  // where an opening's edge lies on the outline's.
  void wind_faces() {
    std::vector<Face> queue{cdt_.infinite_face()};
    queue.back()->info().seen = true;
    while (!queue.empty()) {
      const Face f = queue.back();
      queue.pop_back();
      for (int k = 0; k < 3; ++k) {
        const Face g = f->neighbor(k);
        if (g->info().seen) continue;
        const Vertex from = f->vertex(Cdt::ccw(k)), to = f->vertex(Cdt::cw(k));
        g->info().seen = true;
        g->info().winding = f->info().winding - count_along(from, to) + count_along(to, from);
        queue.push_back(g);
      }
    }
  }

  // Numbers what the region's triangles use by position, so that no container's order shows.
  void number_vertices() {
    for (const Face f : cdt_.finite_face_handles())
      for (int k = 0; k < 3 && f->info().winding == 1; ++k)
        if (std::exchange(f->vertex(k)->info().id, 0) == kNone) vertices_.push_back(f->vertex(k));
    std::sort(vertices_.begin(), vertices_.end(), [](Vertex a, Vertex b) {
      return std::pair(a->point().x(), a->point().y()) < std::pair(b->point().x(), b->point().y());
    });
    for (std::uint32_t i = 0; i < vertices_.size(); ++i) vertices_[i]->info().id = i;
  }

  // Metres. A point of the boundary lies on the segment between the places of its edge's ends.
  Vec2 place(Vertex v) const {
    const VertexInfo info = v->info();
    if (info.corner != kNone) return region_.places[info.corner];
    const Vec2 p = as_vec(v->point());
    if (info.edge == kNone) return region_.lattice.to_metres(p);
    const std::uint32_t next = region_.next(info.edge);
    const LatticePoint from = region_.corners[info.edge], to = region_.corners[next];
    const Vec2 a{static_cast<double>(from.x), static_cast<double>(from.y)};
    const Vec2 edge{static_cast<double>(to.x - from.x), static_cast<double>(to.y - from.y)};
    const double t = dot(p - a, edge) / dot(edge, edge);
    const Vec2 start = region_.places[info.edge], end = region_.places[next];
    return start + t * (end - start);
  }

  void collect_triangles(CrackedTriangles& result) {
    std::vector<std::pair<std::array<std::uint32_t, 3>, Face>> order;
    for (const Face f : cdt_.finite_face_handles()) {
      if (f->info().winding != 1) continue;
      std::array<std::uint32_t, 3> t{f->vertex(0)->info().id, f->vertex(1)->info().id,
                                     f->vertex(2)->info().id};
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      order.emplace_back(t, f);
    }
    std::sort(order.begin(), order.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i].second->info().id = i;
    for (const auto& [t, f] : order) {
      result.triangles.push_back(t);
      auto& across = result.across.emplace_back();
      auto& is_crack = result.is_crack.emplace_back();
      for (int k = 0; k < 3; ++k) {
        const Vertex from = vertices_[t[k]], to = vertices_[t[(k + 1) % 3]];
        const int opposite = 3 - f->index(from) - f->index(to);
        const std::uint32_t other = f->neighbor(opposite)->info().id;
        // With more edges along it than against it, the region's side has one of them.
        across[k] =
            other == kNone ? Across::border(along_.at({from, to}).front()) : Across::cell(other);
        is_crack[k] = other != kNone && f->is_constrained(opposite);
      }
    }
  }

  Vec2 position(std::uint32_t vertex) const { return as_vec(vertices_[vertex]->point()); }

  const LatticeRegion& region_;
  Cdt cdt_;
  std::vector<std::pair<Cdt::Constraint_id, std::uint32_t>> boundary_;
  std::map<DirectedEdge, std::vector<std::uint32_t>> along_;
  std::vector<Vertex> vertices_;
};

// Distance of points on the rest of the wall, lattice units.
double point_spacing(const Lattice& lattice, double rest_cell) {
  const auto width = static_cast<double>(lattice.width),
             height = static_cast<double>(lattice.height);
  const double unit = std::max(lattice.step.x, lattice.step.y);
  const double least = std::sqrt(width * height / kMostPoints) / kSpacing * unit;
  if (!(rest_cell >= least)) {
    std::ostringstream message;
    message << "rest_cell = " << rest_cell << " m makes too many cells; at least " << least << " m";
    throw Error(ErrorCode::geometry, message.str());
  }
  return std::min(kSpacing * rest_cell / unit, 4 * std::max(width, height));
}

}  // namespace

Pattern spiderweb(const LatticeRegion& region, const SpiderwebParams& params, std::uint64_t seed,
                  SpiderwebStats* stats) {
  SpiderwebStats counters;
  const double spacing = point_spacing(region.lattice, params.rest_cell);
  const CrackWeb web = plan_cracks(region, params, spacing, random_bits(seed, 0), counters);
  const RestPoints points = spread_rest_points(region, web, spacing, random_bits(seed, 1));
  WebTriangulation triangulation(region);
  triangulation.insert_boundary(points);
  triangulation.insert_cracks(web);
  triangulation.insert_points(points);
  if (stats) *stats = counters;
  const double unit = std::max(region.lattice.step.x, region.lattice.step.y);
  return gather(triangulation.triangles(web), {.cell_area = params.rest_cell * params.rest_cell,
                                               .least_width = kLeastWidth * unit,
                                               .least_edge = unit});
}

}  // namespace sunder
