// SPDX-License-Identifier: GPL-3.0-or-later
// Where a solid's local frame is, and what that is worth in float32.
#include <gtest/gtest.h>

#include <cmath>

#include "fracture/measure.hpp"
#include "fracture/solid_shapes.hpp"
#include "fracture/solid_sound.hpp"
#include "meshing/random.hpp"

namespace sunder::test {
namespace {

// Moved in float32, as a model's file has it.
TriMesh moved(TriMesh mesh, Vec3 by) {
  const auto in_file = [](double x) { return static_cast<double>(static_cast<float>(x)); };
  for (Vec3& v : mesh.vertices) v = {in_file(v.x + by.x), in_file(v.y + by.y), in_file(v.z + by.z)};
  return mesh;
}

// Slices that are straight, so that they cross the surface where they like.
SolidAsset sliced(const TriMesh& mesh, std::uint64_t seed) {
  SolidModel model;
  model.position = {3, 4, 5};
  model.rotation = {0.1, 0.3, 0.3, 0.9};  // of length 1
  model.pattern =
      SolidSlicesParams{.slices = {3, 3, 2}, .offset_variation = 0.8, .angle_variation = 0.6};
  return fracture_solid(model, as_surface(mesh), 2400, {.seed = seed});
}

double volume_error_in_float32(const SolidAsset& asset) {
  const SolidMeshes meshes = solid_meshes(asset);
  const Soundness found = measure({{soup_of(asset, meshes)}});
  EXPECT_TRUE(found.is_sound());
  return found.volume_error();
}

TEST(SolidPlace, AModelAtItsOriginKeepsItsFrame) {
  for (const Vec3 by : {Vec3{}, Vec3{0, 1, 0}, Vec3{1, -1, 1}}) {
    const TriMesh mesh = moved(box({-.5, 0, -.5}, {1, 1, 1}), by);
    const SolidAsset asset = sliced(mesh, 1);
    EXPECT_EQ(asset.origin, Vec3{});
    EXPECT_EQ(asset.solid.position, (Vec3{3, 4, 5}));
    EXPECT_EQ(asset.surface.mesh.vertices, mesh.vertices);
  }
}

TEST(SolidPlace, AModelFarFromItsOriginIsDescribedFromItsMiddleAndStaysWhereItIs) {
  const TriMesh mesh = moved(gear(), {40, -25, 30});
  const SolidAsset asset = sliced(mesh, 1);
  EXPECT_LT(length(asset.origin - Vec3{40, -25, 30}), 1);
  const Quaternion turn = asset.solid.rotation;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 local = asset.surface.mesh.vertices[v];
    EXPECT_EQ(local + asset.origin, mesh.vertices[v]);
    EXPECT_EQ(static_cast<double>(static_cast<float>(local.x)), local.x) << "exact in float32";
    EXPECT_LT(length(rotate(turn, local) + asset.solid.position -
                     (rotate(turn, mesh.vertices[v]) + Vec3{3, 4, 5})),
              1e-13);
  }
  Vec3 middle;
  double volume = 0;
  for (const MassProperties& chunk : asset.chunks) {
    middle = middle + chunk.volume * chunk.centroid;
    volume += chunk.volume;
  }
  EXPECT_LT(length((1 / volume) * middle - mass_properties(asset.surface.mesh).centroid), 1e-9);
  for (const Bond& bond : asset.bonds) EXPECT_LT(length(bond.centroid), 2);
  expect_sound(asset, 1e-11);
}

// What the float32 of files costs: as little as for a solid at its origin.
TEST(SolidPlace, ThinSolidsFarAwayKeepTheirVolumeInFloat32) {
  double worst = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const auto draw = [&](std::uint64_t k) { return random_unit(seed, k); };
    const Vec3 size{0.01, 0.1 + draw(0), 1};
    const double away = 20 * std::pow(50, draw(1));
    const SolidAsset asset = sliced(moved(box({0, 0, 0}, size), {away, away, -away}), seed);
    worst = std::max(worst, volume_error_in_float32(asset));
  }
  EXPECT_LT(worst, 1e-7);
}

TEST(SolidPlace, AThinSolidIsMovedAlongItsThicknessAlone) {
  double worst = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const SolidAsset asset = sliced(moved(box({0, 0, 0}, {1, 0.01, 1}), {0.3, 1.37, 0}), seed);
    EXPECT_EQ(asset.origin.x, 0);
    EXPECT_NEAR(asset.origin.y, 1.375, 1e-6);
    EXPECT_EQ(asset.origin.z, 0);
    worst = std::max(worst, volume_error_in_float32(asset));
  }
  EXPECT_LT(worst, 1e-7);
}

TEST(SolidPlace, RoughSolidsFarAwayDoNotCrossInFloat32) {
  SolidModel model;
  model.pattern = SolidVoronoiParams{.count = 12, .points = {}, .sites = {}};
  model.roughness = 0.01;
  const SolidAsset asset = fracture_solid(
      model, as_surface(moved(box({0, 0, 0}, {1, 0.05, 1}), {200, 100, -200})), 2400, {.seed = 4});
  EXPECT_GT(asset.stats.roughness, 0);
  EXPECT_LT(volume_error_in_float32(asset), 1e-6);
}

}  // namespace
}  // namespace sunder::test
