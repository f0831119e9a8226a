// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "fracture/measure.hpp"
#include "io/export.hpp"
#include "io/glb.hpp"
#include "io/import.hpp"
#include "io/sample_asset.hpp"
#include "io/sample_solid.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

// A scene of walls and solids, kept together with what refers to it.
struct Sample {
  Asset walls;
  std::vector<SolidAsset> solids;
  MeshedAsset meshed() const { return mesh_asset(walls, 1, solids); }
};

Sample only_solid() {
  Sample sample;
  sample.solids.push_back(sample_solid());
  return sample;
}

Soundness measured(const MeshedAsset& meshed) {
  std::vector<SoupWall> soups;
  for (std::size_t i = 0; i < meshed.meshes.size(); ++i)
    soups.push_back(soup_of(meshed.asset.walls[i], meshed.meshes[i]));
  for (std::size_t i = 0; i < meshed.solids.size(); ++i)
    soups.push_back(soup_of(meshed.solids[i], meshed.solid_meshes[i]));
  return measure(soups);
}

Soundness measured(const ImportedAsset& asset) {
  std::vector<SoupWall> soups;
  for (const ImportedWall& wall : asset.walls) soups.push_back(soup_of(asset, wall));
  return measure(soups);
}

TEST(SolidExport, EveryFormatIsAsSoundAsTheMeshes) {
  const Sample sample = only_solid();
  const MeshedAsset meshed = sample.meshed();
  const Soundness expected = measured(meshed);
  EXPECT_TRUE(expected.is_sound());
  EXPECT_GE(expected.chunks, 12u);
  EXPECT_LT(expected.volume_error(), 1e-6);
  const TestFolder folder;
  for (const char* name : {"a.glb", "a.gltf", "a.obj", "a.stl", "a.ply"}) {
    SCOPED_TRACE(name);
    export_asset(meshed, folder / name);
    const ImportedAsset read = import_asset(folder / name);
    const Soundness found = measured(read);
    EXPECT_TRUE(found.is_sound());
    EXPECT_EQ(found.triangles, expected.triangles);
    EXPECT_NEAR(found.volume, expected.volume, 1e-6 * expected.volume);
    if (!read.has_chunks) continue;
    EXPECT_EQ(found.chunks, expected.chunks);
    EXPECT_EQ(found.unmatched_faces, 0u);
  }
}

TEST(SolidExport, AGlbKeepsKindBondsVolumeAndBits) {
  const Sample sample = only_solid();
  const MeshedAsset meshed = sample.meshed();
  const TestFolder folder;
  export_asset(meshed, folder / "a.glb");
  const ImportedAsset read = import_asset(folder / "a.glb");
  ASSERT_EQ(read.walls.size(), 1u);
  EXPECT_EQ(read.walls[0].kind, SoupWall::Kind::solid);
  EXPECT_EQ(read.walls[0].bonds, sample.solids[0].bonds.size());
  EXPECT_EQ(read.walls[0].volume_expected, sample.solids[0].volume_expected);
  EXPECT_EQ(measured(read).hash, measured(meshed).hash);
}

