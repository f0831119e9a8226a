// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/local_web.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "fracture/breaking.hpp"
#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

using Ends = std::array<std::uint32_t, 2>;

bool is_float(double x) {
  const volatile float narrow = static_cast<float>(x);
  return narrow == x;
}
Vec2 to_float(Vec2 p) {
  const volatile float x = static_cast<float>(p.x), y = static_cast<float>(p.y);
  return {x, y};
}

// A wall as a file gives it back: float32 corners.
WallAsset float_wall(const Region& region, const PatternParams& params, std::uint64_t seed) {
  Wall wall;
  wall.region = region;
  wall.pattern = params;
  WallAsset asset = fracture_wall(wall, 2400, {.seed = seed});
  for (Vec2& p : asset.region.places) p = to_float(p);
  for (Vec2& p : asset.pattern.vertices) p = to_float(p);
  return asset;
}

Region plain_wall() {
  return {rectangle({6, 3}), {}};
}
Region house_wall() {
  return {{{0, 0}, {7, 0}, {7, 2.5}, {3.4, 4.1}, {0, 2.5}},
          {rectangle({0.9, 2.1}, {1, 0}),
           rectangle({1.2, 1.1}, {4, 1}),
           {{3.4, 2.9}, {3.1, 3.3}, {3.4, 3.6}, {3.8, 3.2}}}};
}
PatternParams coarse(double rest_cell = 0.6) {
  return SpiderwebParams{.impacts = {}, .rest_cell = rest_cell};
}

// A wall that hits have changed, and what its cells are.
struct State {
  WallAsset asset;
  std::vector<std::uint8_t> intact, damaged;

  explicit State(WallAsset wall)
      : asset(std::move(wall)),
        intact(asset.pattern.cell_count(), 1),
        damaged(asset.pattern.cell_count(), 0) {}
};

double sum_of_areas(const Pattern& pattern, const std::vector<std::uint32_t>& cells) {
  double sum = 0;
  for (const std::uint32_t c : cells) sum += cell_area(pattern, c);
  return sum;
}

template <class Visit>
void for_each_edge(const Pattern& pattern, Visit visit) {
  for (std::uint32_t c = 0; c < pattern.cell_count(); ++c)
    for (const LoopRange loop : loops_of(pattern, c))
      for (std::uint32_t k = loop.begin; k < loop.end; ++k)
        visit(c, k, Ends{pattern.corners[k], pattern.corners[loop.next(k)]});
}

// The cells that stay, then the added ones, nothing known across.
Pattern cells_of(const Pattern& old, const LocalWeb& web) {
  Pattern result;
  result.vertices = old.vertices;
  result.vertices.insert(result.vertices.end(), web.new_vertices.begin(), web.new_vertices.end());
  for (std::uint32_t c = 0; c < old.cell_count(); ++c) {
    if (std::ranges::binary_search(web.removed, c)) continue;
    for (const LoopRange loop : loops_of(old, c)) {
      if (loop.begin != old.cell_begin[c])
        result.hole_begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
      for (std::uint32_t k = loop.begin; k < loop.end; ++k)
        result.corners.push_back(old.corners[k]);
    }
    result.cell_begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
  }
  for (const NewCell& cell : web.added) {
    EXPECT_EQ(cell.loops.size(), 1u);
    for (const std::uint32_t v : cell.loops.front()) result.corners.push_back(v);
    result.cell_begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
  }
  result.across.resize(result.corners.size());
  return result;
}

