// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/building.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "io/collapse_scene.hpp"
#include "io/scenario.hpp"
#include "io/scene.hpp"
#include "io/scene_corpus.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

namespace fs = std::filesystem;

Scene scene_of(const std::string& building, const SceneParams& params = {}) {
  return parse_scene(R"({"sunder": 1, "building": )" + building + "}", "scene.json", params);
}

Frame frame_of(const std::string& building) {
  return *scene_of(building).building;
}

std::string refusal(const std::string& building, const SceneParams& params = {}) {
  try {
    scene_of(building, params);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "was read: " << building;
  return {};
}

template <class Named>
const Named& named(const std::vector<Named>& all, const std::string& name) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Named& each) { return each.name == name; });
  if (found == all.end()) throw std::out_of_range(name);
  return *found;
}

double load_of(const Frame& frame, const std::string& slab) {
  return named(frame.slabs, slab).live_load;
}

// --- Regular ---------------------------------------------------------------------------------

TEST(Building, TheExampleOfTheContractHasTheCountedParts) {
  const Frame frame = frame_of(R"({ "posts": [4, 5], "storeys": 6, "storey_height": 3.5,
      "bay": [6, 6], "post_section": "HEB300", "beam_section": "IPE300", "steel": "s235",
      "slab": {"thickness": 0.15, "material": "concrete-c30"},
      "walls": {"thickness": 0.1, "material": "brick",
                "pattern": {"type": "voronoi-grid", "cell": 0.6}}, "live_load": 2000 })");
  // 4 x 5 posts, 3 x 5 + 4 x 4 beams, 3 x 4 slabs, 2 (3 + 4) panels per storey.
  EXPECT_EQ(frame.members.size(), 6u * (20 + 31));
  EXPECT_EQ(frame.slabs.size(), 6u * 12);
  EXPECT_EQ(frame.walls.size(), 6u * 14);
  EXPECT_EQ(named(frame.nodes, "node_3_4_6").position, (Vec3{18, 21, 24}));
  EXPECT_EQ(frame.sections[named(frame.members, "post_3_4_5").section].name, "HEB300");
  EXPECT_EQ(frame.sections[named(frame.members, "beam_z_3_3_5").section].name, "IPE300");
  EXPECT_EQ(frame.steels[named(frame.members, "post_3_4_5").steel].name, "s235");
  EXPECT_EQ(named(frame.slabs, "slab_2_3_5").thickness, 0.15);
  EXPECT_EQ(load_of(frame, "slab_2_3_5"), 2000);
  EXPECT_EQ(frame.materials[frame.walls.back().material].name, "brick");
  EXPECT_EQ(frame.walls.back().thickness, 0.1);
  EXPECT_TRUE(defects_of(frame).empty());
}

TEST(Building, WhatIsNotGivenIsAsTheContractSays) {
  const Frame frame = frame_of("{}");
  EXPECT_EQ(frame.members.size(), 8u);
  EXPECT_TRUE(frame.walls.empty());
  ASSERT_EQ(frame.slabs.size(), 1u);
  EXPECT_EQ(frame.slabs[0].thickness, 0.15);
  EXPECT_EQ(frame.slabs[0].live_load, 0);
  EXPECT_EQ(frame.materials[frame.slabs[0].material].name, "concrete-c30");
  EXPECT_EQ(named(frame.nodes, "node_1_1_1").position, (Vec3{6, 3.5, 6}));
  const BreakingRules rules = scene_of("{}").rules;
  EXPECT_EQ(rules.post_rule, "ec3");
  EXPECT_TRUE(rules.breaking && rules.hit_breaks);
}

TEST(Building, TheDefaultsOfTheTablesAreThoseOfTheStorey) {
  const StoreyParams storey;
  EXPECT_EQ(SlabParams{}.thickness, storey.slab_thickness);
  EXPECT_EQ(SlabParams{}.material, storey.slab_material);
  EXPECT_EQ(PanelParams{}.material, storey.wall_material);
  for (const SceneKey& key : kBuildingKeys) {
    if (key.name == "storey_height") {
      EXPECT_EQ(std::stod(std::string(key.default_value)), storey.height);
    }
  }
}

