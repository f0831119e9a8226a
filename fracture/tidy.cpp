// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/tidy.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>

#include "meshing/region.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

template <class Visit>
void for_each_edge(const Pattern& pattern, Visit visit) {
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell)
    for (const LoopRange loop : loops_of(pattern, cell))
      for (std::uint32_t k = loop.begin; k < loop.end; ++k) visit(k, loop.next(k));
}

// Groups of vertices that become one; the group's first vertex gives the place.
class VertexGroups {
 public:
  explicit VertexGroups(const Pattern& pattern)
      : pattern_(pattern), parent_(pattern.vertices.size()), borders_(pattern.vertices.size()) {
    for (std::uint32_t v = 0; v < parent_.size(); ++v) parent_[v] = v;
    for_each_edge(pattern, [&](std::uint32_t k, std::uint32_t next) {
      if (!pattern.across[k].is_border()) return;
      note_border(pattern.corners[k], pattern.across[k].border());
      note_border(pattern.corners[next], pattern.across[k].border());
    });
  }

  std::uint32_t first(std::uint32_t v) const {
    while (parent_[v] != v) v = parent_[v];
    return v;
  }

  bool join(std::uint32_t v, std::uint32_t w, double length) {
    v = first(v), w = first(w);
    if (v == w) return false;
    if (borders_[w].count > borders_[v].count || (borders_[w].count == borders_[v].count && w < v))
      std::swap(v, w);
    const Vec2 d = pattern_.vertices[v] - pattern_.vertices[w];
    const bool equal = d == Vec2{};
    if (!equal && (dot(d, d) > length * length || !can_move_to(w, v))) return false;
    parent_[w] = v;
    return true;
  }

 private:
  // The boundary edges a vertex lies on; more than two are a corner all the same.
  struct Borders {
    std::array<std::uint32_t, 2> edge{};
    std::uint32_t count = 0;
    bool has(std::uint32_t e) const {
      return (count > 0 && edge[0] == e) || (count > 1 && edge[1] == e);
    }
  };

  void note_border(std::uint32_t v, std::uint32_t edge) {
    Borders& b = borders_[v];
    if (b.count < 2 && !b.has(edge)) b.edge[b.count++] = edge;
  }

  bool can_move_to(std::uint32_t w, std::uint32_t v) const {
    const Borders& from = borders_[w];
    return from.count == 0 || (from.count == 1 && borders_[v].has(from.edge[0]));
  }

  const Pattern& pattern_;
  std::vector<std::uint32_t> parent_;
  std::vector<Borders> borders_;
};

// Rebuilds a pattern after vertices were joined. Where an edge of a cell has become the next one's
// reverse, both go, and what lay across the one then lies across the other; a cell may go
// altogether.
class Collapse {
 public:
  Collapse(const Pattern& pattern, const VertexGroups& groups)
      : pattern_(pattern), groups_(groups) {}

  Pattern run() {
    number_cells();
    Pattern result;
    vertex_id_.assign(pattern_.vertices.size(), kNone);
    for (std::uint32_t cell = 0; cell < pattern_.cell_count(); ++cell) {
      if (number_[cell] == kNone) continue;
      bool first = true;
      for (const LoopRange range : loops_of(pattern_, cell)) {
        const std::vector<Side> loop = reduced(cell, range, nullptr);
        if (loop.empty()) continue;
        if (!first) result.hole_begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
        first = false;
        for (std::size_t i = 0; i < loop.size(); ++i)
          append(result, loop[i], loop[i + 1 == loop.size() ? 0 : i + 1].from);
      }
      result.cell_begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
      result.origin.push_back(pattern_.origin_of(cell));
    }
    return result;
  }

 private:
  struct Side {
    std::uint32_t from;
    Across across;
  };
  // {cell, from, to}: the neighbour's edge from → to no longer has the cell across it but this.
  using Bridges = std::map<std::array<std::uint32_t, 3>, Across>;

