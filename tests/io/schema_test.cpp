// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/json_place.hpp"
#include "io/report.hpp"
#include "io/scene.hpp"
#include "io/scene_corpus.hpp"
#include "io/schema_validator.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

using Json = nlohmann::ordered_json;
using Pointer = Json::json_pointer;

const SchemaValidator& scene_validator() {
  static const SchemaValidator validator(nlohmann::json::parse(json_schema("scene")));
  return validator;
}

bool schema_accepts(const Json& scene) {
  return scene_validator().accepts(nlohmann::json::parse(scene.dump()));
}

/// The message with which the reader refuses a scene; empty when it is read.
std::string refusal(const Json& scene) {
  try {
    parse_scene(scene.dump(), "scene.json");
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// Every value of a document, with its pointer; what no verb reads is left out.
void collect(const Json& value, const Pointer& place, std::map<std::string, Pointer>& places) {
  if (place.to_string().starts_with("/building/")) return;
  if (!place.empty()) places.emplace(place.to_string(), place);
  if (value.is_object()) {
    for (const auto& [key, each] : value.items()) collect(each, place / key, places);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) collect(value[i], place / i, places);
  }
}

std::map<std::string, Pointer> all_places(const Json& scene) {
  std::map<std::string, Pointer> places;
  collect(scene, Pointer(), places);
  return places;
}

bool is_same_kind(const Json& a, const Json& b) {
  return a.type() == b.type() || (a.is_number() && b.is_number());
}

// --- Reader and schema against each other ----------------------------------------------------

TEST(SceneMutant, AValueOfAnotherKindIsRefusedByNameAndBySchema) {
  const Json scene = Json::parse(kFullScene);
  const Json others[] = {nullptr, true, 1.5, "text", Json::array(), Json::object()};
  int count = 0;
  for (const auto& [name, place] : all_places(scene)) {
    for (const Json& other : others) {
      if (is_same_kind(scene[place], other)) continue;
      Json mutant = scene;
      mutant[place] = other;
      const std::string message = refusal(mutant);
      EXPECT_NE(message.find(": " + name + ": "), std::string::npos)
          << name << " = " << other << " gave: " << message;
      EXPECT_FALSE(schema_accepts(mutant)) << name << " = " << other;
      ++count;
    }
  }
  EXPECT_GT(count, 750);
}

TEST(SceneMutant, ANumberFarOutOfRangeIsRefusedByNameAndBySchema) {
  const Json scene = Json::parse(kFullScene);
  int count = 0;
  for (const auto& [name, place] : all_places(scene)) {
    if (!scene[place].is_number()) continue;
    for (const double value : {-1e30, 1e30}) {
      Json mutant = scene;
      mutant[place] = value;
      const std::string message = refusal(mutant);
      EXPECT_NE(message.find(": " + name + ": "), std::string::npos) << name << ": " << message;
      EXPECT_FALSE(schema_accepts(mutant)) << name << " = " << value;
      ++count;
    }
  }
  EXPECT_GT(count, 160);
}

TEST(SceneMutant, AKeyTooManyIsRefusedByNameAndBySchema) {
  const Json scene = Json::parse(kFullScene);
  std::map<std::string, Pointer> places = all_places(scene);
  places.emplace("", Pointer());
  for (const auto& [name, place] : places) {
    if (!scene[place].is_object() || name == "/building") continue;
    Json mutant = scene;
    mutant[place]["zzz"] = 1;
    const std::string message = refusal(mutant);
    EXPECT_NE(message.find(": " + name + "/zzz: unknown key"), std::string::npos) << message;
    EXPECT_FALSE(schema_accepts(mutant)) << name;
  }
}

TEST(SceneMutant, AMissingKeyIsReadOrRefusedAsTheSchemaSays) {
  const Json scene = Json::parse(kFullScene);
  int refused = 0;
  for (const auto& [name, place] : all_places(scene)) {
    const Pointer parent = place.parent_pointer();
    if (!scene[parent].is_object()) continue;
    Json mutant = scene;
    mutant[parent].erase(place.back());
    const std::string message = refusal(mutant);
    // What a single key cannot tell: the reader knows other keys and other files.
    const bool is_cross_rule = name == "/materials" || name == "/materials/0/density" ||
                               message.find("must not be above") != std::string::npos;
    if (is_cross_rule) continue;
    EXPECT_EQ(message.empty(), schema_accepts(mutant)) << name << ": " << message;
    refused += !message.empty();
  }
  EXPECT_GE(refused, 15);
}

/// Rules between keys or about files, which a JSON schema cannot tell.
bool is_beyond_schema(const std::string& message) {
  for (const char* rule :
       {"must not be above", "exists already", "unknown material", "the asset ", "an asset is",
        "no wall and no building", "\"density\" is missing", "\" occurs twice, names must differ",
        "may be named", "the speed ", "take a step of at least"}) {
    if (message.find(rule) != std::string::npos) return true;
  }
  return false;
}

TEST(SceneSchema, RefusesWhatTheReaderRefuses) {
  int checked = 0;
  for (const CorpusRow& row : read_corpus("rejected.txt")) {
    const nlohmann::json value = nlohmann::json::parse(row.text, nullptr, false);
    std::string message;
    try {
      parse_scene(row.text, "scene.json");
    } catch (const Error& error) {
      message = error.what();
    }
    // Syntax and what our parser adds to it are not a schema's matter.
    const bool is_repeated_key = message.find(": the key \"") != std::string::npos &&
                                 message.find("occurs twice") != std::string::npos;
    const bool is_parser = value.is_discarded() || is_repeated_key ||
                           message.find("NUL") != std::string::npos ||
                           message.find("told from 0") != std::string::npos ||
                           message.find("64 bits") != std::string::npos;
    if (is_parser || is_beyond_schema(message)) continue;
    EXPECT_FALSE(scene_validator().accepts(value)) << row.name << ": " << message;
    ++checked;
  }
  EXPECT_GT(checked, 170);
}

TEST(SceneSchema, AcceptsWhatTheReaderReads) {
  for (const CorpusRow& row : read_corpus("accepted.txt")) {
    EXPECT_TRUE(scene_validator().accepts(nlohmann::json::parse(row.text))) << row.name;
  }
  EXPECT_TRUE(schema_accepts(Json::parse(kFullScene)));
}

// --- Tables ----------------------------------------------------------------------------------

template <class Params>
std::vector<std::string> table_keys() {
  std::vector<std::string> keys;
  for (const std::string_view key : keys_of<Params>()) keys.emplace_back(key);
  return keys;
}

/// Keys of an object schema's properties.
std::vector<std::string> property_keys(const Json& schema) {
  std::vector<std::string> keys;
  for (const auto& [key, each] : schema.at("properties").items()) {
    EXPECT_TRUE(each.contains("description") || each.contains("const")) << key;
    keys.push_back(key);
  }
  return keys;
}

template <std::size_t i = 0>
void expect_patterns(const Json& alternatives) {
  if constexpr (i < std::variant_size_v<PatternParams>) {
    std::vector<std::string> keys = table_keys<std::variant_alternative_t<i, PatternParams>>();
    keys.insert(keys.begin(), "type");
    EXPECT_EQ(property_keys(alternatives[i]), keys) << kPatternTypes[i];
    EXPECT_EQ(alternatives[i]["properties"]["type"]["const"], kPatternTypes[i]);
    expect_patterns<i + 1>(alternatives);
  } else {
    EXPECT_EQ(alternatives.size(), i);
  }
}

TEST(SceneSchema, HasEveryKeyOfEveryTable) {
  const Json schema = Json::parse(json_schema("scene"));
  const Json& definitions = schema["definitions"];
  expect_patterns(definitions["pattern"]["oneOf"]);
  EXPECT_EQ(property_keys(definitions["material"]), table_keys<Material>());
  std::vector<std::string> wall = table_keys<Wall>();
  for (const char* key : {"outline", "openings", "pattern", "position", "rotation_deg"}) {
    wall.emplace_back(key);
  }
  EXPECT_EQ(property_keys(definitions["wall"]), wall);
  std::vector<std::string> projectile = table_keys<Projectile>();
  for (const char* key : {"position", "velocity"}) projectile.emplace_back(key);
  EXPECT_EQ(property_keys(definitions["projectile"]), projectile);
  EXPECT_EQ(property_keys(definitions["simulation"]), table_keys<SimulationParams>());
  EXPECT_EQ(property_keys(schema).size(), 8u);
}

TEST(SceneSchema, EveryDefaultIsValidByItself) {
  const Json schema = Json::parse(json_schema("scene"));
  const Json flat = schema.flatten();
  int count = 0;
  for (const auto& [name, value] : flat.items()) {
    if (!name.ends_with("/default")) continue;
    const Pointer place = Pointer(name).parent_pointer();
    const SchemaValidator validator(nlohmann::json::parse(schema[place].dump()));
    EXPECT_TRUE(validator.accepts(nlohmann::json::parse(value.dump()))) << name;
    ++count;
  }
  EXPECT_GT(count, 40);
}

TEST(SceneSchema, IsTheSameEveryTimeAndNamesItsDraft) {
  for (const char* which : {"scene", "material", "report", "impact-report"}) {
    const std::string text = json_schema(which);
    EXPECT_EQ(text, json_schema(which));
    EXPECT_EQ(Json::parse(text)["$schema"], "http://json-schema.org/draft-07/schema#") << which;
  }
}

TEST(SceneSchema, AnotherNameIsAUsageError) {
  try {
    json_schema("scenes");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(std::string(error.what()).find("did you mean \"scene\"?"), std::string::npos);
  }
}

TEST(MaterialSchema, AcceptsTheBuiltInMaterials) {
  const SchemaValidator validator(nlohmann::json::parse(json_schema("material")));
  std::ifstream in(std::string(SUNDER_SOURCE_DIR) + "/data/materials.json");
  const nlohmann::json file = nlohmann::json::parse(in);
  for (const nlohmann::json& material : file.at("materials")) {
    EXPECT_TRUE(validator.accepts(material)) << material["name"];
  }
  EXPECT_EQ(file.at("materials").size(), builtin_materials().size());
  EXPECT_FALSE(validator.accepts(nlohmann::json{{"name", "a b"}, {"density", 1}}));
}

TEST(ReportSchema, DescribesEveryKeyThatIsWritten) {
  const Json schema = Json::parse(json_schema("report"));
  const SchemaValidator validator(nlohmann::json::parse(schema.dump()));
  Report report;
  report.version = "0.1.0";
  report.times = {{"pattern", 0.25}};
  report.skipped = {{"cells_exact", 3}};
  const Json written = Json::parse(report_json(report));
  for (const auto& [key, value] : written.items()) {
    EXPECT_TRUE(schema["properties"].contains(key)) << key;
  }
  EXPECT_EQ(written.size(), schema["properties"].size());
  EXPECT_TRUE(validator.accepts(nlohmann::json::parse(written.dump()))) << written.dump(1);
}

TEST(ReportSchema, RefusesAWrongReport) {
  const SchemaValidator validator(nlohmann::json::parse(json_schema("report")));
  nlohmann::json report = nlohmann::json::parse(report_json(Report()));
  EXPECT_TRUE(validator.accepts(report));
  const std::pair<const char*, nlohmann::json> rows[] = {
      {"chunks", -1},  {"chunks", 1.5},  {"hash", 7},
      {"hash", "xyz"}, {"sound", "yes"}, {"time", {{"pattern_s", -1}}}};
  for (const auto& [key, value] : rows) {
    nlohmann::json wrong = report;
    wrong[key] = value;
    EXPECT_FALSE(validator.accepts(wrong)) << key << " = " << value;
  }
  report.erase("hash");
  EXPECT_FALSE(validator.accepts(report));
}

TEST(Parameters, DocumentationIsFresh) {
  std::ifstream in(std::string(SUNDER_SOURCE_DIR) + "/docs/parameters.md");
  std::ostringstream text;
  text << in.rdbuf();
  EXPECT_EQ(text.str(), parameters_markdown()) << "docs/parameters.md is stale; run: ./dev docs";
}

}  // namespace
}  // namespace sunder
