// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/solid_asset.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fracture/solid_shapes.hpp"
#include "fracture/solid_sound.hpp"

namespace sunder::test {
namespace {

SolidAsset voronoi(const TriMesh& mesh, std::int64_t count, std::uint64_t seed = 1) {
  SolidVoronoiParams pattern;
  pattern.count = count;
  return fractured(mesh, pattern, seed);
}

TEST(Solid, VoronoiOfEveryShapeIsSound) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    ASSERT_EQ(check(shape.mesh), MeshDefects{});
    for (const std::uint64_t seed : {1, 2, 3})
      for (const std::int64_t count : {1, 2, 10, 60}) {
        SCOPED_TRACE(testing::Message() << count << " cells, seed " << seed);
        expect_sound(voronoi(shape.mesh, count, seed));
      }
  }
}

TEST(Solid, SlicesOfEveryShapeAreSound) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    for (const double turn : {0.0, 0.2}) {
      SCOPED_TRACE(turn);
      SolidSlicesParams slices;
      slices.angle_variation = turn;
      slices.offset_variation = turn;
      expect_sound(fractured(shape.mesh, slices));
      slices.slices = {7, 0, 5};
      expect_sound(fractured(shape.mesh, slices, 2));
    }
  }
}

TEST(Solid, RadialCracksOfEveryShapeAreSound) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    SolidRadialParams radial;
    for (const double variability : {0.0, 0.5}) {
      radial.variability = variability;
      radial.radius = 0.6;
      expect_sound(fractured(shape.mesh, radial));
      radial.axis = {1, 2, 3};
      radial.centre = {0.3, 0.2, 0.1};
      expect_sound(fractured(shape.mesh, radial));
    }
  }
}

TEST(Solid, BricksOfEveryShapeAreSound) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    for (const double mortar : {0.0, 0.02}) {
      SCOPED_TRACE(mortar);
      SolidBrickParams bricks;
      bricks.brick = {0.5, 0.25, 0.25};
      bricks.mortar = mortar;
      expect_sound(fractured(shape.mesh, bricks));
    }
  }
}

TEST(Solid, RoughFacesAreSoundAndMatch) {
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    SolidModel model;
    SolidVoronoiParams pattern;
    pattern.count = 6;
    model.pattern = pattern;
    model.roughness = 0.01;
    model.roughness_size = std::string_view(shape.name) == "vase" ? 0.05 : 0.4;
    const SolidAsset asset = fracture_solid(model, as_surface(shape.mesh), 2400, {});
    expect_sound(asset);
    EXPECT_GT(asset.stats.roughness, 0.004);
  }
}

TEST(Solid, WavySlicesAreSoundAndTouchTheirAmplitude) {
  SolidModel model;
  SolidSlicesParams slices;
  slices.slices = {0, 1, 0};
  slices.amplitude = 0.1;
  slices.wavelength = 0.5;
  model.pattern = slices;
  const SolidAsset asset = fracture_solid(model, as_surface(box({0, 0, 0}, {1, 1, 1})), 2400, {});
  expect_sound(asset);
  ASSERT_EQ(asset.partition.chunk_count(), 2u);
  double low = 1, high = 0;
  for (const auto& t : asset.partition.triangles)
    if (t.is_inner())
      for (const std::uint32_t v : t.corners) {
        low = std::min(low, asset.partition.vertices[v].y);
        high = std::max(high, asset.partition.vertices[v].y);
      }
  EXPECT_NEAR(high - low, 0.2, 0.02);
}

}  // namespace
}  // namespace sunder::test
