// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/tidy.hpp"

#include <gtest/gtest.h>

#include "fracture/asset.hpp"
#include "fracture/measure.hpp"
#include "meshing/error.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

void expect_sound(const Wall& wall, std::uint64_t seed) {
  const WallAsset asset = fracture_wall(wall, 2400, {.seed = seed});
  EXPECT_EQ(check(asset.pattern), PatternDefects{}) << "seed " << seed;
  EXPECT_NEAR(total_area(asset.pattern), area(asset.wall.region), 1e-13 * area(wall.region));
  const RenderMeshes meshes = render_meshes(asset);
  const Soundness s = measure({soup_of(asset, meshes)});
  EXPECT_TRUE(s.is_sound()) << "seed " << seed << ": nonmanifold " << s.nonmanifold_chunks
                            << " overlapping " << s.overlapping_pairs << " unmatched "
                            << s.unmatched_faces;
}

TEST(Tidy, OpeningsThatShareASlantedEdgeAreCutOnce) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Wall wall;  // the second opening lies along the outline's slope, the third along the second
    wall.region.outline = {{0, 0}, {6, 0}, {6, 2}, {3, 4}, {0, 2}};
    wall.region.openings = {{{6, 2}, {3, 4}, {4, 2}}, rectangle({1, 1}, {0.5, 0.5})};
    expect_sound(wall, seed);
  }
}

TEST(Tidy, OpeningsThatShareAPartOfAnEdgeAreCutOnce) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed)
    for (const double min_cell : {-1.0, 0.0}) {
      Wall wall;
      wall.min_cell = min_cell;
      wall.region.openings = {rectangle({1.25, 1}, {1, 1}), rectangle({1, 0.4}, {2.25, 1.2})};
      expect_sound(wall, seed);
    }
}

TEST(Tidy, ACornerThatTouchesTheBorderLeavesManifoldChunks) {
  Wall wall;
  wall.region.outline = rectangle({3, 1.8});
  wall.region.openings = {{{2.4, 0.6}, {2.7, 0.6}, {2.4, 1.8}}};
  wall.pattern = VoronoiGridParams{6, 1};
  expect_sound(wall, 1);
  const WallAsset asset = fracture_wall(wall, 2400, {});
  EXPECT_GT(asset.pattern.cell_count(), 1u);
  for (const std::uint32_t origin : asset.pattern.origin) EXPECT_EQ(origin, 0u);
}

TEST(Tidy, ARingOfOpeningsLeavesAnIsland) {
  Wall wall;
  wall.region.outline = rectangle({3, 3});
  wall.region.openings = {rectangle({0.5, 1}, {0.5, 1}), rectangle({0.5, 1}, {2, 1}),
                          rectangle({1, 0.5}, {1, 0.5}), rectangle({1, 0.5}, {1, 2})};
  wall.pattern = VoronoiGridParams{6, 1};
  expect_sound(wall, 1);
  EXPECT_EQ(fracture_wall(wall, 2400, {}).pattern.cell_count(), 2u);
}

TEST(Tidy, DecimalsThatRoundBeyondTheBorderAreOnIt) {
  Wall wall;
  wall.region.outline = rectangle({0.3, 3});
  wall.region.openings = {rectangle({0.2, 1}, {0.1, 0})};  // 0.1 + 0.2 > 0.3
  wall.pattern = VoronoiGridParams{0.1, 1};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) expect_sound(wall, seed);
}

TEST(Tidy, AVertexAtANeighbouringEdgeIsPutOnIt) {
  // The corner of the opening lies 1e-9 m from the edge between two cells.
  Wall wall;
  wall.region.outline = rectangle({2, 2});
  wall.region.openings = {{{1 + 1e-9, 1}, {1.5, 0.8}, {1.5, 1.2}}};
  wall.pattern = VoronoiSitesParams{{{0.5, 1}, {1.5, 1}}};
  expect_sound(wall, 1);
}

TEST(Tidy, NothingChangesWhereNothingIsNear) {
  Wall wall;
  wall.pattern = VoronoiGridParams{0.3, 1};
  const Pattern pattern = make_pattern(wall, {}).pattern;
  const Pattern same = split_pinches(join_near_vertices(pattern, 1e-9));
  EXPECT_EQ(same.corners, pattern.corners);
  EXPECT_EQ(same.vertices, pattern.vertices);
}

TEST(Tidy, LongEdgesCollapseAndThePartitionStays) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Wall wall;
    wall.min_cell = 0;
    const Pattern pattern = make_pattern(wall, {.seed = seed}).pattern;
    const Pattern result = join_near_vertices(pattern, 0.02);
    EXPECT_EQ(check(result).unpaired_edges, 0u) << "seed " << seed;
    EXPECT_LT(result.vertices.size(), pattern.vertices.size());
    EXPECT_NEAR(total_area(result), 18, 1e-12) << "seed " << seed;
  }
}

}  // namespace
}  // namespace sunder
