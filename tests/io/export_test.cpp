// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/export.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "io/gltf.hpp"
#include "io/import.hpp"
#include "io/sample_asset.hpp"
#include "io/text_writer.hpp"
#include "io/wall_view.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

Asset sample_asset() {
  Asset asset;
  asset.walls.push_back(sample_wall("facade", 6, 4));
  asset.walls.push_back(sample_wall("side", 3, 2, 5));
  asset.walls[1].wall.material = "brick";
  asset.walls[1].wall.position = {1, 2, 3.25};
  asset.walls[1].wall.rotation = rotation_from_degrees({0, 90, 30});
  return asset;
}

class StringSink : public ByteSink {
 public:
  void write(std::span<const std::byte> bytes) override {
    content.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  void rewrite_front(std::span<const std::byte> bytes) override {
    std::memcpy(content.data(), bytes.data(), bytes.size());
  }
  std::string content;
};

// Triangles as corner coordinates, bit for bit, in a free order.
using Corners = std::array<float, 9>;
std::multiset<Corners> triangles_of(const ImportedChunk& chunk, bool inner) {
  std::multiset<Corners> result;
  for (std::size_t t = 0; t < chunk.inner.size(); ++t) {
    if ((chunk.inner[t] != 0) != inner) continue;
    Corners corners;
    for (std::size_t k = 0; k < 9; ++k) {
      corners[k] = chunk.positions[3 * std::size_t{chunk.triangles[3 * t + k / 3]} + k % 3];
    }
    result.insert(corners);
  }
  return result;
}

std::multiset<Corners> triangles_of(const RenderMeshes& meshes, std::uint32_t chunk, bool inner) {
  std::multiset<Corners> result;
  const std::uint32_t list = inner ? meshes.inner[chunk] : meshes.outer[chunk];
  if (list == RenderMeshes::kNoList) return result;
  const IndexList range = meshes.lists[list];
  for (std::uint32_t i = 0; i < range.count; i += 3) {
    Corners corners;
    for (std::uint32_t k = 0; k < 9; ++k) {
      const std::size_t vertex =
          meshes.vertex_begin[chunk] + meshes.indices[range.begin + i + k / 3];
      corners[k] = meshes.positions[3 * vertex + k % 3];
    }
    result.insert(corners);
  }
  return result;
}

void expect_same_chunks(const ImportedAsset& read, const MeshedAsset& written) {
  ASSERT_EQ(read.walls.size(), written.asset.walls.size());
  for (std::size_t w = 0; w < read.walls.size(); ++w) {
    const WallAsset& wall = written.asset.walls[w];
    EXPECT_EQ(read.walls[w].name, wall.wall.name);
    ASSERT_EQ(read.walls[w].chunks.size(), wall.chunks.size());
    for (std::uint32_t c = 0; c < wall.chunks.size(); ++c) {
      const ImportedChunk& chunk = read.walls[w].chunks[c];
      EXPECT_EQ(chunk.name, wall.chunk_name(c));
      for (const bool inner : {false, true}) {
        EXPECT_EQ(triangles_of(chunk, inner), triangles_of(written.meshes[w], c, inner))
            << chunk.name;
      }
    }
  }
}

TEST(PutNumber, ReadsBackAsTheSameFloat) {
  std::uint64_t failures = 0;
  for (std::uint64_t i = 0; i < 300000; ++i) {
    const auto bits = static_cast<std::uint32_t>(random_bits(3, i));
    const float value = std::bit_cast<float>(bits);
    if (!std::isfinite(value)) continue;
    char text[kNumberRoom + 1] = {};
    *put_number(text, static_cast<double>(value)) = '\0';
    if (std::strtof(text, nullptr) != value) ++failures;
  }
  EXPECT_EQ(failures, 0u);
}

TEST(PutNumber, WritesPlainShortDecimals) {
  const std::pair<double, const char*> rows[] = {{0, "0"},
                                                 {-0.0, "0"},
                                                 {1, "1"},
                                                 {-1.5, "-1.5"},
                                                 {0.1f, "0.100000001"},
                                                 {0.25, "0.25"},
                                                 {2400, "2400"},
                                                 {123456789, "123456789"},
                                                 {1e9, "1e9"},
                                                 {0.001, "0.001"},
                                                 {1e-5, "1e-5"},
                                                 {999999999.9, "1e9"},
                                                 {0.0001, "0.0001"},
                                                 {-12345.678, "-12345.678"},
                                                 {1.5e-7, "1.5e-7"}};
  for (const auto& [value, expected] : rows) {
    char text[kNumberRoom + 1] = {};
    *put_number(text, value) = '\0';
    EXPECT_STREQ(text, expected);
  }
}

TEST(Export, EveryFormatIsTheSameByteForByteThroughAssimp) {
  const Asset asset = sample_asset();
  const MeshedAsset meshed = mesh_asset(asset);
  const TestFolder direct, through;
  for (const char* name : {"a.glb", "b.gltf", "c.obj"}) {
    export_asset(meshed, direct / name);
    export_through_assimp(meshed, through / name);
  }
  EXPECT_EQ(direct.names(), through.names());
  EXPECT_EQ(direct.names(),
            (std::vector<std::string>{"a.glb", "b.bin", "b.gltf", "c.mtl", "c.obj"}));
  for (const std::string& name : direct.names()) {
    EXPECT_TRUE(content_of(direct / name) == content_of(through / name)) << name;
  }
}

TEST(Export, TwiceGivesTheSameBytes) {
  const Asset asset = sample_asset();
  const TestFolder folder;
  for (const std::string name : {"a.glb", "a.gltf", "a.obj", "a.stl", "a.ply", "a.svg"}) {
    export_asset(mesh_asset(asset), folder / name);
    const std::string first = content_of(folder / name);
    export_asset(mesh_asset(asset, 2), folder / name);
    EXPECT_FALSE(first.empty()) << name;
    EXPECT_TRUE(first == content_of(folder / name)) << name;
  }
}

TEST(Export, GltfReadsBackBitForBit) {
  const Asset asset = sample_asset();
  const MeshedAsset meshed = mesh_asset(asset);
  const TestFolder folder;
  for (const char* name : {"a.glb", "a.gltf", "with space.gltf"}) {
    export_asset(meshed, folder / name);
    const ImportedAsset read = import_asset(folder / name);
    expect_same_chunks(read, meshed);
    for (std::size_t w = 0; w < read.walls.size(); ++w) {
      EXPECT_EQ(read.walls[w].volume_expected, asset.walls[w].volume_expected);
      EXPECT_EQ(read.walls[w].bonds, asset.walls[w].bonds.size());
    }
  }
}

TEST(Export, ObjReadsBackItsChunksAndSides) {
  Asset asset = sample_asset();
  asset.walls[1].wall.position = {};  // OBJ has no nodes: the transform would be in the vertices
  asset.walls[1].wall.rotation = {};
  const MeshedAsset meshed = mesh_asset(asset);
  const TestFolder folder;
  export_asset(meshed, folder / "a.obj");
  const ImportedAsset read = import_asset(folder / "a.obj");
  ASSERT_EQ(read.walls.size(), 2u);
  for (std::size_t w = 0; w < 2; ++w) {
    ASSERT_EQ(read.walls[w].chunks.size(), asset.walls[w].chunks.size());
    for (std::uint32_t c = 0; c < asset.walls[w].chunks.size(); ++c) {
      const ImportedChunk& chunk = read.walls[w].chunks[c];
      EXPECT_EQ(chunk.name, asset.walls[w].chunk_name(c));
      const RenderMeshes& m = meshed.meshes[w];
      EXPECT_EQ(triangles_of(chunk, true).size(), m.lists[m.inner[c]].count / 3);
      EXPECT_EQ(triangles_of(chunk, false).size(), m.lists[m.outer[c]].count / 3);
    }
  }
}

// The text itself, read correctly rounded: every vertex of the mesh stands in it, and a corner that
// chunks share is the same text in each.
TEST(Export, ObjVerticesAreTheMeshsFloats) {
  Asset asset;
  asset.walls.push_back(sample_wall("facade", 6, 4));
  const MeshedAsset meshed = mesh_asset(asset);
  const TestFolder folder;
  export_asset(meshed, folder / "a.obj");
  std::istringstream file(content_of(folder / "a.obj"));
  std::set<std::array<float, 3>> in_file, in_mesh;
  std::set<std::string> texts;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("v ")) continue;
    char* at = line.data() + 2;
    std::array<float, 3> p;
    for (float& value : p) value = std::strtof(at, &at);
    in_file.insert(p);
    texts.insert(line);
  }
  const auto& positions = meshed.meshes[0].positions;
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    in_mesh.insert({positions[i], positions[i + 1], positions[i + 2]});
  }
  EXPECT_EQ(in_file, in_mesh);
  EXPECT_EQ(texts.size(), in_mesh.size());
  EXPECT_EQ(in_mesh.size(), 2u * 7 * 5);  // the corners of the grid, back and front
}

