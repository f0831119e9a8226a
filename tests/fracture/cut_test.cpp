// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/cut.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "fracture/asset.hpp"
#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "meshing/trig.hpp"

namespace sunder {
namespace {

Wall door_and_windows() {
  Wall wall;
  wall.region.openings = {rectangle({0.9, 2.1}, {1, 0}),
                          rectangle({1.2, 1.0}, {3.0, 1.1}),
                          {{4.6, 1.2}, {5.5, 1.0}, {5.3, 2.4}, {4.9, 1.8}, {4.5, 2.3}}};
  return wall;
}

// Every generator of convex cells that openings can cut.
std::vector<PatternParams> grids(double cell) {
  return {VoronoiGridParams{cell, 1.0},
          VoronoiGridParams{cell, 0.5},
          VoronoiGridParams{cell, 0.0},
          QuadGridParams{cell, 0.9},
          QuadGridParams{cell, 0.0},
          VoronoiRandomParams{1 + static_cast<std::int64_t>(18 / (cell * cell))}};
}

Pattern pattern_of(Wall wall, std::uint64_t seed) {
  wall.min_cell = 0;
  return make_pattern(wall, {.seed = seed}).pattern;
}

void expect_partition(const Pattern& pattern, const Region& region, const std::string& what) {
  EXPECT_EQ(check(pattern), PatternDefects{}) << what;
  const double expected = area(region);
  EXPECT_NEAR(total_area(pattern), expected, 1e-13 * expected) << what;
}

TEST(Cut, CellsTileAWallWithDoorAndWindows) {
  for (const double cell : {0.13, 0.3, 0.75, 2.0, 9.0})
    for (const PatternParams& params : grids(cell))
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        Wall wall = door_and_windows();
        wall.pattern = params;
        expect_partition(pattern_of(wall, seed), wall.region,
                         "cell " + std::to_string(cell) + " generator " +
                             std::to_string(params.index()) + " seed " + std::to_string(seed));
      }
}

// A quarter of a metre divides everything: corners on cell corners, edges on cell edges.
TEST(Cut, OpeningsThatFollowTheGridLeaveWholeSquares) {
  for (const PatternParams& params :
       {PatternParams(VoronoiGridParams{0.25, 0}), PatternParams(QuadGridParams{0.25, 0})}) {
    Wall wall;
    wall.pattern = params;
    wall.region.openings = {rectangle({1.0, 2.0}, {1, 0}), rectangle({0.5, 0.75}, {3, 1}),
                            rectangle({0.5, 0.75}, {3.5, 1}), rectangle({1.0, 0.5}, {5, 2.5})};
    const Pattern pattern = pattern_of(wall, 1);
    expect_partition(pattern, wall.region, "aligned");
    EXPECT_EQ(pattern.cell_count(), 24u * 12 - 4 * 8 - 2 * 2 * 3 - 4 * 2);
    for (std::uint32_t c = 0; c < pattern.cell_count(); ++c)
      EXPECT_NEAR(cell_area(pattern, c), 0.0625, 1e-14);
  }
}

TEST(Cut, AnOpeningInsideOneCellIsAHole) {
  Wall wall;
  wall.pattern = VoronoiGridParams{3.0, 0};
  wall.region.openings = {rectangle({0.5, 0.5}, {1, 1}), rectangle({0.25, 0.5}, {2, 1})};
  const Pattern pattern = pattern_of(wall, 1);
  ASSERT_EQ(pattern.cell_count(), 2u);
  EXPECT_EQ(pattern.hole_begin.size(), 2u);
  EXPECT_EQ(loops_of(pattern, 0).size(), 3u);
  expect_partition(pattern, wall.region, "holes");
}

TEST(Cut, AnOpeningThatCutsACellInTwoGivesTwoCellsOfOneOrigin) {
  Wall wall;
  wall.pattern = VoronoiGridParams{3.0, 0};
  wall.region.openings = {rectangle({0.5, 3}, {1, 0})};  // from border to border
  const Pattern pattern = pattern_of(wall, 1);
  ASSERT_EQ(pattern.cell_count(), 3u);
  EXPECT_EQ(pattern.origin, (std::vector<std::uint32_t>{0, 0, 1}));
  expect_partition(pattern, wall.region, "in two");
}

TEST(Cut, OpeningsThatTouchEachOtherAtACornerKeepThePartition) {
  for (const PatternParams& params : grids(0.4)) {
    Wall wall;
    wall.pattern = params;
    wall.region.openings = {rectangle({1, 1}, {1, 1}),
                            rectangle({1, 0.5}, {2, 2}),
                            {{4, 0}, {4.5, 1}, {5, 0}},
                            {{4, 3}, {4.25, 2.5}, {4.5, 3}}};
    expect_partition(pattern_of(wall, 3), wall.region, std::to_string(params.index()));
  }
}

Loop star(Vec2 centre, double outer, double inner, int points, double turn) {
  Loop loop;
  for (int i = 0; i < 2 * points; ++i)
    loop.push_back(centre + (i % 2 ? inner : outer) * unit_at_turns(turn + i / (2.0 * points)));
  return loop;
}

TEST(Cut, StarShapedWallsWithStarShapedOpeningsAreTiled) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const PatternParams& params : grids(0.35)) {
      Wall wall;
      wall.region.outline = star({10, -4}, 3, 1.4, 7, random_unit(seed, 0));
      wall.region.openings = {star({10.3, -4}, 0.9, 0.25, 5, random_unit(seed, 1)),
                              star({9.05, -4}, 0.25, 0.12, 3, random_unit(seed, 2))};
      wall.pattern = params;
      expect_partition(pattern_of(wall, seed), wall.region, "seed " + std::to_string(seed));
    }
}

