// SPDX-License-Identifier: GPL-3.0-or-later
// One convex cell against the boundary edges that touch it: a small planar graph of the cell's
// edges and the chords of the boundary, whose faces on the region's side are the parts. Nodes are
// identified, never computed and compared; every sign is one of a three-line determinant.
#include "fracture/cut_cell.hpp"

#include <algorithm>
#include <cassert>

namespace sunder {
namespace {

struct Node {
  NodeKey key;
  LatticeCrossing place;  // relative to the cell's base
};

struct HalfEdge {
  std::uint32_t from = 0, to = 0;
  LatticePoint direction;
  LatticeLine line;
  Across across = {};
  bool is_boundary = false;  // the region's boundary runs along it, the region on its left
  bool outside = false;      // what lies on its left is outside the region
  bool exterior = false;     // what lies on its left is outside the cell
  bool visited = false;
};

struct EdgePoint {
  LatticeLine through;  // a line through the point that is not parallel to the edge
  std::uint32_t node;
};

LatticePoint direction_of(const LatticeLine& line) {
  return {-line.b, line.a};
}

LatticePoint reversed(LatticePoint d) {
  return {-d.x, -d.y};
}

int sign_of(Int128 value) {
  return (value > 0) - (value < 0);
}

// Counter-clockwise order by angle from the positive x axis, exact.
bool precedes(LatticePoint p, LatticePoint q) {
  const bool p_low = p.y < 0 || (p.y == 0 && p.x < 0), q_low = q.y < 0 || (q.y == 0 && q.x < 0);
  if (p_low != q_low) return q_low;
  return cross(p, q) > 0;
}

class CellCutter {
 public:
  CellCutter(std::uint32_t id, const ExactCell& cell, std::span<const Across> across,
             std::span<const std::uint32_t> vertices, const LatticeRegion& region,
             std::span<const std::uint32_t> first_at, std::span<const std::uint32_t> edges)
      : id_(id), cell_(cell), across_(across), region_(region), first_at_(first_at) {
    size_ = static_cast<std::uint32_t>(cell.lines.size());
    on_edge_.resize(size_);
    collect_corners(edges);
    for (std::uint32_t k = 0; k < size_; ++k) add_vertex(k, vertices[k]);
    place_corners_on_edges();
    for (const std::uint32_t f : edges) add_boundary_edge(f);
    add_cell_edges();
  }

  CutCell run() {
    result_.decided = decided_;
    sort_outgoing();
    std::vector<std::vector<std::uint32_t>> outer, holes;
    for (std::uint32_t h = 0; h < half_edges_.size(); ++h) {
      if (half_edges_[h].visited) continue;
      const std::vector<std::uint32_t> loop = trace(h);
      const auto any = [&](bool HalfEdge::*flag) {
        return std::ranges::any_of(loop, [&](std::uint32_t e) { return half_edges_[e].*flag; });
      };
      if (any(&HalfEdge::exterior) || any(&HalfEdge::outside)) continue;
      (is_clockwise(loop) ? holes : outer).push_back(loop);
    }
    for (const auto& loop : outer) result_.parts.push_back({{sides(loop)}});
    for (const auto& hole : holes) {
      const std::size_t owner = owner_of(hole, outer);
      result_.parts[owner].loops.push_back(sides(hole));
    }
    return std::move(result_);
  }

 private:
  struct Corner {
    std::uint32_t id;
    LatticePoint at;  // relative
    std::uint32_t node;
  };

  std::uint32_t next(std::uint32_t k) const { return k + 1 == size_ ? 0 : k + 1; }
  LatticePoint relative(std::uint32_t corner) const { return region_.corners[corner] - cell_.base; }
  LatticeLine boundary_line(std::uint32_t f) const {
    return line_through(relative(f), relative(region_.next(f)));
  }

  std::uint32_t node(const NodeKey& key, const LatticeCrossing& place) {
    for (std::uint32_t i = 0; i < nodes_.size(); ++i)
      if (nodes_[i].key == key) return i;
    nodes_.push_back({key, place});
    return static_cast<std::uint32_t>(nodes_.size()) - 1;
  }

  void collect_corners(std::span<const std::uint32_t> edges) {
    std::vector<std::uint32_t> ids;
    for (const std::uint32_t f : edges) {
      ids.push_back(first_at_[f]);
      ids.push_back(first_at_[region_.next(f)]);
    }
    std::ranges::sort(ids);
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    for (const std::uint32_t id : ids) {
      const LatticePoint at = relative(id);
      if (std::ranges::all_of(cell_.lines,
                              [&](const LatticeLine& l) { return side_of(l, at) <= 0; }))
        corners_.push_back({id, at, node({NodeKey::corner, {id}}, crossing_at(at))});
    }
  }

