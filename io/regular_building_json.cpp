// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "io/building.hpp"
#include "io/materials.hpp"
#include "io/patterns.hpp"
#include "io/printable.hpp"
#include "io/sections.hpp"

namespace sunder {
namespace {

/// The value of "slab" or "walls" of an object when it is there and not false.
const JsonValue* panel_of(const Place& owner, std::string_view key, double& thickness) {
  const JsonValue* value = owner.value.find(key);
  if (!value) return nullptr;
  if (value->members()) return value;
  const bool is_none = value->boolean() && !*value->boolean();
  if (!is_none) Place(owner, key, *value).fail_kind("false or an object {…}");
  thickness = 0;
  return nullptr;
}

/// How a panel breaks, if its object says so.
void read_panel_pattern(std::optional<PanelPattern>& result, const Place& panel,
                        const SceneFolder& folder) {
  const JsonValue* pattern = panel.value.find("pattern");
  const JsonValue* asset = panel.value.find("asset");
  if (pattern && asset)
    Place(panel, "pattern", *pattern)
        .fail("\"pattern\" does not go with \"asset\", whose file has its own; leave one out");
  if (pattern)
    result = PanelPattern{
        .pattern = read_pattern(Place(panel, "pattern", *pattern)), .min_cell = -1, .asset = {}};
  if (asset) {
    result = PanelPattern{};
    result->asset = path_at(Place(panel, "asset", *asset), "asset", folder);
  }
}

void read_slab(StoreyParams& storey, const Place& owner, const SceneFolder& folder) {
  const JsonValue* value = panel_of(owner, "slab", storey.slab_thickness);
  if (!value) return;
  SlabParams slab{.material = storey.slab_material};
  if (storey.slab_thickness > 0) slab.thickness = storey.slab_thickness;
  read_fields(slab, Place(owner, "slab", *value));
  storey.slab_thickness = slab.thickness;
  storey.slab_material = slab.material;
  read_panel_pattern(storey.slab_pattern, Place(owner, "slab", *value), folder);
}

void read_walls(StoreyParams& storey, const Place& owner, const SceneFolder& folder) {
  const JsonValue* value = panel_of(owner, "walls", storey.wall_thickness);
  if (!value) return;
  PanelParams panel{.material = storey.wall_material};
  if (storey.wall_thickness > 0) panel.thickness = storey.wall_thickness;
  read_fields(panel, Place(owner, "walls", *value));
  storey.wall_thickness = panel.thickness;
  storey.wall_material = panel.material;
  read_panel_pattern(storey.wall_pattern, Place(owner, "walls", *value), folder);
}

/// What building and overrides have in common; see check_storey.
void read_storey(StoreyParams& storey, const Place& owner, const SceneFolder& folder) {
  read_fields(storey, owner);
  read_slab(storey, owner, folder);
  read_walls(storey, owner, folder);
}

void check_material(const Place& panel, const Frame& tables) {
  const JsonValue* material = panel.value.find("material");
  if (!material) return;
  const Place place(panel, "material", *material);
  const std::string fault = material_fault(tables.materials, text_at(place));
  if (!fault.empty()) place.fail(fault);
}

/// The keys and names that read_storey takes as they are: once, not for every storey.
void check_storey(const Place& owner, const Frame& tables) {
  for (const std::string_view key : {"post_section", "beam_section", "steel"}) {
    const JsonValue* value = owner.value.find(key);
    if (!value) continue;
    const Place place(owner, key, *value);
    const std::string name = text_at(place);
    const std::string fault =
        key == "steel" ? steel_fault(tables.steels, name) : section_fault(tables.sections, name);
    if (!fault.empty()) place.fail(fault);
  }
  if (const JsonValue* slab = owner.value.find("slab"); slab && slab->members()) {
    const Place place(owner, "slab", *slab);
    check_keys(place, keys_of<SlabParams>({"pattern", "asset"}));
    check_material(place, tables);
  }
  if (const JsonValue* walls = owner.value.find("walls"); walls && walls->members()) {
    const Place place(owner, "walls", *walls);
    check_keys(place, keys_of<PanelParams>({"pattern", "asset"}));
    check_material(place, tables);
  }
}

/// Two whole numbers.
std::array<std::uint32_t, 2> whole_pair_at(const Place& place, const Range& range) {
  if (!place.value.items() || place.value.items()->size() != 2) {
    place.fail_kind("a list of 2 whole numbers");
  }
  return {static_cast<std::uint32_t>(integer_at(Place(place, 0), range)),
          static_cast<std::uint32_t>(integer_at(Place(place, 1), range))};
}

/// Lengths of the bays along x (0) or z (1). `posts` is 0 when the file does not say.
std::vector<double> read_bays(const Place& bay, std::size_t axis, std::uint32_t posts) {
  const Place place(bay, axis);
  if (!place.value.items()) {
    if (!place.value.is_number()) place.fail_kind("a length or a list of lengths");
    return std::vector<double>(std::max(posts, 2u) - 1, number_at(place, kBay, "m"));
  }
  const std::size_t count = list_at(place).size();
  const auto most = static_cast<std::size_t>(kPosts.high) - 1;
  if (count == 0 || count > most) {
    place.fail_kind("a length or a list of 1 to " + std::to_string(most) + " lengths");
  }
  if (posts && count != posts - 1) {
    place.fail(std::to_string(count) + " lengths do not fit " + std::to_string(posts) +
               " posts along " + (axis ? "z" : "x") + ", which have " + std::to_string(posts - 1) +
               " bays between them");
  }
  std::vector<double> lengths;
  for (std::size_t i = 0; i < count; ++i) lengths.push_back(number_at(Place(place, i), kBay, "m"));
  return lengths;
}

void read_grid(RegularBuilding& building, const Place& place) {
  std::array<std::uint32_t, 2> posts{};
  if (const JsonValue* value = place.value.find("posts")) {
    posts = whole_pair_at(Place(place, "posts", *value), kPosts);
  }
  const JsonValue* value = place.value.find("bay");
  if (!value) {
    constexpr double kUsualBay = 6;  // m
    building.bays_x.assign(std::max(posts[0], 2u) - 1, kUsualBay);
    building.bays_z.assign(std::max(posts[1], 2u) - 1, kUsualBay);
    return;
  }
  const Place bay(place, "bay", *value);
  if (!value->items() || value->items()->size() != 2) {
    bay.fail_kind("a list of 2 lengths (m), each may be a list of lengths");
  }
  building.bays_x = read_bays(bay, 0, posts[0]);
  building.bays_z = read_bays(bay, 1, posts[1]);
}

/// Bays [first, end) of a set-back.
void read_range(std::array<std::uint32_t, 2>& range, const Place& owner, std::string_view key,
                std::size_t bays) {
  const JsonValue* value = owner.value.find(key);
  if (!value) return;
  const Place place(owner, key, *value);
  range = whole_pair_at(place, kBayNumber);
  if (range[0] >= range[1] || range[1] > bays) {
    place.fail('[' + std::to_string(range[0]) + ", " + std::to_string(range[1]) +
               "] must be a first bay and an end above it, at most " + std::to_string(bays));
  }
}

void read_override(RegularBuilding& building, const Place& place, const Frame& tables,
                   const SceneFolder& folder) {
  std::vector<std::string_view> keys = keys_of<StoreyParams>();
  append_keys(keys, kOverrideKeys);
  check_keys(place, keys);
  require_key(place, "storeys", "\"storeys\": [0, 1]");
  const Place range(place, "storeys", *place.value.find("storeys"));
  const auto [first, last] = whole_pair_at(range, kStoreyNumber);
  if (first > last || last >= building.storeys.size()) {
    range.fail('[' + std::to_string(first) + ", " + std::to_string(last) +
               "] must be a first and a last storey, at most " +
               std::to_string(building.storeys.size() - 1));
  }
  check_storey(place, tables);
  for (std::uint32_t i = first; i <= last; ++i) {
    StoreyParams& storey = building.storeys[i];
    read_storey(storey, place, folder);
    if (const JsonValue* height = place.value.find("height")) {
      storey.height = number_at(Place(place, "height", *height), kStoreyHeight, "m");
    }
    read_range(storey.bays_x, place, "bays_x", building.bays_x.size());
    read_range(storey.bays_z, place, "bays_z", building.bays_z.size());
  }
}

/// Parts of the whole grid, set-backs and `without` not taken off.
double parts_of(double posts_x, double posts_z, const StoreyParams& storey) {
  const double bays_x = posts_x - 1, bays_z = posts_z - 1;
  const double members = posts_x * posts_z + bays_x * posts_z + posts_x * bays_z;
  return members + (storey.slab_thickness > 0 ? bays_x * bays_z : 0) +
         (storey.wall_thickness > 0 ? 2 * (bays_x + bays_z) : 0);
}

void check_parts(const Place& place, const RegularBuilding& building) {
  const auto posts_x = static_cast<double>(building.bays_x.size() + 1);
  const auto posts_z = static_cast<double>(building.bays_z.size() + 1);
  double parts = 0;
  for (const StoreyParams& storey : building.storeys) parts += parts_of(posts_x, posts_z, storey);
  if (parts <= static_cast<double>(kMaxParts)) return;
  place.fail(number_text(posts_x) + " x " + number_text(posts_z) + " posts and " +
             std::to_string(building.storeys.size()) + " storeys make " + number_text(parts) +
             " parts, the most is " + std::to_string(kMaxParts));
}

std::vector<std::string> read_without(const Place& list) {
  check_count(list);
  std::vector<std::string> names = texts_at(list, {});
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string letters = names[i];
    std::replace(letters.begin(), letters.end(), '*', '_');
    if (!is_name(letters)) {
      const Place place(list, i);
      place.fail("must be the name of a part, * stands for any text, got " + describe(place.value));
    }
  }
  return names;
}

bool has_regular(const Place& building) {
  const auto has = [&](std::string_view key) { return building.value.find(key) != nullptr; };
  return !has("nodes") || has("posts") || has("storeys") || has("bay");
}

}  // namespace