  std::vector<Side> reduced(std::uint32_t cell, LoopRange range, Bridges* bridges) const {
    std::vector<Side> sides;
    for (std::uint32_t k = range.begin; k < range.end; ++k) {
      const std::uint32_t from = groups_.first(pattern_.corners[k]);
      if (from != groups_.first(pattern_.corners[range.next(k)]))
        sides.push_back({from, pattern_.across[k]});
    }
    for (std::size_t i = 0; i < sides.size();) {
      const std::size_t j = (i + 1) % sides.size(), k = (i + 2) % sides.size();
      if (sides[i].from != sides[k].from) {
        ++i;
        continue;
      }
      if (bridges) {
        (*bridges)[{cell, sides[i].from, sides[j].from}] = sides[i].across;
        (*bridges)[{cell, sides[j].from, sides[i].from}] = sides[j].across;
      }
      sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(std::max(i, j)));
      sides.erase(sides.begin() + static_cast<std::ptrdiff_t>(std::min(i, j)));
      i = i > 1 ? i - 2 : 0;
    }
    return sides;
  }

  void number_cells() {
    std::uint32_t count = 0;
    for (std::uint32_t cell = 0; cell < pattern_.cell_count(); ++cell) {
      const auto loops = loops_of(pattern_, cell);
      const bool stays = !reduced(cell, loops.front(), &bridges_).empty();
      for (std::size_t l = 1; l < loops.size(); ++l) reduced(cell, loops[l], &bridges_);
      number_.push_back(stays ? count++ : kNone);
    }
  }

  void append(Pattern& result, Side side, std::uint32_t to) {
    if (vertex_id_[side.from] == kNone) {
      vertex_id_[side.from] = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back(pattern_.vertices[side.from]);
    }
    result.corners.push_back(vertex_id_[side.from]);
    for (auto it = bridges_.end(); !side.across.is_border(); side.across = it->second) {
      it = bridges_.find({side.across.cell(), side.from, to});
      if (it == bridges_.end()) break;
    }
    const Across across = side.across;
    result.across.push_back(across.is_border() ? across : Across::cell(number_[across.cell()]));
  }

  const Pattern& pattern_;
  const VertexGroups& groups_;
  Bridges bridges_;
  std::vector<std::uint32_t> number_, vertex_id_;
};

// Different vertices of a cell not further apart than `length`: a sweep along x.
std::vector<std::array<std::uint32_t, 2>> near_pairs(const Pattern& pattern, std::uint32_t cell,
                                                     double length) {
  std::vector<std::uint32_t> vertices(pattern.corners.begin() + pattern.cell_begin[cell],
                                      pattern.corners.begin() + pattern.cell_begin[cell + 1]);
  const auto at = [&](std::uint32_t v) { return pattern.vertices[v]; };
  std::ranges::sort(vertices, [&](std::uint32_t v, std::uint32_t w) {
    return at(v).x != at(w).x ? at(v).x < at(w).x : v < w;
  });
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (std::size_t i = 0; i < vertices.size(); ++i)
    for (std::size_t j = i + 1; j < vertices.size(); ++j) {
      const Vec2 d = at(vertices[j]) - at(vertices[i]);
      if (d.x > length) break;
      if (vertices[i] != vertices[j] && dot(d, d) <= length * length)
        pairs.push_back({vertices[i], vertices[j]});
    }
  return pairs;
}

// Vertices to be put on edges: {end of smaller index, the other end} → {place along it, vertex}.
using EdgeVertices =
    std::map<std::array<std::uint32_t, 2>, std::vector<std::pair<double, std::uint32_t>>>;

// Whether an edge of the cell joins the two vertices.
bool are_linked(const Pattern& pattern, std::uint32_t cell, std::uint32_t v, std::uint32_t w) {
  for (const LoopRange loop : loops_of(pattern, cell))
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      const std::uint32_t from = pattern.corners[k], to = pattern.corners[loop.next(k)];
      if ((from == v && to == w) || (from == w && to == v)) return true;
    }
  return false;
}

void find_near_edges(const Pattern& pattern, std::uint32_t cell, double length,
                     EdgeVertices& found) {
  std::vector<std::uint32_t> vertices(pattern.corners.begin() + pattern.cell_begin[cell],
                                      pattern.corners.begin() + pattern.cell_begin[cell + 1]);
  const auto x_of = [&](std::uint32_t v) { return pattern.vertices[v].x; };
  std::ranges::sort(vertices, {}, x_of);
  for (const LoopRange loop : loops_of(pattern, cell))
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      if (pattern.across[k].is_border()) continue;
      const std::uint32_t from = std::min(pattern.corners[k], pattern.corners[loop.next(k)]);
      const std::uint32_t to = std::max(pattern.corners[k], pattern.corners[loop.next(k)]);
      const Vec2 a = pattern.vertices[from], edge = pattern.vertices[to] - a;
      const double square = dot(edge, edge);
      auto it = std::ranges::lower_bound(vertices, std::min(a.x, a.x + edge.x) - length, {}, x_of);
      for (; it != vertices.end() && x_of(*it) <= std::max(a.x, a.x + edge.x) + length; ++it) {
        if (*it == from || *it == to) continue;
        const Vec2 d = pattern.vertices[*it] - a;
        const double along = dot(d, edge) / square, off = cross(edge, d);
        if (!(along > 0 && along < 1 && off * off <= length * length * square)) continue;
        // At the tip of a needle the edge would be followed by its own reverse.
        const auto linked = [&](std::uint32_t c) {
          return are_linked(pattern, c, *it, from) || are_linked(pattern, c, *it, to);
        };
        if (!linked(cell) && !linked(pattern.across[k].cell()))
          found[{from, to}].push_back({along, *it});
      }
    }
}