TEST(Cut, AFarOffsetAndAnExtremeSizeChangeNothing) {
  for (const double size : {1e-3, 1.0, 1e4})
    for (const double offset : {0.0, 1e3, 1e6}) {
      Wall wall;
      const Vec2 at{offset * size, -offset * size};
      wall.region.outline = rectangle({6 * size, 3 * size}, at);
      wall.region.openings = {rectangle({0.9 * size, 2.1 * size}, at + Vec2{size, 0})};
      wall.pattern = VoronoiGridParams{0.3 * size, 1};
      const Pattern pattern = pattern_of(wall, 5);
      EXPECT_EQ(check(pattern), PatternDefects{});
      // The coordinates themselves are only good to offset × 1e-16.
      const double expected = area(wall.region);
      EXPECT_NEAR(total_area(pattern), expected, (1e-13 + 1e-15 * offset) * expected);
    }
}

TEST(Cut, MirroringTheWallMirrorsTheCount) {
  Wall wall = door_and_windows();
  wall.pattern = QuadGridParams{0.25, 0};
  const Pattern pattern = pattern_of(wall, 1);
  for (Loop& opening : wall.region.openings)
    for (Vec2& p : opening) p.x = 6 - p.x;
  const Pattern mirrored = pattern_of(wall, 1);
  EXPECT_EQ(pattern.cell_count(), mirrored.cell_count());
  EXPECT_EQ(pattern.corners.size(), mirrored.corners.size());
}

TEST(Cut, BorderEdgesAddUpToThePerimeter) {
  for (const PatternParams& params : grids(0.3)) {
    Wall wall = door_and_windows();
    wall.pattern = params;
    wall.min_cell = 0;
    const WallPattern made = make_pattern(wall, {.seed = 2});
    std::vector<double> lengths(made.region.edge_count(), 0.0);
    for (std::uint32_t c = 0; c < made.pattern.cell_count(); ++c)
      for (const LoopRange loop : loops_of(made.pattern, c))
        for (std::uint32_t k = loop.begin; k < loop.end; ++k)
          if (made.pattern.across[k].is_border())
            lengths[made.pattern.across[k].border()] +=
                length(made.pattern.vertices[made.pattern.corners[loop.next(k)]] -
                       made.pattern.vertices[made.pattern.corners[k]]);
    for (std::uint32_t f = 0; f < made.region.edge_count(); ++f) {
      const Vec2 from = made.region.places[f], to = made.region.places[made.region.next(f)];
      double expected = length(to - from);
      if (f == 0) expected -= 0.9;  // the door stands on the bottom edge: no border there
      if (f >= 4 && from.y == 0 && to.y == 0) expected = 0;
      EXPECT_NEAR(lengths[f], expected, 1e-12) << "edge " << f;
    }
  }
}

TEST(Cut, WallsThatAreNoPolygonAreRefused) {
  const auto message = [](const Region& region) -> std::string {
    Wall wall;
    wall.region = region;
    try {
      make_pattern(wall, {});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const Loop rect = rectangle({6, 3});
  EXPECT_NE(message({{{0, 0}, {6, 3}, {6, 0}, {0, 3}}, {}}).find("meets itself"),
            std::string::npos);
  EXPECT_NE(message({rect, {rectangle({1, 1}, {5.5, 1})}}).find("outside the outline"),
            std::string::npos);
  EXPECT_NE(message({rect, {rectangle({1, 1}, {1, 1}), rectangle({1, 1}, {1.5, 1.5})}})
                .find("crosses opening"),
            std::string::npos);
  EXPECT_NE(
      message({rect, {rectangle({2, 2}, {0.5, 0.5}), rectangle({1, 1}, {1, 1})}}).find("overlap"),
      std::string::npos);
  EXPECT_NE(message({rect, {rect}}).find("leaves nothing"), std::string::npos);
  EXPECT_NE(message({rect, {rectangle({1, 1}, {1, 1}), rectangle({1, 1}, {1, 1})}}).find("overlap"),
            std::string::npos);
}

}  // namespace
}  // namespace sunder
