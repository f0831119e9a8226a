// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <unordered_set>

#include "io/asset_path.hpp"
#include "io/building.hpp"
#include "io/materials.hpp"
#include "io/overrides.hpp"
#include "io/patterns.hpp"
#include "io/printable.hpp"
#include "io/projectiles.hpp"
#include "io/scenario.hpp"
#include "io/scene.hpp"
#include "io/scene_keys.hpp"
#include "io/solids.hpp"
#include "io/strict_json.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

namespace fs = std::filesystem;

Loop read_shape(const Place& place) {
  std::vector<std::string_view> keys;
  append_keys(keys, kShapeKeys);
  check_keys(place, keys);
  const JsonValue* rect = place.value.find("rect");
  const JsonValue* polygon = place.value.find("polygon");
  const JsonValue* at = place.value.find("at");
  if (!rect == !polygon) {
    place.fail("give one of \"rect\": [width, height] and \"polygon\": [[x, y], …], got " +
               std::string(rect ? "both" : "neither"));
  }
  if (polygon) {
    if (at) Place(place, "at", *at).fail("\"at\" goes with \"rect\", a polygon has its own place");
    return pairs_at(Place(place, "polygon", *polygon), 3, kShapePlace, "m");
  }
  const Vec2 size = pair_at(Place(place, "rect", *rect), kShapeSize, "m");
  return rectangle(size, at ? pair_at(Place(place, "at", *at), kShapePlace, "m") : Vec2{});
}

/// What reading one wall needs from the scene around it.
struct WallContext {
  const std::vector<Material>& materials;
  SceneFolder folder;
};

/// An asset brings its own outline, openings and pattern, and a material unless one is given.
void read_asset(Wall& wall, const Place& place, const WallContext& context) {
  const JsonValue* asset = place.value.find("asset");
  if (!asset) return;
  for (const std::string_view key : {"outline", "openings", "pattern"}) {
    if (const JsonValue* value = place.value.find(key)) {
      Place(place, key, *value)
          .fail('"' + std::string(key) +
                "\" does not go with \"asset\", whose file has its own; leave one out");
    }
  }
  if (!place.value.find("material")) wall.material.clear();
  wall.asset = path_at(Place(place, "asset", *asset), "asset", context.folder);
}

void read_region(Wall& wall, const Place& place) {
  if (const JsonValue* outline = place.value.find("outline")) {
    wall.region.outline = read_shape(Place(place, "outline", *outline));
  }
  if (const JsonValue* openings = place.value.find("openings")) {
    const Place list(place, "openings", *openings);
    for (std::size_t i = 0; i < list_at(list).size(); ++i) {
      wall.region.openings.push_back(read_shape(Place(list, i)));
    }
  }
}

Wall read_wall(const Place& place, const WallContext& context) {
  std::vector<std::string_view> keys = keys_of<Wall>();
  append_keys(keys, kWallKeys);
  check_keys(place, keys);
  Wall wall;
  wall.name = place.index == 0 ? "wall" : "wall_" + std::to_string(place.index + 1);
  read_fields(wall, place);
  if (const JsonValue* name = place.value.find("name")) name_at(Place(place, "name", *name));
  if (const JsonValue* material = place.value.find("material")) {
    const std::string fault = material_fault(context.materials, wall.material);
    if (!fault.empty()) Place(place, "material", *material).fail(fault);
  }
  read_asset(wall, place, context);
  read_region(wall, place);
  if (const JsonValue* pattern = place.value.find("pattern")) {
    wall.pattern = read_pattern(Place(place, "pattern", *pattern));
  }
  if (const JsonValue* position = place.value.find("position")) {
    wall.position = triple_at(Place(place, "position", *position), kShapePlace, "m");
  }
  if (const JsonValue* rotation = place.value.find("rotation_deg")) {
    wall.rotation =
        rotation_from_degrees(triple_at(Place(place, "rotation_deg", *rotation), kTurn, "degrees"));
  }
  return wall;
}

void read_walls(Scene& scene, const Place& list, const WallContext& context) {
  std::unordered_set<std::string> names;
  for (std::size_t i = 0; i < list_at(list).size(); ++i) {
    const Place place(list, i);
    scene.walls.push_back(read_wall(place, context));
    const std::string& name = scene.walls.back().name;
    if (!names.insert(name).second) {
      const JsonValue* given = place.value.find("name");
      (given ? Place(place, "name", *given) : place)
          .fail("a wall named \"" + name + "\" exists already, names must differ");
    }
  }
}

void check_version(const Place& scene) {
  require_key(scene, "sunder", "\"sunder\": 1");
  const Place place(scene, "sunder", *scene.value.find("sunder"));
  if (!place.value.is_number() || place.value.number() != kSceneVersion.low) {
    place.fail("must be 1, the version of the scene format, got " + describe(place.value));
  }
}

// Settings that a scene leaves open follow from the error it asks for.
std::optional<ErrorChoice> choose_open_settings(const Place& place, std::string_view job,
                                                SimulationParams& params) {
  if (!place.value.find("max_error")) return std::nullopt;
  std::vector<std::string_view> given;
  for (const JsonMember& member : object_at(place)) given.push_back(member.key);
  return choose_settings(error_front(job), given, params);
}

