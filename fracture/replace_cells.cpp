// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "fracture/recover.hpp"
#include "fracture/recover_detail.hpp"
#include "meshing/error.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

class CellReplacer {
 public:
  CellReplacer(const WallAsset& asset, std::span<const std::uint32_t> removed,
               std::span<const Vec2> new_vertices, std::span<const NewCell> added)
      : asset_(asset), old_(asset.pattern), added_(added), new_id_(old_.cell_count(), 0) {
    for (const std::uint32_t c : removed) {
      assert(c < new_id_.size());
      new_id_[c] = kNone;
      origin_ = old_.origin_of(c);
    }
    for (std::uint32_t c = 0; c < new_id_.size(); ++c)
      if (new_id_[c] != kNone) new_id_[c] = kept_count_++;
    pattern_.vertices = old_.vertices;
    pattern_.vertices.insert(pattern_.vertices.end(), new_vertices.begin(), new_vertices.end());
  }

  ReplacedCells run() {
    copy_kept();
    expect_edges_of_removed();
    for (std::uint32_t i = 0; i < added_.size(); ++i) append(i);
    split_borders();
    if (!open_.empty()) fail(open_.begin()->first);
    const bool convex = old_.all_convex ? added_are_convex() : all_convex(pattern_);
    pattern_.all_convex = convex;
    measure();
    return std::move(result_);
  }

