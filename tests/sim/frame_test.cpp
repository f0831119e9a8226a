// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "sim/stocked_frame.hpp"

namespace sunder {
namespace {

using Kind = FrameMember::Kind;

void expect_near(Vec3 a, Vec3 b, double tolerance = 1e-12) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

// --- Axes ---

Axes axes_between(Kind kind, Vec3 from, Vec3 to, double roll = 0) {
  Frame frame = stocked_frame();
  add_member(frame, "m", kind, add_node(frame, from), add_node(frame, to));
  frame.members[0].roll = roll;
  return axes_of(frame, frame.members[0]);
}

TEST(FrameAxes, WebsOfBeamsStandUpright) {
  const Axes along_x = axes_between(Kind::beam, {}, {6, 0, 0});
  expect_near(along_x.x, {1, 0, 0});
  expect_near(along_x.y, {0, 0, -1});
  expect_near(along_x.z, {0, 1, 0});
  const Axes sloping = axes_between(Kind::beam, {}, {3, 4, 0});
  expect_near(sloping.z, {-0.8, 0.6, 0});
  expect_near(axes_between(Kind::beam, {}, {0, 5, 0}).z, {1, 0, 0});
}

TEST(FrameAxes, WebsOfPostsLieAlongZ) {
  const Axes post = axes_between(Kind::post, {}, {0, 3.5, 0});
  expect_near(post.x, {0, 1, 0});
  expect_near(post.y, {-1, 0, 0});  // y = z × x
  expect_near(post.z, {0, 0, 1});
  expect_near(axes_between(Kind::post, {}, {0, 0, 2}).z, {1, 0, 0});
}

TEST(FrameAxes, RollTurnsYTowardsZ) {
  const Axes plain = axes_between(Kind::beam, {}, {6, 0, 0});
  const Axes rolled = axes_between(Kind::beam, {}, {6, 0, 0}, std::acos(-1.0) / 2);
  expect_near(rolled.y, plain.z);
  expect_near(rolled.z, -1 * plain.y);
}

TEST(FrameAxes, AreRightHandedAndOrthonormalInEveryDirection) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto value = [&](std::uint64_t i) { return 2 * random_unit(seed, i) - 1; };
    const Kind kind = seed % 2 ? Kind::post : Kind::beam;
    const Axes a = axes_between(kind, {}, {value(0), value(1), value(2)}, 3 * value(3));
    expect_near(cross(a.x, a.y), a.z);
    EXPECT_NEAR(length(a.y), 1, 1e-12) << seed;
    EXPECT_NEAR(dot(a.x, a.y), 0, 1e-12) << seed;
  }
}

// --- Regular buildings ---

TEST(RegularFrame, CountsPartsAndJointsAsPublished) {
  struct Row {
    std::size_t x, z, storeys;
    double wall;
    std::size_t parts, joints;
  };
  for (const Row& row : std::vector<Row>{{3, 3, 12, 0, 300, 588},
                                         {3, 3, 12, 0.1, 396, 964},
                                         {4, 5, 6, 0, 378, 780},
                                         {4, 5, 6, 0.1, 462, 1102},
                                         {10, 10, 30, 0, 10830, 23520}}) {
    const Frame frame = joined(regular(row.x, row.z, row.storeys, row.wall));
    EXPECT_EQ(frame.part_count(), row.parts);
    EXPECT_EQ(frame.joints.size(), row.joints);
    EXPECT_EQ(text_of(defects_of(frame)), "");
  }
}