// The pattern with the web's cells in their place, paired anew from nothing but vertex indices; a
// border edge takes its number from the old edge that it is or, exactly, lies on.
Pattern replaced(const Pattern& old, const LocalWeb& web) {
  Pattern result = cells_of(old, web);
  std::map<Ends, Across> border_of;
  for_each_edge(old, [&](std::uint32_t, std::uint32_t k, Ends ends) {
    if (old.across[k].is_border()) border_of[ends] = old.across[k];
  });
  const auto border_under = [&](Ends ends) -> std::optional<Across> {
    if (const auto it = border_of.find(ends); it != border_of.end()) return it->second;
    const Vec2 a = result.vertices[ends[0]], b = result.vertices[ends[1]];
    for (const auto& [border, across] : border_of) {
      const Vec2 p = old.vertices[border[0]], q = old.vertices[border[1]];
      if (orientation(p, q, a) == 0 && orientation(p, q, b) == 0 && dot(b - a, q - p) > 0 &&
          dot(a - p, q - p) >= 0 && dot(b - q, q - p) <= 0)
        return across;
    }
    return {};
  };
  std::map<Ends, std::uint32_t> cell_of;
  for_each_edge(result, [&](std::uint32_t c, std::uint32_t, Ends ends) {
    EXPECT_TRUE(cell_of.insert({ends, c}).second) << "two cells on one side of an edge";
  });
  for_each_edge(result, [&](std::uint32_t, std::uint32_t k, Ends ends) {
    const auto reverse = cell_of.find({ends[1], ends[0]});
    if (reverse != cell_of.end()) {
      EXPECT_FALSE(border_of.contains(ends));
      result.across[k] = Across::cell(reverse->second);
      return;
    }
    const auto border = border_under(ends);
    EXPECT_TRUE(border.has_value()) << "the edge " << ends[0] << " " << ends[1] << " is alone";
    if (border) result.across[k] = *border;
  });
  return result;
}

std::vector<double> border_lengths(const Pattern& pattern, std::uint32_t count) {
  std::vector<double> sums(count);
  for_each_edge(pattern, [&](std::uint32_t, std::uint32_t k, Ends ends) {
    if (pattern.across[k].is_border())
      sums[pattern.across[k].border()] +=
          length(pattern.vertices[ends[1]] - pattern.vertices[ends[0]]);
  });
  return sums;
}

bool is_in_cell(const Pattern& pattern, std::uint32_t cell, Vec2 point) {
  Pattern one;
  one.vertices = pattern.vertices;
  one.corners.insert(one.corners.end(), pattern.corners.begin() + pattern.cell_begin[cell],
                     pattern.corners.begin() + pattern.cell_begin[cell + 1]);
  one.across.resize(one.corners.size());
  one.cell_begin.push_back(static_cast<std::uint32_t>(one.corners.size()));
  return cell_at(one, point) == 0;
}

// Every invariant of one hit; then the wall becomes the changed one.
void expect_sound_hit(State& state, Vec2 impact, const LocalWeb& web) {
  const Pattern& old = state.asset.pattern;
  ASSERT_TRUE(std::ranges::is_sorted(web.removed));
  ASSERT_EQ(web.added.size(), web.is_damaged.size());
  for (const std::uint32_t c : web.removed) EXPECT_TRUE(state.intact[c]);
  for (const Vec2 p : web.new_vertices)
    EXPECT_TRUE(is_float(p.x) && is_float(p.y)) << p.x << " " << p.y;
  const Pattern made = replaced(old, web);
  EXPECT_EQ(check(made), PatternDefects{});
  const auto kept = static_cast<std::uint32_t>(old.cell_count() - web.removed.size());
  std::vector<std::uint32_t> added;
  bool is_hit = false;
  for (std::uint32_t c = kept; c < made.cell_count(); ++c) {
    added.push_back(c);
    std::set<std::uint32_t> corners(made.corners.begin() + made.cell_begin[c],
                                    made.corners.begin() + made.cell_begin[c + 1]);
    EXPECT_EQ(corners.size(), made.cell_begin[c + 1] - made.cell_begin[c]) << "no disc";
    if (web.is_damaged[c - kept]) is_hit |= is_in_cell(made, c, impact);
  }
  EXPECT_TRUE(is_hit) << "the point lies in no damaged cell";
  const double before = sum_of_areas(old, web.removed), after = sum_of_areas(made, added);
  EXPECT_NEAR(after, before, 1e-12 * before);
  const auto edges = state.asset.region.edge_count();
  const auto old_lengths = border_lengths(old, edges), new_lengths = border_lengths(made, edges);
  for (std::uint32_t e = 0; e < edges; ++e) EXPECT_NEAR(new_lengths[e], old_lengths[e], 1e-12);
  std::vector<std::uint8_t> intact, damaged;
  for (std::uint32_t c = 0; c < old.cell_count(); ++c) {
    if (std::ranges::binary_search(web.removed, c)) continue;
    intact.push_back(state.intact[c]);
    damaged.push_back(state.damaged[c]);
  }
  intact.resize(made.cell_count(), 1);
  damaged.insert(damaged.end(), web.is_damaged.begin(), web.is_damaged.end());
  state.intact = std::move(intact);
  state.damaged = std::move(damaged);
  state.asset.pattern = made;
}

