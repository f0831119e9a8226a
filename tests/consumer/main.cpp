// SPDX-License-Identifier: GPL-3.0-or-later
// A program of somebody else: finds the installed library, fractures a wall, writes a file, hits
// the wall, and takes a post from under a building.
#include <cstdio>

#include "fracture/asset.hpp"
#include "fracture/recover.hpp"
#include "io/collapse_scene.hpp"
#include "io/export.hpp"
#include "io/impact_scene.hpp"

namespace {

bool loses_a_post() {
  const sunder::Scene scene = sunder::parse_scene(
      R"({"sunder": 1, "building": {"posts": [2, 3], "storeys": 2},
          "scenario": {"remove": ["post_0_1_0"]}, "simulation": {"duration": 0.1}})",
      "own text");
  const sunder::CollapseResult result = sunder::simulate_collapse(sunder::collapse_scene(scene));
  std::printf("%zu joints broken\n", result.broken_joints.size());
  for (const sunder::RecordedPart& part : result.recording.parts)
    if (part.name == "post_0_1_0") return part.removed == 0 && result.broken_joints.size() >= 2;
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  sunder::Wall wall;
  wall.region.openings = {sunder::rectangle({0.9, 2.1}, {1, 0})};
  wall.anchors = {"bottom"};
  sunder::Asset asset;
  asset.walls.push_back(sunder::fracture_wall(wall, 2400, {.seed = 7}));
  sunder::export_asset(sunder::mesh_asset(asset), argv[1]);
  std::printf("%u chunks\n", asset.walls[0].pattern.cell_count());

  sunder::ImpactScene scene;
  const auto& concrete = sunder::find_material(sunder::builtin_materials(), "concrete-c30");
  scene.walls.push_back({sunder::at_file_precision(asset.walls[0]), concrete});
  scene.projectiles.emplace_back();
  scene.projectiles[0].position = {4, 1.5, 1};
  scene.projectiles[0].velocity = {0, 0, -10};
  scene.simulation.duration = 0.2;
  const sunder::ImpactResult result = sunder::simulate_impact(scene);
  std::printf("%llu chunks freed\n", static_cast<unsigned long long>(result.chunks_freed));
  const bool has_hit = asset.walls[0].pattern.cell_count() > 100 && result.chunks_freed > 0;
  return has_hit && loses_a_post() ? 0 : 1;
}