TEST(RegularFrame, NamesAndPlacesFollowTheGrid) {
  RegularBuilding building = regular(3, 3, 2, 0.1);
  building.bays_x = {4, 5};
  building.bays_z = {6, 7};
  building.storeys[0].height = 3;
  building.position = {10, 1, -2};
  const Frame frame = joined(building);
  const auto member = [&](const std::string& name) {
    return frame.members[find_part(frame, name)];
  };
  expect_near(frame.nodes[member("post_2_1_1").from].position, {19, 4, 4});
  expect_near(frame.nodes[member("post_2_1_1").to].position, {19, 7.5, 4});
  EXPECT_EQ(frame.nodes[member("post_2_1_1").to].name, "node_2_1_2");
  EXPECT_EQ(frame.nodes[member("beam_x_1_2_0").from].name, "node_1_2_1");
  EXPECT_EQ(frame.nodes[member("beam_x_1_2_0").to].name, "node_2_2_1");
  EXPECT_EQ(frame.nodes[member("beam_z_1_1_1").to].name, "node_1_2_2");
  EXPECT_NE(find_part(frame, "slab_1_1_1"), kNoPart);
  EXPECT_EQ(find_part(frame, "slab_2_0_0"), kNoPart);
  EXPECT_NE(find_part(frame, "wall_x_1_2_0"), kNoPart);
  EXPECT_EQ(find_part(frame, "wall_x_1_1_0"), kNoPart);
  EXPECT_NE(find_part(frame, "wall_z_2_1_1"), kNoPart);
  for (const FrameNode& node : frame.nodes) EXPECT_EQ(node.support, node.position.y == 1);
}

TEST(RegularFrame, WallsAreSeenFromOutside) {
  const Frame frame = joined(regular(3, 3, 1, 0.1));
  ASSERT_EQ(frame.walls.size(), 8u);
  for (const FrameWall& wall : frame.walls) {
    const auto at = [&](int i) { return frame.nodes[wall.nodes[i]].position; };
    const Vec3 outward = cross(at(1) - at(0), at(3) - at(0));
    EXPECT_GT(dot(outward, at(0) - Vec3{6, 0, 6}), 0) << wall.name;
  }
}

TEST(RegularFrame, StoreysHaveTheirOwnSectionsAndLoads) {
  RegularBuilding building = regular(2, 2, 2);
  building.storeys[1].post_section = "IPE300";
  building.storeys[1].slab_thickness = 0;
  building.storeys[0].live_load = 2000;
  const Frame frame = joined(building);
  EXPECT_EQ(frame.members[find_part(frame, "post_0_0_0")].section, 0u);
  EXPECT_EQ(frame.members[find_part(frame, "post_0_0_1")].section, 1u);
  ASSERT_EQ(frame.slabs.size(), 1u);
  EXPECT_EQ(frame.slabs[0].live_load, 2000);
}

TEST(RegularFrame, SetBacksKeepTheirRangeOfBays) {
  RegularBuilding building = regular(4, 3, 3, 0.1);
  building.storeys[2].bays_x = {1, 3};
  building.storeys[2].bays_z = {0, 1};
  const Frame frame = joined(building);
  EXPECT_EQ(text_of(defects_of(frame)), "");
  EXPECT_EQ(find_part(frame, "post_0_0_2"), kNoPart);
  EXPECT_EQ(find_part(frame, "post_1_2_2"), kNoPart);
  EXPECT_NE(find_part(frame, "post_3_1_2"), kNoPart);
  EXPECT_NE(find_part(frame, "slab_2_0_2"), kNoPart);
  EXPECT_EQ(find_part(frame, "slab_2_1_2"), kNoPart);
  EXPECT_NE(find_part(frame, "wall_x_1_1_2"), kNoPart);  // on the new edge
  EXPECT_NE(find_part(frame, "wall_z_1_0_2"), kNoPart);
  const auto has_node = [&](const std::string& name) {
    return std::any_of(frame.nodes.begin(), frame.nodes.end(),
                       [&](const FrameNode& n) { return n.name == name; });
  };
  EXPECT_TRUE(has_node("node_0_0_2"));
  EXPECT_FALSE(has_node("node_0_0_3"));
}

TEST(RegularFrame, AnAtriumLosesItsFloorsOnly) {
  RegularBuilding building = regular(4, 4, 3);
  building.without = {"slab_1_1_*"};
  const Frame frame = joined(building);
  EXPECT_EQ(frame.slabs.size(), 24u);
  EXPECT_EQ(frame.members.size(), 120u);
  EXPECT_EQ(text_of(defects_of(frame)), "");
}