  const Corner* corner(std::uint32_t id) const {
    for (const Corner& c : corners_)
      if (c.id == first_at_[id]) return &c;
    return nullptr;
  }

  // The boundary corner on both lines, if one lies in the cell.
  const Corner* corner_on(const LatticeLine& p, const LatticeLine& q) const {
    for (const Corner& c : corners_)
      if (side_of(p, c.at) == 0 && side_of(q, c.at) == 0) return &c;
    return nullptr;
  }

  void add_vertex(std::uint32_t k, std::uint32_t vertex) {
    const LatticeCrossing& v = cell_.vertices[k];
    const auto at = std::ranges::find_if(corners_, [&](const Corner& c) {
      return 2 * c.at.x * v.w == v.x && 2 * c.at.y * v.w == v.y;
    });
    vertex_nodes_.push_back(at != corners_.end() ? at->node : node({NodeKey::vertex, {vertex}}, v));
  }

  void place_corners_on_edges() {
    for (const Corner& c : corners_)
      for (std::uint32_t k = 0; k < size_; ++k) {
        if (side_of(cell_.lines[k], c.at) != 0 || c.node == vertex_nodes_[k] ||
            c.node == vertex_nodes_[next(k)])
          continue;
        const LatticePoint d = direction_of(cell_.lines[k]);
        const LatticeLine across_edge{d.x, d.y, 2 * (d.x * c.at.x + d.y * c.at.y)};
        on_edge_[k].push_back({across_edge, c.node});
      }
  }

  // The node where the boundary edge's line leaves or enters the cell: at vertex k, or on edge k.
  std::uint32_t contact(std::uint32_t k, bool at_vertex, std::uint32_t f, const LatticeLine& line) {
    if (at_vertex) {
      note_on_boundary(vertex_nodes_[k], f);
      return vertex_nodes_[k];
    }
    if (const Corner* c = corner_on(cell_.lines[k], line)) return c->node;
    // Boundary edges that overlap cross here at one place; the first of them, the same one in both
    // cells, names it.
    for (const EdgePoint& p : on_edge_[k])
      if (side_of(line, nodes_[p.node].place) == 0) return p.node;
    assert(!across_[k].is_border());
    const std::uint32_t other = across_[k].cell();
    const NodeKey key{NodeKey::crossing, {std::min(id_, other), std::max(id_, other), f}};
    const std::uint32_t n = node(key, intersection(cell_.lines[k], line));
    on_edge_[k].push_back({line, n});
    note_on_boundary(n, f);
    return n;
  }

  void note_on_boundary(std::uint32_t n, std::uint32_t f) {
    if (nodes_[n].key.kind == NodeKey::corner) return;
    const LatticePoint a = relative(f), d = relative(region_.next(f)) - a;
    const double dx = static_cast<double>(d.x), dy = static_cast<double>(d.y);
    const Vec2 p = rounded(nodes_[n].place);
    const double along =
        (p.x - static_cast<double>(a.x)) * dx + (p.y - static_cast<double>(a.y)) * dy;
    result_.on_boundary.push_back(
        {nodes_[n].key, f, std::clamp(along / (dx * dx + dy * dy), 0., 1.)});
  }

  void add_boundary_edge(std::uint32_t f) {
    const LatticeLine line = boundary_line(f);
    std::vector<int> side(size_);
    for (std::uint32_t k = 0; k < size_; ++k) side[k] = side_of(line, cell_.vertices[k]);
    const bool left = std::ranges::count(side, -1) > 0, right = std::ranges::count(side, 1) > 0;
    if (left && right) return add_chord(f, line, side);
    for (std::uint32_t k = 0; k < size_; ++k)
      if (side[k] == 0 && side[next(k)] == 0) overlaps_.push_back({k, f, left});
  }

  void add_chord(std::uint32_t f, const LatticeLine& line, const std::vector<int>& side) {
    struct Place {
      std::uint32_t k = 0;
      bool at_vertex = false;
    } entry, exit;  // where the edge's line enters and leaves the cell
    for (std::uint32_t k = 0; k < size_; ++k) {
      const std::uint32_t l = next(k);
      if (side[k] * side[l] < 0) {
        (side[k] < 0 ? entry : exit) = {k, false};
      } else if (side[l] == 0) {
        (side[k] < 0 ? entry : exit) = {l, true};
      }
    }
    const std::uint32_t first = first_at_[f], last = first_at_[region_.next(f)];
    const auto end_node = [&](std::uint32_t corner_id, const Place& place) {
      const Corner* c = corner(corner_id);
      return c ? c->node : contact(place.k, place.at_vertex, f, line);
    };
    const LatticePoint d = relative(last) - relative(first);
    const auto along = [&](LatticePoint p) {
      return static_cast<Int128>(d.x) * p.x + static_cast<Int128>(d.y) * p.y;
    };
    std::vector<const Corner*> stops;  // touching corners of other boundary edges
    for (const Corner& c : corners_)
      if (c.id != first && c.id != last && side_of(line, c.at) == 0 &&
          along(c.at) > along(relative(first)) && along(c.at) < along(relative(last)))
        stops.push_back(&c);
    std::ranges::sort(stops, {}, [&](const Corner* c) { return along(c->at); });
    std::vector<std::uint32_t> chain{end_node(first, entry)};
    for (const Corner* c : stops) chain.push_back(c->node);
    chain.push_back(end_node(last, exit));
    chain.erase(std::unique(chain.begin(), chain.end()), chain.end());
    for (std::size_t i = 0; i + 1 < chain.size(); ++i)
      add_chord_part(chain[i], chain[i + 1], d, line, f);
  }

