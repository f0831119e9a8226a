// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/building_keys.hpp"
#include "io/field_row.hpp"
#include "io/printable.hpp"
#include "io/report_schema.hpp"
#include "io/scene.hpp"
#include "io/scene_keys.hpp"
#include "io/suggest.hpp"
#include "meshing/error.hpp"

// The scene's schema is made of the tables that its reader uses.
namespace sunder {
namespace {

using Json = nlohmann::ordered_json;

/// Integers as integers: a schema's reader should not see 1.0.
Json json_number(double value) {
  if (value == std::floor(value) && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
  return value;
}

/// A number or integer and its valid values.
Json number_schema(const char* type, const Range& range) {
  Json schema{{"type", type}};
  if (std::isfinite(range.low)) {
    schema[range.open ? "exclusiveMinimum" : "minimum"] = json_number(range.low);
  }
  if (std::isfinite(range.high)) schema["maximum"] = json_number(range.high);
  return schema;
}

/// A list of `size` numbers.
Json tuple_schema(std::size_t size, const Range& range) {
  return {{"type", "array"},
          {"items", number_schema("number", range)},
          {"minItems", size},
          {"maxItems", size}};
}

Json list_schema(Json items, std::size_t least = 0) {
  Json schema{{"type", "array"}, {"items", std::move(items)}};
  if (least) schema["minItems"] = least;
  return schema;
}

Json text_schema(std::span<const std::string_view> choices = {}) {
  Json schema{{"type", "string"}};
  if (!choices.empty())
    schema["enum"] = Json(std::vector<std::string>(choices.begin(), choices.end()));
  return schema;
}

Json name_schema() {
  return {{"type", "string"}, {"pattern", std::string(kNamePattern)}};
}

Json reference(const std::string& definition) {
  return {{"$ref", "#/definitions/" + definition}};
}

std::string description_of(std::string_view effect, std::string_view unit) {
  return std::string(effect) + (unit.empty() ? "" : " Unit: " + std::string(unit) + '.');
}

/// An object with these properties and no other.
Json object_schema(Json properties, std::vector<std::string> required = {}) {
  Json schema{{"type", "object"}, {"properties", std::move(properties)}};
  if (!required.empty()) schema["required"] = std::move(required);
  schema["additionalProperties"] = false;
  return schema;
}

/// The schema of one field's values; the default stands there when a file could give it.
Json field_schema(const FieldRow& row) {
  const auto make = [&](const auto& value) -> Json {
    using T = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_same_v<T, double>) {
      return number_schema("number", row.range);
    } else if constexpr (std::is_same_v<T, std::int64_t>) {
      return number_schema("integer", row.range);
    } else if constexpr (std::is_same_v<T, bool>) {
      return {{"type", "boolean"}};
    } else if constexpr (std::is_same_v<T, std::string>) {
      return row.name == "name" ? name_schema() : text_schema(row.choices);
    } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
      Json schema = list_schema(text_schema(row.choices));
      schema["uniqueItems"] = true;
      return schema;
    } else if constexpr (std::is_same_v<T, Vec3>) {
      return tuple_schema(3, row.range);
    } else {
      const std::size_t size = std::is_same_v<T, std::vector<Vec2>> ? 2 : 3;
      return list_schema(tuple_schema(size, row.range), row.required ? 1 : 0);
    }
  };
  Json schema = std::visit(make, row.default_value);
  if (const auto* number = std::get_if<double>(&row.default_value)) {
    if (row.has_default()) schema["default"] = json_number(*number);
  } else if (const auto* integer = std::get_if<std::int64_t>(&row.default_value)) {
    schema["default"] = *integer;
  } else if (const auto* text = std::get_if<std::string>(&row.default_value)) {
    if (row.has_default()) schema["default"] = *text;
  } else if (const auto* truth = std::get_if<bool>(&row.default_value)) {
    schema["default"] = *truth;
  } else if (const auto* triple = std::get_if<Vec3>(&row.default_value)) {
    schema["default"] = {json_number(triple->x), json_number(triple->y), json_number(triple->z)};
  }
  schema["description"] = description_of(row.effect, row.unit);
  return schema;
}

/// An object with a struct's fields, after `properties` and `required`.
Json fields_schema(std::span<const FieldRow> rows, Json properties = Json::object(),
                   std::vector<std::string> required = {}) {
  for (const FieldRow& row : rows) {
    properties[std::string(row.name)] = field_schema(row);
    if (row.required) required.emplace_back(row.name);
  }
  return object_schema(std::move(properties), std::move(required));
}

/// Adds a row's description; a reference may not have siblings in this draft.
void add_key(Json& properties, const SceneKey& row, Json schema) {
  const std::string description = description_of(row.effect, row.unit);
  if (schema.contains("$ref")) schema = Json{{"allOf", Json::array({std::move(schema)})}};
  schema["description"] = description;
  properties[std::string(row.name)] = std::move(schema);
}

Json shape_schema() {
  const auto& [rect, at, polygon_row] = kShapeKeys;
  Json rectangle = Json::object(), polygon = Json::object();
  add_key(rectangle, rect, tuple_schema(2, rect.range));
  add_key(rectangle, at, tuple_schema(2, at.range));
  add_key(polygon, polygon_row, list_schema(tuple_schema(2, polygon_row.range), 3));
  return {{"oneOf", Json::array({object_schema(std::move(rectangle), {"rect"}),
                                 object_schema(std::move(polygon), {"polygon"})})}};
}

Json patterns_schema(std::span<const std::vector<FieldRow>> patterns,
                     std::span<const std::string_view> types,
                     std::span<const std::string_view> effects) {
  Json alternatives = Json::array();
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    Json properties{{"type", {{"const", std::string(types[i])}}}};
    Json schema = fields_schema(patterns[i], std::move(properties), {"type"});
    schema["description"] = std::string(effects[i]);
    alternatives.push_back(std::move(schema));
  }
  return {{"type", "object"}, {"oneOf", std::move(alternatives)}};
}