TEST(RegularFrame, WhatRestsOnAPartThatIsLeftOutGoesToo) {
  RegularBuilding building = regular(3, 3, 2, 0.1);
  building.without = {"beam_x_0_0_0"};
  Frame frame = joined(building);
  EXPECT_EQ(find_part(frame, "slab_0_0_0"), kNoPart);
  EXPECT_EQ(find_part(frame, "wall_x_0_0_0"), kNoPart);  // it hung on that beam
  EXPECT_EQ(find_part(frame, "wall_x_0_0_1"), kNoPart);  // it stood on that beam
  EXPECT_EQ(frame.part_count(), 66u - 4);
  EXPECT_EQ(text_of(defects_of(frame)), "");
  building.without = {"post_0_0_1"};  // the top of a corner: two beams end in the air
  frame = joined(building);
  EXPECT_EQ(frame.part_count(), 66u - 1 - 2 - 1 - 2);
  EXPECT_EQ(text_of(defects_of(frame)), "");
}

TEST(RegularFrame, APostThatIsLeftOutHangsTheOneAboveOnItsBeams) {
  RegularBuilding building = regular(3, 3, 2);
  building.without = {"post_1_0_0"};
  const Frame frame = joined(building);
  EXPECT_EQ(frame.part_count(), 50u - 1);
  std::set<std::string> joints;
  for (const FrameJoint& joint : frame.joints) joints.insert(joint.name);
  EXPECT_TRUE(joints.contains("beam_x_0_0_0@post_1_0_1"));
  EXPECT_TRUE(joints.contains("beam_z_1_0_0@post_1_0_1"));
  EXPECT_EQ(text_of(defects_of(frame)), "");
}

TEST(RegularFrame, StarsStandForAnyText) {
  const auto parts = [](const std::string& pattern) {
    RegularBuilding building = regular(3, 3, 2);
    building.without = {pattern};
    return joined(building).part_count();
  };
  EXPECT_EQ(parts("slab_0_0_0"), 49u);
  EXPECT_EQ(parts("slab_*"), 42u);
  EXPECT_EQ(parts("sl*_1_*_1"), 48u);
  EXPECT_EQ(parts("*slab*1_*0*"), 46u);
  EXPECT_EQ(parts("*"), 0u);
}

std::string error_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input);
    return error.what();
  }
  return "no error";
}

TEST(RegularFrame, RefusesWhatItCannotBuildAndNamesIt) {
  struct Row {
    std::function<void(RegularBuilding&)> spoil;
    std::string named;
  };
  for (const Row& row : std::vector<Row>{
           {[](auto& b) { b.storeys[1].post_section = "HEB999"; }, "HEB999"},
           {[](auto& b) { b.storeys[1].beam_section = "IPE1"; }, "IPE1"},
           {[](auto& b) { b.storeys[0].steel = "s9"; }, "s9"},
           {[](auto& b) { b.storeys[0].slab_material = "cheese"; }, "cheese"},
           {[](auto& b) { b.storeys[0].wall_material = "paper"; }, "paper"},
           {[](auto& b) {
              b.without = {"slab_0_0_0", "slab_9_*"};
            },
            "slab_9_*"},
           {[](auto& b) { b.without = {"slab_9_9_9"}; }, "slab_9_9_9"},
           {[](auto& b) { b.bays_x.clear(); }, "bay"},
           {[](auto& b) { b.bays_z[1] = -6; }, "bay"},
           {[](auto& b) { b.storeys.clear(); }, "storey"},
           {[](auto& b) { b.storeys[1].height = 0; }, "storey"},
           {[](auto& b) {
              b.storeys[1].bays_x = {1, 1};
            },
            "storey 1: bays_x = [1, 1)"},
           {[](auto& b) {
              b.storeys[0].bays_z = {0, 3};
            },
            "storey 0: bays_z = [0, 3)"},
           {[](auto& b) { b.bays_x.assign(200000, 6); }, "200000"},
       }) {
    RegularBuilding building = regular(3, 3, 2, 0.1);
    row.spoil(building);
    const std::string error = error_of([&] { joined(building); });
    EXPECT_NE(error.find(row.named), std::string::npos) << error;
  }
}

