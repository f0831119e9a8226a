// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/cut.hpp"

#include <algorithm>
#include <cassert>
#include <map>

#include "fracture/cut_cell.hpp"

namespace sunder {
namespace {

class PatternCutter {
 public:
  PatternCutter(const Pattern& pattern, const ExactCells& exact, const LatticeRegion& region)
      : pattern_(pattern),
        exact_(exact),
        region_(region),
        touching_(pattern.cell_count()),
        status_(pattern.cell_count(), kUnknown) {
    find_first_corners();
  }

  Pattern run(CutStats* stats) {
    trace_boundary();
    cut_touched_cells();
    flood_inside();
    number_parts();
    Pattern result = assemble();
    if (stats) {
      stats->cells_cut = cut_count_;
      stats->cells_outside =
          static_cast<std::uint64_t>(std::ranges::count(status_, kUnknown)) + emptied_count_;
    }
    return result;
  }

 private:
  enum Status : std::uint8_t { kUnknown, kInside, kCut };

  void find_first_corners() {
    std::map<LatticePoint, std::uint32_t> first;
    for (std::uint32_t k = 0; k < region_.edge_count(); ++k)
      first_at_.push_back(first.try_emplace(region_.corners[k], k).first->second);
  }

  // Walks from the start point to each loop and along it; every cell the boundary meets is found
  // because the cells that a segment meets are connected across edges.
  void trace_boundary() {
    std::vector<std::uint32_t> here{0};
    LatticePoint at = exact_.start;
    for (std::uint32_t l = 0; l < region_.loop_count(); ++l) {
      const std::uint32_t begin = region_.loop_begin[l], end = region_.loop_begin[l + 1];
      here = cells_met(here, at, region_.corners[begin]);
      for (std::uint32_t f = begin; f < end; ++f) {
        here = cells_met(here, region_.corners[f], region_.corners[region_.next(f)]);
        for (const std::uint32_t cell : here) touching_[cell].push_back(f);
      }
      at = region_.corners[begin];
    }
  }

  // The cells that the segment meets; `seeds` holds one that contains `from`.
  std::vector<std::uint32_t> cells_met(const std::vector<std::uint32_t>& seeds, LatticePoint from,
                                       LatticePoint to) {
    std::vector<std::uint32_t> met;
    std::map<std::uint32_t, bool> seen;
    std::vector<std::uint32_t> open = seeds;
    for (const std::uint32_t cell : seeds) seen[cell] = true;
    while (!open.empty()) {
      const std::uint32_t cell = open.back();
      open.pop_back();
      if (!touches(exact_.cell(cell), from, to)) continue;
      met.push_back(cell);
      for (std::uint32_t k = pattern_.cell_begin[cell]; k < pattern_.cell_begin[cell + 1]; ++k)
        if (const Across a = pattern_.across[k];
            !a.is_border() && seen.try_emplace(a.cell(), true).second)
          open.push_back(a.cell());
    }
    std::ranges::sort(met);
    return met;
  }

  std::span<const Across> across_of(std::uint32_t cell) const {
    return std::span(pattern_.across)
        .subspan(pattern_.cell_begin[cell],
                 pattern_.cell_begin[cell + 1] - pattern_.cell_begin[cell]);
  }
  std::span<const std::uint32_t> corners_of(std::uint32_t cell) const {
    return std::span(pattern_.corners)
        .subspan(pattern_.cell_begin[cell],
                 pattern_.cell_begin[cell + 1] - pattern_.cell_begin[cell]);
  }

  void cut_touched_cells() {
    for (std::uint32_t cell = 0; cell < pattern_.cell_count(); ++cell) {
      if (touching_[cell].empty()) continue;
      CutCell result = cut_cell(cell, exact_.cell(cell), across_of(cell), corners_of(cell), region_,
                                first_at_, touching_[cell]);
      if (result.decided) {
        status_[cell] = kCut;
        ++(result.parts.empty() ? emptied_count_ : cut_count_);
      }
      for (const CutCell::OnBoundary& p : result.on_boundary)
        on_boundary_.insert({p.key, {p.edge, p.t}});
      cut_[cell] = std::move(result);
    }
  }

  // Inside cells are those reached from the parts without crossing the boundary.
  void flood_inside() {
    std::vector<std::uint32_t> open;
    const auto reach = [&](Across a) {
      if (a.is_border() || status_[a.cell()] != kUnknown) return;
      status_[a.cell()] = kInside;
      open.push_back(a.cell());
    };
    for (const auto& [cell, result] : cut_)
      if (result.decided)
        for (const CutPart& part : result.parts)
          for (const auto& loop : part.loops)
            for (const CutSide& side : loop) reach(side.across);
    while (!open.empty()) {
      const std::uint32_t cell = open.back();
      open.pop_back();
      for (const Across a : across_of(cell)) reach(a);
    }
  }

