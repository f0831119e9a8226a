// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <map>
#include <utility>

#include "fracture/local_web_detail.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

struct FaceInfo {
  std::uint32_t id = kNone;  // of the triangle; kNone outside the field
  bool is_inside = false;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
// A crossing would need a vertex that is not in the graph: it throws instead.
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;
using Vertex = Cdt::Vertex_handle;
using Face = Cdt::Face_handle;
using Kind = CrackGraph::Kind;

bool is_border(const CrackGraph::Edge& edge) {
  return edge.kind == Kind::fixed || edge.kind == Kind::border;
}

class FieldTriangulation {
 public:
  explicit FieldTriangulation(const CrackGraph& graph) : graph_(graph) {
    std::vector<bool> used(graph.vertices.size());
    for (const auto& edge : graph.edges)
      if (edge.from != edge.to) used[edge.from] = used[edge.to] = true;
    vertices_.resize(graph.vertices.size());
    Face hint;
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
      if (!used[v]) continue;
      vertices_[v] = cdt_.insert(Point(graph.vertices[v].x, graph.vertices[v].y), hint);
      vertices_[v]->info() = v;
      hint = vertices_[v]->face();
    }
  }

  // False when a border edge is not an edge of the triangulation afterwards.
  bool insert_edges() {
    for (const bool border : {true, false})
      for (const auto& edge : graph_.edges)
        if (edge.from != edge.to && is_border(edge) == border && !insert(edge) && border)
          return false;
    return true;
  }

  CrackedTriangles triangles() {
    mark_inside();
    CrackedTriangles result;
    result.vertices = graph_.vertices;
    std::vector<std::pair<std::array<std::uint32_t, 3>, Face>> order;
    for (const Face f : cdt_.finite_face_handles()) {
      if (!f->info().is_inside) continue;
      std::array<std::uint32_t, 3> t{f->vertex(0)->info(), f->vertex(1)->info(),
                                     f->vertex(2)->info()};
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
        const std::uint32_t from = t[k], to = t[(k + 1) % 3];
        const int opposite = 3 - f->index(vertices_[from]) - f->index(vertices_[to]);
        const auto border = border_.find({from, to});
        across[k] = border != border_.end() ? Across::border(border->second)
                                            : Across::cell(f->neighbor(opposite)->info().id);
        is_crack[k] = !across[k].is_border() && f->is_constrained(opposite);
      }
    }
    return result;
  }

 private:
  bool insert(const CrackGraph::Edge& edge) {
    const Vertex a = vertices_[edge.from], b = vertices_[edge.to];
    if (a == b) return false;
    try {
      cdt_.insert_constraint(a, b);
    } catch (const Cdt::Intersection_of_constraints_exception&) {
      return false;
    }
    if (!is_border(edge)) return true;
    border_[{edge.from, edge.to}] = edge.border;
    Face f;
    int k = 0;
    return cdt_.is_edge(a, b, f, k) && f->is_constrained(k);
  }

  // What lies left of the border edges and all that is joined to it without crossing one.
  void mark_inside() {
    std::vector<Face> queue;
    const auto mark = [&](Face f) {
      if (!std::exchange(f->info().is_inside, true)) queue.push_back(f);
    };
    for (const auto& [ends, number] : border_) {
      Face f;
      int k = 0;
      if (!cdt_.is_edge(vertices_[ends.first], vertices_[ends.second], f, k)) continue;
      const bool runs_along = f->vertex(Cdt::ccw(k)) == vertices_[ends.first];
      mark(runs_along ? f : f->neighbor(k));
    }
    while (!queue.empty()) {
      const Face f = queue.back();
      queue.pop_back();
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t from = f->vertex(Cdt::ccw(k))->info();
        const std::uint32_t to = f->vertex(Cdt::cw(k))->info();
        if (!border_.contains({from, to})) mark(f->neighbor(k));
      }
    }
  }

  const CrackGraph& graph_;
  Cdt cdt_;
  std::vector<Vertex> vertices_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> border_;
};

}  // namespace

std::optional<CrackedTriangles> triangulate_cracks(const CrackGraph& graph) {
  FieldTriangulation triangulation(graph);
  if (!triangulation.insert_edges()) return std::nullopt;
  return triangulation.triangles();
}

}  // namespace sunder