 private:
  using Ends = std::pair<std::uint32_t, std::uint32_t>;
  // What an edge of an added cell will have across it, and the corner that gets the cell in turn.
  struct Open {
    Across across;
    std::uint32_t corner = kNone;
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::geometry, "wall " + asset_.wall.name +
                                         ": the new cells do not fill what they replace: " + what);
  }
  [[noreturn]] void fail(Ends ends) const {
    fail("the edge from vertex " + std::to_string(ends.first) + " to vertex " +
         std::to_string(ends.second) + " has no counterpart");
  }

  void finish_cell(std::uint32_t old_cell, std::uint32_t origin) {
    pattern_.cell_begin.push_back(static_cast<std::uint32_t>(pattern_.corners.size()));
    pattern_.origin.push_back(origin);
    result_.old_cell.push_back(old_cell);
  }

  void copy_kept() {
    pattern_.corners.reserve(old_.corners.size());
    pattern_.across.reserve(old_.corners.size());
    for (std::uint32_t c = 0; c < old_.cell_count(); ++c) {
      if (new_id_[c] == kNone) continue;
      copy_corners(c);
      finish_cell(c, old_.origin_of(c));
      result_.asset.chunks.push_back(asset_.chunks[c]);
    }
  }

  void copy_corners(std::uint32_t c) {
    const auto copy = [&](LoopRange loop) {
      for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
        const Across across = old_.across[k];
        const auto corner = static_cast<std::uint32_t>(pattern_.corners.size());
        pattern_.corners.push_back(old_.corners[k]);
        if (across.is_border() || new_id_[across.cell()] != kNone) {
          pattern_.across.push_back(across.is_border() ? across
                                                       : Across::cell(new_id_[across.cell()]));
          continue;
        }
        pattern_.across.push_back(across);
        open_[{old_.corners[loop.next(k)], old_.corners[k]}] = {Across::cell(new_id_[c]), corner};
      }
    };
    if (old_.hole_begin.empty()) return copy({old_.cell_begin[c], old_.cell_begin[c + 1]});
    for (const LoopRange loop : loops_of(old_, c)) {
      if (loop.begin != old_.cell_begin[c])
        pattern_.hole_begin.push_back(static_cast<std::uint32_t>(pattern_.corners.size()));
      copy(loop);
    }
  }

  void expect_edges_of_removed() {
    for (std::uint32_t c = 0; c < old_.cell_count(); ++c) {
      if (new_id_[c] != kNone) continue;
      for (const LoopRange loop : loops_of(old_, c))
        for (std::uint32_t k = loop.begin; k < loop.end; ++k)
          if (old_.across[k].is_border())
            open_[{old_.corners[k], old_.corners[loop.next(k)]}] = {old_.across[k], kNone};
    }
  }

  void append(std::uint32_t i) {
    const auto cell = Across::cell(kept_count_ + i);
    for (const auto& loop : added_[i].loops) {
      const auto begin = static_cast<std::uint32_t>(pattern_.corners.size());
      if (&loop != &added_[i].loops.front()) pattern_.hole_begin.push_back(begin);
      for (std::size_t j = 0; j < loop.size(); ++j) {
        const Ends ends{loop[j], loop[j + 1 == loop.size() ? 0 : j + 1]};
        if (ends.first >= pattern_.vertices.size()) fail(ends);
        pattern_.corners.push_back(ends.first);
        pattern_.across.push_back(across_of(ends, cell));
      }
    }
    finish_cell(kNone - i, origin_);
  }

  // An edge finds what is across it, or waits for an added cell that has it the other way round.
  Across across_of(Ends ends, Across cell) {
    const auto corner = static_cast<std::uint32_t>(pattern_.across.size());
    const auto it = open_.find(ends);
    if (it == open_.end()) {
      if (!open_.try_emplace({ends.second, ends.first}, Open{cell, corner}).second) fail(ends);
      return {};
    }
    const Open open = it->second;
    if (open.across == cell) fail(ends);
    open_.erase(it);
    if (open.corner != kNone) pattern_.across[open.corner] = cell;
    return open.across;
  }

  // A border edge that added cells cut into several: what waits for a counterpart and follows it
  // from end to end, exactly on it.
  void split_borders() {
    std::map<std::uint32_t, std::vector<std::uint32_t>> ends_from;
    for (const auto& [ends, open] : open_)
      if (open.corner != kNone) ends_from[ends.second].push_back(ends.first);
    std::vector<std::pair<Ends, Across>> borders;
    for (const auto& [ends, open] : open_)
      if (open.corner == kNone) borders.emplace_back(ends, open.across);
    for (const auto& [ends, across] : borders)
      if (follow(ends, across, ends_from)) open_.erase(ends);
  }

  bool follow(Ends ends, Across across,
              const std::map<std::uint32_t, std::vector<std::uint32_t>>& ends_from) {
    const Vec2 a = pattern_.vertices[ends.first], b = pattern_.vertices[ends.second];
    for (std::uint32_t at = ends.first; at != ends.second;) {
      const auto found = ends_from.find(at);
      if (found == ends_from.end()) return false;
      const auto next = std::ranges::find_if(found->second, [&](std::uint32_t v) {
        const Vec2 p = pattern_.vertices[v];
        return open_.contains({v, at}) && orientation(a, b, p) == 0 &&
               dot(p - pattern_.vertices[at], b - a) > 0 && dot(p - b, b - a) <= 0;
      });
      if (next == found->second.end()) return false;
      const auto open = open_.find({*next, at});
      pattern_.across[open->second.corner] = across;
      open_.erase(open);
      at = *next;
    }
    return true;
  }

  bool added_are_convex() const {
    for (std::uint32_t c = kept_count_; c < pattern_.cell_count(); ++c)
      if (!is_strictly_convex(pattern_, c)) return false;
    return true;
  }

  void measure() {
    WallAsset& asset = result_.asset;
    asset.wall = asset_.wall;
    asset.density = asset_.density;
    asset.region = asset_.region;
    asset.volume_expected = asset_.volume_expected;
    asset.stats = asset_.stats;
    for (std::uint32_t c = kept_count_; c < pattern_.cell_count(); ++c) {
      if (!(cell_area(pattern_, c) > 0))
        fail("new cell " + std::to_string(c - kept_count_) + " has no area");
      asset.chunks.push_back(measured_chunk(asset, c));
    }
    merge_bonds();
  }

  // Bonds of the added cells among themselves, with their neighbours and with the world, numbered
  // as in the result: those of a pattern of these cells alone, in the same order.
  std::vector<Bond> bonds_of_added() {
    std::vector<std::uint32_t> cells;
    for (std::uint32_t c = kept_count_; c < pattern_.cell_count(); ++c) {
      cells.push_back(c);
      for (std::uint32_t k = pattern_.cell_begin[c]; k < pattern_.cell_begin[c + 1]; ++k)
        if (!pattern_.across[k].is_border()) cells.push_back(pattern_.across[k].cell());
    }
    std::ranges::sort(cells);
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    Pattern part;
    for (const std::uint32_t c : cells) copy_part(c, cells, part);
    std::swap(part.vertices, pattern_.vertices);
    std::vector<Bond> bonds = find_bonds(part, asset_.wall.thickness,
                                         edges_on_anchored_sides(asset_.wall, asset_.region));
    std::swap(part.vertices, pattern_.vertices);
    for (Bond& bond : bonds) {
      bond.a = cells[bond.a];
      if (bond.b != kWorld) bond.b = cells[bond.b];
    }
    std::erase_if(bonds, [&](const Bond& bond) {
      return bond.a < kept_count_ && (bond.b == kWorld || bond.b < kept_count_);
    });
    return bonds;
  }

  void copy_part(std::uint32_t c, const std::vector<std::uint32_t>& cells, Pattern& part) const {
    const Across elsewhere = Across::border(0x7FFFFFFF);  // never anchored
    for (const LoopRange loop : loops_of(pattern_, c)) {
      if (loop.begin != pattern_.cell_begin[c])
        part.hole_begin.push_back(static_cast<std::uint32_t>(part.corners.size()));
      for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
        Across across = pattern_.across[k];
        if (!across.is_border()) {
          const auto at = std::ranges::lower_bound(cells, across.cell());
          const bool here = at != cells.end() && *at == across.cell();
          across = here ? Across::cell(static_cast<std::uint32_t>(at - cells.begin())) : elsewhere;
        }
        part.corners.push_back(pattern_.corners[k]);
        part.across.push_back(across);
      }
    }
    part.cell_begin.push_back(static_cast<std::uint32_t>(part.corners.size()));
  }

  void merge_bonds() {
    std::vector<Bond>& bonds = result_.asset.bonds;
    bonds.reserve(asset_.bonds.size());
    for (Bond bond : asset_.bonds) {
      bond.a = new_id_[bond.a];
      if (bond.a == kNone) continue;
      if (bond.b != kWorld && (bond.b = new_id_[bond.b]) == kNone) continue;
      bonds.push_back(bond);
    }
    const std::vector<Bond> more = bonds_of_added();
    const auto old_count = static_cast<std::ptrdiff_t>(bonds.size());
    bonds.insert(bonds.end(), more.begin(), more.end());
    const auto order = [](const Bond& bond) {
      return std::tuple(bond.b == kWorld, bond.a, bond.b);
    };
    std::ranges::inplace_merge(bonds, bonds.begin() + old_count, {}, order);
  }

  const WallAsset& asset_;
  const Pattern& old_;
  std::span<const NewCell> added_;
  std::vector<std::uint32_t> new_id_;  // per old cell; kNone: removed
  std::uint32_t kept_count_ = 0, origin_ = 0;
  ReplacedCells result_;
  Pattern& pattern_ = result_.asset.pattern;
  std::map<Ends, Open> open_;
};