TEST(Export, StlAndPlyHoldEveryTriangleInTheWorldsFrame) {
  Asset asset = sample_asset();
  const MeshedAsset meshed = mesh_asset(asset);
  std::size_t triangles = 0;
  for (const RenderMeshes& m : meshed.meshes) {
    for (std::uint32_t c = 0; c < m.chunk_count(); ++c) {
      triangles += m.lists[m.outer[c]].count / 3 + m.lists[m.inner[c]].count / 3;
    }
  }
  const TestFolder folder;
  for (const char* name : {"a.stl", "a.ply"}) {
    export_asset(meshed, folder / name);
    const ImportedAsset read = import_asset(folder / name);
    EXPECT_FALSE(read.has_chunks);
    ASSERT_EQ(read.walls.size(), 1u);
    ASSERT_EQ(read.walls[0].chunks.size(), 1u);
    const ImportedChunk& all = read.walls[0].chunks[0];
    EXPECT_EQ(all.inner.size(), triangles) << name;
    TriMesh mesh;
    for (std::size_t i = 0; i < all.positions.size(); i += 3) {
      mesh.vertices.push_back({all.positions[i], all.positions[i + 1], all.positions[i + 2]});
    }
    for (std::size_t i = 0; i < all.triangles.size(); i += 3) {
      mesh.triangles.push_back({all.triangles[i], all.triangles[i + 1], all.triangles[i + 2]});
    }
    const double expected = asset.walls[0].volume_expected + asset.walls[1].volume_expected;
    EXPECT_NEAR(mass_properties(mesh).volume / expected, 1, 1e-6) << name;
    EXPECT_TRUE(std::ranges::any_of(mesh.vertices, [](Vec3 v) { return v.z > 3; })) << name;
  }
}