// Two vertices in a row on an edge that an edge of the same cell joins already would leave nothing
// between the two edges; such a neck stays as thin as it is.
bool leaves_a_lens(const Pattern& pattern, std::uint32_t cell,
                   const std::vector<std::pair<double, std::uint32_t>>& list) {
  for (std::size_t i = 1; i < list.size(); ++i)
    if (are_linked(pattern, cell, list[i - 1].second, list[i].second)) return true;
  return false;
}

EdgeVertices vertices_near_edges(const Pattern& pattern, double length) {
  EdgeVertices found;
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell) {
    if (is_strictly_convex(pattern, cell)) continue;
    EdgeVertices own;
    find_near_edges(pattern, cell, length, own);
    for (auto& [edge, list] : own) {
      std::ranges::sort(list);
      list.erase(std::unique(list.begin(), list.end()), list.end());
      if (leaves_a_lens(pattern, cell, list)) continue;
      auto& all = found[edge];
      all.insert(all.end(), list.begin(), list.end());
    }
  }
  for (auto& [edge, list] : found) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return found;
}

Pattern insert_vertices(const Pattern& pattern, const EdgeVertices& inserted) {
  Pattern result;
  result.vertices = pattern.vertices;
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell) {
    const auto loops = loops_of(pattern, cell);
    for (std::size_t l = 0; l < loops.size(); ++l) {
      if (l > 0) result.hole_begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
      for (std::uint32_t k = loops[l].begin; k < loops[l].end; ++k) {
        const std::uint32_t from = pattern.corners[k], to = pattern.corners[loops[l].next(k)];
        const auto add = [&](std::uint32_t v) {
          result.corners.push_back(v);
          result.across.push_back(pattern.across[k]);
        };
        add(from);
        const auto it = inserted.find({std::min(from, to), std::max(from, to)});
        if (it == inserted.end() || pattern.across[k].is_border()) continue;
        if (from < to)
          for (const auto& [along, v] : it->second) add(v);
        else
          for (auto v = it->second.rbegin(); v != it->second.rend(); ++v) add(v->second);
      }
    }
    result.cell_begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
    result.origin.push_back(pattern.origin_of(cell));
  }
  return result;
}

bool visits_twice(const Pattern& pattern, std::uint32_t cell, std::vector<std::uint32_t>& scratch) {
  scratch.assign(pattern.corners.begin() + pattern.cell_begin[cell],
                 pattern.corners.begin() + pattern.cell_begin[cell + 1]);
  std::ranges::sort(scratch);
  return std::ranges::adjacent_find(scratch) != scratch.end();
}

// Pattern with some cells replaced by convex parts of them.
class PinchSplitter {
 public:
  PinchSplitter(const Pattern& pattern, std::span<const std::uint32_t> cells) : pattern_(pattern) {
    for (const std::uint32_t cell : cells)
      if (Parts parts = parts_of(cell); tile(cell, parts)) parts_[cell] = std::move(parts);
    number_parts();
  }

  Pattern run() const {
    Pattern result;
    result.vertices = pattern_.vertices;
    for (std::uint32_t cell = 0; cell < pattern_.cell_count(); ++cell) {
      const auto it = parts_.find(cell);
      if (it == parts_.end()) {
        copy_cell(result, cell);
      } else {
        append_parts(result, cell, it->second);
      }
    }
    return result;
  }

 private:
  using Edge = std::array<std::uint32_t, 3>;  // cell, from, to
  using Parts = std::vector<std::vector<std::uint32_t>>;