// --- sectors
// --------------------------------------------------------------------------------------

// Grows with the direction's angle, by 4 per turn.
double turned(Vec2 d) {
  const double part = d.x / (std::abs(d.x) + std::abs(d.y));
  return d.y >= 0 ? 1 - part : 3 + part;
}

class SpokeChoice {
 public:
  SpokeChoice(std::span<const Vec2> corners, Vec2 point) : corners_(corners), point_(point) {
    for (const Vec2& a : corners_)
      for (const Vec2& b : corners_) costs_.push_back(cost_of(a, b));
  }

  bool is_inside() const {
    for (std::size_t i = 0; i < corners_.size(); ++i)
      if (orientation(corners_[i], corners_[(i + 1) % corners_.size()], point_) <= 0) return false;
    return true;
  }

  /// The `count` corners whose spokes are spread best: least sum of squares of the angles between
  /// them, each below half a turn. Empty if there are none.
  std::vector<std::uint32_t> best(std::size_t count) const {
    std::vector<std::uint32_t> spokes;
    double least = kNever;
    for (std::size_t first = 0; first + count <= corners_.size(); ++first)
      try_from(first, count, least, spokes);
    return spokes;
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  double cost_of(Vec2 a, Vec2 b) const {
    if (orientation(point_, a, b) <= 0) return kNever;
    const double gap = turned(b - point_) - turned(a - point_);
    return gap > 0 ? gap * gap : (gap + 4) * (gap + 4);
  }
  double cost(std::size_t a, std::size_t b) const { return costs_[a * corners_.size() + b]; }

  // Least cost of reaching corner j with m sectors from `first` on, m by m.
  void try_from(std::size_t first, std::size_t count, double& least,
                std::vector<std::uint32_t>& spokes) const {
    const std::size_t size = corners_.size();
    std::vector<std::vector<double>> reach(count, std::vector<double>(size, kNever));
    std::vector<std::vector<std::uint32_t>> from(count, std::vector<std::uint32_t>(size, 0));
    reach[0][first] = 0;
    for (std::size_t m = 1; m < count; ++m)
      for (std::size_t j = first + m; j < size; ++j)
        for (std::size_t i = first + m - 1; i < j; ++i)
          if (const double sum = reach[m - 1][i] + cost(i, j); sum < reach[m][j]) {
            reach[m][j] = sum;
            from[m][j] = static_cast<std::uint32_t>(i);
          }
    for (std::size_t last = first + count - 1; last < size; ++last) {
      const double total = reach[count - 1][last] + cost(last, first);
      if (!(total < least)) continue;
      least = total;
      spokes.assign(count, static_cast<std::uint32_t>(last));
      for (std::size_t m = count - 1; m > 0; --m) spokes[m - 1] = from[m][spokes[m]];
    }
  }

  std::span<const Vec2> corners_;
  Vec2 point_;
  std::vector<double> costs_;  // of a sector from corner to corner
};

}  // namespace

ReplacedCells replace_cells(const WallAsset& asset, std::span<const std::uint32_t> removed,
                            std::span<const Vec2> new_vertices, std::span<const NewCell> added) {
  return CellReplacer(asset, removed, new_vertices, added).run();
}

std::vector<std::uint32_t> choose_spokes(std::span<const Vec2> polygon, Vec2 point,
                                         std::uint32_t count) {
  const SpokeChoice choice(polygon, point);
  if (polygon.size() < 3 || !choice.is_inside()) return {};
  const auto size = static_cast<std::uint32_t>(polygon.size());
  std::vector<std::uint32_t> spokes;
  for (std::size_t n = std::clamp(count, 3u, size); spokes.empty() && n <= size; ++n)
    spokes = choice.best(n);
  return spokes;
}

Vec2 rounded_to_float(Vec2 p) {
  // Without the sums, which also make -0 to 0, GCC 12 drops a pair of conversions there and back.
  const float x = static_cast<float>(p.x) + 0.f, y = static_cast<float>(p.y) + 0.f;
  return {x, y};
}

}  // namespace sunder