TEST(Building, SlabsAndWallsMayBeLeftOut) {
  const Frame frame = frame_of(R"({"slab": false, "walls": false})");
  EXPECT_TRUE(frame.slabs.empty());
  EXPECT_TRUE(frame.walls.empty());
  EXPECT_EQ(frame_of(R"({"walls": {}})").walls.size(), 4u);
  EXPECT_EQ(frame_of(R"({"walls": {}})").walls[0].thickness, PanelParams{}.thickness);
}

TEST(Building, BaysOfTheirOwnSayHowManyPostsThereAre) {
  const Frame frame = frame_of(R"({"bay": [[6, 4.5, 3], 5], "position": [1, 2, 3]})");
  EXPECT_EQ(frame.members.size(), 8u + 6u + 4u);
  EXPECT_EQ(named(frame.nodes, "node_0_0_0").position, (Vec3{1, 2, 3}));
  EXPECT_EQ(named(frame.nodes, "node_2_1_0").position, (Vec3{11.5, 2, 8}));
  EXPECT_EQ(named(frame.nodes, "node_3_0_1").position, (Vec3{14.5, 5.5, 3}));
}

TEST(Building, OverridesChangeTheirStoreysAndLaterOnesWin) {
  const Frame frame = frame_of(R"({"posts": [3, 3], "storeys": 4, "live_load": 100,
      "walls": {"thickness": 0.3, "material": "brick"}, "overrides": [
      {"storeys": [0, 1], "height": 5, "live_load": 1, "post_section": "IPE300"},
      {"storeys": [1, 2], "live_load": 2, "slab": {"thickness": 0.4}, "walls": false},
      {"storeys": [2, 2], "walls": {}, "beam_section": "HEB300"},
      {"storeys": [3, 3], "slab": false, "bays_x": [1, 2], "bays_z": [0, 1],
       "walls": {"material": "concrete-c30"}}]})");
  EXPECT_EQ(load_of(frame, "slab_0_0_0"), 1);
  EXPECT_EQ(load_of(frame, "slab_0_0_1"), 2);
  EXPECT_EQ(load_of(frame, "slab_0_0_2"), 2);
  EXPECT_EQ(named(frame.slabs, "slab_1_1_0").thickness, 0.15);
  EXPECT_EQ(named(frame.slabs, "slab_1_1_2").thickness, 0.4);
  EXPECT_EQ(named(frame.nodes, "node_1_0_4").position, (Vec3{6, 17, 0}));
  const auto section = [&](const char* member) {
    return frame.sections[named(frame.members, member).section].name;
  };
  EXPECT_EQ(section("post_0_0_1"), "IPE300");
  EXPECT_EQ(section("post_0_0_2"), "HEB300");
  EXPECT_EQ(section("beam_x_0_0_2"), "HEB300");
  std::size_t walls[4] = {}, slabs[4] = {};
  for (const FrameWall& wall : frame.walls) ++walls[wall.name.back() - '0'];
  for (const FrameSlab& slab : frame.slabs) ++slabs[slab.name.back() - '0'];
  EXPECT_EQ(walls[0], 8u);
  EXPECT_EQ(walls[1], 0u);
  EXPECT_EQ(walls[2], 8u);
  EXPECT_EQ(walls[3], 4u);
  EXPECT_EQ(slabs[2], 4u);
  EXPECT_EQ(slabs[3], 0u);
  const auto wall = std::find_if(frame.walls.begin(), frame.walls.end(),
                                 [](const FrameWall& each) { return each.name.ends_with("_2"); });
  EXPECT_EQ(wall->thickness, PanelParams{}.thickness);  // after false, the usual again
  EXPECT_EQ(frame.walls.back().thickness, 0.3);
  EXPECT_EQ(frame.materials[frame.walls.back().material].name, "concrete-c30");
}

