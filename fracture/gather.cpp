// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/gather.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <queue>
#include <set>
#include <tuple>

namespace sunder {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr double kLargest = 1.35;   // of a gathered cell, in cell_area
constexpr double kSmallest = 0.35;  // below it a gathered cell joins a neighbour

// A growing cell; its id is that of one of its triangles.
struct Cell {
  double area = 0, perimeter = 0;
  std::vector<std::uint32_t> edges;  // half-edges 3 t + k on its border
  std::uint32_t version = 0;
  bool is_damaged = false;
};

// What two neighbouring cells have in common.
struct Contact {
  std::uint32_t cell = 0, edges = 0;
  double length = 0;
  bool cracked = false;
};

class Gatherer {
 public:
  Gatherer(const CrackedTriangles& field, const GatherParams& params)
      : field_(field),
        params_(params),
        parent_(field.triangles.size()),
        cells_(field.triangles.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    list_triangles_at_vertices();
    for (std::uint32_t t = 0; t < cells_.size(); ++t) {
      const auto& [a, b, c] = field.triangles[t];
      const Vec2* v = field.vertices.data();
      cells_[t].area = 0.5 * cross(v[b] - v[a], v[c] - v[a]);
      cells_[t].is_damaged = field.is_damaged[t];
      for (std::uint32_t k = 0; k < 3; ++k) {
        cells_[t].edges.push_back(3 * t + k);
        cells_[t].perimeter += edge_length(3 * t + k);
      }
    }
  }

  Pattern run(std::vector<std::uint8_t>* is_damaged) {
    join_compact_pairs();
    join_small_cells(
        [&](const Cell& c) { return !c.is_damaged && c.area < kSmallest * params_.cell_area; },
        false);
    join_small_cells([&](const Cell& c) { return 2 * c.area <= params_.least_width * c.perimeter; },
                     true);
    join_small_cells(
        [&](const Cell& c) {
          return !c.is_damaged && 2 * c.area <= params_.least_rest_width * c.perimeter;
        },
        true);
    contract_short_edges();
    return make_pattern(is_damaged);
  }

 private:
  // A pair of neighbours, the most compact union first; ties by id.
  struct Pair {
    double cost;
    std::uint32_t a, b, version_a, version_b;
    friend bool operator<(const Pair& p, const Pair& q) {
      return std::tie(q.cost, q.a, q.b) < std::tie(p.cost, p.a, p.b);
    }
  };

  std::uint32_t find(std::uint32_t t) {
    while (parent_[t] != t) t = parent_[t] = parent_[parent_[t]];
    return t;
  }
  std::uint32_t start_of(std::uint32_t edge) const { return field_.triangles[edge / 3][edge % 3]; }
  std::uint32_t end_of(std::uint32_t edge) const {
    return field_.triangles[edge / 3][(edge % 3 + 1) % 3];
  }
  double edge_length(std::uint32_t edge) const {
    return length(field_.vertices[end_of(edge)] - field_.vertices[start_of(edge)]);
  }
  Across across(std::uint32_t edge) const { return field_.across[edge / 3][edge % 3]; }

  void list_triangles_at_vertices() {
    first_at_.assign(field_.vertices.size() + 1, 0);
    for (const auto& t : field_.triangles)
      for (const std::uint32_t v : t) ++first_at_[v + 1];
    std::partial_sum(first_at_.begin(), first_at_.end(), first_at_.begin());
    at_.resize(3 * field_.triangles.size());
    auto next = first_at_;
    for (std::uint32_t t = 0; t < field_.triangles.size(); ++t)
      for (const std::uint32_t v : field_.triangles[t]) at_[next[v]++] = t;
  }

  std::vector<Contact> contacts_of(std::uint32_t cell) {
    std::vector<Contact> contacts;
    for (const std::uint32_t edge : cells_[cell].edges) {
      if (across(edge).is_border()) continue;
      const std::uint32_t other = find(across(edge).cell());
      auto found = std::ranges::find(contacts, other, &Contact::cell);
      if (found == contacts.end()) found = contacts.insert(found, Contact{other});
      ++found->edges;
      found->length += edge_length(edge);
      found->cracked |= field_.is_crack[edge / 3][edge % 3];
    }
    return contacts;
  }

  // Two discs whose borders meet in one path make a disc: they share one vertex more than edges.
  bool makes_disc(std::uint32_t a, const Contact& contact) {
    std::uint32_t b = contact.cell, shared = 0;
    if (cells_[a].edges.size() > cells_[b].edges.size()) std::swap(a, b);
    for (const std::uint32_t edge : cells_[a].edges) {
      const std::uint32_t v = start_of(edge);
      for (std::uint32_t k = first_at_[v]; k < first_at_[v + 1]; ++k)
        if (find(at_[k]) == b) {
          ++shared;
          break;
        }
    }
    return shared == contact.edges + 1;
  }

