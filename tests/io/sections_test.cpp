// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/sections.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "io/strict_json.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

std::vector<Section> sections_with(const std::string& list) {
  const std::string file = "scene.json";
  const JsonValue root = parse_json(list, file);
  std::vector<Section> sections = builtin_sections();
  read_sections(Place(file, root), sections);
  return sections;
}

std::vector<SteelGrade> steels_with(const std::string& list) {
  const std::string file = "scene.json";
  const JsonValue root = parse_json(list, file);
  std::vector<SteelGrade> steels = builtin_steels();
  read_steels(Place(file, root), steels);
  return steels;
}

template <class Item>
const Item& named(const std::vector<Item>& items, const std::string& name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Item& each) { return each.name == name; });
  EXPECT_NE(found, items.end()) << name;
  return found == items.end() ? items.front() : *found;
}

std::string message_of(const std::string& list) {
  try {
    sections_with(list);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input);
    return error.what();
  }
  return "accepted";
}

TEST(SectionTables, HaveNamesThatDiffer) {
  std::set<std::string> names;
  for (const Section& each : builtin_sections()) {
    EXPECT_TRUE(names.insert(each.name).second) << each.name;
  }
  for (const char* name :
       {"HEA100", "HEB1000", "IPE80", "IPE600", "SHS100x5", "RHS200x100x8", "CHS168.3x8"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST(SectionTables, HaveTheGradesOfTheStandard) {
  const struct {
    const char* name;
    double yield, ultimate;
  } kGrades[] = {{"s235", 235e6, 360e6},
                 {"s275", 275e6, 430e6},
                 {"s355", 355e6, 490e6},
                 {"s420", 420e6, 520e6},
                 {"s460", 460e6, 540e6}};
  ASSERT_EQ(builtin_steels().size(), std::size(kGrades));
  for (const auto& grade : kGrades) {
    const SteelGrade& steel = named(builtin_steels(), grade.name);
    EXPECT_EQ(steel.yield_strength, grade.yield);
    EXPECT_EQ(steel.ultimate_strength, grade.ultimate);
    EXPECT_EQ(steel.density, 7850);
    EXPECT_EQ(steel.youngs_modulus, 210e9);
    EXPECT_NE(steel.source, "");
  }
}

TEST(SectionTables, TakeANewSectionByItsDimensions) {
  const auto sections = sections_with(
      R"([{"name": "box-1.5", "shape": "rhs", "height": 0.2, "width": 0.1, "web": 0.01},
          {"name": "pipe", "shape": "chs", "height": 0.2, "web": 0.01, "area": 0.005,
           "curve_y": "c"}])");
  EXPECT_EQ(sections.size(), builtin_sections().size() + 2);
  const Section& box = named(sections, "box-1.5");
  EXPECT_NEAR(box.area, 0.1 * 0.2 - 0.08 * 0.18, 1e-17);
  EXPECT_EQ(box.wpl_y, with_properties(box).wpl_y);
  EXPECT_EQ(box.curve_z, "a");
  const Section& pipe = named(sections, "pipe");
  EXPECT_EQ(pipe.width, 0.2);
  EXPECT_EQ(pipe.area, 0.005);
  EXPECT_EQ(pipe.iy, with_properties(pipe).iy);
  EXPECT_EQ(pipe.curve_y + pipe.curve_z, "ca");
}

TEST(SectionTables, ChangeTheValuesThatAKnownSectionGives) {
  const Section& printed = named(builtin_sections(), "HEB300");
  const auto changed = sections_with(R"([{"name": "HEB300", "wpl_y": 2e-3}])");
  EXPECT_EQ(changed.size(), builtin_sections().size());
  EXPECT_EQ(named(changed, "HEB300").wpl_y, 2e-3);
  EXPECT_EQ(named(changed, "HEB300").iy, printed.iy);
  EXPECT_EQ(named(changed, "HEB300").source, printed.source);
  // What follows from a changed dimension follows it.
  const auto higher = sections_with(R"([{"name": "HEB300", "height": 0.4, "it": 2e-6}])");
  const Section& post = named(higher, "HEB300");
  EXPECT_GT(post.iy, 1.5 * printed.iy);
  EXPECT_EQ(post.it, 2e-6);
  EXPECT_EQ(post.curve_y + post.curve_z, "ab");
}

TEST(SectionTables, RefuseWhatIsNoSection) {
  EXPECT_EQ(message_of(R"([{"name": "x"}])"),
            "scene.json:1: /0: the key \"shape\" is missing, for example \"shape\": \"i\"");
  EXPECT_EQ(message_of(R"([{"name": "x", "shape": "i", "height": 1, "width": 1, "web": 0.1}])"),
            "scene.json:1: /0: the key \"flange\" is missing, for example \"flange\": 0.019");
  EXPECT_EQ(message_of(R"([{"name": "x", "shape": "chs", "height": 0.1, "web": 0.05}])"),
            "scene.json:1: /0: 2 web = 0.1 m is not below the side = 0.1 m");
  EXPECT_EQ(message_of(R"([{"name": "HEB300", "flange": 0.15}])"),
            "scene.json:1: /0: 2 flange = 0.3 m is not below the height = 0.3 m");
  EXPECT_EQ(message_of(R"([{"name": "x y"}])"),
            "scene.json:1: /0/name: a name is 1 to 40 letters A-Z a-z, digits, _, - and ., got "
            "\"x y\"");
  EXPECT_EQ(message_of(R"([{"name": "IPE80", "area": 0}])"),
            "scene.json:1: /0/area: 0 is outside (0, 100] m²");
  EXPECT_NE(message_of(R"([{"name": "IPE80"}, {"name": "IPE80"}])").find("occurs twice"),
            std::string::npos);
  EXPECT_NE(message_of(R"([{"name": "IPE80", "higth": 1}])").find("did you mean \"height\""),
            std::string::npos);
  EXPECT_NE(message_of(R"([{"name": "IPE80", "curve_y": "e"}])").find("unknown word \"e\""),
            std::string::npos);
}

TEST(SectionTables, TakeSteels) {
  const auto steels = steels_with(
      R"([{"name": "s235", "yield_strength": 280e6},
          {"name": "s690", "yield_strength": 690e6, "ultimate_strength": 770e6}])");
  EXPECT_EQ(named(steels, "s235").yield_strength, 280e6);
  EXPECT_EQ(named(steels, "s235").ultimate_strength, 360e6);
  EXPECT_EQ(named(steels, "s690").yield_strength, 690e6);
  EXPECT_EQ(named(steels, "s690").density, 7850);
  EXPECT_THROW(steels_with(R"([{"name": "s690", "yield_strength": 690e6}])"), Error);
}

TEST(SectionTables, SuggestTheNameThatWasMeant) {
  EXPECT_EQ(section_fault(builtin_sections(), "HEB300"), "");
  EXPECT_EQ(steel_fault(builtin_steels(), "s355"), "");
  EXPECT_TRUE(section_fault(builtin_sections(), "heb3000")
                  .starts_with("unknown section \"heb3000\", did you mean \"HEB300\"?"));
  EXPECT_TRUE(steel_fault(builtin_steels(), "S356")
                  .starts_with("unknown steel \"S356\", did you mean \"s355\"?"));
}

}  // namespace
}  // namespace sunder
