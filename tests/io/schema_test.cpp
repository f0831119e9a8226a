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
  static const SchemaValidator validator(json_schema("scene"));
  return validator;
}

bool schema_accepts(const Json& scene) {
  return scene_validator().accepts(scene.dump());
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

/// Every value of a document, with its pointer.
void collect(const Json& value, const Pointer& place, std::map<std::string, Pointer>& places) {
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

/// Rules between keys or about files, which a JSON schema cannot tell.
bool is_beyond_schema(const std::string& message) {
  for (const char* rule : {"must not be above",
                           "exists already",
                           "unknown material",
                           "the asset ",
                           "no wall, solid or building",
                           "the model ",
                           "is a direction",
                           "\"density\" is missing",
                           "\" occurs twice, names must differ",
                           "may be named",
                           "the speed ",
                           "take a step of at least",
                           "unknown section",
                           "unknown steel",
                           "unknown node",
                           "unknown member",
                           "unknown joint class",
                           "no connection uses",
                           "is no support",
                           "does not end at",
                           "joined to itself",
                           "must be a first",
                           "do not fit",
                           " parts, the most is",
                           "goes with a regular building",
                           "no beam joins",
                           "no member joins",
                           "the building has no part",
                           "the ground motion",
                           "is what supports stand on",
                           "member \"",
                           "slab \"",
                           "wall panel \"",
                           "node \"",
                           "the frame ",
                           "matches none of its parts",
                           "occurs twice, give four",
                           "is given twice",
                           "\"shape\" is missing",
                           "\"height\" is missing",
                           "\"width\" is missing",
                           "\"web\" is missing",
                           "\"flange\" is missing",
                           "\"yield_strength\" is missing",
                           "\"ultimate_strength\" is missing"}) {
    if (message.find(rule) != std::string::npos) return true;
  }
  return false;
}

// --- Reader and schema against each other ----------------------------------------------------

/// Mutations of the scenes that between them give every key there is.
class SceneMutant : public testing::TestWithParam<const char*> {
 protected:
  const Json scene_ = Json::parse(GetParam());
};

INSTANTIATE_TEST_SUITE_P(Full, SceneMutant, testing::Values(kFullScene, kGivenScene),
                         [](const auto& row) {
                           return row.param == kFullScene ? "walls" : "building_part_by_part";
                         });

TEST_P(SceneMutant, AValueOfAnotherKindIsRefusedByNameAndBySchema) {
  const Json others[] = {nullptr, true, 1.5, "text", Json::array(), Json::object()};
  int count = 0;
  for (const auto& [name, place] : all_places(scene_)) {
    for (const Json& other : others) {
      if (is_same_kind(scene_[place], other)) continue;
      Json mutant = scene_;
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

TEST_P(SceneMutant, ANumberFarOutOfRangeIsRefusedByNameAndBySchema) {
  int count = 0;
  for (const auto& [name, place] : all_places(scene_)) {
    if (!scene_[place].is_number()) continue;
    for (const double value : {-1e30, 1e30}) {
      Json mutant = scene_;
      mutant[place] = value;
      const std::string message = refusal(mutant);
      EXPECT_NE(message.find(": " + name + ": "), std::string::npos) << name << ": " << message;
      EXPECT_FALSE(schema_accepts(mutant)) << name << " = " << value;
      ++count;
    }
  }
  EXPECT_GT(count, 90);
}

TEST_P(SceneMutant, AKeyTooManyIsRefusedByNameAndBySchema) {
  std::map<std::string, Pointer> places = all_places(scene_);
  places.emplace("", Pointer());
  for (const auto& [name, place] : places) {
    if (!scene_[place].is_object()) continue;
    Json mutant = scene_;
    mutant[place]["zzz"] = 1;
    const std::string message = refusal(mutant);
    // Keys of joints are names that the scene chooses.
    const std::string fault = name == "/building/joints" ? ": must be an object" : ": unknown key";
    EXPECT_NE(message.find(": " + name + "/zzz" + fault), std::string::npos) << message;
    EXPECT_FALSE(schema_accepts(mutant)) << name;
  }
}

TEST_P(SceneMutant, AMissingKeyIsReadOrRefusedAsTheSchemaSays) {
  int refused = 0;
  for (const auto& [name, place] : all_places(scene_)) {
    const Pointer parent = place.parent_pointer();
    if (!scene_[parent].is_object()) continue;
    Json mutant = scene_;
    mutant[parent].erase(place.back());
    const std::string message = refusal(mutant);
    if (is_beyond_schema(message)) continue;
    EXPECT_EQ(message.empty(), schema_accepts(mutant)) << name << ": " << message;
    refused += !message.empty();
  }
  EXPECT_GE(refused, 15);
}

TEST(SceneSchema, RefusesWhatTheReaderRefuses) {
  int checked = 0;
  for (const CorpusRow& row : read_corpus("rejected.txt")) {
        std::string message;
    try {
      parse_scene(row.text, "scene.json");
    } catch (const Error& error) {
      message = error.what();
    }
    // Syntax and what our parser adds to it are not a schema's matter.
    const bool is_repeated_key = message.find(": the key \"") != std::string::npos &&
                                 message.find("occurs twice") != std::string::npos;
    const bool is_parser = !Json::accept(row.text) || is_repeated_key ||
                           message.find("NUL") != std::string::npos ||
                           message.find("told from 0") != std::string::npos ||
                           message.find("64 bits") != std::string::npos;
    if (is_parser || is_beyond_schema(message)) continue;
    EXPECT_FALSE(scene_validator().accepts(row.text)) << row.name << ": " << message;
    ++checked;
  }
  EXPECT_GT(checked, 170);
}

TEST(SceneSchema, AcceptsWhatTheReaderReads) {
  for (const CorpusRow& row : read_corpus("accepted.txt")) {
    EXPECT_TRUE(scene_validator().accepts(row.text)) << row.name;
  }
  for (const char* scene : {kFullScene, kGivenScene}) {
    EXPECT_TRUE(schema_accepts(Json::parse(scene)));
  }
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
  std::vector<std::string> solid = table_keys<SolidModel>();
  for (const char* key : {"pattern", "craters", "position", "rotation_deg"})
    solid.emplace_back(key);
  EXPECT_EQ(property_keys(definitions["solid"]), solid);
  std::vector<std::string> crater = table_keys<CarveParams>();
  for (const char* key : {"centre", "into"}) crater.emplace_back(key);
  EXPECT_EQ(property_keys(definitions["crater"]), crater);
  EXPECT_EQ(definitions["solid_pattern"]["oneOf"].size(), std::size(kSolidPatternTypes));
  EXPECT_EQ(property_keys(definitions["hulls"]), table_keys<HullParams>());
  EXPECT_EQ(property_keys(schema).size(), 11u);
}

TEST(SceneSchema, HasEveryKeyOfABuilding) {
  const Json definitions = Json::parse(json_schema("scene"))["definitions"];
  const Json& properties = definitions["building"]["properties"];
  EXPECT_EQ(property_keys(definitions["building"]).size(),
            21u + table_keys<BreakingRules>().size());
  EXPECT_EQ(property_keys(definitions["override"]).size(), 10u);
  std::vector<std::string> joint = table_keys<JointClass>();
  joint.erase(joint.begin());  // its name is the key
  for (const char* key : {"force", "torque"}) joint.emplace_back(key);
  EXPECT_EQ(property_keys(definitions["joint_class"]), joint);
  EXPECT_EQ(property_keys(definitions["scenario"]),
            (std::vector<std::string>{"remove", "load_rate", "ground_motion"}));
  const auto keys = [&](const char* list) { return property_keys(properties[list]["items"]); };
  using Keys = std::vector<std::string>;
  EXPECT_EQ(keys("nodes"), (Keys{"name", "support", "at"}));
  EXPECT_EQ(keys("members"), (Keys{"name", "from", "to", "section", "steel", "kind", "roll_deg"}));
  EXPECT_EQ(keys("slabs"), (Keys{"name", "thickness", "material", "live_load", "nodes"}));
  EXPECT_EQ(keys("wall_panels"), (Keys{"name", "thickness", "material", "nodes"}));
  EXPECT_EQ(keys("connections"), (Keys{"of", "to", "at", "class"}));
  EXPECT_EQ(keys("sections"), table_keys<Section>());
  EXPECT_EQ(keys("steels"), table_keys<SteelGrade>());
}

TEST(SceneSchema, EveryDefaultIsValidByItself) {
  const Json schema = Json::parse(json_schema("scene"));
  const Json flat = schema.flatten();
  int count = 0;
  for (const auto& [name, value] : flat.items()) {
    if (!name.ends_with("/default")) continue;
    const Pointer place = Pointer(name).parent_pointer();
    const SchemaValidator validator(schema[place].dump());
    EXPECT_TRUE(validator.accepts(value.dump())) << name;
    ++count;
  }
  EXPECT_GT(count, 40);
}

TEST(SceneSchema, IsTheSameEveryTimeAndNamesItsDraft) {
  for (const char* which : {"scene", "material", "report", "impact-report", "collapse-report"}) {
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
  const SchemaValidator validator(json_schema("material"));
  std::ifstream in(std::string(SUNDER_SOURCE_DIR) + "/data/materials.json");
  const Json file = Json::parse(in);
  for (const Json& material : file.at("materials")) {
    EXPECT_TRUE(validator.accepts(material.dump())) << material["name"];
  }
  EXPECT_EQ(file.at("materials").size(), builtin_materials().size());
  EXPECT_FALSE(validator.accepts(R"({"name": "a b", "density": 1})"));
}

TEST(ReportSchema, DescribesEveryKeyThatIsWritten) {
  const Json schema = Json::parse(json_schema("report"));
  const SchemaValidator validator(schema.dump());
  Report report;
  report.version = "0.1.0";
  report.times = {{"pattern", 0.25}};
  report.skipped = {{"cells_exact", 3}};
  const Json written = Json::parse(report_json(report));
  for (const auto& [key, value] : written.items()) {
    EXPECT_TRUE(schema["properties"].contains(key)) << key;
  }
  EXPECT_EQ(written.size(), schema["properties"].size());
  EXPECT_TRUE(validator.accepts(written.dump())) << written.dump(1);
}

TEST(ReportSchema, RefusesAWrongReport) {
  const SchemaValidator validator(json_schema("report"));
  Json report = Json::parse(report_json(Report()));
  EXPECT_TRUE(validator.accepts(report.dump()));
  const std::pair<const char*, Json> rows[] = {
      {"chunks", -1},  {"chunks", 1.5},  {"hash", 7},
      {"hash", "xyz"}, {"sound", "yes"}, {"time", {{"pattern_s", -1}}}};
  for (const auto& [key, value] : rows) {
    Json wrong = report;
    wrong[key] = value;
    EXPECT_FALSE(validator.accepts(wrong.dump())) << key << " = " << value;
  }
  report.erase("hash");
  EXPECT_FALSE(validator.accepts(report.dump()));
}

TEST(Parameters, DocumentationIsFresh) {
  std::ifstream in(std::string(SUNDER_SOURCE_DIR) + "/docs/parameters.md");
  std::ostringstream text;
  text << in.rdbuf();
  EXPECT_EQ(text.str(), parameters_markdown()) << "docs/parameters.md is stale; run: ./dev docs";
}

}  // namespace
}  // namespace sunder
