// SPDX-License-Identifier: GPL-3.0-or-later
// A program of somebody else: finds the installed library, fractures a wall, writes a file, and
// hits the wall.
#include <cstdio>

#include "fracture/asset.hpp"
#include "io/export.hpp"
#include "io/impact_scene.hpp"

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
  return asset.walls[0].pattern.cell_count() > 100 && result.chunks_freed > 0 ? 0 : 1;
}