  Parts parts_of(std::uint32_t cell) const {
    std::map<std::uint32_t, std::uint32_t> index;
    std::vector<std::uint32_t> vertices;
    std::vector<Vec2> points;
    IndexLoops loops;
    for (const LoopRange loop : loops_of(pattern_, cell)) {
      loops.emplace_back();
      for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
        const std::uint32_t v = pattern_.corners[k];
        const auto [it, added] = index.try_emplace(v, static_cast<std::uint32_t>(points.size()));
        if (added) {
          points.push_back(pattern_.vertices[v]);
          vertices.push_back(v);
        }
        loops.back().push_back(it->second);
      }
    }
    Parts parts = convex_parts(points, loops);
    for (auto& part : parts)
      for (std::uint32_t& v : part) v = vertices[v];
    return parts;
  }

  // Whether the parts have area and every edge of the cell is an edge of one of them: a cell so
  // flat that rounding has turned it over has no such parts and stays as it is.
  bool tile(std::uint32_t cell, const Parts& parts) const {
    std::map<std::array<std::uint32_t, 2>, int> edges;
    for (const auto& part : parts) {
      Loop places;
      for (const std::uint32_t v : part) places.push_back(pattern_.vertices[v]);
      if (!(area(places) > 0)) return false;
      for (std::size_t i = 0; i < part.size(); ++i)
        ++edges[{part[i], part[i + 1 == part.size() ? 0 : i + 1]}];
    }
    for (const auto& [edge, count] : edges)
      if (count > 1) return false;
    for (const LoopRange loop : loops_of(pattern_, cell))
      for (std::uint32_t k = loop.begin; k < loop.end; ++k)
        if (edges.erase({pattern_.corners[k], pattern_.corners[loop.next(k)]}) == 0) return false;
    return std::ranges::all_of(edges, [&](const auto& entry) {
      return edges.contains({entry.first[1], entry.first[0]});
    });
  }

  void number_parts() {
    std::uint32_t count = 0;
    for (std::uint32_t cell = 0; cell < pattern_.cell_count(); ++cell) {
      first_.push_back(count);
      const auto it = parts_.find(cell);
      if (it == parts_.end()) {
        ++count;
        continue;
      }
      for (const auto& part : it->second) {
        for (std::size_t i = 0; i < part.size(); ++i)
          part_at_[{cell, part[i], part[i + 1 == part.size() ? 0 : i + 1]}] = count;
        ++count;
      }
      for (const LoopRange loop : loops_of(pattern_, cell))
        for (std::uint32_t k = loop.begin; k < loop.end; ++k)
          across_at_[{cell, pattern_.corners[k], pattern_.corners[loop.next(k)]}] =
              pattern_.across[k];
    }
  }

  // An old neighbour as a new one, across the edge from → to.
  Across translate(Across across, std::uint32_t from, std::uint32_t to) const {
    if (across.is_border()) return across;
    if (!parts_.contains(across.cell())) return Across::cell(first_[across.cell()]);
    return Across::cell(part_at_.at({across.cell(), to, from}));
  }

  void copy_cell(Pattern& result, std::uint32_t cell) const {
    const auto loops = loops_of(pattern_, cell);
    for (std::size_t l = 0; l < loops.size(); ++l) {
      if (l > 0) result.hole_begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
      for (std::uint32_t k = loops[l].begin; k < loops[l].end; ++k) {
        result.corners.push_back(pattern_.corners[k]);
        result.across.push_back(
            translate(pattern_.across[k], pattern_.corners[k], pattern_.corners[loops[l].next(k)]));
      }
    }
    finish(result, cell);
  }

  void append_parts(Pattern& result, std::uint32_t cell, const Parts& parts) const {
    for (const auto& part : parts) {
      for (std::size_t i = 0; i < part.size(); ++i) {
        const std::uint32_t from = part[i], to = part[i + 1 == part.size() ? 0 : i + 1];
        const auto outer = across_at_.find({cell, from, to});
        result.corners.push_back(from);
        result.across.push_back(outer != across_at_.end()
                                    ? translate(outer->second, from, to)
                                    : Across::cell(part_at_.at({cell, to, from})));
      }
      finish(result, cell);
    }
  }

  void finish(Pattern& result, std::uint32_t cell) const {
    result.cell_begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
    result.origin.push_back(pattern_.origin_of(cell));
  }

  const Pattern& pattern_;
  std::map<std::uint32_t, Parts> parts_;
  std::vector<std::uint32_t> first_;
  std::map<Edge, std::uint32_t> part_at_;
  std::map<Edge, Across> across_at_;
};

}  // namespace

Pattern join_near_vertices(Pattern pattern, double length) {
  VertexGroups groups(pattern);
  bool joined = false;
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell)
    for (const auto& [v, w] : near_pairs(pattern, cell, length))
      joined |= groups.join(v, w, length);
  if (joined) pattern = Collapse(pattern, groups).run();
  const EdgeVertices inserted = vertices_near_edges(pattern, length);
  return inserted.empty() ? pattern : insert_vertices(pattern, inserted);
}

Pattern split_pinches(Pattern pattern) {
  std::vector<std::uint32_t> cells, scratch;
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell)
    if (visits_twice(pattern, cell, scratch)) cells.push_back(cell);
  if (cells.empty()) return pattern;
  return PinchSplitter(pattern, cells).run();
}

}  // namespace sunder