Json pattern_schema() {
  return patterns_schema(pattern_rows<PatternParams>(), kPatternTypes, kPatternEffects);
}

Json solid_pattern_schema() {
  Json schema =
      patterns_schema(pattern_rows<SolidPatternParams>(), kSolidPatternTypes, kSolidPatternEffects);
  for (Json& each : schema["oneOf"]) {
    if (each["properties"].contains("slices")) {
      each["properties"]["slices"]["items"]["type"] = "integer";
    }
  }
  return schema;
}

Json crater_schema() {
  const auto& [centre, into] = kCraterKeys;
  Json schema = fields_schema(field_rows<CarveParams>(), Json::object(), {"centre"});
  add_key(schema["properties"], centre, tuple_schema(3, centre.range));
  add_key(schema["properties"], into, tuple_schema(3, into.range));
  return schema;
}

Json solid_schema() {
  const std::array<Json, std::size(kSolidKeys)> schemas{
      reference("solid_pattern"), list_schema(reference("crater")), tuple_schema(3, kShapePlace),
      tuple_schema(3, kTurn)};
  Json schema = fields_schema(field_rows<SolidModel>());
  for (std::size_t i = 0; i < std::size(kSolidKeys); ++i) {
    add_key(schema["properties"], kSolidKeys[i], schemas[i]);
  }
  return schema;
}

Json wall_schema() {
  const std::array<Json, std::size(kWallKeys)> schemas{
      reference("shape"), list_schema(reference("shape")), reference("pattern"),
      tuple_schema(3, kShapePlace), tuple_schema(3, kTurn)};
  Json schema = fields_schema(field_rows<Wall>());
  for (std::size_t i = 0; i < std::size(kWallKeys); ++i) {
    add_key(schema["properties"], kWallKeys[i], schemas[i]);
  }
  schema["if"] = {{"required", {"asset"}}};
  schema["then"] = {{"properties",
                     {{"outline", false},
                      {"openings", false},
                      {"pattern", false},
                      {"material", {{"description", std::string(kAssetMaterial)}}}}}};
  return schema;
}

Json projectile_schema() {
  std::vector<std::string> required;
  for (const SceneKey& row : kProjectileKeys) required.emplace_back(row.name);
  Json schema = fields_schema(field_rows<Projectile>(), Json::object(), std::move(required));
  for (const SceneKey& row : kProjectileKeys) {
    add_key(schema["properties"], row, tuple_schema(3, row.range));
  }
  return schema;
}

