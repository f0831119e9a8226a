// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/chunk_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fracture/measure.hpp"

namespace sunder {
namespace {

std::vector<PatternParams> generators() {
  return {VoronoiGridParams{0.3, 1}, VoronoiGridParams{0.3, 0},
          VoronoiRandomParams{150},  VoronoiFocusParams{{{3, 1.5}}, 150, 1, 0.7},
          QuadGridParams{0.3, 1},    SpiderwebParams{.impacts = {{3, 1.5}}}};
}

WallAsset asset_of(const PatternParams& params, std::uint64_t seed, bool openings,
                   double scale = 1) {
  Wall wall;
  wall.pattern = params;
  wall.region.outline = rectangle({6 * scale, 3 * scale});
  if (openings)
    wall.region.openings = {rectangle({0.9, 2.1}, {1, 0}),
                            {{4.6, 1.2}, {5.5, 1.0}, {5.3, 2.4}, {4.9, 1.8}, {4.5, 2.3}}};
  return fracture_wall(wall, 2400, {.seed = seed});
}

TEST(ChunkMesh, EveryChunkIsAClosedSolidOfTheRightVolume) {
  for (const PatternParams& params : generators())
    for (const bool openings : {false, true}) {
      const WallAsset asset = asset_of(params, 3, openings);
      for (std::uint32_t c = 0; c < asset.pattern.cell_count(); ++c) {
        const ChunkMesh chunk = chunk_mesh(asset, c);
        ASSERT_EQ(check(chunk.mesh), MeshDefects{}) << params.index() << " chunk " << c;
        const MassProperties m = mass_properties(chunk.mesh);
        const MassProperties& closed_form = asset.chunks[c];
        const double v = closed_form.volume;
        EXPECT_NEAR(m.volume, v, 1e-12 * v);
        EXPECT_NEAR(m.centroid.x, closed_form.centroid.x, 1e-10);
        EXPECT_NEAR(m.centroid.y, closed_form.centroid.y, 1e-10);
        EXPECT_NEAR(m.inertia.xx, closed_form.inertia.xx, 1e-10 * closed_form.inertia.zz);
        EXPECT_NEAR(m.inertia.yy, closed_form.inertia.yy, 1e-10 * closed_form.inertia.zz);
        EXPECT_NEAR(m.inertia.zz, closed_form.inertia.zz, 1e-10 * closed_form.inertia.zz);
        EXPECT_NEAR(m.inertia.xy, closed_form.inertia.xy, 1e-10 * closed_form.inertia.zz);
      }
    }
}

TEST(ChunkMesh, VolumesAddUpToTheWall) {
  for (const PatternParams& params : generators())
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const WallAsset asset = asset_of(params, seed, true);
      double sum = 0;
      for (const MassProperties& chunk : asset.chunks) sum += chunk.volume;
      EXPECT_NEAR(sum, asset.volume_expected, 1e-13 * asset.volume_expected);
    }
}

TEST(ChunkMesh, ConvexPartsTileTheCell) {
  for (const PatternParams& params : generators()) {
    const WallAsset asset = asset_of(params, 2, true);
    for (std::uint32_t c = 0; c < asset.pattern.cell_count(); ++c) {
      double sum = 0;
      for (const auto& part : convex_parts(asset, c)) {
        Loop loop;
        for (const std::uint32_t v : part) loop.push_back(asset.pattern.vertices[v]);
        EXPECT_GT(area(loop), 0);
        sum += area(loop);
      }
      EXPECT_NEAR(sum, cell_area(asset.pattern, c), 1e-13);
    }
  }
}

TEST(RenderMeshes, AreSoundInFloatForEveryGenerator) {
  for (const PatternParams& params : generators())
    for (const bool openings : {false, true})
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const WallAsset asset = asset_of(params, seed, openings);
        const RenderMeshes meshes = render_meshes(asset);
        const Soundness s = measure({soup_of(asset, meshes)});
        EXPECT_TRUE(s.is_sound()) << params.index() << " seed " << seed << ": open "
                                  << s.open_chunks << " nonmanifold " << s.nonmanifold_chunks
                                  << " unmatched " << s.unmatched_faces << " overlapping "
                                  << s.overlapping_pairs << " volume " << s.volume_error();
      }
}

