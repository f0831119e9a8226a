// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/bonds.hpp"

#include <gtest/gtest.h>

#include "fracture/asset.hpp"
#include "fracture/inner_length.hpp"

namespace sunder {
namespace {

WallAsset square_grid(double jitter, std::vector<std::string> anchors, std::uint64_t seed = 1) {
  Wall wall;
  wall.region.outline = rectangle({2, 1});
  wall.pattern = VoronoiGridParams{0.25, jitter};
  wall.thickness = 0.1;
  wall.anchors = std::move(anchors);
  return fracture_wall(wall, 2000, {.seed = seed});
}

TEST(Bonds, ASquareGridHasTheBondsOfAGridGraph) {
  const WallAsset asset = square_grid(0, {"bottom"});
  std::size_t anchors = 0;
  for (const Bond& bond : asset.bonds) {
    EXPECT_NEAR(bond.area, 0.025, 1e-15);
    EXPECT_NEAR(length(bond.normal), 1, 1e-15);
    anchors += bond.b == kWorld;
  }
  EXPECT_EQ(anchors, 8u);
  EXPECT_EQ(asset.bonds.size(), 7u * 4 + 8 * 3 + 8);
  const Bond& anchor = asset.bonds.back();
  EXPECT_NEAR(anchor.normal.y, -1, 1e-15);
  EXPECT_NEAR(anchor.centroid.y, 0, 1e-15);
}

TEST(Bonds, NormalsPointFromAToB) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const WallAsset asset = square_grid(1, {}, seed);
    for (const Bond& bond : asset.bonds) {
      const Vec3 between = asset.chunks[bond.b].centroid - asset.chunks[bond.a].centroid;
      EXPECT_GT(dot(between, bond.normal), 0) << "seed " << seed;
      EXPECT_LT(bond.a, bond.b);
    }
  }
}

TEST(Bonds, TheirAreaIsHalfTheInnerArea) {
  Wall wall;
  wall.region.openings = {rectangle({0.9, 2.1}, {1, 0}), rectangle({1.2, 1}, {3, 1})};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const WallAsset asset = fracture_wall(wall, 2000, {.seed = seed});
    const double inner = inner_length(asset.pattern);
    double bonds = 0;
    for (const Bond& bond : asset.bonds) bonds += bond.area;
    EXPECT_NEAR(bonds, inner / 2 * wall.thickness, 1e-12 * inner) << "seed " << seed;
  }
}

TEST(Bonds, AnchorsOfASideAddUpToItsLength) {
  const WallAsset asset = square_grid(1, {"left", "top"}, 3);
  double left = 0, top = 0;
  for (const Bond& bond : asset.bonds)
    if (bond.b == kWorld) (bond.normal.x < -0.5 ? left : top) += bond.area;
  EXPECT_NEAR(left, 0.1, 1e-15);
  EXPECT_NEAR(top, 0.2, 1e-15);
}

}  // namespace
}  // namespace sunder