TEST(Building, AnAtriumHasNoSlabs) {
  const Frame whole = frame_of(R"({"posts": [4, 4], "storeys": 3})");
  const Frame frame = frame_of(R"({"posts": [4, 4], "storeys": 3, "without": ["slab_1_1_*"]})");
  EXPECT_EQ(frame.slabs.size(), whole.slabs.size() - 3);
  EXPECT_EQ(frame.members.size(), whole.members.size());
}

TEST(Building, TooManyPartsAreRefusedBeforeTheyAreMade) {
  // 1e9 parts would not fit into memory; nor may a set-back hide how large the grid is.
  for (const char* rest : {"", R"(, "slab": false)",
                           R"(, "overrides": [{"storeys": [0, 999], "bays_x": [0, 1],
                               "bays_z": [0, 1]}])"}) {
    const std::string message =
        refusal(R"({"posts": [1000, 1000], "storeys": 1000)" + std::string(rest) + "}");
    EXPECT_NE(message.find("the most is 200000"), std::string::npos) << message;
  }
  std::string members = R"({"members": [)";
  for (std::size_t i = 0; i < kMaxParts; ++i) members += "1,";
  EXPECT_NE(refusal(members + "1]}").find("has 200010 parts"), std::string::npos);
}

TEST(Building, ListsOfABuildingAreShort) {
  for (const char* key : {"overrides", "without", "sections", "steels"}) {
    std::string text = "{\"" + std::string(key) + "\": [";
    for (std::size_t i = 0; i < kMaxBuildingList; ++i) text += "1,";
    EXPECT_NE(refusal(text + "1]}").find("has 1001 entries, the most is 1000"), std::string::npos);
  }
}

// --- Joints ----------------------------------------------------------------------------------

TEST(Building, ThresholdsOfThePaperArriveTimesTheirStrength) {
  const Frame frame = frame_of(R"({"joints": {"post": {"strength": 3, "force": [1, 2, 3],
      "torque": [4, 5, 6], "interaction": "box", "bearing": false, "friction": 0.25}}})");
  const JointClass& post = named(frame.classes, "post");
  EXPECT_EQ(post.force, (Vec3{1, 2, 3}));
  EXPECT_EQ(post.friction, 0.25);
  EXPECT_EQ(post.interaction, "box");
  int count = 0;
  for (const FrameJoint& joint : frame.joints) {
    if (joint.kind != FrameJoint::Kind::base) continue;
    EXPECT_EQ(joint.strength.force, (Vec3{3, 6, 9}));
    EXPECT_EQ(joint.strength.torque, (Vec3{12, 15, 18}));
    EXPECT_EQ(joint.strength.interaction, Interaction::box);
    EXPECT_FALSE(joint.strength.bearing);
    ++count;
  }
  EXPECT_EQ(count, 4);
}

TEST(Building, AJointClassChangesOnlyWhatItGives) {
  const Frame plain = frame_of("{}");
  const Frame strong = frame_of(R"({"joints": {"slab": {"strength": 2}}})");
  ASSERT_EQ(plain.joints.size(), strong.joints.size());
  for (std::size_t i = 0; i < plain.joints.size(); ++i) {
    const bool is_slab = plain.joints[i].kind == FrameJoint::Kind::slab;
    EXPECT_EQ(strong.joints[i].strength.force,
              (is_slab ? 2.0 : 1.0) * plain.joints[i].strength.force);
    EXPECT_EQ(strong.joints[i].strength.interaction, plain.joints[i].strength.interaction);
    EXPECT_EQ(strong.joints[i].strength.bearing, plain.joints[i].strength.bearing);
  }
}

