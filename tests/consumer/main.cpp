// SPDX-License-Identifier: GPL-3.0-or-later
// A program of somebody else: finds the installed library, fractures a wall, writes a file.
#include <cstdio>

#include "fracture/asset.hpp"
#include "io/export.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  sunder::Wall wall;
  wall.region.openings = {sunder::rectangle({0.9, 2.1}, {1, 0})};
  sunder::Asset asset;
  asset.walls.push_back(sunder::fracture_wall(wall, 2400, {.seed = 7}));
  sunder::export_asset(sunder::mesh_asset(asset), argv[1]);
  std::printf("%u chunks\n", asset.walls[0].pattern.cell_count());
  return asset.walls[0].pattern.cell_count() > 100 ? 0 : 1;
}
