// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "io/export_files.hpp"
#include "io/import.hpp"
#include "io/materials.hpp"
#include "io/printable.hpp"
#include "io/scene_keys.hpp"
#include "io/solids.hpp"

namespace sunder {
namespace {

/// The place of a member that may be left out, else of the object.
Place place_of(const Place& object, std::string_view key) {
  const JsonValue* value = object.value.find(key);
  return value ? Place(object, key, *value) : object;
}

void check_direction(Vec3 direction, const Place& place) {
  if (direction == Vec3{}) place.fail("is a direction, [0, 0, 0] is none");
}

/// What a table cannot say of a pattern, and degrees to radians.
void finish(SolidVoronoiParams&, const Place&) {}
void finish(SolidSlicesParams& params, const Place& place) {
  const auto whole = [](double value) { return value == std::floor(value); };
  const Vec3 cuts = params.slices;
  if (!whole(cuts.x) || !whole(cuts.y) || !whole(cuts.z)) {
    place_of(place, "slices").fail("must be whole numbers of cuts along x, y and z");
  }
  params.angle_variation *= std::numbers::pi / 180;
}
void finish(SolidRadialParams& params, const Place& place) {
  check_direction(params.axis, place_of(place, "axis"));
}
void finish(SolidBrickParams&, const Place&) {}

template <class Params>
SolidPatternParams read_params(const Place& place) {
  check_keys(place, keys_of<Params>({"type"}));
  Params params;
  read_fields(params, place);
  finish(params, place);
  return params;
}

template <std::size_t... i>
SolidPatternParams read_pattern_of(std::size_t type, const Place& place,
                                   std::index_sequence<i...>) {
  using Reader = SolidPatternParams (*)(const Place&);
  constexpr Reader kReaders[] = {
      &read_params<std::variant_alternative_t<i, SolidPatternParams>>...};
  return kReaders[type](place);
}

SolidPatternParams read_solid_pattern(const Place& place) {
  constexpr std::size_t kTypes = std::variant_size_v<SolidPatternParams>;
  static_assert(std::size(kSolidPatternTypes) == kTypes);
  object_at(place);
  require_key(place, "type", "\"type\": \"voronoi\"");
  const std::string type =
      text_at(Place(place, "type", *place.value.find("type")), kSolidPatternTypes);
  const auto found = std::ranges::find(kSolidPatternTypes, type);
  return read_pattern_of(static_cast<std::size_t>(found - std::begin(kSolidPatternTypes)), place,
                         std::make_index_sequence<kTypes>());
}

CarveParams read_crater(const Place& place) {
  const auto& [centre, into] = kCraterKeys;
  std::vector<std::string_view> keys = keys_of<CarveParams>();
  append_keys(keys, kCraterKeys);
  check_keys(place, keys);
  CarveParams crater;
  read_fields(crater, place);
  require_key(place, centre.name, "\"centre\": [0, 0, 0]");
  crater.centre =
      triple_at(Place(place, centre.name, *place.value.find(centre.name)), centre.range, "m");
  crater.into = {};
  if (const JsonValue* value = place.value.find(into.name)) {
    const Place at(place, into.name, *value);
    crater.into = triple_at(at, into.range, "");
    check_direction(crater.into, at);
    crater.into = (1 / length(crater.into)) * crater.into;
  }
  return crater;
}

/// What stands beside the fields.
void read_keys(SolidModel& solid, const Place& place) {
  if (const JsonValue* pattern = place.value.find("pattern")) {
    solid.pattern = read_solid_pattern(Place(place, "pattern", *pattern));
  }
  if (const JsonValue* craters = place.value.find("craters")) {
    const Place list(place, "craters", *craters);
    for (std::size_t i = 0; i < list_at(list).size(); ++i) {
      solid.craters.push_back(read_crater(Place(list, i)));
    }
  }
  if (const JsonValue* position = place.value.find("position")) {
    solid.position = triple_at(Place(place, "position", *position), kShapePlace, "m");
  }
  if (const JsonValue* rotation = place.value.find("rotation_deg")) {
    solid.rotation =
        rotation_from_degrees(triple_at(Place(place, "rotation_deg", *rotation), kTurn, "degrees"));
  }
}

SolidModel read_solid(const Place& place, const std::vector<Material>& materials,
                      const SceneFolder& folder) {
  std::vector<std::string_view> keys = keys_of<SolidModel>();
  append_keys(keys, kSolidKeys);
  check_keys(place, keys);
  SolidModel solid;
  solid.name = place.index == 0 ? "solid" : "solid_" + std::to_string(place.index + 1);
  read_fields(solid, place);
  if (const JsonValue* name = place.value.find("name")) name_at(Place(place, "name", *name));
  const std::string fault = material_fault(materials, solid.material);
  if (!fault.empty()) place_of(place, "material").fail(fault);
  read_keys(solid, place);
  const Place file(place, "file", *place.value.find("file"));
  solid.file = path_at(file, "model", folder);
  if (!is_import_suffix(suffix_of(solid.file))) {
    file.fail("the model " + describe(file.value) + " is not .obj, .glb, .gltf, .stl or .ply");
  }
  return solid;
}

}  // namespace

std::vector<SolidModel> read_solids(const Place& list, const std::vector<Material>& materials,
                                    const SceneFolder& folder,
                                    std::unordered_set<std::string> names) {
  std::vector<SolidModel> solids;
  for (std::size_t i = 0; i < list_at(list).size(); ++i) {
    const Place place(list, i);
    solids.push_back(read_solid(place, materials, folder));
    const std::string& name = solids.back().name;
    if (!names.insert(name).second) {
      place_of(place, "name")
          .fail("a wall or solid named \"" + name + "\" exists already, names must differ");
    }
  }
  return solids;
}

}  // namespace sunder