  void number_parts() {
    first_part_.assign(pattern_.cell_count() + 1, 0);
    std::uint32_t count = 0;
    for (std::uint32_t cell = 0; cell < pattern_.cell_count(); ++cell) {
      first_part_[cell] = count;
      if (status_[cell] == kInside) count += 1;
      if (status_[cell] == kCut) count += static_cast<std::uint32_t>(cut_.at(cell).parts.size());
    }
    first_part_.back() = count;
    for (const auto& [cell, result] : cut_)
      if (status_[cell] == kCut)
        for (std::uint32_t i = 0; i < result.parts.size(); ++i)
          for (const auto& loop : result.parts[i].loops)
            for (std::size_t s = 0; s < loop.size(); ++s)
              part_at_[{loop[s].from, loop[s + 1 == loop.size() ? 0 : s + 1].from}] =
                  first_part_[cell] + i;
  }

  Pattern assemble() {
    vertex_id_.assign(pattern_.vertices.size(), kNone);
    Pattern result;
    for (std::uint32_t cell = 0; cell < pattern_.cell_count(); ++cell) {
      const auto it = cut_.find(cell);
      if (status_[cell] == kUnknown) continue;
      if (it == cut_.end()) {
        copy_cell(result, cell);
      } else {
        for (const CutPart& part : it->second.parts) append_part(result, cell, part);
      }
    }
    for (const auto& [key, id] : node_id_) result.vertices[id] = place_of(key);
    return result;
  }

  void copy_cell(Pattern& result, std::uint32_t cell) {
    for (std::uint32_t k = pattern_.cell_begin[cell]; k < pattern_.cell_begin[cell + 1]; ++k) {
      const std::uint32_t v = pattern_.corners[k];
      const std::uint32_t l =
          k + 1 == pattern_.cell_begin[cell + 1] ? pattern_.cell_begin[cell] : k + 1;
      result.corners.push_back(vertex_of(result, v));
      result.across.push_back(translate(pattern_.across[k], {NodeKey::vertex, {v}},
                                        {NodeKey::vertex, {pattern_.corners[l]}}));
    }
    finish_cell(result, cell);
  }

  void append_part(Pattern& result, std::uint32_t cell, const CutPart& part) {
    for (std::size_t l = 0; l < part.loops.size(); ++l) {
      const auto& loop = part.loops[l];
      if (l > 0) result.hole_begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
      for (std::size_t s = 0; s < loop.size(); ++s) {
        result.corners.push_back(vertex_of(result, loop[s].from));
        result.across.push_back(
            translate(loop[s].across, loop[s].from, loop[s + 1 == loop.size() ? 0 : s + 1].from));
      }
    }
    finish_cell(result, cell);
  }

  void finish_cell(Pattern& result, std::uint32_t cell) const {
    result.cell_begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
    result.origin.push_back(pattern_.origin_of(cell));
  }

  // An old neighbour as a new one: the part of it that has this edge the other way round.
  Across translate(Across old, const NodeKey& from, const NodeKey& to) const {
    if (old.is_border()) return old;
    if (status_[old.cell()] == kInside) return Across::cell(first_part_[old.cell()]);
    const auto it = part_at_.find({to, from});
    assert(it != part_at_.end() && "an interior edge has a part on its other side");
    return Across::cell(it->second);
  }

  std::uint32_t vertex_of(Pattern& result, std::uint32_t v) {
    if (vertex_id_[v] == kNone) {
      vertex_id_[v] = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back(pattern_.vertices[v]);
    }
    return vertex_id_[v];
  }

  std::uint32_t vertex_of(Pattern& result, const NodeKey& key) {
    if (key.kind == NodeKey::vertex) {
      const std::uint32_t id = vertex_of(result, key.ids[0]);
      if (on_boundary_.contains(key)) node_id_[key] = id;
      return id;
    }
    const auto [it, added] =
        node_id_.try_emplace(key, static_cast<std::uint32_t>(result.vertices.size()));
    if (added) result.vertices.emplace_back();
    return it->second;
  }

  Vec2 place_of(const NodeKey& key) const {
    if (key.kind == NodeKey::corner) return region_.places[key.ids[0]];
    const auto [edge, t] = on_boundary_.at(key);
    const Vec2 a = region_.places[edge], b = region_.places[region_.next(edge)];
    return t < 0.5 ? a + t * (b - a) : b - (1 - t) * (b - a);
  }

  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  const Pattern& pattern_;
  const ExactCells& exact_;
  const LatticeRegion& region_;
  std::vector<std::uint32_t> first_at_;
  std::vector<std::vector<std::uint32_t>> touching_;  // boundary edges per cell, ascending
  std::vector<Status> status_;
  std::map<std::uint32_t, CutCell> cut_;
  std::map<NodeKey, std::pair<std::uint32_t, double>> on_boundary_;
  std::vector<std::uint32_t> first_part_;
  std::map<std::pair<NodeKey, NodeKey>, std::uint32_t> part_at_;
  std::vector<std::uint32_t> vertex_id_;
  std::map<NodeKey, std::uint32_t> node_id_;
  std::uint64_t cut_count_ = 0, emptied_count_ = 0;
};

}  // namespace

Pattern cut(const Pattern& pattern, const ExactCells& exact, const LatticeRegion& region,
            CutStats* stats) {
  return PatternCutter(pattern, exact, region).run(stats);
}

}  // namespace sunder