TEST(Export, GlbHeaderCountsItsBytes) {
  const Asset asset = sample_asset();
  const TestFolder folder;
  export_asset(mesh_asset(asset), folder / "a.glb");
  const std::string bytes = content_of(folder / "a.glb");
  std::uint32_t head[5];
  std::memcpy(head, bytes.data(), sizeof head);
  EXPECT_EQ(head[0], 0x46546C67u);
  EXPECT_EQ(head[1], 2u);
  EXPECT_EQ(head[2], bytes.size());
  EXPECT_EQ(head[3] % 4, 0u);
  std::uint32_t binary[2];
  std::memcpy(binary, bytes.data() + 20 + head[3], sizeof binary);
  EXPECT_EQ(20 + head[3] + 8 + binary[0], bytes.size());
}

TEST(Export, ChunksWithTheSameCornersShareTheirIndices) {
  Asset asset;
  asset.walls.push_back(sample_wall("facade", 20, 10));
  const MeshedAsset meshed = mesh_asset(asset);
  const WallView view = view_of(asset.walls[0], meshed.meshes[0]);
  // Inside, on an edge, in a corner: few kinds of quads, whatever their number.
  EXPECT_LE(unique_lists({&view, 1}).lists.size(), 20u);
}

TEST(Export, LargeChunksGetWideIndices) {
  Asset asset;
  asset.walls.push_back(sample_wall("large", 1, 1));
  MeshedAsset meshed = mesh_asset(asset);
  RenderMeshes m;
  constexpr std::uint32_t kCount = 70000;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    m.positions.insert(m.positions.end(), {static_cast<float>(i), static_cast<float>(i % 7), 0});
    m.normals.insert(m.normals.end(), {0, 0, 1});
    m.uvs.insert(m.uvs.end(), {0, 0});
    if (i >= 2) m.indices.insert(m.indices.end(), {0, i - 1, i});
  }
  m.vertex_begin = {0, kCount};
  m.lists = {{0, static_cast<std::uint32_t>(m.indices.size())}};
  m.outer = {0};
  m.inner = {RenderMeshes::kNoList};
  meshed.meshes[0] = m;
  const TestFolder folder;
  export_asset(meshed, folder / "a.glb");
  EXPECT_NE(content_of(folder / "a.glb").find("\"componentType\":5125,\"count\""),
            std::string::npos);
  expect_same_chunks(import_asset(folder / "a.glb"), meshed);
}