TEST(Building, RulesOfBreakingArrive) {
  const Scene scene =
      scene_of(R"({"post_rule": "unbraced", "breaking": false, "hit_breaks": false})");
  EXPECT_EQ(scene.rules.post_rule, "unbraced");
  EXPECT_FALSE(scene.rules.breaking);
  EXPECT_FALSE(scene.rules.hit_breaks);
}

// --- Given part by part ----------------------------------------------------------------------

TEST(GivenBuilding, EveryKeyArrivesWhereItBelongs) {
  const Frame frame = *parse_scene(kGivenScene, "s").building;
  ASSERT_EQ(frame.nodes.size(), 8u);
  EXPECT_TRUE(named(frame.nodes, "D").support);
  EXPECT_FALSE(named(frame.nodes, "d").support);
  EXPECT_EQ(named(frame.nodes, "c").position, (Vec3{6, 3, 5}));
  const FrameMember& own = named(frame.members, "P1");
  EXPECT_EQ(own.kind, FrameMember::Kind::post);
  EXPECT_EQ(frame.nodes[own.from].name, "A");
  EXPECT_EQ(frame.sections[own.section].name, "own-1.5");
  EXPECT_EQ(frame.steels[own.steel].yield_strength, 5e8);
  EXPECT_DOUBLE_EQ(own.roll, std::numbers::pi / 2);
  const FrameMember& usual = named(frame.members, "P3");
  EXPECT_EQ(usual.kind, FrameMember::Kind::post);
  EXPECT_EQ(frame.sections[usual.section].name, "HEB300");
  EXPECT_EQ(frame.sections[named(frame.members, "cd").section].name, "IPE300");
  const FrameSlab& top = frame.slabs.at(0);
  EXPECT_EQ(top.name, "top");
  EXPECT_EQ(top.thickness, 0.22);
  EXPECT_EQ(top.live_load, 1500);
  EXPECT_EQ(frame.materials[top.material].name, "brick");
  const char* const beams[] = {"ab", "bc", "cd", "da"};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(frame.members[top.beams[i]].name, beams[i]);
  const FrameWall& back = frame.walls.at(0);
  EXPECT_EQ(back.thickness, 0.17);
  EXPECT_EQ(back.edges[0], kNoPart);
  EXPECT_EQ(frame.members[back.edges[1]].name, "P2");
  EXPECT_EQ(frame.members[back.edges[2]].name, "ab");
  EXPECT_EQ(frame.members[back.edges[3]].name, "P1");
}

TEST(GivenBuilding, APostStandsOnItsLowerNodeAndKeepsItsTurn) {
  const Frame frame = *parse_scene(kGivenScene, "s").building;
  const FrameMember& post = named(frame.members, "P2");  // given from b down to B, 30 degrees
  EXPECT_EQ(frame.nodes[post.from].name, "B");
  // Right-handed about the downward direction: z turns towards -x.
  const Axes axes = axes_of(frame, post);
  EXPECT_NEAR(std::abs(axes.z.z), std::cos(std::numbers::pi / 6), 1e-12);
  EXPECT_NEAR(axes.z.x / axes.z.z, -std::tan(std::numbers::pi / 6), 1e-12);
}