StoreyParams read_common_storey(const Place& building, const Frame& tables,
                                const SceneFolder& folder) {
  StoreyParams storey;
  check_storey(building, tables);
  read_storey(storey, building, folder);
  if (const JsonValue* height = building.value.find("storey_height")) {
    storey.height = number_at(Place(building, "storey_height", *height), kStoreyHeight, "m");
  }
  return storey;
}

std::optional<RegularBuilding> read_regular(const Place& building, const Frame& tables,
                                            const StoreyParams& common, const SceneFolder& folder) {
  if (!has_regular(building)) {
    for (const std::string_view key : {"storey_height", "overrides", "without"}) {
      if (const JsonValue* value = building.value.find(key)) {
        Place(building, key, *value)
            .fail('"' + std::string(key) +
                  "\" goes with a regular building, give \"posts\", \"bay\" or \"storeys\" too");
      }
    }
    return std::nullopt;
  }
  RegularBuilding regular;
  read_grid(regular, building);
  std::int64_t storeys = 1;
  if (const JsonValue* value = building.value.find("storeys")) {
    storeys = integer_at(Place(building, "storeys", *value), kStoreys);
  }
  regular.storeys.assign(static_cast<std::size_t>(storeys), common);
  if (const JsonValue* value = building.value.find("overrides")) {
    const Place list(building, "overrides", *value);
    check_count(list);
    for (std::size_t i = 0; i < value->items()->size(); ++i) {
      read_override(regular, Place(list, i), tables, folder);
    }
  }
  if (const JsonValue* value = building.value.find("position")) {
    regular.position = triple_at(Place(building, "position", *value), kBuildingPlace, "m");
  }
  if (const JsonValue* value = building.value.find("without")) {
    regular.without = read_without(Place(building, "without", *value));
  }
  check_parts(building, regular);
  return regular;
}

}  // namespace sunder
