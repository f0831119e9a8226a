// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/slivers.hpp"

#include <algorithm>
#include <cassert>
#include <map>
#include <set>

namespace sunder {
namespace {

double loop_area(const Pattern& pattern, const std::vector<std::uint32_t>& corners) {
  double sum = 0;
  const Vec2 base = pattern.vertices[pattern.corners[corners[0]]];
  for (std::size_t i = 2; i < corners.size(); ++i)
    sum += cross(pattern.vertices[pattern.corners[corners[i - 1]]] - base,
                 pattern.vertices[pattern.corners[corners[i]]] - base);
  return sum / 2;
}

// A cell without area is none, whatever the limit.
bool is_small(double area, double limit) {
  return area < limit || !(area > 0);
}

class SliverMerger {
 public:
  SliverMerger(const Pattern& pattern, std::vector<double> areas)
      : pattern_(pattern),
        area_(std::move(areas)),
        group_(pattern.cell_count()),
        members_(pattern.cell_count()) {
    for (std::uint32_t c = 0; c < pattern.cell_count(); ++c) group_[c] = c;
  }

  std::uint64_t merge(double min_area) {
    std::set<std::pair<double, std::uint32_t>> small;
    for (std::uint32_t c = 0; c < pattern_.cell_count(); ++c)
      if (is_small(area_[c], min_area)) small.insert({area_[c], c});
    std::uint64_t merged = 0;
    while (!small.empty()) {
      const std::uint32_t cell = small.begin()->second;
      small.erase(small.begin());
      const std::uint32_t into = best_neighbour(cell);
      if (into == kNone) continue;
      small.erase({area_[into], into});
      area_[into] += area_[cell];
      absorb(into, cell);
      if (is_small(area_[into], min_area)) small.insert({area_[into], into});
      ++merged;
    }
    return merged;
  }