void read_simulation(const Place& place, Scene& scene) {
  constexpr double kMostSteps = 1e7;
  check_keys(place, keys_of<SimulationParams>());
  SimulationParams& params = scene.simulation;
  read_fields(params, place);
  scene.error_choice =
      choose_open_settings(place, scene.building ? "collapse" : "impact", params);
  const double steps = std::floor(params.duration / params.step);
  if (steps > kMostSteps) {
    const JsonValue* step = place.value.find("step");
    (step ? Place(place, "step", *step) : place)
        .fail("step = " + number_text(params.step) +
              " s cuts duration = " + number_text(params.duration) + " s into " +
              number_text(steps) + " steps, the most is " + number_text(kMostSteps) +
              "; take a step of at least " + number_text(params.duration / kMostSteps) + " s");
  }
}

void read_buildings(Scene& scene, const Place& place, const SceneFolder& folder) {
  if (const JsonValue* building = place.value.find("building")) {
    const Place at(place, "building", *building);
    scene.building = read_building(at, scene.materials, folder);
    read_fields(scene.rules, at);
  }
  const JsonValue* scenario = place.value.find("scenario");
  if (!scenario) return;
  const Place at(place, "scenario", *scenario);
  if (!scene.building) at.fail("happens to a building, the key \"building\" is missing");
  scene.scenario = read_scenario(at, *scene.building, folder);
  if (const JsonValue* motion = at.value.find("ground_motion")) {
    scene.ground_motion_file =
        path_at(Place(at, "ground_motion", *motion), "ground motion", folder);
  }
}

/// What stands beside walls, solids and buildings.
void read_run(Scene& scene, const Place& place) {
  if (const JsonValue* projectiles = place.value.find("projectiles")) {
    scene.projectiles = read_projectiles(Place(place, "projectiles", *projectiles), scene.walls,
                                         scene.building ? &*scene.building : nullptr);
  }
  if (const JsonValue* simulation = place.value.find("simulation")) {
    read_simulation(Place(place, "simulation", *simulation), scene);
  }
  if (const JsonValue* hulls = place.value.find("hulls")) {
    const Place at(place, "hulls", *hulls);
    check_keys(at, keys_of<HullParams>());
    read_fields(scene.hulls, at);
  }
}

Scene read_tree(const Place& place, const SceneFolder& folder) {
  std::vector<std::string_view> keys;
  append_keys(keys, kSceneKeys);
  check_keys(place, keys);
  check_version(place);
  Scene scene;
  scene.materials = builtin_materials();
  if (const JsonValue* schema = place.value.find("$schema")) {
    text_at(Place(place, "$schema", *schema));
  }
  if (const JsonValue* seed = place.value.find("seed")) {
    scene.seed = natural_at(Place(place, "seed", *seed));
  }
  if (const JsonValue* materials = place.value.find("materials")) {
    read_materials(Place(place, "materials", *materials), scene.materials);
  }
  for (const JsonMember& member : object_at(place)) scene.keys.push_back(member.key);
  const JsonValue* walls = place.value.find("walls");
  const WallContext context{scene.materials, folder};
  if (walls) read_walls(scene, Place(place, "walls", *walls), context);
  if (const JsonValue* solids = place.value.find("solids")) {
    std::unordered_set<std::string> names;
    for (const Wall& wall : scene.walls) names.insert(wall.name);
    scene.solids =
        read_solids(Place(place, "solids", *solids), scene.materials, folder, std::move(names));
  }
  if (scene.walls.empty() && scene.solids.empty() && !place.value.find("building")) {
    const std::string example = "for example \"walls\": [{\"outline\": {\"rect\": [6, 3]}}]";
    if (const JsonValue* solids = place.value.find("solids")) {
      Place(place, "solids", *solids).fail("no wall, solid or building, " + example);
    }
    if (walls) Place(place, "walls", *walls).fail("no wall, solid or building, " + example);
    place.fail("the key \"walls\" is missing, " + example);
  }
  read_buildings(scene, place, folder);
  read_run(scene, place);
  return scene;
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& name, const SceneParams& params) {
  JsonValue root = parse_json(text, name);
  const Place place(name, root);
  object_at(place);
  for (const std::string& override_text : params.overrides) apply_override(root, override_text);
  const fs::path folder = fs::path(name).parent_path();
  return read_tree(place, {folder, params.allow_outside});
}

Scene read_scene(const std::filesystem::path& path, const SceneParams& params) {
  return parse_scene(read_text_file(path), path.string(), params);
}

std::vector<std::string> given_keys(const Scene& scene,
                                    std::initializer_list<std::string_view> keys) {
  std::vector<std::string> given;
  for (const std::string_view key : keys) {
    if (std::find(scene.keys.begin(), scene.keys.end(), key) != scene.keys.end()) {
      given.emplace_back(key);
    }
  }
  return given;
}

}  // namespace sunder
