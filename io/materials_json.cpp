// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <set>

#include "io/materials.hpp"
#include "io/materials_text.hpp"
#include "io/printable.hpp"
#include "io/scene_keys.hpp"
#include "io/strict_json.hpp"
#include "io/suggest.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

Material* find(std::vector<Material>& materials, const std::string& name) {
  const auto found = std::find_if(materials.begin(), materials.end(),
                                  [&](const Material& each) { return each.name == name; });
  return found == materials.end() ? nullptr : &*found;
}

std::vector<Material> parse_builtin_materials() {
  const std::string file = "data/materials.json";
  const JsonValue root = parse_json(kMaterialsText, file);
  const Place place(file, root);
  check_keys(place, std::array<std::string_view, 1>{"materials"});
  require_key(place, "materials", "\"materials\": []");
  std::vector<Material> materials;
  read_materials(Place(place, "materials", *root.find("materials")), materials);
  return materials;
}

}  // namespace

bool is_name(std::string_view text) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  return !text.empty() && text.size() <= kMaxNameLength &&
         text.find_first_not_of(kLetters) == std::string_view::npos;
}

std::string name_at(const Place& place) {
  std::string name = text_at(place);
  if (!is_name(name)) {
    place.fail("a name is 1 to " + std::to_string(kMaxNameLength) +
               " letters A-Z a-z, digits, _ and -, got " + describe(place.value));
  }
  return name;
}

void read_materials(const Place& list, std::vector<Material>& materials) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < list_at(list).size(); ++i) {
    const Place place(list, i);
    check_keys(place, keys_of<Material>());
    require_key(place, "name", "\"name\": \"granite\"");
    const Place name_place(place, "name", *place.value.find("name"));
    const std::string name = name_at(name_place);
    if (!names.insert(name).second) {
      name_place.fail(describe(name_place.value) + " occurs twice, names must differ");
    }
    Material* known = find(materials, name);
    if (!known) {
      require_key(place, "density", "\"density\": 2400");
      materials.emplace_back();
      known = &materials.back();
    }
    read_fields(*known, place);
  }
}

const std::vector<Material>& builtin_materials() {
  static const std::vector<Material> materials = parse_builtin_materials();
  return materials;
}

std::string material_fault(const std::vector<Material>& materials, const std::string& name) {
  std::vector<std::string_view> names;
  for (const Material& each : materials) {
    if (each.name == name) return {};
    names.push_back(each.name);
  }
  return "unknown material \"" + printable(name, 40) + '"' + hint_for(name, names);
}

const Material& find_material(const std::vector<Material>& materials, const std::string& name) {
  const std::string fault = material_fault(materials, name);
  if (!fault.empty()) throw Error(ErrorCode::input, fault);
  return *std::find_if(materials.begin(), materials.end(),
                       [&](const Material& each) { return each.name == name; });
}

}  // namespace sunder