TEST(RegularFrame, MaterialsOfWhatIsNotThereNeedNotExist) {
  RegularBuilding building = regular(2, 2, 1);
  building.storeys[0].slab_thickness = 0;
  building.storeys[0].slab_material = building.storeys[0].wall_material = "none";
  EXPECT_EQ(joined(building).part_count(), 8u);
}

// --- Defects ---

struct Flaw {
  const char* name;
  std::function<void(Frame&)> spoil;
  const char* expected;  ///< a line of text_of(defects)
};

std::vector<Flaw> flaws() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return {
      {"zero", [](Frame& f) { f.nodes[4].position = f.nodes[0].position; },
       "post_0_0_0 has zero length"},
      {"same_node", [](Frame& f) { f.members[0].to = f.members[0].from; },
       "post_0_0_0 has zero length"},
      {"long", [](Frame& f) { f.nodes[4].position.y = 2000; },
       "post_0_0_0 is 2000 m long, more than 1000 m"},
      {"far", [](Frame& f) { f.nodes[4].position.y = 2e5; },
       "node_0_0_1 is 200000 m from the origin, more than 100000 m"},
      {"nan", [nan](Frame& f) { f.nodes[4].position.x = nan; },
       "node_0_0_1 has a position that is not finite"},
      {"roll", [nan](Frame& f) { f.members[1].roll = nan; },
       "post_1_0_0 has a roll that is not finite"},
      {"head", [](Frame& f) { std::swap(f.members[0].from, f.members[0].to); },
       "post_0_0_0 stands on its head: it must go from the lower node to the upper one"},
      {"double", [](Frame& f) { add_beam(f, "extra", f.members[4].to, f.members[4].from); },
       "extra joins the same nodes as another member"},
      {"alone",
       [](Frame& f) {
         add_beam(f, "extra", add_node(f, {50, 9, 0}), add_node(f, {56, 9, 0}));
       },
       "extra meets nothing"},
      {"passing",
       [](Frame& f) {
         add_beam(f, "extra", add_node(f, {3, 3.5, -1}), add_node(f, {3, 3.5, 1}));
       },
       "extra meets nothing"},
      {"adrift",
       [](Frame& f) {
         const std::uint32_t middle = add_node(f, {56, 9, 0});
         add_beam(f, "left", add_node(f, {50, 9, 0}), middle);
         add_beam(f, "right", middle, add_node(f, {62, 9, 0}));
       },
       "left is not connected to the ground"},
      {"no_support",
       [](Frame& f) {
         for (FrameNode& n : f.nodes) n.support = false;
       },
       "frame has no support"},
      {"twice", [](Frame& f) { f.members[5].name = "slab_0_0_0"; },
       "slab_0_0_0 is a name that occurs twice"},
      {"ground", [](Frame& f) { f.members[5].name = "ground"; },
       "ground is a name that occurs twice"},
      {"node_twice", [](Frame& f) { f.nodes[1].name = f.nodes[0].name; },
       "node_0_0_0 is a name that occurs twice"},
      {"slab_level", [](Frame& f) { f.nodes[4].position.y += 0.25; },
       "slab_0_0_0 is not flat: its corners differ by 0.25 m in height"},
      {"slab_convex",
       [](Frame& f) {
         f.nodes[4].position = {5, 3.5, 5};
       },
       "slab_0_0_0 is not convex in plan"},
      {"slab_crossed", [](Frame& f) { std::swap(f.slabs[0].nodes[0], f.slabs[0].nodes[1]); },
       "slab_0_0_0 is not convex in plan"},
      {"slab_beams", [](Frame& f) { std::swap(f.slabs[0].beams[0], f.slabs[0].beams[1]); },
       "slab_0_0_0 beam_z_1_0_0 does not join its corners node_0_0_1 and node_1_0_1"},
      {"slab_thin", [](Frame& f) { f.slabs[0].thickness = 0; }, "slab_0_0_0 has no thickness"},
      {"slab_thick", [](Frame& f) { f.slabs[0].thickness = 1e-4; },
       "slab_0_0_0 is 0.0001 m thick, outside 0.001 m to 1000 m"},
      {"load", [](Frame& f) { f.slabs[0].live_load = -1; },
       "slab_0_0_0 has a live load that is negative or not finite"},
      {"load_nan", [nan](Frame& f) { f.slabs[0].live_load = nan; },
       "slab_0_0_0 has a live load that is negative or not finite"},
      {"wall_thin", [](Frame& f) { f.walls[0].thickness = -1; }, "wall_x_0_0_0 has no thickness"},
      {"wall_leans", [](Frame& f) { f.nodes[4].position.x += 0.01; },
       "wall_x_0_0_0 is not flat: no upright rectangle"},
      {"wall_edges", [](Frame& f) { std::swap(f.walls[0].edges[1], f.walls[0].edges[3]); },
       "wall_x_0_0_0 post_1_0_0 does not join its corners node_0_0_0 and node_0_0_1"},
      {"no_node", [](Frame& f) { f.members[0].to = 99; }, "post_0_0_0 ends at no node"},
      {"no_section", [](Frame& f) { f.members[0].section = 9; }, "post_0_0_0 has no section"},
      {"no_steel", [](Frame& f) { f.members[0].steel = 9; }, "post_0_0_0 has no steel grade"},
      {"no_corner", [](Frame& f) { f.slabs[0].nodes[3] = 99; },
       "slab_0_0_0 has a corner at no node"},
      {"no_beam", [](Frame& f) { f.slabs[0].beams[3] = kNoPart; },
       "slab_0_0_0 lies on a beam that is not there"},
      {"no_material", [](Frame& f) { f.slabs[0].material = 9; }, "slab_0_0_0 has no material"},
      {"no_edge", [](Frame& f) { f.walls[0].edges[2] = 99; },
       "wall_x_0_0_0 has an edge on a member that is not there"},
      {"no_wall_node", [](Frame& f) { f.walls[0].nodes[2] = 99; },
       "wall_x_0_0_0 has a corner at no node"},
      {"no_wall_material", [](Frame& f) { f.walls[0].material = 9; },
       "wall_x_0_0_0 has no material"},
  };
}