  void add_chord_part(std::uint32_t from, std::uint32_t to, LatticePoint d, const LatticeLine& line,
                      std::uint32_t f) {
    HalfEdge& forth = half_edges_[half_edge(from, to, d, line)];
    forth.across = Across::border(f);
    forth.is_boundary = true;
    half_edges_[half_edge(to, from, reversed(d), line)].outside = true;
    decided_ = true;
  }

  std::uint32_t half_edge(std::uint32_t from, std::uint32_t to, LatticePoint d,
                          const LatticeLine& line) {
    for (std::uint32_t h = 0; h < half_edges_.size(); ++h)
      if (half_edges_[h].from == from && half_edges_[h].to == to) return h;
    half_edges_.push_back({.from = from, .to = to, .direction = d, .line = line});
    return static_cast<std::uint32_t>(half_edges_.size()) - 1;
  }

  void add_cell_edges() {
    for (std::uint32_t k = 0; k < size_; ++k) {
      std::vector<std::uint32_t> chain = chain_of_edge(k);
      const std::size_t begin = half_edges_.size();
      const LatticePoint d = direction_of(cell_.lines[k]);
      for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
        half_edges_.push_back({.from = chain[i],
                               .to = chain[i + 1],
                               .direction = d,
                               .line = cell_.lines[k],
                               .across = across_[k]});
        HalfEdge back{
            .from = chain[i + 1], .to = chain[i], .direction = reversed(d), .line = cell_.lines[k]};
        back.exterior = true;
        half_edges_.push_back(back);
      }
      for (const Overlap& o : overlaps_)
        if (o.edge == k) apply_overlap(o, chain, begin);
    }
  }

  std::vector<std::uint32_t> chain_of_edge(std::uint32_t k) {
    auto& points = on_edge_[k];
    const LatticePoint d = direction_of(cell_.lines[k]);
    std::ranges::sort(points, [&](const EdgePoint& p, const EdgePoint& q) {
      if (p.node == q.node) return false;
      const LatticeLine& g = q.through;  // its value grows or falls along the edge, 0 at q
      const int growth = sign_of(static_cast<Int128>(g.a) * d.x + static_cast<Int128>(g.b) * d.y);
      return side_of(g, nodes_[p.node].place) * growth < 0;
    });
    std::vector<std::uint32_t> chain{vertex_nodes_[k]};
    for (const EdgePoint& p : points) chain.push_back(p.node);
    chain.push_back(vertex_nodes_[next(k)]);
    chain.erase(std::unique(chain.begin(), chain.end()), chain.end());
    return chain;
  }

  struct Overlap {
    std::uint32_t edge, boundary_edge;
    bool same_direction;  // the cell lies left of the boundary edge
  };

  void apply_overlap(const Overlap& o, const std::vector<std::uint32_t>& chain, std::size_t begin) {
    const std::uint32_t f = o.boundary_edge;
    const auto index_of = [&](std::uint32_t corner_id, bool at_start) {
      const Corner* c = corner(corner_id);
      const auto it = c ? std::ranges::find(chain, c->node) : chain.end();
      if (it != chain.end()) return it - chain.begin();
      return at_start ? std::ptrdiff_t{0} : std::ssize(chain) - 1;
    };
    const std::uint32_t first = o.same_direction ? f : region_.next(f);
    const std::uint32_t last = o.same_direction ? region_.next(f) : f;
    for (std::ptrdiff_t i = index_of(first, true); i < index_of(last, false); ++i) {
      HalfEdge& h = half_edges_[begin + 2 * static_cast<std::size_t>(i)];
      decided_ = true;
      note_on_boundary(h.from, f);
      note_on_boundary(h.to, f);
      if (o.same_direction) {
        h.across = Across::border(f);
        h.is_boundary = true;
      } else {
        h.outside = true;
      }
    }
  }

  void sort_outgoing() {
    outgoing_.resize(nodes_.size());
    for (std::uint32_t h = 0; h < half_edges_.size(); ++h)
      outgoing_[half_edges_[h].from].push_back(h);
    for (auto& list : outgoing_)
      std::ranges::sort(list, precedes, [&](std::uint32_t h) { return half_edges_[h].direction; });
  }