TEST(Export, AnotherSuffixIsAUsageError) {
  const Asset asset = sample_asset();
  const TestFolder folder;
  for (const char* name : {"a.fbx", "a", "a.dae"}) {
    try {
      export_asset(mesh_asset(asset), folder / name);
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      EXPECT_NE(std::string(error.what()).find(".glb"), std::string::npos);
    }
    EXPECT_FALSE(is_export_suffix(std::filesystem::path(name).extension()));
  }
  EXPECT_TRUE(is_export_suffix(".glb"));
  EXPECT_TRUE(folder.names().empty());
}

// Each row spoils the meshes in one way; no format may write or crash on any of them.
TEST(Export, SpoiledMeshesAreRefusedBeforeAnythingIsWritten) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  struct Row {
    const char* what;
    std::function<void(Asset&, RenderMeshes&)> spoil;
  };
  const Row rows[] = {
      {"vertex NaN", [&](Asset&, RenderMeshes& m) { m.positions[4] = nan; }},
      {"vertex infinite", [&](Asset&, RenderMeshes& m) { m.positions[0] = infinity; }},
      {"uv NaN", [&](Asset&, RenderMeshes& m) { m.uvs[3] = nan; }},
      {"normal NaN", [&](Asset&, RenderMeshes& m) { m.normals[5] = nan; }},
      {"normal zero",
       [](Asset&, RenderMeshes& m) { m.normals[0] = m.normals[1] = m.normals[2] = 0; }},
      {"index out of range", [](Asset&, RenderMeshes& m) { m.indices[2] = 5000; }},
      {"index huge", [](Asset&, RenderMeshes& m) { m.indices[2] = UINT32_MAX; }},
      {"list out of range", [](Asset&, RenderMeshes& m) { m.outer[0] = 99999; }},
      {"range out of indices", [](Asset&, RenderMeshes& m) { m.lists[0].count = 3000000; }},
      {"range overflows", [](Asset&, RenderMeshes& m) { m.lists[0].begin = UINT32_MAX - 2; }},
      {"half a triangle", [](Asset&, RenderMeshes& m) { m.lists[0].count -= 1; }},
      {"vertices missing", [](Asset&, RenderMeshes& m) { m.uvs.pop_back(); }},
      {"ranges not in order",
       [](Asset&, RenderMeshes& m) { std::swap(m.vertex_begin[1], m.vertex_begin[3]); }},
      {"mass NaN",
       [&](Asset& a, RenderMeshes&) { a.walls[0].chunks[1].volume = static_cast<double>(nan); }},
      {"chunks missing", [](Asset& a, RenderMeshes&) { a.walls[0].chunks.pop_back(); }},
      {"bond to nothing", [](Asset& a, RenderMeshes&) { a.walls[0].bonds[0].b = 12345; }},
      {"empty name", [](Asset& a, RenderMeshes&) { a.walls[0].wall.name = ""; }},
      {"name with a dot", [](Asset& a, RenderMeshes&) { a.walls[0].wall.name = "a.b"; }},
      {"name too long",
       [](Asset& a, RenderMeshes&) { a.walls[0].wall.name = std::string(57, 'a'); }},
      {"name twice", [](Asset& a, RenderMeshes&) { a.walls[0].wall.name = a.walls[1].wall.name; }},
      {"name of a chunk",
       [](Asset& a, RenderMeshes&) { a.walls[1].wall.name = "facade_chunk_0002"; }},
      {"material not UTF-8", [](Asset& a, RenderMeshes&) { a.walls[0].wall.material = "a\xff"; }},
      {"rotation not unit", [](Asset& a, RenderMeshes&) { a.walls[0].wall.rotation.w = 2; }}};
  const TestFolder folder;
  for (const Row& row : rows) {
    Asset asset = sample_asset();
    MeshedAsset meshed = mesh_asset(asset);
    row.spoil(asset, meshed.meshes[0]);
    for (const char* name : {"a.glb", "a.gltf", "a.obj", "a.stl", "a.ply"}) {
      for (const auto& write : {export_asset, export_through_assimp}) {
        try {
          write(meshed, folder / name);
          ADD_FAILURE() << row.what << " in " << name;
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ErrorCode::output) << row.what;
          EXPECT_EQ(std::string(error.what()).find((folder / name).string()), 0u) << error.what();
        }
      }
    }
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(Export, AnAssetWithoutWallsOrChunksDoesNotCrash) {
  Asset none, empty;
  empty.walls.push_back(sample_wall("empty", 1, 1));
  empty.walls[0].pattern = {};
  empty.walls[0].chunks.clear();
  empty.walls[0].bonds.clear();
  const TestFolder folder;
  for (const Asset* asset : {&none, &empty}) {
    for (const char* name : {"a.glb", "a.gltf", "a.obj", "a.stl", "a.ply", "a.svg"}) {
      try {
        export_asset(mesh_asset(*asset), folder / name);
        EXPECT_TRUE(std::filesystem::exists(folder / name));
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::output);
      }
    }
  }
}