// Vertices near 0, the way in the node: where things stand in the world is as it was.
TEST(SolidExport, ASolidFarFromItsOriginStandsWhereItIs) {
  TriMesh mesh = test::gear();
  for (Vec3& v : mesh.vertices) v = v + Vec3{64, -32, 128};
  SolidModel solid;
  solid.name = "far";
  solid.pattern = SolidVoronoiParams{.count = 9, .points = {}, .sites = {}};
  solid.position = {1, 2, 3};
  solid.rotation = {0, 1, 0, 0};  // half a turn about y
  Sample sample;
  sample.solids.push_back(fracture_solid(solid, test::as_surface(mesh), 1000, {.seed = 3}));
  const MeshedAsset meshed = sample.meshed();
  const TestFolder folder;
  for (const char* name : {"a.glb", "a.obj", "a.svg"}) export_asset(meshed, folder / name);
  const Soundness found = measured(import_asset(folder / "a.glb"));
  EXPECT_TRUE(found.is_sound());
  EXPECT_LT(found.volume_error(), 1e-7);
  EXPECT_EQ(found.hash, measured(meshed).hash);

  const Glb glb(content_of(folder / "a.glb"));
  const Json& root = glb.json["nodes"][0];
  const auto vector = [](const Json& json) {
    return Vec3{json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
  };
  const Vec3 origin = vector(root["extras"]["sunder"]["origin"]), at = vector(root["translation"]);
  EXPECT_LT(length(origin - Vec3{64, -32, 128}), 1);
  EXPECT_LT(length(at - (Vec3{-origin.x, origin.y, -origin.z} + Vec3{1, 2, 3})), 1e-6);
  EXPECT_LT(length(vector(glb.json["nodes"][1]["extras"]["sunder"]["centroid"])), 1);
  for (const float x : glb.values(glb.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"]))
    EXPECT_LT(std::abs(x), 1.5f);

  // In the world: half a turn and the way.
  Vec3 least{1e9, 1e9, 1e9}, low = least;
  for (const Vec3 v : mesh.vertices)
    low = {std::min(low.x, 1 - v.x), std::min(low.y, 2 + v.y), std::min(low.z, 3 - v.z)};
  std::istringstream obj(content_of(folder / "a.obj"));
  for (std::string line; std::getline(obj, line);) {
    Vec3 v;
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &v.x, &v.y, &v.z) != 3) continue;
    least = {std::min(least.x, v.x), std::min(least.y, v.y), std::min(least.z, v.z)};
  }
  EXPECT_LT(length(least - low), 1e-4);
}

TEST(SolidExport, AGlbHasTheModelsMaterialsAndColours) {
  const Sample sample = only_solid();
  const TestFolder folder;
  export_asset(sample.meshed(), folder / "a.glb");
  const Glb glb(content_of(folder / "a.glb"));
  std::set<std::string> names;
  for (const Json& material : glb.json["materials"]) names.insert(material["name"]);
  EXPECT_EQ(names, (std::set<std::string>{"blue_paint", "steel_outer", "steel_inner"}));
  std::size_t vertices = 0;
  for (const Json& mesh : glb.json["meshes"]) {
    EXPECT_GE(mesh["primitives"].size(), 2u);
    for (const Json& primitive : mesh["primitives"]) {
      const std::vector<float> colours =
          glb.values(primitive["attributes"]["COLOR_0"].get<std::size_t>());
      const std::string& name =
          glb.json["materials"][primitive["material"].get<std::size_t>()]["name"]
              .get_ref<const std::string&>();
      EXPECT_FALSE(name.empty());
      vertices = std::max(vertices, colours.size() / 3);
      for (const float channel : colours) {
        EXPECT_GE(channel, 0);
        EXPECT_LE(channel, 1);
      }
    }
  }
  EXPECT_GT(vertices, 0u);
  const Json& extras = glb.json["nodes"][0]["extras"]["sunder"];
  EXPECT_EQ(extras["kind"], "solid");
  EXPECT_FALSE(extras.contains("thickness"));
  EXPECT_EQ(glb.json["nodes"][1]["name"], "gear_chunk_0000");
}

TEST(SolidExport, PicturesStandInAGlbAndBesideAGltf) {
  const std::string png = "\x89PNG\r\n\x1a\n and so on";
  const TestFolder folder;
  std::filesystem::create_directories(folder / "models");
  std::filesystem::create_directories(folder / "out");
  put_content(folder / "models/skin 1.png", png);
  put_content(folder / "models/skin.bmp", "BM");
  Sample sample = only_solid();
  sample.solids[0].solid.file = (folder / "models/gear.obj").string();
  sample.solids[0].surface.materials[0].texture = "skin 1.png";
  sample.solids[0].surface.materials[1].name = "other";
  sample.solids[0].surface.materials[1].texture = "skin.bmp";  // glTF has PNG and JPEG only
  const MeshedAsset meshed = sample.meshed();
  export_asset(meshed, folder / "out/a.glb");
  const Glb glb(content_of(folder / "out/a.glb"));
  ASSERT_EQ(glb.json["images"].size(), 1u);
  EXPECT_EQ(glb.json["images"][0]["mimeType"], "image/png");
  const Json& view =
      glb.json["bufferViews"].at(glb.json["images"][0]["bufferView"].get<std::size_t>());
  EXPECT_EQ(glb.binary.substr(view["byteOffset"].get<std::size_t>(),
                              view["byteLength"].get<std::size_t>()),
            png);
  export_asset(meshed, folder / "out/a.gltf");
  const Json gltf = Json::parse(content_of(folder / "out/a.gltf"));
  EXPECT_EQ(gltf["images"][0]["uri"], "../models/skin%201.png");
  export_asset(meshed, folder / "out/a.obj");
  EXPECT_NE(content_of(folder / "out/a.mtl").find("map_Kd ../models/skin 1.png\n"),
            std::string::npos);
}

TEST(SolidExport, WallsAndSolidsShareAFile) {
  Sample sample = only_solid();
  sample.walls.walls.push_back(sample_wall("facade", 4, 3));
  sample.solids.push_back(sample_solid("second", 5));
  sample.solids[1].surface.materials[0].base_colour = {1, 1, 0, 1};  // the same name, another look
  const MeshedAsset meshed = sample.meshed();
  const Soundness expected = measured(meshed);
  EXPECT_TRUE(expected.is_sound());
  const TestFolder folder;
  for (const char* name : {"a.glb", "a.obj", "a.ply"}) {
    SCOPED_TRACE(name);
    export_asset(meshed, folder / name);
    const Soundness found = measured(import_asset(folder / name));
    EXPECT_TRUE(found.is_sound());
    EXPECT_EQ(found.triangles, expected.triangles);
  }
  const std::string materials = content_of(folder / "a.mtl");
  for (const char* name : {"concrete-c30_outer", "blue_paint", "blue_paint_2", "steel_inner"})
    EXPECT_NE(materials.find("newmtl " + std::string(name) + "\n"), std::string::npos) << name;
}

TEST(SolidExport, ThreadsDoNotChangeAByte) {
  const TestFolder folder;
  for (const int threads : {1, 2, 5}) {
    Sample sample;
    sample.solids.push_back(sample_solid("gear", 40, threads));
    const MeshedAsset meshed = mesh_asset(sample.walls, threads, sample.solids);
    for (const char* suffix : {".glb", ".svg"})
      export_asset(meshed, folder / (std::to_string(threads) + suffix));
  }
  for (const char* suffix : {".glb", ".svg"})
    for (const char* threads : {"2", "5"})
      EXPECT_EQ(content_of(folder / ("1" + std::string(suffix))),
                content_of(folder / (threads + std::string(suffix))));
}

TEST(SolidExport, APictureShowsEveryChunkTwice) {
  const Sample sample = only_solid();
  const TestFolder folder;
  export_asset(sample.meshed(), folder / "a.svg");
  const std::string svg = content_of(folder / "a.svg");
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_NE(svg.find(">gear</text>"), std::string::npos);
  std::size_t groups = 0;
  for (std::size_t at = 0; (at = svg.find("<g transform", at)) != std::string::npos; ++at) ++groups;
  EXPECT_EQ(groups, 2u);
}

// --- faults -----------------------------------------------------------------------------------

// A solid's soup, changed by hand.
struct Faulty {
  SolidAsset asset = sample_solid();
  SolidMeshes meshes = solid_meshes(asset);
  std::vector<SoupChunk> chunks;
  Faulty() {
    const SoupWall soup = soup_of(asset, meshes);
    for (std::uint32_t c = 0; c < soup.chunk_count; ++c) chunks.push_back(soup.chunk(c));
  }
  Soundness measured(SoupWall::Kind kind = SoupWall::Kind::solid) const {
    SoupWall soup;
    soup.chunk_count = static_cast<std::uint32_t>(chunks.size());
    soup.kind = kind;
    soup.volume_expected = asset.volume_expected;
    soup.chunk = [this](std::uint32_t c) { return chunks[c]; };
    return measure({soup});
  }
};

TEST(SolidMeasure, ASolidOfAnUnknownKindIsKnownByItsFaces) {
  const Faulty sound;
  EXPECT_TRUE(sound.measured().is_sound());
  EXPECT_TRUE(sound.measured(SoupWall::Kind::unknown).is_sound());
  EXPECT_EQ(sound.measured().slivers, sound.measured(SoupWall::Kind::unknown).slivers);
}

TEST(SolidMeasure, AMovedChunkHasNoPartners) {
  Faulty faulty;
  for (float& x : faulty.chunks[0].positions) x += 0.01f;
  const Soundness s = faulty.measured();
  EXPECT_FALSE(s.is_sound());
  EXPECT_GT(s.unmatched_faces, 0u);
}

TEST(SolidMeasure, AChunkThatIsThereTwiceOverlaps) {
  Faulty faulty;
  faulty.chunks.push_back(faulty.chunks[1]);
  const Soundness s = faulty.measured();
  EXPECT_FALSE(s.is_sound());
  EXPECT_GT(s.unmatched_faces, 0u);
  EXPECT_EQ(s.overlapping_pairs, 1u);
}

TEST(SolidMeasure, AMissingTriangleOpensItsChunk) {
  Faulty faulty;
  faulty.chunks[2].triangles.resize(faulty.chunks[2].triangles.size() - 3);
  faulty.chunks[2].inner.pop_back();
  const Soundness s = faulty.measured();
  EXPECT_EQ(s.open_chunks, 1u);
  EXPECT_FALSE(s.is_sound());
}

TEST(SolidMeasure, AChunkTurnedInsideOutIsTold) {
  Faulty faulty;
  for (std::size_t i = 0; i < faulty.chunks[3].triangles.size(); i += 3)
    std::swap(faulty.chunks[3].triangles[i], faulty.chunks[3].triangles[i + 1]);
  const Soundness s = faulty.measured();
  EXPECT_EQ(s.inverted_chunks, 1u);
  EXPECT_FALSE(s.is_sound());
}

// A closed box, all of it outside.
SoupChunk box_chunk(Vec3 low, Vec3 size) {
  SoupChunk chunk;
  const TriMesh box = test::box(low, size);
  for (const Vec3 p : box.vertices)
    for (const double x : {p.x, p.y, p.z}) chunk.positions.push_back(static_cast<float>(x));
  for (const auto& t : box.triangles) {
    chunk.triangles.insert(chunk.triangles.end(), t.begin(), t.end());
    chunk.inner.push_back(0);
  }
  return chunk;
}

Soundness measured(const std::vector<SoupChunk>& chunks) {
  SoupWall soup;
  soup.chunk_count = static_cast<std::uint32_t>(chunks.size());
  soup.kind = SoupWall::Kind::solid;
  soup.chunk = [&](std::uint32_t c) { return chunks[c]; };
  return measure({soup});
}

TEST(SolidMeasure, AChunkWhoseCornerIsPushedThroughItsOtherSideCrossesItself) {
  SoupChunk chunk = box_chunk({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(measured({chunk}).self_crossing_chunks, 0u);
  std::ranges::copy(std::array{1.5f, 0.3f, 0.6f}, chunk.positions.begin());  // the corner at 0
  const Soundness s = measured({chunk});
  EXPECT_EQ(s.open_chunks + s.nonmanifold_chunks, 0u);
  EXPECT_EQ(s.self_crossing_chunks, 1u);
  EXPECT_EQ(s.crossing_surfaces, 1u);
  EXPECT_FALSE(s.is_sound());
}

TEST(SolidMeasure, ChunksThatRunThroughEachOtherCrossInTheSurface) {
  const SoupChunk one = box_chunk({0, 0, 0}, {1, 1, 1});
  const Soundness apart = measured({one, box_chunk({1.5, 0, 0}, {1, 1, 1})});
  EXPECT_TRUE(apart.is_sound());
  const Soundness s = measured({one, box_chunk({0.75, 0.25, 0.25}, {1, 0.5, 0.5})});
  EXPECT_EQ(s.self_crossing_chunks, 0u);
  EXPECT_EQ(s.crossing_surfaces, 1u);
  EXPECT_FALSE(s.is_sound());
}

TEST(SolidMeasure, AChunkInsideAnotherFacesTheWrongWay) {
  const Soundness s =
      measured({box_chunk({0, 0, 0}, {1, 1, 1}), box_chunk({0.25, 0.25, 0.25}, {0.5, 0.5, 0.5})});
  EXPECT_EQ(s.self_crossing_chunks, 0u);
  EXPECT_EQ(s.crossing_surfaces, 1u);
  EXPECT_FALSE(s.is_sound());
}

TEST(SolidMeasure, NeedlesAreSlivers) {
  Faulty faulty;
  const std::uint64_t before = faulty.measured().slivers;
  faulty.chunks.push_back(box_chunk({50, 50, 50}, {1, 0.01, 0.01}));
  EXPECT_EQ(faulty.measured().slivers, before + 1);
}

}  // namespace
}  // namespace sunder
