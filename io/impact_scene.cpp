// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/impact_scene.hpp"

#include <algorithm>

#include "fracture/recover.hpp"
#include "io/import.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

// The wall of a file: its only one, or the one that has the scene wall's name.
const ImportedWall& choose_wall(const ImportedAsset& asset, const Wall& wall) {
  if (asset.walls.size() == 1) return asset.walls.front();
  const auto found = std::ranges::find(asset.walls, wall.name, &ImportedWall::name);
  if (found != asset.walls.end()) return *found;
  std::string names;
  for (const ImportedWall& each : asset.walls) names += (names.empty() ? "" : ", ") + each.name;
  throw Error(ErrorCode::input, wall.asset + ": holds several walls (" + names +
                                    "); give the scene's wall the name of one, not \"" + wall.name +
                                    "\"");
}

}  // namespace

ImpactWall import_wall(const Scene& scene, Wall wall) {
  const ImportedAsset asset = import_asset(wall.asset);
  if (!asset.has_chunks)
    throw Error(ErrorCode::input, wall.asset +
                                      ": the format keeps no chunks apart; an asset is a "
                                      ".glb, .gltf or .obj that sunder fracture wrote");
  const ImportedWall& imported = choose_wall(asset, wall);
  if (wall.material.empty()) wall.material = imported.material;
  if (wall.material.empty())
    throw Error(ErrorCode::input, wall.asset + ": names no material; give the scene's wall \"" +
                                      wall.name + "\" one");
  ImpactWall result;
  try {
    result.material = find_material(scene.materials, wall.material);
    result.asset = recover_wall(soup_of(asset, imported), wall, result.material.density);
  } catch (const Error& error) {
    throw Error(ErrorCode::input, wall.asset + ": " + error.what());
  }
  return result;
}

ImpactScene impact_scene(const Scene& scene, int threads, const Progress& progress) {
  ImpactScene result;
  result.seed = scene.seed;
  result.projectiles = scene.projectiles;
  result.simulation = scene.simulation;
  const auto count = static_cast<double>(scene.walls.size());
  for (const Wall& wall : scene.walls) {
    if (!wall.asset.empty()) {
      result.walls.push_back(import_wall(scene, wall));
      continue;
    }
    const double before = static_cast<double>(result.walls.size());
    const Progress part = [&](double done) {
      if (progress) progress((before + done) / count);
    };
    const Material& material = find_material(scene.materials, wall.material);
    const WallAsset asset = fracture_wall(wall, material.density, {scene.seed, threads, part});
    result.walls.push_back({at_file_precision(asset, threads), material});
  }
  return result;
}

}  // namespace sunder