  std::uint32_t join(std::uint32_t a, const Contact& contact) {
    std::uint32_t b = contact.cell;
    if (cells_[a].edges.size() < cells_[b].edges.size()) std::swap(a, b);
    Cell &into = cells_[a], &from = cells_[b];
    into.edges.insert(into.edges.end(), from.edges.begin(), from.edges.end());
    parent_[b] = a;
    std::erase_if(into.edges, [&](std::uint32_t edge) {
      return !across(edge).is_border() && find(across(edge).cell()) == a;
    });
    into.area += from.area;
    into.perimeter += from.perimeter - 2 * contact.length;
    into.is_damaged |= from.is_damaged;
    ++into.version;
    ++from.version;
    from.edges.clear();
    return a;
  }

  void propose(std::priority_queue<Pair>& queue, std::uint32_t cell, bool only_later) {
    const Cell& a = cells_[cell];
    for (const Contact& contact : contacts_of(cell)) {
      const Cell& b = cells_[contact.cell];
      if (contact.cracked || (only_later && contact.cell < cell)) continue;
      const double area = a.area + b.area,
                   perimeter = a.perimeter + b.perimeter - 2 * contact.length;
      if (a.is_damaged != b.is_damaged) continue;
      if (!a.is_damaged && area > kLargest * params_.cell_area) continue;
      const double roundness = perimeter * perimeter / (16 * area);  // 1 for a square
      const double cost = 2 * roundness + area / params_.cell_area;
      queue.push({cost, cell, contact.cell, a.version, b.version});
    }
  }

  void join_compact_pairs() {
    std::priority_queue<Pair> queue;
    for (std::uint32_t c = 0; c < cells_.size(); ++c) propose(queue, c, true);
    while (!queue.empty()) {
      const Pair pair = queue.top();
      queue.pop();
      if (cells_[pair.a].version != pair.version_a || cells_[pair.b].version != pair.version_b)
        continue;
      const auto contacts = contacts_of(pair.a);
      const auto contact = std::ranges::find(contacts, pair.b, &Contact::cell);
      if (contact == contacts.end() || !makes_disc(pair.a, *contact)) continue;
      propose(queue, join(pair.a, *contact), false);
    }
  }

  // The neighbour with the longest common edge that the cell may join.
  std::optional<Contact> best_neighbour(std::uint32_t cell, bool across_cracks) {
    std::optional<Contact> best;
    for (const Contact& contact : contacts_of(cell)) {
      const bool mixes = cells_[cell].is_damaged != cells_[contact.cell].is_damaged;
      if (!across_cracks && (contact.cracked || mixes)) continue;
      if (best && std::tie(best->length, contact.cell) >= std::tie(contact.length, best->cell))
        continue;
      if (makes_disc(cell, contact)) best = contact;
    }
    return best;
  }

  template <class IsSmall>
  void join_small_cells(IsSmall is_small, bool across_cracks) {
    for (bool changed = true; changed;) {
      changed = false;
      std::vector<std::pair<double, std::uint32_t>> small;
      for (std::uint32_t c = 0; c < cells_.size(); ++c)
        if (find(c) == c && is_small(cells_[c])) small.emplace_back(cells_[c].area, c);
      std::sort(small.begin(), small.end());
      for (const auto& [area, c] : small) {
        if (find(c) != c || !is_small(cells_[c])) continue;
        const auto neighbour = best_neighbour(c, across_cracks);
        if (!neighbour) continue;
        join(c, *neighbour);
        changed = true;
      }
    }
  }

  // 0 inside, 1 on one boundary edge, 2 where boundary edges meet: how much a vertex must stay.
  int firmness(std::uint32_t v) const {
    int first = -1;
    for (std::uint32_t i = first_at_[v]; i < first_at_[v + 1]; ++i)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const auto& t = field_.triangles[at_[i]];
        const Across beyond = field_.across[at_[i]][k];
        if (!beyond.is_border() || (t[k] != v && t[(k + 1) % 3] != v)) continue;
        const int edge = static_cast<int>(beyond.border());
        if (first >= 0 && first != edge) return 2;
        first = edge;
      }
    return first >= 0 ? 1 : 0;
  }

  std::set<std::uint32_t> cells_at(std::uint32_t vertex) {
    std::set<std::uint32_t> cells;
    for (const std::uint32_t v : merged_[vertex])
      for (std::uint32_t i = first_at_[v]; i < first_at_[v + 1]; ++i) cells.insert(find(at_[i]));
    return cells;
  }

  // Crossings of three cracks at one place come out as vertices a rounding error apart. Two ends of
  // a short edge become one where no cell but the edge's own touches both, so that discs stay
  // discs.
  void contract_short_edges() {
    representative_.resize(field_.vertices.size());
    std::iota(representative_.begin(), representative_.end(), 0u);
    merged_.clear();
    for (std::uint32_t c = 0; c < cells_.size(); ++c)
      for (const std::uint32_t edge : cells_[c].edges)
        if (edge_length(edge) < params_.least_edge) contract(edge);
  }
  void contract(std::uint32_t edge) {
    std::uint32_t keep = representative_[start_of(edge)];
    std::uint32_t drop = representative_[end_of(edge)];
    if (keep == drop) return;
    if (firmness(keep) < firmness(drop)) std::swap(keep, drop);
    const int firm = firmness(drop);
    if (firm == 2 || (firm == 1 && !across(edge).is_border())) return;
    for (const std::uint32_t v : {keep, drop}) merged_.try_emplace(v, 1, v);
    const auto a = cells_at(keep), b = cells_at(drop);
    std::vector<std::uint32_t> both;
    std::ranges::set_intersection(a, b, std::back_inserter(both));
    if (both.size() != (across(edge).is_border() ? 1u : 2u)) return;
    if (std::ranges::any_of(both, [&](std::uint32_t c) { return loop_of(c).size() <= 3; })) return;
    for (const std::uint32_t v : merged_[drop]) {
      representative_[v] = keep;
      merged_[keep].push_back(v);
    }
    merged_.erase(drop);
  }

