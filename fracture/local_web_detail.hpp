// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "fracture/gather.hpp"
#include "fracture/recover.hpp"
#include "meshing/vec.hpp"

namespace sunder {

/// Edges in the plane that meet at vertices only; every new vertex has float32 values.
struct CrackGraph {
  enum class Kind : std::uint8_t {
    fixed,   ///< border of the field, may get no vertex: a cell that stays has this edge too
    border,  ///< border of the field along an axis, nobody else's: a vertex on it lies on it
             ///< exactly
    seam,    ///< between two old cells
    hull,    ///< around the damage
    crack
  };
  struct Edge {
    std::uint32_t from, to;
    std::uint32_t border;  ///< number of the border edge it is (a part of), the field on its left
    Kind kind;
  };
  std::vector<Vec2> vertices;
  std::vector<Edge> edges;
};

/// Draws cracks into a field with a given border so that the graph stays one: where a crack comes
/// nearer than `least` to a vertex it runs through it, a crossing becomes a vertex rounded to
/// float32, a crack that meets a fixed edge ends at one of that edge's ends. `least` is far above
/// the rounding, so that rounding turns nothing over. O(edges) per crack.
class CrackDrawing {
 public:
  using Kind = CrackGraph::Kind;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  explicit CrackDrawing(double least) : least_(least) {}

  std::uint32_t add_vertex(Vec2 place);
  void add_edge(CrackGraph::Edge edge);
  /// The vertex for an end of cracks: one near it, one put on an edge near it, or a new one; kNone
  /// outside the field and near a fixed edge.
  std::uint32_t vertex_for(Vec2 place);
  /// Draws what lies in the field of a crack. False when it meets the field's border.
  bool draw(Vec2 from, Vec2 to, Kind kind);
  /// Draws from a vertex towards a place, to the last edge met on the way.
  void draw_towards(std::uint32_t from, Vec2 to, Kind kind);

  const CrackGraph& graph() const { return graph_; }

 private:
  // A stretch to be drawn; an end without vertex lies outside the field.
  struct Stretch {
    std::uint32_t from, to;
    Vec2 a, b;
    Kind kind;
    int depth;
  };
  // A vertex along a stretch, or an edge to be split there.
  struct Event {
    double at;
    std::uint32_t vertex, edge;
    bool moved;   // the vertex is not exactly where the stretch passes
    double bend;  // how far the crack is led aside, along a fixed edge
  };

  bool is_inside(Vec2 place) const;
  bool run(const Stretch& first);
  bool trace(const Stretch& stretch);
  bool find_events(const Stretch& stretch, std::vector<Event>& events) const;
  std::optional<Event> crossing(const Stretch& stretch, std::uint32_t edge) const;
  std::optional<Event> fixed_end(const Stretch& stretch, std::uint32_t edge) const;
  void resolve(const Stretch& stretch, std::vector<Event>& events);
  void link(const Stretch& stretch, const Event& a, const Event& b);
  std::uint32_t split(std::uint32_t edge, Vec2 place);
  void lead_through(std::uint32_t edge, std::uint32_t vertex);
  void remove_edge(std::uint32_t edge);
  std::uint32_t near_vertex(Vec2 place, double distance) const;

  double least_;
  CrackGraph graph_;
  std::set<std::array<std::uint32_t, 2>> linked_;
  std::map<std::pair<double, double>, std::uint32_t> ends_;
  std::vector<Stretch> waiting_;
};

/// Triangles of the field (constrained Delaunay, CGAL, exact predicates); `across` borders are the
/// graph's numbers. An edge that would cross another is left out, so the triangles tile the field
/// whatever the cracks are. Nothing when the field's border crosses itself.
std::optional<CrackedTriangles> triangulate_cracks(const CrackGraph& graph);

}  // namespace sunder