TEST(GivenBuilding, SteeperThan45DegreesIsAPost) {
  const std::string head = R"({"nodes": [{"name": "A", "at": [0, 0, 0], "support": true},
      {"name": "B", "at": [3, )";
  const std::string tail = R"(, 4]}], "members": [{"name": "m", "from": "A", "to": "B"}]})";
  EXPECT_EQ(frame_of(head + "5.01" + tail).members[0].kind, FrameMember::Kind::post);
  EXPECT_EQ(frame_of(head + "5" + tail).members[0].kind, FrameMember::Kind::beam);
  EXPECT_EQ(frame_of(head + "0" + tail).members[0].kind, FrameMember::Kind::beam);
}

TEST(GivenBuilding, ConnectionsReplaceTheUsualJointsOfMembers) {
  const Frame frame = *parse_scene(kGivenScene, "s").building;
  std::size_t members = 0;
  for (const FrameJoint& joint : frame.joints) {
    members += joint.kind != FrameJoint::Kind::slab && joint.kind != FrameJoint::Kind::wall;
  }
  EXPECT_EQ(members, 12u);
  const FrameJoint& hinge = named(frame.joints, "P1@ground");
  EXPECT_EQ(frame.classes[hinge.joint_class].name, "hinge");
  EXPECT_EQ(hinge.strength.torque, (Vec3{1, 2, 3}));
  EXPECT_EQ(frame.classes[named(frame.joints, "P2@ground").joint_class].name, "post");
  EXPECT_EQ(frame.part_name(named(frame.joints, "bc@P3").b), "P3");
}

TEST(GivenBuilding, StandsBesideARegularOneWhosePartsItMayName) {
  const Frame frame = frame_of(R"({"posts": [2, 2], "position": [10, 0, 0], "live_load": 7,
      "nodes": [{"name": "t", "at": [9, 3.5, 0]}, {"name": "u", "at": [9, 3.5, 6]}],
      "members": [{"name": "arm1", "from": "node_1_0_1", "to": "t"},
                  {"name": "arm2", "from": "node_1_1_1", "to": "u"},
                  {"name": "edge", "from": "t", "to": "u"}],
      "slabs": [{"name": "deck", "nodes": ["node_1_0_1", "t", "u", "node_1_1_1"]}]})");
  EXPECT_EQ(frame.members.size(), 11u);
  EXPECT_EQ(named(frame.nodes, "t").position, (Vec3{19, 3.5, 0}));  // from the position too
  ASSERT_EQ(frame.slabs.size(), 2u);
  const FrameSlab& deck = named(frame.slabs, "deck");
  EXPECT_EQ(deck.thickness, 0.15);
  EXPECT_EQ(deck.live_load, 7);
  EXPECT_EQ(frame.members[deck.beams[3]].name, "beam_z_1_0_0");
}

// --- The rest of the scene -------------------------------------------------------------------

TEST(Building, IsReachedByOverridesOfTheCommandLine) {
  const Scene scene =
      scene_of(R"({"posts": [2, 2]})",
               {.overrides = {"building.storeys=3", "building.posts.0=4", "building.slab=false",
                              "building.post_rule=none", "building.joints.beam.strength=5",
                              R"(scenario.remove=["post_3_1_2"])"}});
  EXPECT_EQ(scene.building->members.size(), 3u * (8 + 10));
  EXPECT_TRUE(scene.building->slabs.empty());
  EXPECT_EQ(scene.rules.post_rule, "none");
  EXPECT_EQ(named(scene.building->classes, "beam").strength, 5);
  EXPECT_EQ(scene.scenario.remove, std::vector<std::string>{"post_3_1_2"});
  EXPECT_EQ(refusal("{}", {.overrides = {"building.storeys=0"}}),
            "scene.json: --set: /building/storeys: 0 is outside [1, 1000]");
}

TEST(Building, FindsMaterialsOfTheSceneAndBringsItsOwnSections) {
  const Scene scene = parse_scene(kFullScene, "s");
  const Frame& frame = *scene.building;
  EXPECT_EQ(frame.materials[named(frame.slabs, "slab_0_0_0").material].density, 2700);
  const Frame own = frame_of(R"({"steels": [{"name": "s235", "yield_strength": 2e8}],
      "sections": [{"name": "box", "shape": "rhs", "height": 0.2, "width": 0.2, "web": 0.01}],
      "beam_section": "box"})");
  EXPECT_EQ(own.steels[own.members[0].steel].yield_strength, 2e8);
  EXPECT_EQ(own.sections[named(own.members, "beam_x_0_0_0").section].name, "box");
}