TEST(RenderMeshes, NormalsAreUnitAndPerpendicularToTheirTriangles) {
  const WallAsset asset = asset_of(VoronoiGridParams{0.3, 1}, 1, true);
  const RenderMeshes meshes = render_meshes(asset);
  const auto vec = [](const RawVector<float>& data, std::size_t v) {
    return Vec3{data[3 * v], data[3 * v + 1], data[3 * v + 2]};
  };
  for (std::uint32_t c = 0; c < meshes.chunk_count(); ++c)
    for (const std::uint32_t list : {meshes.outer[c], meshes.inner[c]}) {
      if (list == RenderMeshes::kNoList) continue;
      for (std::uint32_t i = 0; i < meshes.lists[list].count; i += 3) {
        const std::uint32_t* t = meshes.indices.data() + meshes.lists[list].begin + i;
        const std::size_t base = meshes.vertex_begin[c];
        const Vec3 a = vec(meshes.positions, base + t[0]);
        const Vec3 n =
            cross(vec(meshes.positions, base + t[1]) - a, vec(meshes.positions, base + t[2]) - a);
        for (int corner = 0; corner < 3; ++corner) {
          const Vec3 given = vec(meshes.normals, base + t[corner]);
          EXPECT_NEAR(length(given), 1, 1e-6);
          EXPECT_GT(dot(given, n), 0.999 * length(n));
        }
      }
    }
}

TEST(RenderMeshes, ConvexChunksShareTheirIndexLists) {
  const WallAsset asset = asset_of(VoronoiGridParams{0.1, 1}, 1, false);
  const RenderMeshes meshes = render_meshes(asset);
  EXPECT_GT(meshes.chunk_count(), 1700u);
  EXPECT_LT(meshes.lists.size(), 60u);
}

TEST(RenderMeshes, ThreadsDoNotChangeABit) {
  const WallAsset asset = asset_of(VoronoiGridParams{0.05, 1}, 1, true);
  const RenderMeshes one = render_meshes(asset, 1), three = render_meshes(asset, 3);
  EXPECT_EQ(one.positions, three.positions);
  EXPECT_EQ(one.normals, three.normals);
  EXPECT_EQ(one.uvs, three.uvs);
  EXPECT_EQ(one.indices, three.indices);
}

TEST(RenderMeshes, CellsAtTheLimitOfFloatStaySoundOrAreRefused) {
  // Tiny jitter makes edges far below what float32 resolves: they vanish on both sides.
  Wall wall;
  wall.pattern = VoronoiGridParams{0.3, 1e-5};
  wall.min_cell = 0;
  const WallAsset asset = fracture_wall(wall, 2400, {.seed = 1});
  const RenderMeshes meshes = render_meshes(asset);
  EXPECT_GT(meshes.edges_dropped, 0u);
  EXPECT_TRUE(measure({soup_of(asset, meshes)}).is_sound());
}

TEST(Measure, FindsPlantedFaults) {
  const WallAsset asset = asset_of(VoronoiGridParams{0.5, 1}, 1, false);
  const RenderMeshes meshes = render_meshes(asset);
  const SoupWall good = soup_of(asset, meshes);
  ASSERT_TRUE(measure({good}).is_sound());
  const auto with = [&](auto change) {
    SoupWall wall = good;
    wall.chunk = [&good, change](std::uint32_t c) {
      SoupChunk chunk = good.chunk(c);
      if (c == 20) change(chunk);
      return chunk;
    };
    return measure({wall});
  };
  const Soundness moved = with([](SoupChunk& c) { c.positions[0] += 1e-3f; });
  EXPECT_GT(moved.open_chunks, 0u);
  const Soundness missing = with([](SoupChunk& c) {
    c.triangles.resize(c.triangles.size() - 3);
    c.inner.pop_back();
  });
  EXPECT_EQ(missing.open_chunks, 1u);
  EXPECT_EQ(missing.unmatched_faces, 1u);
  const Soundness flipped = with([](SoupChunk& c) { std::swap(c.triangles[0], c.triangles[1]); });
  EXPECT_EQ(flipped.nonmanifold_chunks, 1u);
  const Soundness shifted = with([](SoupChunk& c) {
    for (std::size_t i = 0; i < c.positions.size(); i += 3) c.positions[i] += 0.01f;
  });
  EXPECT_GT(shifted.overlapping_pairs, 0u);
  const Soundness inverted = with([](SoupChunk& c) {
    for (std::size_t i = 0; i < c.triangles.size(); i += 3)
      std::swap(c.triangles[i], c.triangles[i + 1]);
  });
  EXPECT_EQ(inverted.inverted_chunks, 1u);
  SoupWall fewer = good;
  fewer.chunk_count -= 1;
  EXPECT_GT(measure({fewer}).unmatched_faces, 0u);
  EXPECT_GT(measure({fewer}).volume_error(), 1e-3);
  SoupWall twice = good;
  twice.chunk_count += 1;
  twice.chunk = [&good](std::uint32_t c) { return good.chunk(c % good.chunk_count); };
  EXPECT_GT(measure({twice}).overlapping_pairs, 0u);
}

}  // namespace
}  // namespace sunder
