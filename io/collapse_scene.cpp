// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/collapse_scene.hpp"

#include "meshing/error.hpp"

namespace sunder {

CollapseScene collapse_scene(const Scene& scene) {
  if (!scene.building) {
    throw Error(ErrorCode::input,
                "the scene has no building to bring down, give it one, for example \"building\": "
                "{\"posts\": [4, 5], \"storeys\": 6}");
  }
  return {.seed = scene.seed,
          .frame = *scene.building,
          .projectiles = scene.projectiles,
          .scenario = scene.scenario,
          .rules = scene.rules,
          .simulation = scene.simulation};
}

}  // namespace sunder