TEST(Export, NodeNamesAreChunkNames) {
  for (const std::uint32_t columns : {2u, 101u}) {
    const WallAsset wall = sample_wall("w", columns, 100);
    ChunkNames name(wall.chunk_name(0));
    for (std::uint32_t c = 0; c < wall.chunks.size(); ++c, ++name) {
      ASSERT_EQ(*name, wall.chunk_name(c));
    }
  }
}

// Set up with: npm install --prefix tests/validate_gltf
TEST(Export, KhronosValidatorFindsNoErrorsAndNoWarnings) {
  const std::string tool = SUNDER_SOURCE_DIR "/tests/validate_gltf";
  if (!std::filesystem::exists(tool + "/node_modules/gltf-validator")) {
    GTEST_SKIP() << "gltf-validator is not installed";
  }
  const Asset asset = sample_asset();
  const MeshedAsset meshed = mesh_asset(asset);
  const TestFolder folder;
  export_asset(meshed, folder / "a.glb");
  export_asset(meshed, folder / "b c.gltf");
  const std::string command = "node '" + tool + "/validate.js' '" + (folder / "a.glb").string() +
                              "' '" + (folder / "b c.gltf").string() + "' > '" +
                              (folder / "log").string() + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << content_of(folder / "log");
}

// The svg of a wall: one path per cell in the flat view, and well-formed nesting.
TEST(Export, SvgDrawsEveryCell) {
  const Asset asset = sample_asset();
  const TestFolder folder;
  export_asset(mesh_asset(asset), folder / "a.svg");
  const std::string svg = content_of(folder / "a.svg");
  EXPECT_TRUE(svg.starts_with("<svg "));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  const auto count = [&svg](const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = svg.find(part); at != std::string::npos; at = svg.find(part, at + 1)) {
      ++found;
    }
    return found;
  };
  EXPECT_EQ(count("class=\"cell\""), 24u + 6u);
  EXPECT_EQ(count("<g"), count("</g>"));
  EXPECT_EQ(count("nan"), 0u);
}

}  // namespace
}  // namespace sunder
