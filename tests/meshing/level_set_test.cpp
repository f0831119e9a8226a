// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/level_set.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "meshing/repair_remake.hpp"
#include "meshing/sample_solids.hpp"
#include "meshing/surface_defects.hpp"

namespace {

using namespace sunder;
using std::numbers::pi;

double volume(const TriMesh& mesh) {
  return mass_properties(mesh).volume;
}

TEST(LevelSet, ASphereComesBackWithSecondOrder) {
  const TriMesh sphere = sphere_mesh(1, 32);
  double last = 0;
  for (const double voxel : {0.1, 0.05, 0.025}) {
    const TriMesh made = smooth_surface(level_set(sphere, voxel));
    EXPECT_TRUE(diagnose(made).is_solid()) << diagnose(made).text();
    const double error = std::abs(volume(made) / volume(sphere) - 1);
    if (last > 0) {
      EXPECT_NEAR(std::log2(last / error), 2, 0.25) << voxel;
    }
    EXPECT_LT(farthest(made, TriangleTree(sphere), voxel / 2), 0.1 * voxel);
    last = error;
  }
}

TEST(LevelSet, BothSurfacesOfATorusAreSolidWithOneHole) {
  const TriMesh torus = torus_mesh(1, 0.3, 64, 32);
  const LevelSet set = level_set(torus, 0.04);
  for (const TriMesh& made : {smooth_surface(set), sound_surface(set)}) {
    EXPECT_TRUE(diagnose(made).is_solid()) << diagnose(made).text();
    const auto v = static_cast<long>(made.vertices.size());
    const auto t = static_cast<long>(made.triangles.size());
    EXPECT_EQ(v - t / 2, 0);  // Euler's number of a torus
    EXPECT_NEAR(volume(made), volume(torus), 0.01 * volume(torus));
  }
}

TEST(LevelSet, CavitiesStay) {
  TriMesh shell = sphere_mesh(1, 16);
  append(shell, turned_over(sphere_mesh(0.5, 16)));
  const TriMesh made = smooth_surface(level_set(shell, 0.05));
  EXPECT_NEAR(volume(made), volume(shell), 0.01 * volume(shell));
}

TEST(LevelSet, CrossingBodiesBecomeTheirUnion) {
  TriMesh both = box_mesh({0, 0, 0}, {1, 1, 1});
  append(both, box_mesh({.5, .5, .5}, {1.5, 1.5, 1.5}));
  append(both, box_mesh({.3, .3, .3}, {.6, .6, .6}));  // inside the union
  const TriMesh made = smooth_surface(level_set(both, 0.02));
  EXPECT_TRUE(diagnose(made).is_solid()) << diagnose(made).text();
  EXPECT_NEAR(volume(made), 2 - 0.125, 0.01);
}

TEST(LevelSet, TheSoundSurfaceIsSoundForAnyValues) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    LevelSet set{1, {}, {}};
    for (int i = 0; i < 9; ++i)
      for (int k = 0; k < 9; ++k)
        for (int m = 0; m < 9; ++m) {
          const bool border = i % 8 == 0 || k % 8 == 0 || m % 8 == 0;
          const auto draw =
              static_cast<float>(random_unit(seed, static_cast<std::uint64_t>(81 * i + 9 * k + m)));
          const float value = border ? 1 : 2 * draw - 1;
          set.values.push_back({{i, k, m}, value < 0 ? value - 1e-3f : value + 1e-3f});
        }
    const TriMesh made = sound_surface(set);
    EXPECT_GT(made.triangles.size(), 1000u);
    const auto diagnosis = diagnose(made);
    EXPECT_TRUE(diagnosis.is_solid()) << "seed " << seed << ": " << diagnosis.text();
  }
}

