// SPDX-License-Identifier: GPL-3.0-or-later
#include <unordered_map>

#include "io/materials.hpp"
#include "io/printable.hpp"
#include "io/projectiles.hpp"
#include "io/scene_keys.hpp"

namespace sunder {
namespace {

/// The wall whose chunk would have this name ("facade_chunk_0012": "facade"); empty for none.
std::string wall_of_chunk(const std::string& name) {
  constexpr std::string_view kMiddle = "_chunk_", kDigits = "0123456789";
  const std::size_t end = name.find_last_not_of(kDigits) + 1;
  const bool is_chunk =
      end < name.size() && std::string_view(name).substr(0, end).ends_with(kMiddle);
  return is_chunk ? name.substr(0, end - kMiddle.size()) : std::string();
}

using Owners = std::unordered_map<std::string, const char*>;  // name → whose it is

void claim_name(Owners& owners, const Projectile& projectile, const Place& place) {
  const JsonValue* given = place.value.find("name");
  const auto fail = [&](const std::string& what) {
    (given ? Place(place, "name", *given) : place).fail(what + ", names must differ");
  };
  const std::string wall = wall_of_chunk(projectile.name);
  if (!wall.empty() && owners.contains(wall)) {
    fail("a chunk of the wall \"" + wall + "\" may be named \"" + projectile.name + '"');
  }
  const auto [owner, is_new] = owners.emplace(projectile.name, "projectile");
  if (!is_new) {
    fail("a " + std::string(owner->second) + " named \"" + projectile.name + "\" exists already");
  }
}

/// Each component is in range already; the speed is bounded as a whole too.
void check_speed(const Place& place, Vec3 velocity) {
  const double speed = length(velocity);
  if (speed > kVelocity.high) {
    place.fail("the speed " + number_text(speed) + " m/s is above " + number_text(kVelocity.high) +
               " m/s");
  }
}

Projectile read_projectile(const Place& place) {
  std::vector<std::string_view> keys = keys_of<Projectile>();
  append_keys(keys, kProjectileKeys);
  check_keys(place, keys);
  require_key(place, "position", "\"position\": [3, 1.5, 5]");
  require_key(place, "velocity", "\"velocity\": [0, 0, -10]");
  Projectile projectile;
  if (place.index > 0) projectile.name += '_' + std::to_string(place.index + 1);
  read_fields(projectile, place);
  if (const JsonValue* name = place.value.find("name")) name_at(Place(place, "name", *name));
  projectile.position =
      triple_at(Place(place, "position", *place.value.find("position")), kShapePlace, "m");
  const Place velocity(place, "velocity", *place.value.find("velocity"));
  projectile.velocity = triple_at(velocity, kVelocity, "m/s");
  check_speed(velocity, projectile.velocity);
  return projectile;
}

}  // namespace

std::vector<Projectile> read_projectiles(const Place& list, std::span<const Wall> walls,
                                         const Frame* building) {
  Owners owners;
  for (const Wall& wall : walls) owners.emplace(wall.name, "wall");
  for (std::uint32_t i = 0; building && i < building->part_count(); ++i) {
    owners.emplace(building->part_name(i), "part of the building");
  }
  std::vector<Projectile> projectiles;
  for (std::size_t i = 0; i < list_at(list).size(); ++i) {
    const Place place(list, i);
    projectiles.push_back(read_projectile(place));
    claim_name(owners, projectiles.back(), place);
  }
  return projectiles;
}

}  // namespace sunder