class FrameFlaw : public testing::TestWithParam<Flaw> {};

// The frame is joined again where that is possible: a flaw of the description, not of old joints.
TEST_P(FrameFlaw, IsNamed) {
  Frame frame = joined(regular(2, 2, 1, 0.1));
  ASSERT_EQ(text_of(defects_of(frame)), "");
  GetParam().spoil(frame);
  try {
    join(frame);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().expected), std::string::npos)
        << error.what();
  }
  const std::string found = "\n" + text_of(defects_of(frame));
  EXPECT_NE(found.find("\n" + std::string(GetParam().expected) + "\n"), std::string::npos) << found;
}

INSTANTIATE_TEST_SUITE_P(All, FrameFlaw, testing::ValuesIn(flaws()),
                         [](const auto& flaw) { return std::string(flaw.param.name); });

TEST(FrameDefects, JointsToNothingAndWithoutStrengthAreNamed) {
  Frame frame = joined(regular(2, 2, 1));
  frame.joints[0].b = 77;
  frame.joints[1].strength.torque.y = 0;
  frame.joints[2].b = frame.joints[2].a;
  const std::string found = text_of(defects_of(frame));
  EXPECT_NE(found.find("post_0_0_0@ground does not join two parts"), std::string::npos);
  EXPECT_NE(found.find("post_0_1_0@ground does not join two parts"), std::string::npos);
  EXPECT_NE(found.find("post_1_0_0@ground has no strength"), std::string::npos);
}