Json integer_pair_schema(const Range& range) {
  Json schema = tuple_schema(2, range);
  schema["items"] = number_schema("integer", range);
  return schema;
}

/// Adds the rows of a table with their schemas.
template <std::size_t count>
void add_keys(Json& properties, const SceneKey (&table)[count],
              const std::array<Json, count>& schemas) {
  for (std::size_t i = 0; i < count; ++i) add_key(properties, table[i], schemas[i]);
}

/// A list of at most as many as a building's short lists have.
Json short_list_schema(Json items) {
  Json schema = list_schema(std::move(items));
  schema["maxItems"] = kMaxBuildingList;
  return schema;
}

Json distinct(Json list) {
  list["uniqueItems"] = true;
  return list;
}

/// Left out with `false`.
Json or_false(Json schema) {
  return {{"anyOf", Json::array({Json{{"const", false}}, std::move(schema)})}};
}

/// Slab or wall panel of every bay. Without defaults in an override, which changes what was before.
Json panel_schema(Json schema, bool is_override) {
  for (const char* key : {"thickness", "material"}) {
    if (is_override) schema["properties"][key].erase("default");
  }
  return or_false(std::move(schema));
}

void add_panel_keys(Json& schema) {
  add_keys(schema["properties"], kPanelKeys,
           std::array<Json, std::size(kPanelKeys)>{reference("pattern"), Json{{"type", "string"}}});
  schema["not"] = {{"required", {"pattern", "asset"}}};
}

Json slab_schema(bool is_override) {
  Json schema = fields_schema(field_rows<SlabParams>());
  add_panel_keys(schema);
  return panel_schema(std::move(schema), is_override);
}

Json walls_schema(bool is_override) {
  Json schema = fields_schema(field_rows<PanelParams>());
  add_panel_keys(schema);
  return panel_schema(std::move(schema), is_override);
}

Json override_schema() {
  Json schema = fields_schema(field_rows<StoreyParams>(), Json::object(), {"storeys"});
  for (Json& each : schema["properties"]) each.erase("default");
  add_keys(schema["properties"], kOverrideKeys,
           std::array<Json, std::size(kOverrideKeys)>{
               integer_pair_schema(kStoreyNumber), number_schema("number", kStoreyHeight),
               slab_schema(true), walls_schema(true), integer_pair_schema(kBayNumber),
               integer_pair_schema(kBayNumber)});
  return schema;
}

Json joint_class_schema() {
  std::vector<FieldRow> rows = field_rows<JointClass>();
  rows.erase(rows.begin());  // its name is the key
  Json schema = fields_schema(rows);
  for (const SceneKey& row : kJointKeys) {
    add_key(schema["properties"], row, tuple_schema(3, row.range));
  }
  const auto has = [](const char* key) { return Json{{"required", {key}}}; };
  schema["if"] = {{"anyOf", Json::array({has("force"), has("torque")})}};
  schema["then"] = {{"required", {"force", "torque"}}};
  return schema;
}

/// Fields of a struct and one required key beside them.
template <class Params>
Json given_schema(const SceneKey& row, Json value) {
  Json schema = fields_schema(field_rows<Params>(), Json::object(), {std::string(row.name)});
  add_key(schema["properties"], row, std::move(value));
  return schema;
}

Json corners_schema() {
  Json schema = distinct(list_schema(text_schema(), 4));
  schema["maxItems"] = 4;
  return schema;
}

/// A section or steel, whose names may have points.
template <class Params>
Json table_entry_schema() {
  Json schema = fields_schema(field_rows<Params>());
  schema["properties"]["name"]["pattern"] = std::string(kSectionNamePattern);
  for (Json& each : schema["properties"]) each.erase("default");
  return schema;
}