SpiderwebParams random_params(std::uint64_t seed, std::uint64_t hit) {
  const auto pick = [&](std::uint64_t draw, std::uint64_t count) {
    return static_cast<std::int64_t>(random_bits(seed, 100 + hit, draw) % count);
  };
  SpiderwebParams params{.impacts = {}};
  params.min_points = 3 + pick(0, 8);
  params.max_points = params.min_points + pick(1, 5);
  params.min_radius = 0.1 + 0.1 * static_cast<double>(pick(2, 4));
  params.max_radius = params.min_radius * (1 + 0.5 * static_cast<double>(pick(3, 4)));
  params.rings = pick(4, 4);
  params.radial = pick(5, 4) * pick(6, 4);
  params.reach = 0.5 * static_cast<double>(pick(7, 5));
  return params;
}

// Damaged cells leave the wall, most of those near the hit, some others.
void break_some(State& state, std::uint64_t seed) {
  for (std::uint32_t c = 0; c < state.asset.pattern.cell_count(); ++c)
    if (state.damaged[c] && random_unit(seed, c) < 0.5) state.intact[c] = 0;
}

void hit_in_a_row(const WallAsset& asset, std::uint64_t seed, std::uint64_t hits) {
  State state(asset);
  const Box box = bounding_box(asset.region.places);
  Vec2 last{random_unit(seed, 1) * box.high.x, random_unit(seed, 2) * box.high.y};
  for (std::uint64_t hit = 0; hit < hits; ++hit) {
    SCOPED_TRACE("seed " + std::to_string(seed) + " hit " + std::to_string(hit));
    Vec2 at{random_unit(seed, hit, 1) * box.high.x, random_unit(seed, hit, 2) * box.high.y};
    if (hit % 3 != 0) at = last + 0.15 * (at - last);
    const auto& vertices = state.asset.pattern.vertices;
    if (hit % 5 == 4) at = vertices[random_bits(seed, hit, 3) % vertices.size()];
    last = at;
    const LocalWeb web = local_web(state.asset, state.intact, at, random_params(seed, hit), seed);
    if (web.removed.empty()) {
      for (std::uint32_t c = 0; c < state.intact.size(); ++c)
        EXPECT_FALSE(state.intact[c] && is_in_cell(state.asset.pattern, c, at));
      continue;
    }
    expect_sound_hit(state, at, web);
    if (::testing::Test::HasFailure()) return;
    break_some(state, random_bits(seed, hit));
  }
}

TEST(LocalWeb, HitsOnACoarseWallKeepItAPartition) {
  for (std::uint64_t seed = 0; seed < 60; ++seed)
    hit_in_a_row(float_wall(plain_wall(), coarse(), seed), seed, 6);
}

TEST(LocalWeb, HitsOnAWallWithOpeningsAndAGableKeepItAPartition) {
  for (std::uint64_t seed = 0; seed < 40; ++seed)
    hit_in_a_row(float_wall(house_wall(), coarse(), seed), seed, 6);
}

TEST(LocalWeb, HitsOnVoronoiCellsKeepThemAPartition) {
  for (std::uint64_t seed = 0; seed < 40; ++seed)
    hit_in_a_row(float_wall(house_wall(), VoronoiGridParams{0.35, 1}, seed), seed, 6);
}