TEST(FrameDefects, AFloatingStoreyIsReportedByItsFirstParts) {
  RegularBuilding building = regular(3, 3, 3);
  building.without = {"post_*_1"};
  const Frame frame = joined(building);
  const std::vector<FrameDefect> defects = defects_of(frame);
  ASSERT_EQ(defects.size(), 6u) << text_of(defects);
  EXPECT_EQ(defects[0].part, "beam_x_0_0_1");
  EXPECT_EQ(defects[0].what, "is not connected to the ground");
  EXPECT_EQ(defects[5].part, "frame");  // 9 posts, 24 beams, 8 slabs, less 5
  EXPECT_EQ(defects[5].what, "has 36 more parts of which each is not connected to the ground");
}

TEST(FrameDefects, TooManyPartsAreReportedAtOnce) {
  Frame frame = stocked_frame();
  frame.members.resize(200001);
  EXPECT_EQ(text_of(defects_of(frame)), "frame has 200001 parts, more than 200000\n");
}

// Parts that no chain of shared nodes, beams under slabs and edges of walls ties to a support.
std::size_t loose_parts(const Frame& frame) {
  std::vector<std::vector<std::uint32_t>> next(frame.part_count());
  std::vector<std::uint32_t> queue;
  std::vector<bool> reached(frame.part_count(), false);
  const auto reach = [&](std::uint32_t part) {
    if (!reached[part]) queue.push_back(part);
    reached[part] = true;
  };
  std::vector<std::vector<std::uint32_t>> ends(frame.nodes.size());
  for (std::uint32_t m = 0; m < frame.members.size(); ++m) {
    for (const std::uint32_t node : {frame.members[m].from, frame.members[m].to}) {
      ends[node].push_back(m);
      if (frame.nodes[node].support) reach(m);
    }
  }
  const auto tie = [&](std::uint32_t a, std::uint32_t b) {
    next[a].push_back(b);
    next[b].push_back(a);
  };
  for (std::uint32_t n = 0; n < ends.size(); ++n) {
    for (const std::uint32_t a : ends[n]) tie(a, ends[n][0]);
  }
  for (std::uint32_t s = 0; s < frame.slabs.size(); ++s) {
    for (const std::uint32_t beam : frame.slabs[s].beams) tie(frame.slab_part(s), beam);
  }
  for (std::uint32_t w = 0; w < frame.walls.size(); ++w) {
    for (const std::uint32_t edge : frame.walls[w].edges) {
      if (edge != kNoPart) tie(frame.wall_part(w), edge);
    }
  }
  while (!queue.empty()) {
    const std::uint32_t part = queue.back();
    queue.pop_back();
    for (const std::uint32_t other : next[part]) reach(other);
  }
  return static_cast<std::size_t>(std::count(reached.begin(), reached.end(), false));
}

/// Parts that the defects call loose, named or counted; anything else they say is a failure.
std::size_t reported_loose(const Frame& frame) {
  std::size_t count = 0;
  for (const FrameDefect& d : defects_of(frame)) {
    if (d.what.starts_with("has ") && d.what.find(" more parts") != std::string::npos) {
      count += std::stoul(d.what.substr(4));
    } else {
      EXPECT_TRUE(d.what == "meets nothing" || d.what == "is not connected to the ground")
          << d.part << " " << d.what;
      ++count;
    }
  }
  return count;
}

TEST(FrameDefects, LoosePartsAreThoseThatASearchFindsInRandomFrames) {
  std::size_t unsound = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RegularBuilding building = regular(3, 3, 3, 0.1);
    const Frame whole = joined(building);
    const double share = 0.6 * random_unit(seed, 0);
    for (std::uint32_t m = 0; m < whole.members.size(); ++m) {
      if (random_unit(seed, 1 + m) < share) building.without.push_back(whole.members[m].name);
    }
    const Frame frame = joined(building);
    const std::size_t loose = loose_parts(frame);
    if (frame.nodes.empty() || !frame.nodes[0].support) continue;
    EXPECT_EQ(reported_loose(frame), loose) << "seed " << seed;
    unsound += loose > 0;
  }
  EXPECT_GT(unsound, 20u);
  EXPECT_LT(unsound, 180u);
}

}  // namespace
}  // namespace sunder