  // The border of a cell in order, without the points that only split a boundary edge.
  std::vector<std::uint32_t> loop_of(std::uint32_t cell) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> by_start;
    for (const std::uint32_t edge : cells_[cell].edges) by_start.emplace_back(start_of(edge), edge);
    std::sort(by_start.begin(), by_start.end());
    std::vector<std::uint32_t> loop;
    std::uint32_t edge = by_start.front().second;
    do {
      loop.push_back(edge);
      const std::uint32_t end = end_of(edge);
      const auto next = std::ranges::lower_bound(by_start, std::pair{end, 0u});
      assert(next != by_start.end() && next->first == end);
      edge = next->second;
    } while (edge != by_start.front().second);
    assert(loop.size() == by_start.size());
    std::erase_if(loop, [&](std::uint32_t e) {
      return representative_[start_of(e)] == representative_[end_of(e)];
    });
    std::vector<std::uint32_t> kept;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Across before = across(loop[(k + loop.size() - 1) % loop.size()]);
      if (!before.is_border() || !(before == across(loop[k]))) kept.push_back(loop[k]);
    }
    return kept;
  }

  Pattern make_pattern(std::vector<std::uint8_t>* is_damaged) {
    Pattern pattern;
    std::vector<std::uint32_t> cell_of(cells_.size(), kNone),
        vertex_of(field_.vertices.size(), kNone);
    std::uint32_t count = 0;
    for (std::uint32_t t = 0; t < cells_.size(); ++t) {
      if (cell_of[find(t)] == kNone) cell_of[find(t)] = count++;
      cell_of[t] = cell_of[find(t)];
    }
    std::vector<std::uint32_t> roots(count);
    for (std::uint32_t t = 0; t < cells_.size(); ++t) roots[cell_of[t]] = find(t);
    for (const std::uint32_t root : roots) {
      if (is_damaged) is_damaged->push_back(cells_[root].is_damaged);
      for (const std::uint32_t edge : loop_of(root)) {
        const std::uint32_t v = representative_[start_of(edge)];
        if (vertex_of[v] == kNone) {
          vertex_of[v] = static_cast<std::uint32_t>(pattern.vertices.size());
          pattern.vertices.push_back(field_.vertices[v]);
        }
        pattern.corners.push_back(vertex_of[v]);
        const Across beyond = across(edge);
        pattern.across.push_back(beyond.is_border() ? beyond
                                                    : Across::cell(cell_of[beyond.cell()]));
      }
      pattern.cell_begin.push_back(static_cast<std::uint32_t>(pattern.corners.size()));
    }
    pattern.all_convex = true;
    for (std::uint32_t c = 0; c < count && pattern.all_convex; ++c)
      pattern.all_convex = is_strictly_convex(pattern, c);
    return pattern;
  }

  const CrackedTriangles& field_;
  const GatherParams& params_;
  std::vector<std::uint32_t> parent_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> first_at_, at_;   // triangles around each vertex
  std::vector<std::uint32_t> representative_;  // of each vertex, itself unless contracted
  std::map<std::uint32_t, std::vector<std::uint32_t>> merged_;  // the vertices it stands for
};

}  // namespace

std::vector<std::vector<std::uint32_t>> parts_between_cracks(const CrackedTriangles& field) {
  const auto count = static_cast<std::uint32_t>(field.triangles.size());
  const auto twice_area = [&](std::uint32_t t) {
    const auto& [a, b, c] = field.triangles[t];
    return cross(field.vertices[b] - field.vertices[a], field.vertices[c] - field.vertices[a]);
  };
  std::vector<std::vector<std::uint32_t>> parts;
  std::vector<bool> seen(count);
  for (std::uint32_t start = 0; start < count; ++start) {
    if (seen[start]) continue;
    std::vector<std::uint32_t>& part = parts.emplace_back(1, start);
    seen[start] = true;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const Across across = field.across[part[i]][k];
        if (across.is_border() || field.is_crack[part[i]][k] || seen[across.cell()]) continue;
        seen[across.cell()] = true;
        part.push_back(across.cell());
      }
    std::iter_swap(part.begin(), std::ranges::max_element(part, {}, twice_area));
  }
  return parts;
}

Pattern gather(const CrackedTriangles& triangles, const GatherParams& params,
               std::vector<std::uint8_t>* is_damaged) {
  return Gatherer(triangles, params).run(is_damaged);
}

}  // namespace sunder
