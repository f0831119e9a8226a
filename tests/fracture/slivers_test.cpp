// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/slivers.hpp"

#include <gtest/gtest.h>

#include "fracture/asset.hpp"

namespace sunder {
namespace {

TEST(Slivers, MergingKeepsThePartitionAndLeavesNoneBelowTheLimit) {
  Wall wall;
  wall.region.openings = {rectangle({0.9, 2.1}, {1, 0}), rectangle({1.2, 1}, {3, 1})};
  wall.min_cell = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Pattern pattern = make_pattern(wall, {.seed = seed}).pattern;
    for (const double size : {0.05, 0.15, 0.3, 0.6}) {
      std::uint64_t merged = 0;
      const Pattern result = merge_slivers(pattern, size * size, &merged);
      EXPECT_EQ(check(result), PatternDefects{}) << "seed " << seed << " size " << size;
      EXPECT_EQ(result.cell_count() + merged, pattern.cell_count());
      EXPECT_NEAR(total_area(result), area(wall.region), 1e-12);
      for (std::uint32_t c = 0; c < result.cell_count(); ++c)
        EXPECT_GE(cell_area(result, c), size * size * (1 - 1e-12));
    }
  }
}

TEST(Slivers, NothingChangesWhenNoCellIsSmall) {
  Wall wall;
  wall.min_cell = 0;
  const Pattern pattern = make_pattern(wall, {}).pattern;
  std::uint64_t merged = 7;
  const Pattern result = merge_slivers(pattern, 1e-9, &merged);
  EXPECT_EQ(merged, 0u);
  EXPECT_EQ(result.corners, pattern.corners);
  EXPECT_EQ(result.vertices, pattern.vertices);
}

TEST(Slivers, EverythingMergesIntoOneCellAtLast) {
  Wall wall;
  wall.region.openings = {rectangle({1, 1}, {2, 1})};
  const Pattern pattern = make_pattern(wall, {}).pattern;
  const Pattern one = merge_slivers(pattern, 1e9);
  ASSERT_EQ(one.cell_count(), 1u);
  EXPECT_EQ(one.hole_begin.size(), 1u);
  EXPECT_NEAR(cell_area(one, 0), 17, 1e-12);
}

TEST(Slivers, ASliverJoinsTheNeighbourWithTheLongestCommonEdge) {
  Wall wall;
  wall.region.outline = rectangle({2.1, 1});
  wall.pattern = VoronoiSitesParams{{{0.5, 0.5}, {1.5, 0.5}, {2.05, 0.25}, {2.05, 0.75}}};
  wall.min_cell = 0;
  const Pattern pattern = make_pattern(wall, {}).pattern;
  ASSERT_EQ(pattern.cell_count(), 4u);
  // The two narrow cells at the right share 0.325 m with each other, 0.5 m with the middle one.
  const Pattern result = merge_slivers(pattern, 0.2);
  EXPECT_EQ(result.cell_count(), 2u);
  EXPECT_NEAR(cell_area(result, 0), 1, 1e-7);
}

}  // namespace
}  // namespace sunder
