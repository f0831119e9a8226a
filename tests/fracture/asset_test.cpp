// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/asset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fracture/chunk_mesh.hpp"
#include "fracture/inner_length.hpp"
#include "fracture/measure.hpp"
#include "meshing/error.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

// Everything a fractured wall promises, in memory and in the float32 meshes that files hold.
void expect_sound(const Wall& wall, std::uint64_t seed, const std::string& what) {
  const WallAsset asset = fracture_wall(wall, 2400, {.seed = seed});
  const double expected = asset.volume_expected;
  double sum = 0, smallest = std::numeric_limits<double>::infinity(), bonds = 0;
  for (const MassProperties& chunk : asset.chunks) {
    sum += chunk.volume;
    smallest = std::min(smallest, chunk.volume);
  }
  EXPECT_EQ(check(asset.pattern), PatternDefects{}) << what;
  EXPECT_NEAR(sum, expected, 1e-13 * expected) << what;
  EXPECT_GT(smallest, 0) << what;
  for (const Bond& bond : asset.bonds) bonds += bond.area;
  const double inner = inner_length(asset.pattern) * asset.wall.thickness;
  EXPECT_NEAR(bonds, inner / 2, 1e-12 * inner) << what;
  const RenderMeshes meshes = render_meshes(asset);
  const Soundness s = measure({soup_of(asset, meshes)});
  EXPECT_TRUE(s.is_sound()) << what << ": open " << s.open_chunks << " nonmanifold "
                            << s.nonmanifold_chunks << " inverted " << s.inverted_chunks
                            << " unmatched " << s.unmatched_faces << " overlapping "
                            << s.overlapping_pairs << " volume " << s.volume_error();
}

template <std::size_t size>
double pick(const double (&values)[size], std::uint64_t seed, std::uint64_t draw) {
  return values[random_bits(seed, draw) % size];
}

constexpr double kSizes[] = {1e-3, 0.05, 1, 6, 300, 1e4};
constexpr double kOffsets[] = {0, -1, 1e3, 1e6};  // in the size of the wall, and metres below
constexpr double kThickness[] = {1e-4, 1e-2, 0.1, 1};

// A thousand seeds per jitter; size, offset, thickness, shape and openings follow from the seed.
class AssetOverSeeds : public testing::TestWithParam<double> {};

TEST_P(AssetOverSeeds, EveryWallIsSound) {
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const double size = pick(kSizes, seed, 1);
    const Vec2 at = pick(kOffsets, seed, 2) * Vec2{1, -0.7};
    Wall wall;
    const double height = size * (0.3 + random_unit(seed, 3));
    wall.region.outline = rectangle({size, height}, size > 0.5 ? at : Vec2{});
    wall.thickness = size * pick(kThickness, seed, 4);
    wall.position = {at.x, at.y, 0};
    const double cell = size / (3 + 5 * random_unit(seed, 5));
    if (seed % 3 == 0)
      wall.pattern = QuadGridParams{cell, GetParam()};
    else
      wall.pattern = VoronoiGridParams{cell, GetParam()};
    if (seed % 2 == 0)
      wall.region.openings = {
          rectangle({0.31 * size, 0.2 * size}, wall.region.outline[0] + Vec2{0.25 * size, 0})};
    expect_sound(wall, seed, "seed " + std::to_string(seed));
  }
}
INSTANTIATE_TEST_SUITE_P(Jitters, AssetOverSeeds, testing::Values(0, 0.3, 0.66, 0.9, 1));

TEST(Asset, OtherGeneratorsAreSoundOverSeeds) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Wall wall;
    wall.region.openings = {rectangle({0.9, 2.1}, {1, 0})};
    const Vec2 hit{2.2 + 3.5 * random_unit(seed, 1), 0.1 + 2.8 * random_unit(seed, 2)};
    for (const PatternParams& params :
         {PatternParams(VoronoiRandomParams{60}),
          PatternParams(VoronoiFocusParams{{hit}, 80, 1, 0.8}),
          PatternParams(SpiderwebParams{.impacts = {hit}}),
          PatternParams(SpiderwebParams{.impacts = {hit, {4, 1.5}}, .radial = 9})}) {
      wall.pattern = params;
      expect_sound(wall, seed,
                   "seed " + std::to_string(seed) + " generator " + std::to_string(params.index()));
    }
  }
}