// Of the solid one: shells that enclose, or leave out, hardly anything say nothing about a model.
TEST(LevelSet, SpecksAndBubblesBelowAVoxelGo) {
  const auto ball = [](bool with_noise, float depth) {
    LevelSet set{0.5, {}, {}};
    for (int i = -9; i <= 20; ++i)
      for (int k = -9; k <= 9; ++k)
        for (int m = -9; m <= 9; ++m) {
          auto value = static_cast<float>(std::sqrt(i * i + k * k + m * m) - 6.3);
          if (with_noise && k == 0 && m == 0 && i == 15) value = -depth;
          if (with_noise && k == 0 && m == 0 && i == 0) value = depth;
          if (std::abs(value) < LevelSet::kBand || with_noise)
            set.values.push_back({{i, k, m}, value});
        }
    return set;
  };
  const TriMesh clean = solid_surface(ball(false, 0));
  for (const float depth : {0.001f, 0.1f, 0.5f}) {
    EXPECT_GT(sound_surface(ball(true, depth)).triangles.size(),
              sound_surface(ball(false, 0)).triangles.size());
    const TriMesh made = solid_surface(ball(true, depth));
    EXPECT_TRUE(diagnose(made).is_solid()) << diagnose(made).text();
    EXPECT_EQ(made.triangles.size(), clean.triangles.size());
    EXPECT_NEAR(volume(made), volume(clean), 1e-12);
  }
  // One inside, six neighbours that are far outside: what is all there is stays.
  LevelSet speck = ball(true, 0.001f);
  for (VoxelValue& v : speck.values) v.value = v.at == std::array{15, 0, 0} ? -0.001f : 1;
  EXPECT_GT(volume(solid_surface(speck)), 0);
}

TEST(LevelSet, ThreadsDoNotChangeABit) {
  TriMesh both = sphere_mesh(1, 20);
  append(both, box_mesh({.1, .2, .3}, {1.5, 1.5, 1.5}));
  const LevelSet one = level_set(both, 0.03, 1), many = level_set(both, 0.03, 2);
  ASSERT_EQ(one.values.size(), many.values.size());
  for (std::size_t i = 0; i < one.values.size(); ++i) {
    ASSERT_EQ(one.values[i].at, many.values[i].at);
    ASSERT_EQ(one.values[i].value, many.values[i].value);
  }
  const TriMesh a = smooth_surface(one, 1), b = smooth_surface(many, 2);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(LevelSet, TooManyVoxelsAreRefused) {
  try {
    level_set(unit_cube(), 1e-4);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::geometry);
    EXPECT_NE(std::string(error.what()).find("voxels of 0.0001 m would take about 3.6e+09"),
              std::string::npos)
        << error.what();
  }
}

TEST(LevelSet, ABallTakenOutOfABoxLeavesTheRest) {
  LevelSet set = level_set(unit_cube(), 0.02);
  take_away(set, {{.2, .2, .7}, {.8, .8, 1.3}}, [](Vec3 p) {
    return length(p - Vec3{.5, .5, 1}) - 0.3;
  });
  const TriMesh made = smooth_surface(set);
  EXPECT_TRUE(diagnose(made).is_solid()) << diagnose(made).text();
  EXPECT_NEAR(volume(made), 1 - 2 * pi / 3 * 0.027, 0.005);
}

TEST(TriangleTree, NearestPointsAndWindingNumbersAreThoseOfABox) {
  const TriMesh cube = unit_cube();
  const TriangleTree tree(cube);
  for (std::uint64_t i = 0; i < 500; ++i) {
    const Vec3 p{4 * random_unit(1, i, 0) - 1.5, 4 * random_unit(1, i, 1) - 1.5,
                 4 * random_unit(1, i, 2) - 1.5};
    const Box3 box{{0, 0, 0}, {1, 1, 1}};
    const bool inside = box.distance2(p) == 0;
    const double depth = std::min({p.x, p.y, p.z, 1 - p.x, 1 - p.y, 1 - p.z});
    EXPECT_NEAR(tree.nearest(p).distance, inside ? depth : std::sqrt(box.distance2(p)), 1e-14);
    EXPECT_NEAR(tree.winding_number(p), inside, 0.05);
  }
}

TEST(TriangleTree, TheFarthestPointOfAConcentricCubeIsItsCorner) {
  const TriMesh cube = unit_cube(), larger = box_mesh({-.1, -.1, -.1}, {1.1, 1.1, 1.1});
  EXPECT_NEAR(farthest(larger, TriangleTree(cube), 0.05), 0.1 * std::sqrt(3), 1e-14);
  EXPECT_NEAR(farthest(cube, TriangleTree(larger), 0.05), 0.1, 1e-14);
}

}  // namespace
