// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/collapse_scene.hpp"

#include "io/impact_scene.hpp"
#include "meshing/error.hpp"

namespace sunder {

CollapseScene collapse_scene(const Scene& scene) {
  if (!scene.building) {
    throw Error(ErrorCode::input,
                "the scene has no building to bring down, give it one, for example \"building\": "
                "{\"posts\": [4, 5], \"storeys\": 6}");
  }
  std::vector<std::optional<WallAsset>> assets;
  for (const PanelPattern& pattern : scene.building->patterns) {
    assets.emplace_back();
    if (pattern.asset.empty()) continue;
    Wall wall;
    wall.asset = pattern.asset;
    wall.material = "concrete-c30";  // the panel's own counts
    wall.anchors = {"bottom", "left", "right", "top"};
    assets.back() = import_wall(scene, wall).asset;
  }
  return {.seed = scene.seed,
          .frame = *scene.building,
          .assets = std::move(assets),
          .projectiles = scene.projectiles,
          .scenario = scene.scenario,
          .rules = scene.rules,
          .simulation = scene.simulation};
}

}  // namespace sunder
