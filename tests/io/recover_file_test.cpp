// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <ostream>

#include "fracture/chunk_mesh.hpp"
#include "fracture/recover.hpp"
#include "fracture/same_asset.hpp"
#include "io/export.hpp"
#include "io/import.hpp"
#include "io/sample_asset.hpp"
#include "io/scene.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

SoupWall soup_of_file(const ImportedWall& wall) {
  SoupWall soup;
  soup.chunk_count = static_cast<std::uint32_t>(wall.chunks.size());
  soup.chunk = [&wall](std::uint32_t c) {
    const ImportedChunk& chunk = wall.chunks[c];
    return SoupChunk{chunk.positions, chunk.triangles, chunk.inner};
  };
  return soup;
}

// Every scene that the project comes with, fractured.
class RecoverScene : public testing::TestWithParam<std::filesystem::path> {
 protected:
  RecoverScene() : scene_(read_scene(GetParam())) {
    for (const Wall& wall : scene_.walls)
      asset_.walls.push_back(fracture_wall(
          wall, find_material(scene_.materials, wall.material).density, {.seed = scene_.seed}));
  }

  void expect_same_from(const std::string& suffix) {
    const TestFolder folder;
    const MeshedAsset meshed = mesh_asset(asset_);
    export_asset(meshed, folder / ("a" + suffix));
    const ImportedAsset read = import_asset(folder / ("a" + suffix));
    ASSERT_EQ(read.walls.size(), asset_.walls.size());
    for (std::size_t i = 0; i < asset_.walls.size(); ++i) {
      const WallAsset& wall = asset_.walls[i];
      const WallAsset memory =
          recover_wall(soup_of(wall, meshed.meshes[i]), wall.wall, wall.density);
      const WallAsset file = recover_wall(soup_of_file(read.walls[i]), wall.wall, wall.density);
      expect_same(memory, file, wall.wall.name);
      EXPECT_EQ(memory.bonds.size(), wall.bonds.size());
      EXPECT_NEAR(memory.volume_expected, wall.volume_expected, 1e-6 * wall.volume_expected);
    }
  }

  Scene scene_;
  Asset asset_;
};

TEST_P(RecoverScene, AWallFromAGlbIsTheOneInMemoryBitForBit) {
  expect_same_from(".glb");
}

TEST_P(RecoverScene, AWallFromAGltfIsTheOneInMemoryBitForBit) {
  expect_same_from(".gltf");
}

// OBJ has no nodes: its walls stand where the scene puts them, so they are put at the origin first.
TEST_P(RecoverScene, AWallFromAnObjIsTheOneInMemoryBitForBit) {
  for (WallAsset& wall : asset_.walls) wall.wall.position = {}, wall.wall.rotation = {};
  expect_same_from(".obj");
}

std::vector<std::filesystem::path> scenes() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(SUNDER_SOURCE_DIR "/data/scenes"))
    if (entry.path().extension() == ".json" && !read_scene(entry.path()).walls.empty())
      paths.push_back(entry.path());
  std::ranges::sort(paths);
  return paths;
}

INSTANTIATE_TEST_SUITE_P(Scenes, RecoverScene, testing::ValuesIn(scenes()), [](const auto& scene) {
  std::string name = scene.param.stem().string();
  std::ranges::replace(name, '-', '_');
  return name;
});

TEST(RecoverFile, AFormatThatKeepsNoChunksApartIsAnError) {
  Asset asset;
  asset.walls.push_back(sample_wall("w", 3, 2));
  const TestFolder folder;
  export_asset(mesh_asset(asset), folder / "a.stl");
  const ImportedAsset read = import_asset(folder / "a.stl");
  SoupWall soup = soup_of_file(read.walls.at(0));
  soup.has_chunks = read.has_chunks;
  EXPECT_THROW(recover_wall(soup, asset.walls[0].wall, 1), Error);
}

}  // namespace
}  // namespace sunder
