// SPDX-License-Identifier: GPL-3.0-or-later
// Breakable slabs and walls of a building: read, given as files, and the files of a run.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "io/collapse_scene.hpp"
#include "io/export.hpp"
#include "io/export_recording.hpp"
#include "io/glb.hpp"
#include "io/sample_asset.hpp"
#include "io/scene.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr const char* kSlab =
    R"({"thickness": 0.15, "pattern": {"type": "voronoi-grid", "cell": 2}})";

std::string scene_text(const std::string& panels) {
  return R"({"sunder": 1, "seed": 3,
    "building": {"posts": [2, 2], "storeys": 1, "slab": false, )" +
         panels + R"(},
    "projectiles": [{"name": "ball", "radius": 0.3, "mass": 900, "position": [2.7, 1.8, 7.5],
                     "velocity": [0.3, 0, -30]}],
    "simulation": {"duration": 0.3}})";
}

std::filesystem::path write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// What the first scene's wall in front is, as `sunder fracture` would write it.
void write_front_wall(const Frame& frame, double width, const std::filesystem::path& path) {
  std::uint32_t part = 0;
  while (frame.part_name(part) != "wall_x_0_1_0") ++part;
  const PartSolid solid = solid_of(frame, part);
  Wall wall;
  wall.name = "front";
  wall.region = solid.outline;
  if (width > 0) wall.region = {rectangle({width, 3}), {}};
  wall.thickness = 2 * solid.half_length;
  wall.material = "brick";
  wall.pattern = VoronoiGridParams{1.2, 0.9};
  wall.anchors = {"bottom", "left", "right", "top"};
  Asset asset;
  asset.walls.push_back(fracture_wall(wall, 1850, {.seed = 3}));
  export_asset(mesh_asset(asset), path);
}

TEST(PanelFiles, PatternsOfABuildingAreRead) {
  const Scene scene =
      parse_scene(R"({"sunder": 1, "building": {"posts": [2, 2], "storeys": 2, "slab": )" +
                      std::string(kSlab) + R"(,
          "walls": {"material": "brick", "pattern": {"type": "quad-grid", "cell": 0.5}},
          "overrides": [{"storeys": [1, 1], "walls": {"thickness": 0.2}}]}})",
                  "scene.json");
  const Frame& frame = *scene.building;
  ASSERT_EQ(frame.slabs.size(), 2u);
  ASSERT_EQ(frame.walls.size(), 8u);
  for (const FrameSlab& slab : frame.slabs) {
    ASSERT_LT(slab.pattern, frame.patterns.size());
    const auto* grid = std::get_if<VoronoiGridParams>(&frame.patterns[slab.pattern].pattern);
    ASSERT_NE(grid, nullptr);
    EXPECT_EQ(grid->cell, 2);
  }
  for (const FrameWall& wall : frame.walls) {
    ASSERT_LT(wall.pattern, frame.patterns.size()) << wall.name;
    EXPECT_TRUE(std::holds_alternative<QuadGridParams>(frame.patterns[wall.pattern].pattern));
  }
}

TEST(PanelFiles, PatternAndAssetDoNotGoTogether) {
  try {
    parse_scene(scene_text(R"("walls": {"asset": "w.glb", "pattern": {"type": "voronoi-grid"}})"),
                "scene.json");
    ADD_FAILURE() << "was read";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("does not go with \"asset\""), std::string::npos)
        << error.what();
  }
}

TEST(PanelFiles, WallOfAFileStandsInTheBuilding) {
  const TestFolder folder;
  const std::filesystem::path path =
      write(folder / "s.json", scene_text(R"("walls": {"thickness": 0.1, "asset": "w.glb"})"));
  write_front_wall(*parse_scene(scene_text(R"("walls": {"thickness": 0.1})"), "s.json").building,
                   0, folder / "w.glb");
  const CollapseScene scene = collapse_scene(read_scene(path));
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_TRUE(r.projectiles[0].perforated);
  EXPECT_GT(r.broken_bonds, 0u);
  write_front_wall(scene.frame, 4, folder / "w.glb");
  try {
    simulate_collapse(collapse_scene(read_scene(path)));
    ADD_FAILURE() << "was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input);
    EXPECT_NE(std::string(error.what()).find("w.glb: is 4.0"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("fracture a wall of that size"), std::string::npos);
  }
}

TEST(PanelFiles, FileOfNoWallIsRefused) {
  const TestFolder folder;
  write(folder / "w.glb", "nothing");
  const std::filesystem::path path =
      write(folder / "s.json", scene_text(R"("walls": {"asset": "w.glb"})"));
  EXPECT_THROW(collapse_scene(read_scene(path)), Error);
}

/// A wall of the run is there as its chunks, from the start, and not as a part.
TEST(PanelFiles, FilesOfARunShowChunksInThePanelsPlace) {
  const TestFolder folder;
  const Scene scene = parse_scene(
      scene_text(
          R"("walls": {"thickness": 0.1, "material": "brick", "pattern": {"type": "voronoi-grid", "cell": 1.2}})"),
      "scene.json");
  const CollapseResult r = simulate_collapse(collapse_scene(scene));
  export_recording(r.recording, folder / "run.glb");
  const Glb glb(text_of(folder / "run.glb"));
  ASSERT_FALSE(r.recording.walls.empty());
  for (const RecordedWall& wall : r.recording.walls) {
    const Json& whole = glb.json["nodes"][glb.node_of.at(wall.asset.wall.name + "_whole")];
    EXPECT_FALSE(whole.contains("mesh")) << "shown by its chunks";
    for (std::uint32_t c = 0; c < wall.asset.chunks.size(); ++c) {
      const std::string name = wall.asset.chunk_name(c);
      ASSERT_TRUE(glb.node_of.contains(name)) << name;
      EXPECT_EQ(glb.sampler(name, "translation") != nullptr, wall.track[c] != kNoTrack) << name;
    }
  }
  EXPECT_TRUE(glb.node_of.contains("post_0_0_0"));
  export_recording(r.recording, folder / "moment.obj", {.at = 0.2});
  const std::string obj = text_of(folder / "moment.obj");
  EXPECT_NE(obj.find("wall_x_0_1_0_chunk_0000"), std::string::npos);
  EXPECT_EQ(obj.find("_whole"), std::string::npos);
  export_recording(r.recording, folder / "run.svg");
  EXPECT_GT(text_of(folder / "run.svg").size(), 10000u);
}

}  // namespace
}  // namespace sunder
