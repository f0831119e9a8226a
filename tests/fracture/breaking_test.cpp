// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/breaking.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fracture/asset.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

std::vector<PatternParams> generators() {
  return {VoronoiGridParams{0.2, 1}, VoronoiGridParams{0.2, 0}, QuadGridParams{0.2, 0.9},
          VoronoiRandomParams{300}, SpiderwebParams{.impacts = {{3, 1.5}, {5, 0.5}}}};
}

WallPattern pattern_of(const PatternParams& params, std::uint64_t seed) {
  Wall wall;
  wall.pattern = params;
  wall.region.openings = {rectangle({0.9, 2.1}, {1, 0})};
  return make_pattern(wall, {.seed = seed});
}

TEST(Breaking, HitAfterHitEqualsAFullRebuild) {
  for (const PatternParams& params : generators())
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Pattern pattern = pattern_of(params, seed).pattern;
      BreakableWall wall(pattern);
      for (std::uint64_t hit = 0; hit < 30; ++hit) {
        std::vector<std::uint8_t> before(wall.shown().begin(), wall.shown().end());
        std::vector<std::uint32_t> cells;
        for (std::uint64_t i = 0; i < 1 + hit % 7; ++i)
          cells.push_back(
              static_cast<std::uint32_t>(random_bits(seed, hit, i) % pattern.cell_count()));
        const BreakableWall::Change change = wall.break_cells(cells);
        const auto full = shown_faces(pattern, wall.intact());
        ASSERT_TRUE(std::ranges::equal(full, wall.shown())) << "seed " << seed << " hit " << hit;
        // The change is the difference, no more and no less.
        for (const std::uint32_t k : change.shown) before[k] ^= 1;
        for (const std::uint32_t k : change.hidden) before[k] ^= 1;
        ASSERT_EQ(before, full);
      }
    }
}

TEST(Breaking, AHitTouchesOnlyTheCellAndItsNeighbours) {
  const Pattern pattern = pattern_of(VoronoiGridParams{0.1, 1}, 1).pattern;
  BreakableWall wall(pattern);
  const std::uint32_t cell = cell_at(pattern, {4, 1.5});
  const BreakableWall::Change change = wall.break_cells(std::vector{cell});
  EXPECT_EQ(change.cells_touched, 1u + pattern.cell_begin[cell + 1] - pattern.cell_begin[cell]);
  EXPECT_EQ(change.shown.size(), change.cells_touched - 1);
  EXPECT_TRUE(wall.break_cells(std::vector{cell}).broken.empty());
}

TEST(Breaking, BreakingEverythingShowsNothing) {
  const Pattern pattern = pattern_of(QuadGridParams{}, 2).pattern;
  BreakableWall wall(pattern);
  for (std::uint32_t c = 0; c < pattern.cell_count(); ++c) wall.break_cells(std::vector{c});
  EXPECT_EQ(std::ranges::count(wall.shown(), 1), 0);
  EXPECT_EQ(std::ranges::count(wall.intact(), 1), 0);
}

TEST(Breaking, TheCellAtAPointContainsIt) {
  const WallPattern made = pattern_of(VoronoiGridParams{0.2, 1}, 4);
  for (std::uint32_t c = 0; c < made.pattern.cell_count(); ++c) {
    Vec2 centre;
    const std::uint32_t begin = made.pattern.cell_begin[c], end = made.pattern.cell_begin[c + 1];
    if (!is_strictly_convex(made.pattern, c)) continue;
    for (std::uint32_t k = begin; k < end; ++k)
      centre = centre + made.pattern.vertices[made.pattern.corners[k]];
    EXPECT_EQ(cell_at(made.pattern, (1.0 / (end - begin)) * centre), c);
  }
  EXPECT_EQ(cell_at(made.pattern, {1.4, 1}), made.pattern.cell_count()) << "inside the door";
}

TEST(Breaking, CellsNearADiscAreThoseThatMeetIt) {
  const Pattern pattern = pattern_of(VoronoiGridParams{0.25, 0}, 1).pattern;
  const Vec2 hit{4.125, 1.125};
  const std::uint32_t start = cell_at(pattern, hit);
  EXPECT_EQ(cells_near(pattern, start, hit, 0.1).size(), 1u);
  EXPECT_EQ(cells_near(pattern, start, hit, 0.13).size(), 5u);
  EXPECT_EQ(cells_near(pattern, start, hit, 0.2).size(), 9u);
}

}  // namespace
}  // namespace sunder