// The block of four sites for which a search two cells wide is wrong, side by side and as one.
TEST(Asset, ThePapersAdversarialBlockIsSound) {
  for (int blocks = 1; blocks <= 12; ++blocks) {
    VoronoiSitesParams sites;
    for (int b = 0; b < blocks; ++b)
      for (const Vec2 p : {Vec2{0.9, 0.1}, {1.1, 0.9}, {2.9, 0.9}, {3.1, 0.1}})
        sites.sites.push_back({4 * b + p.x, p.y});
    Wall wall;
    wall.region.outline = rectangle({4.0 * blocks, 1});
    wall.pattern = sites;
    expect_sound(wall, 1, std::to_string(blocks) + " blocks");
  }
}

TEST(Asset, RepeatedAndCocircularSitesAreSound) {
  VoronoiSitesParams sites;
  for (int i = 0; i < 8; ++i)  // a circle of lattice directions, exactly cocircular
    for (const Vec2 d : {Vec2{3, 4},
                         {4, 3},
                         {5, 0},
                         {0, 5},
                         {-3, 4},
                         {-4, 3},
                         {-5, 0},
                         {0, -5},
                         {3, -4},
                         {4, -3},
                         {-3, -4},
                         {-4, -3}})
      sites.sites.push_back(Vec2{3, 1.5} + 0.125 * (1 + i) * d);
  std::erase_if(sites.sites, [](Vec2 p) { return p.x < 0 || p.x > 6 || p.y < 0 || p.y > 3; });
  const std::size_t distinct = sites.sites.size();
  for (std::size_t i = 0; i < distinct; i += 3) sites.sites.push_back(sites.sites[i]);
  Wall wall;
  wall.pattern = sites;
  wall.min_cell = 0;
  expect_sound(wall, 1, "cocircular");
  const WallAsset asset = fracture_wall(wall, 2400, {});
  EXPECT_EQ(asset.pattern.cell_count() + asset.stats.sites_repeated, sites.sites.size());
}

TEST(Asset, APatternDependsOnTheWallsNameNotOnOtherWalls) {
  Wall a, b;
  a.name = "a", b.name = "b";
  EXPECT_NE(make_pattern(a, {.seed = 1}).pattern.vertices,
            make_pattern(b, {.seed = 1}).pattern.vertices);
  EXPECT_EQ(make_pattern(a, {.seed = 1}).pattern.vertices,
            make_pattern(a, {.seed = 1, .threads = 3}).pattern.vertices);
}

TEST(Asset, MovingTheOutlineMovesTheWallAndNothingElse) {
  Wall wall;
  wall.region.openings = {rectangle({1, 1}, {2, 1})};
  const WallAsset here = fracture_wall(wall, 2400, {});
  const Vec2 far{1 << 20, -(1 << 18)};
  for (Vec2& p : wall.region.outline) p = p + far;
  for (Vec2& p : wall.region.openings[0]) p = p + far;
  const WallAsset there = fracture_wall(wall, 2400, {});
  EXPECT_EQ(here.pattern.vertices, there.pattern.vertices);
  EXPECT_EQ(there.wall.position, (Vec3{far.x, far.y, 0}));
}

TEST(Asset, ChunkNamesHaveAsManyDigitsAsTheLastNeeds) {
  Wall wall;
  EXPECT_EQ(fracture_wall(wall, 2400, {}).chunk_name(7), "wall_chunk_0007");
  wall.pattern = VoronoiGridParams{0.04, 1};
  EXPECT_EQ(fracture_wall(wall, 2400, {}).chunk_name(7), "wall_chunk_00007");
}

TEST(Asset, AnImpactOutsideTheWallIsRefused) {
  Wall wall;
  wall.pattern = SpiderwebParams{.impacts = {{7, 1}}};
  EXPECT_THROW(fracture_wall(wall, 2400, {}), Error);
}

}  // namespace
}  // namespace sunder