Json building_schema() {
  Json bay = tuple_schema(2, kBay);
  Json lengths = list_schema(number_schema("number", kBay), 1);
  lengths["maxItems"] = static_cast<std::size_t>(kPosts.high) - 1;
  bay["items"] = {{"anyOf", Json::array({number_schema("number", kBay), std::move(lengths)})}};
  Json part_pattern{{"type", "string"}, {"pattern", std::string(kPartPattern)}};
  Json joints{{"type", "object"},
              {"propertyNames", {{"pattern", std::string(kNamePattern)}}},
              {"additionalProperties", reference("joint_class")}};
  const std::array<Json, std::size(kBuildingKeys)> schemas{
      integer_pair_schema(kPosts),
      number_schema("integer", kStoreys),
      number_schema("number", kStoreyHeight),
      std::move(bay),
      slab_schema(false),
      walls_schema(false),
      tuple_schema(3, kBuildingPlace),
      short_list_schema(reference("override")),
      distinct(short_list_schema(std::move(part_pattern))),
      std::move(joints),
      list_schema(given_schema<FrameNode>(kNodePlace, tuple_schema(3, kNodePlace.range))),
      list_schema(fields_schema(field_rows<GivenMember>())),
      list_schema(given_schema<GivenSlab>(kSlabNodes, corners_schema())),
      list_schema(given_schema<GivenPanel>(kPanelNodes, corners_schema())),
      list_schema(fields_schema(field_rows<GivenJoint>())),
      short_list_schema(table_entry_schema<Section>()),
      short_list_schema(table_entry_schema<SteelGrade>())};
  Json schema = fields_schema(field_rows<StoreyParams>());
  add_keys(schema["properties"], kBuildingKeys, schemas);
  for (const FieldRow& row : field_rows<BreakingRules>()) {
    schema["properties"][std::string(row.name)] = field_schema(row);
  }
  return schema;
}

Json scenario_schema() {
  Json properties = Json::object();
  add_keys(properties, kScenarioKeys,
           std::array<Json, std::size(kScenarioKeys)>{distinct(short_list_schema(text_schema())),
                                                      number_schema("number", kLoadRate),
                                                      text_schema()});
  return object_schema(std::move(properties));
}

Json with_title(const std::string& title, Json schema) {
  Json whole{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
  whole.update(schema);
  return whole;
}

Json scene_schema() {
  Json version = number_schema("integer", kSceneVersion);
  Json seed{{"type", "integer"}, {"minimum", 0}, {"maximum", ~std::uint64_t{0}}, {"default", 1}};
  const std::array<Json, std::size(kSceneKeys)> schemas{text_schema(),
                                                        version,
                                                        seed,
                                                        list_schema(reference("wall")),
                                                        list_schema(reference("solid")),
                                                        list_schema(reference("material")),
                                                        list_schema(reference("projectile")),
                                                        reference("building"),
                                                        reference("scenario"),
                                                        reference("simulation"),
                                                        reference("hulls")};
  Json properties = Json::object();
  add_keys(properties, kSceneKeys, schemas);
  Json schema = object_schema(std::move(properties), {"sunder"});
  schema["anyOf"] = Json::array({Json{{"required", {"walls"}}}, Json{{"required", {"solids"}}},
                                 Json{{"required", {"building"}}}});
  schema["if"] = {{"required", {"scenario"}}};
  schema["then"] = {{"required", {"building"}}};
  schema["definitions"] = {{"wall", wall_schema()},
                           {"shape", shape_schema()},
                           {"pattern", pattern_schema()},
                           {"solid", solid_schema()},
                           {"solid_pattern", solid_pattern_schema()},
                           {"crater", crater_schema()},
                           {"material", fields_schema(field_rows<Material>())},
                           {"projectile", projectile_schema()},
                           {"building", building_schema()},
                           {"override", override_schema()},
                           {"joint_class", joint_class_schema()},
                           {"scenario", scenario_schema()},
                           {"simulation", fields_schema(field_rows<SimulationParams>())},
                           {"hulls", fields_schema(field_rows<HullParams>())}};
  return with_title("sunder scene", std::move(schema));
}

}  // namespace

std::string json_schema(std::string_view which) {
  if (which == "scene") return scene_schema().dump(2) + '\n';
  if (which == "material") {
    return with_title("sunder material", fields_schema(field_rows<Material>())).dump(2) + '\n';
  }
  if (which == "report") return report_schema();
  if (which == "impact-report") return impact_report_schema();
  if (which == "collapse-report") return collapse_report_schema();
  throw Error(ErrorCode::usage,
              "no schema of \"" + printable(which, 40) + '"' + hint_for(which, kSchemas));
}

}  // namespace sunder
