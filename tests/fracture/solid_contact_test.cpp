// SPDX-License-Identifier: GPL-3.0-or-later
// Solids that lie on the planes that cut them, and files' numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "fracture/solid_shapes.hpp"
#include "fracture/solid_sound.hpp"
#include "meshing/error.hpp"

namespace sunder::test {
namespace {

SolidVoronoiParams grid_of_sites(int n, double size) {
  SolidVoronoiParams pattern;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        pattern.sites.push_back((size / n) * Vec3{i + 0.5, j + 0.5, k + 0.5});
  return pattern;
}

// A cube whose faces are n × n squares.
TriMesh meshed_cube(int n) {
  std::map<std::array<int, 3>, std::uint32_t> known;
  TriMesh mesh;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [it, added] = known.try_emplace(p, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (added) mesh.vertices.push_back({1.0 * p[0] / n, 1.0 * p[1] / n, 1.0 * p[2] / n});
    return it->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int u, int v) {
            std::array<int, 3> p{};
            p[axis] = side;
            p[(axis + 1) % 3] = i + (side ? u : v);
            p[(axis + 2) % 3] = j + (side ? v : u);
            return vertex(p);
          };
          mesh.triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
          mesh.triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
        }
  return mesh;
}

TEST(SolidContact, RegularSitesCutACubeIntoCubes) {
  const SolidAsset asset = fractured(box({0, 0, 0}, {1, 1, 1}), grid_of_sites(4, 1));
  expect_sound(asset);
  ASSERT_EQ(asset.partition.chunk_count(), 64u);
  EXPECT_EQ(asset.bonds.size(), 3u * 4 * 4 * 3);
  for (const auto& chunk : asset.chunks) EXPECT_NEAR(chunk.volume, 1.0 / 64, 1e-8);
  for (const Bond& bond : asset.bonds) EXPECT_NEAR(bond.area, 1.0 / 16, 1e-8);
}

TEST(SolidContact, PlanesThroughRowsOfEdgesAreSound) {
  const TriMesh cube = meshed_cube(8);
  ASSERT_EQ(check(cube), MeshDefects{});
  expect_sound(fractured(cube, grid_of_sites(4, 1)));
  expect_sound(fractured(cube, SolidSlicesParams{}));
  SolidBrickParams bricks;
  bricks.brick = {0.25, 0.125, 0.25};
  expect_sound(fractured(cube, bricks));
}

TEST(SolidContact, ASliceInTheStepOfAnLLeavesNoSkin) {
  SolidSlicesParams slices;
  slices.slices = {1, 1, 0};
  const SolidAsset asset = fractured(l_shape(), slices);
  expect_sound(asset);
  ASSERT_EQ(asset.partition.chunk_count(), 3u);
  ASSERT_EQ(asset.bonds.size(), 2u);
  for (const auto& chunk : asset.chunks) EXPECT_NEAR(chunk.volume, 1, 1e-7);
  for (const Bond& bond : asset.bonds) EXPECT_NEAR(bond.area, 1, 1e-7);
}

TEST(SolidContact, BricksOfAWallAreWholeAndHalfBricks) {
  SolidBrickParams bricks;
  bricks.brick = {0.25, 0.1, 0.2};
  const SolidAsset asset = fractured(box({0, 0, 0}, {1, 0.5, 0.2}), bricks);
  expect_sound(asset);
  EXPECT_EQ(asset.partition.chunk_count(), 3u * 4 + 2 * 5);
  int whole = 0, half = 0;
  for (const auto& chunk : asset.chunks) {
    whole += std::abs(chunk.volume - 0.005) < 1e-9;
    half += std::abs(chunk.volume - 0.0025) < 1e-9;
  }
  EXPECT_EQ(whole, 18);
  EXPECT_EQ(half, 4);
}

TEST(SolidContact, MortarIsAJointPerBrick) {
  SolidBrickParams bricks;
  bricks.brick = {0.24, 0.09, 0.2};
  bricks.mortar = 0.01;
  const SolidAsset asset = fractured(box({0, 0, 0}, {0.99, 0.19, 0.2}), bricks);
  expect_sound(asset);
  double brick = 0;
  int bricks_found = 0;
  for (const auto& chunk : asset.chunks)
    if (std::abs(chunk.volume - 0.24 * 0.09 * 0.2) < 1e-9) brick += chunk.volume, ++bricks_found;
  EXPECT_EQ(bricks_found, 4 + 3);
}

TEST(SolidContact, IslandsOfACellAreChunks) {
  // Two boxes, one cell.
  const SolidAsset asset = fractured(two_shells(), grid_of_sites(1, 1));
  expect_sound(asset);
  EXPECT_EQ(asset.partition.chunk_count(), 2u);
  EXPECT_EQ(asset.stats.islands_split, 1u);
  EXPECT_TRUE(asset.bonds.empty());
}

TEST(SolidContact, ACavityBelongsToTheChunkAroundIt) {
  const SolidAsset asset = fractured(nested_cavity(), grid_of_sites(1, 2));
  expect_sound(asset);
  ASSERT_EQ(asset.partition.chunk_count(), 2u);
  const double ball = mass_properties(sphere({1, 1, 1}, 0.7, 10)).volume;
  EXPECT_NEAR(asset.chunks[0].volume, 8 - ball, 1e-12);
}

TEST(SolidContact, SizesAndPlacesFarFromTheOriginAreSound) {
  for (const double scale : {1e-3, 1.0, 1e3})
    for (const Vec3 offset : {Vec3{}, Vec3{1e5, -3e4, 7e4}}) {
      SCOPED_TRACE(scale);
      TriMesh mesh = gear();
      for (Vec3& v : mesh.vertices) v = scale * (v + offset);
      SolidVoronoiParams pattern;
      pattern.count = 40;
      expect_sound(fractured(mesh, pattern), offset == Vec3{} ? 1e-12 : 1e-9);
    }
}

TEST(SolidContact, WhatIsNoSolidIsRefusedWithAPlace) {
  TriMesh open = box({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  TriMesh inverted;
  append(inverted, box({0, 0, 0}, {1, 1, 1}), true);
  TriMesh crossing = box({0, 0, 0}, {1, 1, 1});
  append(crossing, box({0.5, 0.5, 0.5}, {1, 1, 1}));
  for (const TriMesh& mesh : {open, inverted, crossing}) {
    try {
      fractured(mesh, grid_of_sites(4, 1.5));
      FAIL() << "it was taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::geometry) << error.what();
    }
  }
}

TEST(SolidContact, ThreadsDoNotChangeABit) {
  const TriMesh mesh = sphere({0, 0, 0}, 1, 40);
  SolidVoronoiParams pattern;
  pattern.count = 600;
  const SolidAsset one = fractured(mesh, pattern, 5, 1), three = fractured(mesh, pattern, 5, 3);
  EXPECT_EQ(one.partition.vertices, three.partition.vertices);
  EXPECT_EQ(one.partition.chunk_begin, three.partition.chunk_begin);
  ASSERT_EQ(one.partition.triangles.size(), three.partition.triangles.size());
  for (std::size_t t = 0; t < one.partition.triangles.size(); ++t)
    ASSERT_EQ(one.partition.triangles[t].corners, three.partition.triangles[t].corners);
  const SolidMeshes a = solid_meshes(one, 1), b = solid_meshes(three, 3);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.indices, b.indices);
}

TEST(SolidContact, ScaledByTwoIsTheSameTwiceAsLarge) {
  TriMesh mesh = gear();
  SolidVoronoiParams pattern;
  pattern.count = 50;
  const SolidAsset one = fractured(mesh, pattern);
  for (Vec3& v : mesh.vertices) v = 2.0 * v;
  const SolidAsset two = fractured(mesh, pattern);
  ASSERT_EQ(one.partition.vertices.size(), two.partition.vertices.size());
  for (std::size_t v = 0; v < one.partition.vertices.size(); ++v)
    ASSERT_EQ(2.0 * one.partition.vertices[v], two.partition.vertices[v]);
}

// Every chunk of the float mesh is closed when vertices of equal bits are one.
TEST(SolidMesh, FloatChunksStayClosed) {
  for (const Shape& shape : shapes())
    for (const double far : {0.0, 1e4}) {
      SCOPED_TRACE(testing::Message() << shape.name << " at " << far);
      TriMesh mesh = shape.mesh;
      for (Vec3& v : mesh.vertices) v = v + Vec3{far, far, far};
      SolidVoronoiParams pattern;
      pattern.count = 30;
      const SolidMeshes meshes = solid_meshes(fractured(mesh, pattern));
      for (std::size_t c = 0; c + 1 < meshes.vertex_begin.size(); ++c) {
        std::map<std::array<std::array<float, 3>, 2>, int> edges;
        for (std::uint32_t p = meshes.part_begin[c]; p < meshes.part_begin[c + 1]; ++p)
          for (std::uint32_t i = 0; i < meshes.parts[p].count; i += 3) {
            std::array<std::array<float, 3>, 3> at;
            for (std::uint32_t k = 0; k < 3; ++k) {
              const std::size_t v =
                  meshes.vertex_begin[c] + meshes.indices[meshes.parts[p].begin + i + k];
              std::copy_n(meshes.positions.begin() + static_cast<std::ptrdiff_t>(3 * v), 3,
                          at[k].begin());
            }
            for (std::size_t k = 0; k < 3; ++k) {
              ++edges[{at[k], at[(k + 1) % 3]}];
              --edges[{at[(k + 1) % 3], at[k]}];
            }
          }
        for (const auto& [edge, count] : edges) ASSERT_EQ(count, 0) << "chunk " << c;
      }
    }
}

TEST(SolidMesh, OuterFacesKeepWhatTheyCarry) {
  ModelSurface surface = as_surface(box({0, 0, 0}, {1, 1, 1}));
  surface.has_uvs = surface.has_colours = true;
  surface.materials.resize(2);
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
    surface.material[t] = t % 2;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 at = surface.mesh.vertices[surface.mesh.triangles[t][k]];
      Corner& corner = surface.corners[3 * t + k];
      corner.uv = {static_cast<float>(at.x + 2 * at.y), static_cast<float>(at.z)};
      corner.colour = {static_cast<float>(at.x), 0.5f, static_cast<float>(at.y), 1};
    }
  }
  SolidModel model;
  SolidVoronoiParams pattern;
  pattern.count = 20;
  model.pattern = pattern;
  const SolidAsset asset = fracture_solid(model, surface, 2400, {});
  const SolidMeshes meshes = solid_meshes(asset);
  std::array<double, 2> area{};
  for (std::size_t c = 0; c + 1 < meshes.vertex_begin.size(); ++c)
    for (std::uint32_t p = meshes.part_begin[c]; p < meshes.part_begin[c + 1]; ++p) {
      const auto& part = meshes.parts[p];
      std::array<Vec3, 3> at;
      for (std::uint32_t i = 0; i < part.count; ++i) {
        const std::size_t v = meshes.vertex_begin[c] + meshes.indices[part.begin + i];
        const Vec3 x{meshes.positions[3 * v], meshes.positions[3 * v + 1],
                     meshes.positions[3 * v + 2]};
        at[i % 3] = x;
        if (part.material == SolidMeshes::kInnerMaterial) continue;
        EXPECT_NEAR(meshes.uvs[2 * v], x.x + 2 * x.y, 1e-6);
        EXPECT_NEAR(meshes.uvs[2 * v + 1], x.z, 1e-6);
        EXPECT_NEAR(meshes.colours[4 * v], x.x, 1e-6);
        EXPECT_NEAR(meshes.colours[4 * v + 2], x.y, 1e-6);
        if (i % 3 == 2) area[part.material] += length(cross(at[1] - at[0], at[2] - at[0])) / 2;
      }
    }
  EXPECT_NEAR(area[0], 3, 1e-5);
  EXPECT_NEAR(area[1], 3, 1e-5);
}

}  // namespace
}  // namespace sunder::test