  // Half-edges of the face on the left of `start`, in order.
  std::vector<std::uint32_t> trace(std::uint32_t start) {
    std::vector<std::uint32_t> loop;
    for (std::uint32_t h = start; !half_edges_[h].visited;) {
      half_edges_[h].visited = true;
      loop.push_back(h);
      const auto& list = outgoing_[half_edges_[h].to];
      const auto twin = std::ranges::find_if(
          list, [&](std::uint32_t e) { return half_edges_[e].to == half_edges_[h].from; });
      assert(twin != list.end());
      h = twin == list.begin() ? list.back() : *(twin - 1);
    }
    return loop;
  }

  // Only loops that float inside the cell can be clockwise; all their nodes are corners.
  bool is_clockwise(const std::vector<std::uint32_t>& loop) const {
    const auto is_corner = [&](std::uint32_t h) {
      return nodes_[half_edges_[h].from].key.kind == NodeKey::corner;
    };
    if (!std::ranges::all_of(loop, is_corner)) return false;
    Int128 twice_area = 0;
    for (const std::uint32_t h : loop) {
      const HalfEdge& e = half_edges_[h];
      twice_area += cross(relative(nodes_[e.from].key.ids[0]), relative(nodes_[e.to].key.ids[0]));
    }
    return twice_area < 0;
  }

  std::size_t owner_of(const std::vector<std::uint32_t>& hole,
                       const std::vector<std::vector<std::uint32_t>>& outer) const {
    for (std::size_t i = 0; i < outer.size(); ++i) {
      if (outer.size() == 1) return i;
      // A hole may touch the loop that it lies in, or one beside it, but not everywhere.
      const auto is_apart = [&](std::uint32_t h) {
        return std::ranges::none_of(
            outer[i], [&](std::uint32_t e) { return half_edges_[e].from == half_edges_[h].from; });
      };
      const auto free = std::ranges::find_if(hole, is_apart);
      if (free != hole.end() &&
          contains(outer[i], relative(nodes_[half_edges_[*free].from].key.ids[0])))
        return i;
    }
    assert(false && "every hole lies in a part");
    return 0;
  }

  // Crossing number of the upward ray; `at` does not lie on the loop.
  bool contains(const std::vector<std::uint32_t>& loop, LatticePoint at) const {
    const LatticeLine vertical{1, 0, 2 * at.x};
    bool inside = false;
    for (const std::uint32_t h : loop) {
      const HalfEdge& e = half_edges_[h];
      if ((side_of(vertical, nodes_[e.from].place) > 0) ==
          (side_of(vertical, nodes_[e.to].place) > 0))
        continue;
      inside ^= side_of(e.line, at) * (e.line.b > 0 ? 1 : -1) < 0;
    }
    return inside;
  }

  std::vector<CutSide> sides(const std::vector<std::uint32_t>& loop) const {
    std::vector<CutSide> result;
    for (const std::uint32_t h : loop)
      result.push_back({nodes_[half_edges_[h].from].key, half_edges_[h].across});
    return result;
  }

  std::uint32_t id_, size_ = 0;
  const ExactCell& cell_;
  std::span<const Across> across_;
  const LatticeRegion& region_;
  std::span<const std::uint32_t> first_at_;
  bool decided_ = false;
  std::vector<Node> nodes_;
  std::vector<Corner> corners_;
  std::vector<std::uint32_t> vertex_nodes_;
  std::vector<std::vector<EdgePoint>> on_edge_;
  std::vector<Overlap> overlaps_;
  std::vector<HalfEdge> half_edges_;
  std::vector<std::vector<std::uint32_t>> outgoing_;
  CutCell result_;
};

}  // namespace

bool touches(const ExactCell& cell, LatticePoint from, LatticePoint to) {
  const LatticePoint a = from - cell.base, b = to - cell.base;
  for (const LatticeLine& line : cell.lines)
    if (side_of(line, a) > 0 && side_of(line, b) > 0) return false;
  if (a == b) return true;
  const LatticeLine line = line_through(a, b);
  const auto strictly = [&](int side) {
    return std::ranges::all_of(cell.vertices,
                               [&](const LatticeCrossing& v) { return side_of(line, v) == side; });
  };
  return !strictly(1) && !strictly(-1);
}

CutCell cut_cell(std::uint32_t id, const ExactCell& cell, std::span<const Across> across,
                 std::span<const std::uint32_t> vertices, const LatticeRegion& region,
                 std::span<const std::uint32_t> first_at, std::span<const std::uint32_t> edges) {
  return CellCutter(id, cell, across, vertices, region, first_at, edges).run();
}

}  // namespace sunder