  Pattern rebuild() {
    number_groups();
    Pattern result;
    result.vertices.reserve(pattern_.vertices.size());
    vertex_id_.assign(pattern_.vertices.size(), kNone);
    visited_.assign(pattern_.corners.size(), false);
    for (std::uint32_t c = 0; c < pattern_.cell_count(); ++c)
      if (stays(c)) append_group(result, c);
    return result;
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

  template <class Visit>
  void for_each_edge(std::uint32_t group, Visit visit) const {
    const auto visit_cell = [&](std::uint32_t c) {
      for (std::uint32_t k = pattern_.cell_begin[c]; k < pattern_.cell_begin[c + 1]; ++k)
        if (const Across a = pattern_.across[k]; a.is_border() || group_[a.cell()] != group)
          visit(c, k);
    };
    visit_cell(group);
    for (const std::uint32_t c : members_[group]) visit_cell(c);
  }

  // The group with the longest common boundary; the smaller id among equals.
  std::uint32_t best_neighbour(std::uint32_t group) const {
    std::map<std::uint32_t, double> shared;
    for_each_edge(group, [&](std::uint32_t c, std::uint32_t k) {
      if (pattern_.across[k].is_border()) return;
      const std::uint32_t l = loop_with(pattern_, c, k).next(k);
      shared[group_[pattern_.across[k].cell()]] +=
          length(pattern_.vertices[pattern_.corners[l]] - pattern_.vertices[pattern_.corners[k]]);
    });
    std::uint32_t best = kNone;
    for (const auto& [other, common] : shared)
      if (best == kNone || common > shared[best]) best = other;
    return best;
  }

  void absorb(std::uint32_t into, std::uint32_t group) {
    members_[into].push_back(group);
    members_[into].insert(members_[into].end(), members_[group].begin(), members_[group].end());
    members_[group].clear();
    group_[group] = into;
    for (const std::uint32_t c : members_[into]) group_[c] = into;
  }

  void number_groups() {
    number_.assign(pattern_.cell_count(), 0);
    std::uint32_t count = 0;
    for (std::uint32_t c = 0; c < pattern_.cell_count(); ++c)
      if (stays(c)) number_[c] = count++;
  }

  // A cell without area and without neighbours is a trace of rounding in the region itself.
  bool stays(std::uint32_t c) const {
    return group_[c] == c && (area_[c] > 0 || best_neighbour(c) != kNone);
  }

  std::uint32_t cell_of(std::uint32_t corner) const {
    const auto after =
        std::upper_bound(pattern_.cell_begin.begin(), pattern_.cell_begin.end(), corner);
    return static_cast<std::uint32_t>(after - pattern_.cell_begin.begin()) - 1;
  }

  // The corner in the neighbouring cell whose edge is this one the other way round.
  std::uint32_t reverse_of(std::uint32_t cell, std::uint32_t corner) const {
    const std::uint32_t from = pattern_.corners[corner];
    const std::uint32_t to = pattern_.corners[loop_with(pattern_, cell, corner).next(corner)];
    const std::uint32_t other = pattern_.across[corner].cell();
    for (const LoopRange loop : loops_of(pattern_, other))
      for (std::uint32_t k = loop.begin; k < loop.end; ++k)
        if (pattern_.corners[k] == to && pattern_.corners[loop.next(k)] == from &&
            pattern_.across[k] == Across::cell(cell))
          return k;
    assert(false && "interior edges are paired");
    return corner;
  }

  // Boundary corner of the group that follows `corner`: turn round its end through merged cells.
  std::uint32_t next_boundary(std::uint32_t group, std::uint32_t corner) const {
    std::uint32_t cell = cell_of(corner);
    std::uint32_t k = loop_with(pattern_, cell, corner).next(corner);
    while (!pattern_.across[k].is_border() && group_[pattern_.across[k].cell()] == group) {
      const std::uint32_t reverse = reverse_of(cell, k);
      cell = pattern_.across[k].cell();
      k = loop_with(pattern_, cell, reverse).next(reverse);
    }
    return k;
  }

  void append_group(Pattern& result, std::uint32_t group) {
    std::vector<std::vector<std::uint32_t>> loops;
    for_each_edge(group, [&](std::uint32_t, std::uint32_t k) {
      if (visited_[k]) return;
      std::vector<std::uint32_t> loop;
      for (; !visited_[k]; k = next_boundary(group, k)) {
        visited_[k] = true;
        loop.push_back(k);
      }
      loops.push_back(std::move(loop));
    });
    std::ranges::stable_sort(loops, std::greater{}, [&](const auto& loop) {
      return loops.size() == 1 ? 0 : loop_area(pattern_, loop);
    });
    for (std::size_t l = 0; l < loops.size(); ++l) {
      if (l > 0) result.hole_begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
      for (const std::uint32_t k : loops[l]) append_corner(result, k);
    }
    result.cell_begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
    result.origin.push_back(pattern_.origin_of(group));
  }

  void append_corner(Pattern& result, std::uint32_t k) {
    std::uint32_t& id = vertex_id_[pattern_.corners[k]];
    if (id == kNone) {
      id = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back(pattern_.vertices[pattern_.corners[k]]);
    }
    result.corners.push_back(id);
    const Across a = pattern_.across[k];
    result.across.push_back(a.is_border() ? a : Across::cell(number_[group_[a.cell()]]));
  }

  const Pattern& pattern_;
  std::vector<double> area_;
  std::vector<std::uint32_t> group_;                 // cell that stands for the cell's group
  std::vector<std::vector<std::uint32_t>> members_;  // other cells of a group
  std::vector<std::uint32_t> number_, vertex_id_;
  std::vector<bool> visited_;
};

}  // namespace

Pattern merge_slivers(Pattern pattern, double min_area, std::uint64_t* merged) {
  std::vector<double> areas(pattern.cell_count());
  bool any = false;
  for (std::uint32_t c = 0; c < pattern.cell_count(); ++c) {
    areas[c] = cell_area(pattern, c);
    any |= is_small(areas[c], min_area);
  }
  if (merged) *merged = 0;
  if (!any) return pattern;
  SliverMerger merger(pattern, std::move(areas));
  const std::uint64_t count = merger.merge(min_area);
  if (merged) *merged = count;
  return merger.rebuild();
}

}  // namespace sunder