TEST(CollapseScene, HasEverythingOfTheScene) {
  const Scene scene = parse_scene(kFullScene, "s");
  const CollapseScene collapse = collapse_scene(scene);
  EXPECT_EQ(collapse.seed, 7u);
  EXPECT_EQ(collapse.frame.part_count(), scene.building->part_count());
  EXPECT_EQ(collapse.projectiles.size(), 2u);
  EXPECT_EQ(collapse.scenario.load_rate, 250.5);
  EXPECT_EQ(collapse.scenario.remove, (std::vector<std::string>{"post_1_0_0", "wall_x_0_0_0"}));
  EXPECT_EQ(collapse.rules.post_rule, "euler");
  EXPECT_EQ(collapse.simulation.duration, 2.5);
}

TEST(CollapseScene, NeedsABuilding) {
  try {
    collapse_scene(parse_scene(R"({"sunder": 1, "walls": [{}]})", "s"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input);
    EXPECT_NE(std::string(error.what()).find("no building"), std::string::npos);
  }
}

// --- Ground motion ---------------------------------------------------------------------------

/// A folder of its own that is removed again.
class MotionFolder : public testing::Test {
 protected:
  MotionFolder() {
    std::string name = (fs::temp_directory_path() / "sunder_motion_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~MotionFolder() override { fs::remove_all(path_); }

  fs::path write(const std::string& name, const std::string& content) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }
  GroundMotion motion(const std::string& content) const {
    return read_ground_motion(write("quake.csv", content));
  }
  std::string fault(const std::string& content) const {
    const fs::path file = write("quake.csv", content);
    try {
      read_ground_motion(file);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::input);
      const std::string message = error.what(), head = file.string();
      EXPECT_TRUE(message.starts_with(head)) << message;
      return message.substr(std::min(message.size(), head.size()));
    }
    ADD_FAILURE() << "was read: " << content;
    return {};
  }

  fs::path path_;
};

TEST_F(MotionFolder, RowsOfThreeDirectionsAreRead) {
  const GroundMotion read = motion("0,1,2,3\n0.5,-1,0,1e-3\n");
  EXPECT_EQ(read.times, (std::vector<double>{0, 0.5}));
  EXPECT_EQ(read.accelerations, (std::vector<Vec3>{{1, 2, 3}, {-1, 0, 1e-3}}));
}

TEST_F(MotionFolder, ASingleAccelerationIsAlongX) {
  EXPECT_EQ(motion("0.25, 4").accelerations, (std::vector<Vec3>{{4, 0, 0}}));
}

TEST_F(MotionFolder, HeadingsCommentsEmptyLinesAndCarriageReturnsAreAllowed) {
  const GroundMotion read = motion(
      "\xEF\xBB\xBF# a station\r\n\r\ntime, ax, ay, az\r\n 0 ,\t+1, 0, 0\r\n  # pause\r\n"
      "1,2,0,0\r\n\r\n2,3,0,0");
  EXPECT_EQ(read.times, (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(read.accelerations.back(), (Vec3{3, 0, 0}));
}

TEST_F(MotionFolder, WhatIsWrongIsNamedWithItsLineAndValue) {
  const std::pair<const char*, const char*> rows[] = {
      {"", ": no row of time and acceleration"},
      {"# nothing\n\n", ": no row of time and acceleration"},
      {"time,a\n", ": no row of time and acceleration"},
      {"0,1\n1\n", ":2: a row is time, a or time, ax, ay, az, got 1 value"},
      {"0,1,2\n", ":1: a row is time, a or time, ax, ay, az, got 3 values"},
      {"0,1,2,3,4\n", ":1: a row is time, a or time, ax, ay, az, got 5 values"},
      {"0,1\n1,2,3,4\n", ":2: 4 values, the rows before have 2"},
      {"t,a\n0,1,2,3\n", ":2: 4 values, the rows before have 2"},
      {"0,1\n\ntime,a\n", ":3: must be a number, got \"time\""},
      {"0,1\n1,x2\n", ":2: must be a number, got \"x2\""},
      {"0,1\n1,2m\n", ":2: must be a number, got \"2m\""},
      {"0,1\n1,\n", ":2: must be a number, got \"\""},
      {"0,1\n1,nan\n", ":2: must be a number, got \"nan\""},
      {"nan,1\n", ":1: must be a number, got \"nan\""},
      {"0,inf\n", ":1: must be a number, got \"inf\""},
      {"0,1e999\n", ":1: must be a number, got \"1e999\""},
      {"0,+-1\n", ":1: must be a number, got \"+-1\""},
      {"0;1\n", ":1: a row is time, a or time, ax, ay, az, got 1 value"},
      {"-0.5,1\n", ":1: time = -0.5 is outside [0, 1e9] s"},
      {"0,1\n0.5,1\n0.5,2\n", ":3: time = 0.5 s is not after the 0.5 s of the row before"},
      {"0,1\n0.5,1\n0.25,2\n", ":3: time = 0.25 s is not after the 0.5 s of the row before"},
      {"0,1\n1,1000.5\n", ":2: acceleration = 1000.5 is outside [-1000, 1000] m/s²"},
      {"0,0,0,-2e3\n", ":1: acceleration = -2000 is outside [-1000, 1000] m/s²"},
      {"0,\x1b[31m\n", ":1: must be a number, got \"\\u001b[31m\""},
  };
  for (const auto& [content, words] : rows) {
    const std::string message = fault(content);
    EXPECT_TRUE(message.starts_with(words)) << content << " gave: " << message;
  }
}

TEST_F(MotionFolder, MoreThanAMillionRowsAreRefused) {
  std::string content;
  for (int i = 0; i <= 1000000; ++i) content += std::to_string(i) + ",0\n";
  EXPECT_EQ(fault(content), ":1000001: more than 1000000 rows, which is the limit");
}

TEST_F(MotionFolder, IsFoundBesideTheSceneAndNotOutside) {
  const std::string text =
      R"({"sunder": 1, "building": {}, "scenario": {"ground_motion": "NAME"}})";
  const auto scene = [&](const std::string& name, const SceneParams& params = {}) {
    std::string content = text;
    content.replace(content.find("NAME"), 4, name);
    return read_scene(write("scenes/scene.json", content), params);
  };
  write("scenes/data/quake.csv", "0,1\n1,2\n");
  write("quake.csv", "0,5\n");
  EXPECT_EQ(scene("data/quake.csv").scenario.ground_motion.times.size(), 2u);
  EXPECT_THROW(scene("../quake.csv"), Error);
  EXPECT_THROW(scene((path_ / "quake.csv").string()), Error);
  EXPECT_THROW(scene("data"), Error);
  const Scene outside = scene("../quake.csv", {.allow_outside = true});
  EXPECT_EQ(outside.scenario.ground_motion.accelerations, (std::vector<Vec3>{{5, 0, 0}}));
}

TEST(GroundMotion, IsLinearBetweenItsTimesAndZeroOutside) {
  const GroundMotion motion{{1, 2, 4}, {{0, 0, 0}, {2, 4, 6}, {4, 0, 0}}};
  EXPECT_EQ(motion.at(0.5), Vec3{});
  EXPECT_EQ(motion.at(1), Vec3{});
  EXPECT_EQ(motion.at(1.5), (Vec3{1, 2, 3}));
  EXPECT_EQ(motion.at(2), (Vec3{2, 4, 6}));
  EXPECT_EQ(motion.at(3.5), (Vec3{3.5, 1, 1.5}));
  EXPECT_EQ(motion.at(4), (Vec3{4, 0, 0}));
  EXPECT_EQ(motion.at(4.001), Vec3{});
  EXPECT_EQ(GroundMotion{}.at(0), Vec3{});
}

}  // namespace
}  // namespace sunder
