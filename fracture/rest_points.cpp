// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "fracture/crack_web.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

// Shares of the spacing: how far a point strays from its grid node, and how near it may come to a
// crack or border; together they keep triangles from becoming slivers.
constexpr double kStray = 0.28;
constexpr double kClearance = 0.45;

double squared_distance(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = from_segment(p, a, b);
  return dot(d, d);
}

struct EdgeEnds {
  Vec2 a, b;
};

EdgeEnds edge_ends(const LatticeRegion& region, std::uint32_t edge) {
  const auto place = [&](std::uint32_t corner) {
    return Vec2{static_cast<double>(region.corners[corner].x),
                static_cast<double>(region.corners[corner].y)};
  };
  return {place(edge), place(region.next(edge))};
}

// Jittered nodes of a staggered grid over the wall; `alive` says which are still wanted.
class NodeGrid {
 public:
  NodeGrid(const Lattice& lattice, double spacing, std::uint64_t seed)
      : spacing_(spacing), row_height_(spacing * 0.866), seed_(seed) {
    columns_ = static_cast<std::int64_t>(static_cast<double>(lattice.width) / spacing_) + 2;
    rows_ = static_cast<std::int64_t>(static_cast<double>(lattice.height) / row_height_) + 2;
    alive_.assign(static_cast<std::size_t>(columns_ * rows_), 1);
  }

  Vec2 node(std::int64_t i, std::int64_t j) const {
    const auto k = static_cast<std::uint64_t>(j * columns_ + i);
    const double x = static_cast<double>(i) + (j % 2 == 0 ? 0.25 : -0.25) + stray(k, 0);
    const double y = static_cast<double>(j) + stray(k, 1);
    return {std::nearbyint(x * spacing_), std::nearbyint(y * row_height_)};
  }

  // Drops the nodes nearer than `clearance` to a segment.
  void clear_around(Vec2 a, Vec2 b, double clearance) {
    const double reach = clearance + 2 * spacing_;  // a node strays less than its grid cell
    const auto range = [&](double low, double high, double cell, std::int64_t count) {
      const auto clamped = [&](double v) {
        return static_cast<std::int64_t>(std::clamp(v, 0.0, static_cast<double>(count)));
      };
      return std::pair{clamped(std::floor((low - reach) / cell)),
                       clamped(std::ceil((high + reach) / cell))};
    };
    const auto [i0, i1] = range(std::min(a.x, b.x), std::max(a.x, b.x), spacing_, columns_);
    const auto [j0, j1] = range(std::min(a.y, b.y), std::max(a.y, b.y), row_height_, rows_);
    for (std::int64_t j = j0; j < j1; ++j)
      for (std::int64_t i = i0; i < i1; ++i) {
        auto& alive = alive_[static_cast<std::size_t>(j * columns_ + i)];
        if (alive && squared_distance(node(i, j), a, b) < clearance * clearance) alive = 0;
      }
  }

  template <class Keep>
  std::vector<Vec2> points(Keep keep) const {
    std::vector<Vec2> result;
    for (std::int64_t j = 0; j < rows_; ++j)
      for (std::int64_t i = 0; i < columns_; ++i)
        if (alive_[static_cast<std::size_t>(j * columns_ + i)] && keep(node(i, j)))
          result.push_back(node(i, j));
    return result;
  }

 private:
  double stray(std::uint64_t k, std::uint64_t axis) const {
    return kStray * (2 * random_unit(seed_, k, axis) - 1);
  }

  double spacing_, row_height_;
  std::uint64_t seed_;
  std::int64_t columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> alive_;
};

bool is_in_some_hull(const CrackWeb& web, Vec2 p) {
  return std::ranges::any_of(web.hulls, [&](const auto& hull) { return is_in_convex(hull, p); });
}

// True where another boundary edge runs along this one: an opening that touches the outline.
bool lies_on_another_edge(const LatticeRegion& region, std::uint32_t edge, Vec2 p) {
  constexpr double kTouching = 2;  // lattice units
  for (std::uint32_t e = 0; e < region.edge_count(); ++e) {
    const EdgeEnds ends = edge_ends(region, e);
    if (e != edge && squared_distance(p, ends.a, ends.b) < kTouching * kTouching) return true;
  }
  return false;
}

}  // namespace

RestPoints spread_rest_points(const LatticeRegion& region, const CrackWeb& web, double spacing,
                              std::uint64_t seed) {
  RestPoints result;
  const std::uint64_t edge_seed = random_bits(seed, 1), node_seed = random_bits(seed, 2);
  const double clearance = kClearance * spacing;
  const auto near_crack = [&](Vec2 p) {
    return std::ranges::any_of(web.outer_cracks, [&](const CrackWeb::Segment& s) {
      return squared_distance(p, s.a, s.b) < clearance * clearance;
    });
  };
  for (std::uint32_t e = 0; e < region.edge_count(); ++e) {
    auto& row = result.on_edge.emplace_back();
    const EdgeEnds ends = edge_ends(region, e);
    const auto count = static_cast<std::uint64_t>(length(ends.b - ends.a) / spacing + 0.5);
    for (std::uint64_t i = 1; i < count; ++i) {
      const double stray = kStray * (2 * random_unit(edge_seed, e, i) - 1);
      const double t = (static_cast<double>(i) + stray) / static_cast<double>(count);
      const Vec2 p = ends.a + t * (ends.b - ends.a);
      if (!is_in_some_hull(web, p) && !near_crack(p) && !lies_on_another_edge(region, e, p))
        row.push_back(p);
    }
  }
  NodeGrid grid(region.lattice, spacing, node_seed);
  for (std::uint32_t e = 0; e < region.edge_count(); ++e)
    grid.clear_around(edge_ends(region, e).a, edge_ends(region, e).b, clearance);
  for (const CrackWeb::Segment& s : web.outer_cracks) grid.clear_around(s.a, s.b, clearance);
  result.inside = grid.points([&](Vec2 p) {
    const LatticePoint q{std::llround(p.x), std::llround(p.y)};
    return locate(region, q) > 0 && !is_in_some_hull(web, p);
  });
  return result;
}

}  // namespace sunder
