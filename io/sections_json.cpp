// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <set>

#include "io/printable.hpp"
#include "io/scene_keys.hpp"
#include "io/sections.hpp"
#include "io/sections_text.hpp"
#include "io/strict_json.hpp"
#include "io/suggest.hpp"

namespace sunder {
namespace {

/// Unlike other names these may have a point: CHS168.3x8.
std::string section_name_at(const Place& place) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.";
  std::string name = text_at(place);
  if (name.empty() || name.size() > kMaxNameLength ||
      name.find_first_not_of(kLetters) != std::string::npos) {
    place.fail("a name is 1 to " + std::to_string(kMaxNameLength) +
               " letters A-Z a-z, digits, _, - and ., got " + describe(place.value));
  }
  return name;
}

bool gives_dimensions(const Place& section) {
  constexpr std::array<std::string_view, 6> kKeys{"shape", "height", "width",
                                                  "web",   "flange", "radius"};
  return std::any_of(kKeys.begin(), kKeys.end(),
                     [&](std::string_view key) { return section.value.find(key) != nullptr; });
}

void read_item(Section& section, const Place& place, bool is_new) {
  if (is_new) require_key(place, "shape", "\"shape\": \"i\"");
  read_fields(section, place);
  if (!is_new && !gives_dimensions(place)) return;
  if (is_new) {
    require_key(place, "height", "\"height\": 0.3");
    require_key(place, "web", "\"web\": 0.011");
    if (section.shape != "chs") require_key(place, "width", "\"width\": 0.3");
    if (section.shape == "i") require_key(place, "flange", "\"flange\": 0.019");
  }
  if (section.shape == "chs" && !place.value.find("width")) section.width = section.height;
  const std::string fault = dimension_fault(section);
  if (!fault.empty()) place.fail(fault);
  section = with_properties(section);
  read_fields(section, place);
}

void read_item(SteelGrade& steel, const Place& place, bool is_new) {
  if (is_new) {
    require_key(place, "yield_strength", "\"yield_strength\": 235e6");
    require_key(place, "ultimate_strength", "\"ultimate_strength\": 360e6");
  }
  read_fields(steel, place);
}

template <class Item>
void read_items(const Place& list, std::vector<Item>& items, std::string_view example) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < list_at(list).size(); ++i) {
    const Place place(list, i);
    check_keys(place, keys_of<Item>());
    require_key(place, "name", example);
    const Place name_place(place, "name", *place.value.find("name"));
    const std::string name = section_name_at(name_place);
    if (!names.insert(name).second) {
      name_place.fail(describe(name_place.value) + " occurs twice, names must differ");
    }
    auto item = std::find_if(items.begin(), items.end(),
                             [&](const Item& each) { return each.name == name; });
    const bool is_new = item == items.end();
    if (is_new) item = items.emplace(items.end());
    read_item(*item, place, is_new);
  }
}

template <class Item>
std::string fault_of(std::string_view kind, const std::vector<Item>& items,
                     const std::string& name) {
  std::vector<std::string_view> names;
  for (const Item& each : items) {
    if (each.name == name) return {};
    names.push_back(each.name);
  }
  return "unknown " + std::string(kind) + " \"" + printable(name, 40) + '"' + hint_for(name, names);
}

struct Tables {
  std::vector<Section> sections;
  std::vector<SteelGrade> steels;
};

Tables parse_builtin_tables() {
  const std::string file = "data/sections.json";
  const JsonValue root = parse_json(kSectionsText, file);
  const Place place(file, root);
  check_keys(place, std::array<std::string_view, 2>{"sections", "steels"});
  require_key(place, "sections", "\"sections\": []");
  require_key(place, "steels", "\"steels\": []");
  Tables tables;
  read_sections(Place(place, "sections", *root.find("sections")), tables.sections);
  read_steels(Place(place, "steels", *root.find("steels")), tables.steels);
  return tables;
}

const Tables& builtin_tables() {
  static const Tables tables = parse_builtin_tables();
  return tables;
}

}  // namespace

const std::vector<Section>& builtin_sections() {
  return builtin_tables().sections;
}

const std::vector<SteelGrade>& builtin_steels() {
  return builtin_tables().steels;
}

void read_sections(const Place& list, std::vector<Section>& sections) {
  read_items(list, sections, "\"name\": \"HEB300\"");
}

void read_steels(const Place& list, std::vector<SteelGrade>& steels) {
  read_items(list, steels, "\"name\": \"s235\"");
}

std::string section_fault(const std::vector<Section>& sections, const std::string& name) {
  return fault_of("section", sections, name);
}

std::string steel_fault(const std::vector<SteelGrade>& steels, const std::string& name) {
  return fault_of("steel", steels, name);
}

}  // namespace sunder