SpiderwebParams one_size(std::int64_t points, double radius, std::int64_t rings) {
  return {.impacts = {},
          .min_points = points,
          .max_points = points,
          .min_radius = radius,
          .max_radius = radius,
          .rings = rings};
}

TEST(LocalWeb, DamageInTheOpenHasAllSectorsAndTheClosedFormArea) {
  const WallAsset wall = float_wall(plain_wall(), VoronoiSitesParams{{{3, 1.5}}}, 1);  // one cell
  for (const std::int64_t n : {3, 5, 12})
    for (std::int64_t rings = 0; rings < 4; ++rings)
      for (std::uint64_t seed = 0; seed < 10; ++seed) {
        SCOPED_TRACE(std::to_string(n) + " " + std::to_string(rings) + " " + std::to_string(seed));
        State state(wall);
        const Vec2 at{3.1, 1.4};
        const LocalWeb web = local_web(wall, state.intact, at, one_size(n, 0.5, rings), seed);
        EXPECT_EQ(std::ranges::count(web.is_damaged, 1), n * (rings + 1));
        expect_sound_hit(state, at, web);
        // The corners lie on a circle: the polygon is the hull of what lies on it.
        std::set<std::uint32_t> on_circle;
        const Pattern& p = state.asset.pattern;
        double sum = 0;
        for (std::uint32_t c = 0; c < p.cell_count(); ++c) {
          if (!state.damaged[c]) continue;
          sum += cell_area(p, c);
          for (std::uint32_t k = p.cell_begin[c]; k < p.cell_begin[c + 1]; ++k)
            if (length(p.vertices[p.corners[k]] - at) > 0.5 - 1e-4) on_circle.insert(p.corners[k]);
        }
        ASSERT_EQ(on_circle.size(), static_cast<std::size_t>(n));
        std::vector<Vec2> corners;
        for (const std::uint32_t v : on_circle) corners.push_back(p.vertices[v]);
        std::ranges::sort(corners, [&](Vec2 a, Vec2 b) {
          const Vec2 u = a - at, v = b - at;
          return (u.y > 0) != (v.y > 0) ? u.y > 0 : cross(u, v) > 0;
        });
        // Long edges of the polygon have vertices between, rounded to float32.
        EXPECT_NEAR(sum, area(corners), n == 12 ? 1e-14 : 3 * 0x1p-23);
      }
}

TEST(LocalWeb, HitsOnBordersCornersAndOpeningsWork) {
  const Vec2 impacts[] = {{0, 0},      {7, 2.5},       {3.4, 4.1}, {0, 1},    {5, 0},
                          {1.9, 1},    {1.9, 2.1},     {1, 0},     {4, 1},    {4.6, 2.1},
                          {1.7, 3.25}, {3.4, 3.6},     {3.8, 3.2}, {1e-9, 1}, {5.5, 1e-6},
                          {3.6, 3.05}, {1, 2.1 - 1e-5}};
  for (const PatternParams& pattern : {coarse(), coarse(2), PatternParams{VoronoiGridParams{}}}) {
    const WallAsset wall = float_wall(house_wall(), pattern, 2);
    int hits = 0;
    for (Vec2 at : impacts)
      for (std::uint64_t seed = 0; seed < 8; ++seed) {
        SCOPED_TRACE(std::to_string(at.x) + " " + std::to_string(at.y) + " seed " +
                     std::to_string(seed));
        State state(wall);
        if (cell_at(wall.pattern, at) == wall.pattern.cell_count()) at = to_float(at);
        const LocalWeb web = local_web(wall, state.intact, at, random_params(seed, 7), seed);
        EXPECT_EQ(web.removed.empty(), cell_at(wall.pattern, at) == wall.pattern.cell_count());
        if (web.removed.empty()) continue;
        ++hits;
        expect_sound_hit(state, at, web);
      }
    EXPECT_GE(hits, 14 * 8);
  }
}

