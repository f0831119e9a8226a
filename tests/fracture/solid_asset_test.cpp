// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/solid_asset.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "fracture/solid_shapes.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

TriMesh chunk_of(const SolidPartition& partition, std::uint32_t chunk) {
  TriMesh mesh;
  std::map<std::uint32_t, std::uint32_t> local;
  for (std::uint32_t t = partition.chunk_begin[chunk]; t < partition.chunk_begin[chunk + 1]; ++t) {
    auto& triangle = mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = partition.triangles[t].corners[k];
      const auto [it, added] =
          local.try_emplace(v, static_cast<std::uint32_t>(mesh.vertices.size()));
      if (added) mesh.vertices.push_back(partition.vertices[v]);
      triangle[k] = it->second;
    }
  }
  return mesh;
}

// All that is promised of any asset.
void expect_sound(const SolidAsset& asset, double volume_error = 1e-12) {
  const SolidPartition& p = asset.partition;
  double volume = 0;
  std::map<std::array<std::uint32_t, 4>, int> inner;  // sorted corners and face
  double inner_area = 0, bond_area = 0;
  for (std::uint32_t c = 0; c < p.chunk_count(); ++c) {
    const TriMesh mesh = chunk_of(p, c);
    MeshDefects defects = check(mesh);
    EXPECT_EQ(defects.open_edges, 0u) << "chunk " << c;
    EXPECT_EQ(defects.nonmanifold_edges, 0u) << "chunk " << c;
    EXPECT_EQ(defects.degenerate_triangles, 0u) << "chunk " << c;
    EXPECT_FALSE(defects.inside_out) << "chunk " << c << ", " << asset.chunks[c].volume << " m³";
    volume += asset.chunks[c].volume;
    for (std::uint32_t t = p.chunk_begin[c]; t < p.chunk_begin[c + 1]; ++t) {
      const auto& triangle = p.triangles[t];
      if (!triangle.is_inner()) continue;
      const auto& face = p.faces[triangle.face()];
      EXPECT_TRUE(face.a == c || face.b == c);
      auto corners = triangle.corners;
      std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
      if (face.b == c) std::swap(corners[1], corners[2]);
      inner[{corners[0], corners[1], corners[2], triangle.face()}] += face.a == c ? 1 : 2;
      const Vec3 a = p.vertices[corners[0]];
      inner_area += length(cross(p.vertices[corners[1]] - a, p.vertices[corners[2]] - a)) / 2;
    }
  }
  for (const auto& [corners, sides] : inner) EXPECT_EQ(sides, 3);
  for (const Bond& bond : asset.bonds) bond_area += bond.area;
  EXPECT_NEAR(bond_area, inner_area / 2, 1e-12 * (inner_area + 1e-300));
  EXPECT_NEAR(volume, asset.volume_expected, volume_error * asset.volume_expected);
}

SolidAsset fractured(const TriMesh& mesh, const SolidPatternParams& pattern, std::uint64_t seed = 1,
                     int threads = 1) {
  SolidModel model;
  model.pattern = pattern;
  return fracture_solid(model, test::as_surface(mesh), 2400,
                        {.seed = seed, .threads = threads, .progress = {}});
}

SolidAsset voronoi(const TriMesh& mesh, std::int64_t count, std::uint64_t seed = 1) {
  SolidVoronoiParams pattern;
  pattern.count = count;
  return fractured(mesh, pattern, seed);
}

TEST(Solid, VoronoiOfEveryShapeIsSound) {
  for (const test::Shape& shape : test::shapes()) {
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
  for (const test::Shape& shape : test::shapes()) {
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
  for (const test::Shape& shape : test::shapes()) {
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
  for (const test::Shape& shape : test::shapes()) {
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

}  // namespace
}  // namespace sunder
