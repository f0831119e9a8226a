// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "fracture/solid_asset.hpp"
#include "fracture/solid_shapes.hpp"

namespace sunder::test {

inline TriMesh chunk_of(const SolidPartition& partition, std::uint32_t chunk) {
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
inline void expect_sound(const SolidAsset& asset, double volume_error = 1e-12) {
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

inline SolidAsset fractured(const TriMesh& mesh, const SolidPatternParams& pattern,
                            std::uint64_t seed = 1, int threads = 1) {
  SolidModel model;
  model.pattern = pattern;
  return fracture_solid(model, as_surface(mesh), 2400,
                        {.seed = seed, .threads = threads, .progress = {}});
}

}  // namespace sunder::test