TEST(LocalWeb, HitsOnVerticesAndEdgesOfCellsWork) {
  const WallAsset wall = float_wall(plain_wall(), coarse(), 3);
  const Pattern& p = wall.pattern;
  for (std::uint32_t k = 0; k < p.corners.size(); k += 5) {
    const Vec2 a = p.vertices[p.corners[k]];
    const Vec2 b = p.vertices[p.corners[k + 1 < p.corners.size() ? k + 1 : 0]];
    for (const Vec2 at : {a, 0.5 * (a + b)}) {
      State state(wall);
      const LocalWeb web = local_web(wall, state.intact, at, random_params(k, 3), k);
      SCOPED_TRACE("corner " + std::to_string(k));
      if (!web.removed.empty()) expect_sound_hit(state, at, web);
    }
  }
}

TEST(LocalWeb, APointOutsideOrInAHoleGivesNothing) {
  WallAsset wall = float_wall(house_wall(), coarse(), 1);
  State state(wall);
  for (const Vec2 at : {Vec2{-1e-6, 1}, Vec2{1.5, 1}, Vec2{6, 3.5}, Vec2{1e9, 0}}) {
    const LocalWeb web = local_web(wall, state.intact, at, one_size(7, 0.3, 1), 1);
    EXPECT_TRUE(web.removed.empty() && web.added.empty() && web.new_vertices.empty());
  }
  const Vec2 at{6, 1.1};
  state.intact[cell_at(wall.pattern, at)] = 0;
  EXPECT_TRUE(local_web(wall, state.intact, at, one_size(7, 0.3, 1), 1).removed.empty());
}

TEST(LocalWeb, ARadiusBeyondTheWallDamagesAllOfIt) {
  for (const double radius : {10.0, 1e3, 1e6})
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      SCOPED_TRACE(std::to_string(radius) + " seed " + std::to_string(seed));
      State state(float_wall(house_wall(), coarse(), seed));
      const std::uint32_t count = state.asset.pattern.cell_count();
      const Vec2 at{6, 1.5};
      const LocalWeb web = local_web(state.asset, state.intact, at, one_size(12, radius, 2), seed);
      EXPECT_EQ(web.removed.size(), count);
      EXPECT_EQ(std::ranges::count(web.is_damaged, 0), 0);
      expect_sound_hit(state, at, web);
    }
}

TEST(LocalWeb, TheSameHitGivesTheSameWebWithOrWithoutTheCell) {
  const WallAsset wall = float_wall(house_wall(), coarse(), 5);
  const State state(wall);
  const Vec2 at{5.9, 2.2};
  SpiderwebParams params = one_size(9, 0.4, 2);
  params.radial = 5;
  const LocalWeb a = local_web(wall, state.intact, at, params, 3);
  const LocalWeb other = local_web(wall, state.intact, at, params, 4);
  EXPECT_NE(a.new_vertices, other.new_vertices);
  for (const std::uint32_t start : {~0u, cell_at(wall.pattern, at), 0u}) {
    const LocalWeb b = local_web(wall, state.intact, at, params, 3, start);
    EXPECT_EQ(a.removed, b.removed);
    EXPECT_EQ(a.new_vertices, b.new_vertices);
    EXPECT_EQ(a.is_damaged, b.is_damaged);
    ASSERT_EQ(a.added.size(), b.added.size());
    for (std::size_t i = 0; i < a.added.size(); ++i) EXPECT_EQ(a.added[i].loops, b.added[i].loops);
  }
}

TEST(LocalWeb, AHitMeetsAsManyCellsOnALargeWallAsOnASmallOne) {
  const auto squares = [](double size) {
    return float_wall({rectangle({size, size}), {}}, VoronoiGridParams{0.5, 0}, 1);
  };
  const State small(squares(10)), large(squares(50));
  ASSERT_EQ(small.intact.size(), 400u);
  ASSERT_EQ(large.intact.size(), 10000u);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SpiderwebParams params = one_size(12, 0.6, 3);
    params.radial = 6;
    const Vec2 at{5.1, 4.8};
    const LocalWeb a = local_web(small.asset, small.intact, at, params, seed);
    const LocalWeb b = local_web(large.asset, large.intact, at, params, seed);
    EXPECT_EQ(a.removed.size(), b.removed.size()) << "seed " << seed;
    EXPECT_EQ(a.is_damaged, b.is_damaged) << "seed " << seed;
    EXPECT_EQ(a.new_vertices.size(), b.new_vertices.size()) << "seed " << seed;
  }
}

TEST(LocalWeb, ALaterHitReplacesTheDamageItCovers) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    State state(float_wall(plain_wall(), coarse(), seed));
    const Vec2 at{2.7, 1.6};
    expect_sound_hit(state, at,
                     local_web(state.asset, state.intact, at, one_size(8, 0.3, 2), seed));
    const std::vector<std::uint8_t> damaged = state.damaged;
    const LocalWeb web = local_web(state.asset, state.intact, at, one_size(12, 0.5, 0), seed + 1);
    for (std::uint32_t c = 0; c < damaged.size(); ++c)  // the polygon holds a circle of 0.43 m
      if (damaged[c]) {
        EXPECT_TRUE(std::ranges::binary_search(web.removed, c));
      }
    EXPECT_EQ(std::ranges::count(web.is_damaged, 1), 12);
    expect_sound_hit(state, at, web);
  }
}

TEST(LocalWeb, RadialCracksRunOnAsFarAsTheyReach) {
  const State state(float_wall({rectangle({20, 20}), {}}, coarse(0.5), 1));
  const Vec2 at{10, 10};
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    SpiderwebParams params = one_size(8, 0.4, 1);
    const LocalWeb plain = local_web(state.asset, state.intact, at, params, seed);
    params.radial = 6;
    std::size_t least = plain.removed.size();
    for (const double reach : {1.0, 2.0, 4.0}) {
      params.reach = reach;
      const LocalWeb web = local_web(state.asset, state.intact, at, params, seed);
      EXPECT_GT(web.removed.size(), least) << "reach " << reach << " seed " << seed;
      least = web.removed.size();
      for (const Vec2 p : web.new_vertices) EXPECT_LE(length(p - at), reach + 1.5);
      EXPECT_EQ(std::ranges::count(web.is_damaged, 1), 8 * 2);
    }
  }
}

TEST(LocalWeb, LeftoversAreNoSlivers) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const State state(float_wall(plain_wall(), coarse(), seed));
    const LocalWeb web = local_web(state.asset, state.intact, {3, 1.5}, one_size(10, 0.4, 2), seed);
    const Pattern made = replaced(state.asset.pattern, web);
    for (std::size_t i = 0; i < web.added.size(); ++i) {
      const std::size_t c = made.cell_count() - web.added.size() + i;
      double perimeter = 0;
      const LoopRange loop{made.cell_begin[c], made.cell_begin[c + 1]};
      for (std::uint32_t k = loop.begin; k < loop.end; ++k)
        perimeter +=
            length(made.vertices[made.corners[loop.next(k)]] - made.vertices[made.corners[k]]);
      const double width = 2 * cell_area(made, static_cast<std::uint32_t>(c)) / perimeter;
      EXPECT_GT(width, web.is_damaged[i] ? 0.1 * 0.4 / 30 : 0.05 * 0.4) << "seed " << seed;
    }
  }
}

TEST(LocalWeb, NamesParametersThatCannotBe) {
  const State state(float_wall(plain_wall(), coarse(), 1));
  const auto fails = [&](const SpiderwebParams& params, ErrorCode code) {
    try {
      local_web(state.asset, state.intact, {3, 1}, params, 1);
    } catch (const Error& error) {
      return error.code() == code;
    }
    return false;
  };
  EXPECT_TRUE(fails(one_size(2, 0.3, 1), ErrorCode::input));
  EXPECT_TRUE(fails(one_size(7, 0.3, -1), ErrorCode::input));
  EXPECT_TRUE(fails(one_size(7, 1e-4, 1), ErrorCode::geometry));
}

}  // namespace
}  // namespace sunder
