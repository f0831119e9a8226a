// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "meshing/error.hpp"
#include "sim/frame.hpp"
#include "sim/stocked_frame.hpp"

namespace sunder {
namespace {

using Kind = FrameMember::Kind;
using Names = std::vector<std::string>;

const FrameJoint& joint_named(const Frame& frame, const std::string& name) {
  const auto found = std::find_if(frame.joints.begin(), frame.joints.end(),
                                  [&](const FrameJoint& j) { return j.name == name; });
  if (found == frame.joints.end()) throw std::runtime_error("no joint " + name);
  return *found;
}

Names joint_names(const Frame& frame) {
  Names names;
  for (const FrameJoint& joint : frame.joints) names.push_back(joint.name);
  return names;
}

std::string refusal(Frame frame, const std::vector<GivenJoint>& given) {
  try {
    join(frame, given);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input);
    return error.what();
  }
  return "no error";
}

/// Two supports 12 m apart, a node between them, two beams.
Frame bridge() {
  Frame frame = stocked_frame();
  const std::uint32_t left = add_node(frame, {0, 5, 0}, true);
  const std::uint32_t middle = add_node(frame, {6, 5, 0});
  const std::uint32_t right = add_node(frame, {12, 5, 0}, true);
  add_beam(frame, "west", left, middle);
  add_beam(frame, "east", middle, right);
  return frame;
}

TEST(FrameJoints, OfABayHangOnThePostBelow) {
  const Frame frame = joined(regular(2, 2, 2, 0.1));
  std::map<FrameJoint::Kind, int> count;
  for (const FrameJoint& joint : frame.joints) ++count[joint.kind];
  EXPECT_EQ(count[FrameJoint::Kind::base], 4);
  EXPECT_EQ(count[FrameJoint::Kind::splice], 4);
  EXPECT_EQ(count[FrameJoint::Kind::beam_end], 16);
  EXPECT_EQ(count[FrameJoint::Kind::slab], 8);
  EXPECT_EQ(count[FrameJoint::Kind::wall], 4 * 3 + 4 * 4);
  for (const FrameJoint& joint : frame.joints) {
    if (joint.kind != FrameJoint::Kind::beam_end) continue;
    const FrameMember& post = frame.members[joint.b];
    EXPECT_EQ(post.kind, Kind::post);
    EXPECT_EQ(post.to, joint.node) << joint.name;
    EXPECT_EQ(joint.end_b, 1) << joint.name;
    EXPECT_EQ(joint.end_a == 0 ? frame.members[joint.a].from : frame.members[joint.a].to,
              joint.node);
  }
  EXPECT_EQ(joint_named(frame, "post_0_0_0@ground").b, kNoPart);
  const FrameJoint& splice = joint_named(frame, "post_1_0_1@post_1_0_0");
  EXPECT_EQ(splice.end_a, 0);
  EXPECT_EQ(splice.end_b, 1);
  EXPECT_EQ(splice.point, (Vec3{6, 3.5, 0}));
  EXPECT_EQ(joint_named(frame, "slab_0_0_1@beam_x_0_1_1").point, (Vec3{3, 7, 6}));
  EXPECT_EQ(joint_named(frame, "wall_x_0_0_1@post_1_0_1").point, (Vec3{6, 5.25, 0}));
}

TEST(FrameJoints, AxesPointFromTheCarrierIntoSlabsAndWalls) {
  const Frame frame = joined(regular(2, 2, 2, 0.1));
  const auto expect_axes = [&](const std::string& name, Vec3 x, Vec3 y) {
    const Axes axes = joint_named(frame, name).axes;
    EXPECT_NEAR(length(axes.x - x), 0, 1e-12) << name;
    EXPECT_NEAR(length(axes.y - y), 0, 1e-12) << name;
    EXPECT_NEAR(length(axes.z - cross(x, y)), 0, 1e-12) << name;
  };
  expect_axes("slab_0_0_0@beam_x_0_0_0", {0, 1, 0}, {1, 0, 0});
  expect_axes("slab_0_0_0@beam_z_1_0_0", {0, 1, 0}, {0, 0, 1});
  expect_axes("wall_x_0_0_1@beam_x_0_0_0", {0, 1, 0}, {1, 0, 0});
  expect_axes("wall_x_0_0_1@beam_x_0_0_1", {0, -1, 0}, {1, 0, 0});
  expect_axes("wall_x_0_0_1@post_0_0_1", {1, 0, 0}, {0, 1, 0});
  expect_axes("wall_x_0_0_1@post_1_0_1", {-1, 0, 0}, {0, 1, 0});
  expect_axes("beam_x_0_0_0@post_1_0_0", {1, 0, 0}, {0, 0, -1});
}

TEST(FrameJoints, ABridgeRestsOnItsAbutments) {
  Frame frame = bridge();
  join(frame);
  EXPECT_EQ(joint_names(frame), (Names{"west@ground", "east@west", "east@ground"}));
  EXPECT_EQ(frame.joints[0].kind, FrameJoint::Kind::base);
  EXPECT_EQ(frame.joints[1].kind, FrameJoint::Kind::beam_end);
  EXPECT_EQ(frame.joints[1].end_b, 1);
  EXPECT_EQ(text_of(defects_of(frame)), "");
}

TEST(FrameJoints, ABeamHeldAtBothEndsHasTwoNames) {
  Frame frame = stocked_frame();
  const std::uint32_t left = add_node(frame, {}, true);
  add_beam(frame, "beam", left, add_node(frame, {6, 0, 0}, true));
  join(frame);
  EXPECT_EQ(joint_names(frame), (Names{"beam@ground@node_0", "beam@ground@node_1"}));
  EXPECT_EQ(text_of(defects_of(frame)), "");
}

TEST(FrameJoints, AStarOfBeamsHangsOnItsFirst) {
  Frame frame = stocked_frame();
  const std::uint32_t hub = add_node(frame, {0, 5, 0});
  for (int i = 0; i < 5; ++i) {
    const Vec3 foot{i < 2 ? -4.0 : 4.0, 0, 2.0 * i};
    add_beam(frame, "beam_" + std::to_string(i), add_node(frame, foot, true), hub);
  }
  join(frame);
  std::size_t at_hub = 0;
  for (const FrameJoint& joint : frame.joints) {
    if (joint.node != hub) continue;
    ++at_hub;
    EXPECT_EQ(joint.b, 0u);
    EXPECT_NE(joint.a, 0u);
  }
  EXPECT_EQ(at_hub, 4u);
  EXPECT_EQ(frame.joints.size(), 9u);
}

TEST(FrameJoints, BeamsUnderAPostThatEndsOnThemHangOnIt) {
  Frame frame = bridge();
  add_member(frame, "stub", Kind::post, 1, add_node(frame, {6, 8, 0}), 0);
  join(frame);
  EXPECT_EQ(joint_names(frame), (Names{"west@ground", "west@stub", "east@stub", "east@ground"}));
  EXPECT_EQ(text_of(defects_of(frame)), "");
}

TEST(FrameJoints, StandAtEndsOrMiddlesOfTheirParts) {
  RegularBuilding building = regular(3, 4, 3, 0.1);
  building.position = {7, -3, 11};
  const Frame frame = joined(building);
  const std::vector<PartSolid> solids = solids_of(frame);
  // Beyond the solid, at most half a post and its gap, half a beam and the wall's gap.
  const auto distance = [&](std::uint32_t part, Vec3 point) {
    const PartSolid& s = solids[part];
    const Vec3 p = into(s.axes, point - s.centre);
    const Box box = bounding_box(s.hull);
    return std::max({box.low.x - p.x, p.x - box.high.x, box.low.y - p.y, p.y - box.high.y,
                     std::fabs(p.z) - s.half_length});
  };
  for (const FrameJoint& joint : frame.joints) {
    EXPECT_LT(distance(joint.a, joint.point), 0.31) << joint.name;
    if (joint.b == kNoPart) continue;
    EXPECT_LT(distance(joint.b, joint.point), 1e-9) << joint.name;
  }
}

// --- Strength ---

TEST(FrameJoints, CarryWhatTheSectionCarries) {
  const Frame frame = joined(regular(2, 2, 1));
  const JointStrength post = joint_named(frame, "post_0_0_0@ground").strength;
  EXPECT_NEAR(post.force.x, 149.1e-4 * 235e6, 1e-3);
  EXPECT_NEAR(post.torque.y, 1869e-6 * 235e6, 1e-3);
  EXPECT_TRUE(post.bearing);
  EXPECT_NEAR(post.web_share, (149.1 - 2 * 30 * 1.9) / 149.1, 1e-12);
  const JointStrength beam = joint_named(frame, "beam_x_0_0_0@post_0_0_0").strength;
  EXPECT_NEAR(beam.force.x, 53.81e-4 * 235e6, 1e-3);
  EXPECT_NEAR(beam.force.z, 25.68e-4 * 235e6 / std::sqrt(3), 1e-3);
  EXPECT_NEAR(beam.torque.y, 628.4e-6 * 235e6, 1e-3);
  EXPECT_FALSE(beam.bearing);
  EXPECT_EQ(beam.interaction, Interaction::linear);
  const JointStrength slab = joint_named(frame, "slab_0_0_0@beam_x_0_0_0").strength;
  EXPECT_EQ(slab.force, (Vec3{0.3e6, 0.3e6, 0.3e6}));
  EXPECT_EQ(slab.torque, (Vec3{100e3, 100e3, 100e3}));
  EXPECT_EQ(slab.interaction, Interaction::ellipsoid);
}

TEST(FrameJoints, OfTwoPostsTheWeakerDecides) {
  RegularBuilding building = regular(2, 2, 3);
  building.storeys[1].post_section = "IPE300";
  const Frame frame = joined(building);
  for (const char* name : {"post_0_0_1@post_0_0_0", "post_0_0_2@post_0_0_1"}) {
    EXPECT_NEAR(joint_named(frame, name).strength.force.x, 53.81e-4 * 235e6, 1e-3) << name;
  }
}

TEST(FrameJoints, ClassesOfTheSceneReplaceTheBuiltInOnes) {
  Frame frame = stocked_frame();
  add_regular(frame, regular(2, 2, 1, 0.1));
  frame.classes = {{.name = "beam",
                    .strength = 2,
                    .force = {1, 2, 3},
                    .torque = {4, 5, 6},
                    .interaction = "box",
                    .bearing = true,
                    .friction = 0.7},
                   {.name = "slab", .strength = 3}};
  join(frame);
  const FrameJoint& beam = joint_named(frame, "beam_x_0_0_0@post_0_0_0");
  EXPECT_EQ(frame.classes[beam.joint_class].name, "beam");
  EXPECT_EQ(beam.strength.force, (Vec3{2, 4, 6}));
  EXPECT_EQ(beam.strength.torque, (Vec3{8, 10, 12}));
  EXPECT_EQ(beam.strength.interaction, Interaction::box);
  EXPECT_TRUE(beam.strength.bearing);
  EXPECT_EQ(beam.strength.friction, 0.7);
  const FrameJoint& slab = joint_named(frame, "slab_0_0_0@beam_x_0_0_0");
  EXPECT_NEAR(slab.strength.force.x, 0.9e6, 1e-6);
  EXPECT_EQ(slab.strength.interaction, Interaction::linear);
  ASSERT_EQ(frame.classes.size(), 4u);
  EXPECT_EQ(frame.classes[joint_named(frame, "post_0_0_0@ground").joint_class].name, "post");
  EXPECT_EQ(frame.classes[joint_named(frame, "wall_x_0_0_0@beam_x_0_0_0").joint_class].name,
            "wall");
}

TEST(FrameJoints, JoiningAgainChangesNothing) {
  Frame frame = joined(regular(3, 2, 2, 0.1));
  const Names before = joint_names(frame);
  join(frame);
  EXPECT_EQ(joint_names(frame), before);
  EXPECT_EQ(frame.classes.size(), 4u);
}

TEST(FrameJoints, AClassNeedsAllSixResistances) {
  Frame frame = bridge();
  frame.classes = {{.name = "beam", .force = {1e5, 1e5, 0}, .torque = {1, 1, 1}}};
  EXPECT_NE(refusal(frame, {}).find("joint class beam"), std::string::npos);
  frame.classes = {{.name = "beam", .force = {1e5, 1e5, 1e5}}};
  EXPECT_NE(refusal(frame, {}).find("joint class beam"), std::string::npos);
}

// --- Given joints ---

TEST(FrameJoints, GivenOnesReplaceThoseOfMembersOnly) {
  Frame frame = stocked_frame();
  RegularBuilding building = regular(2, 2, 1);
  add_regular(frame, building);
  frame.classes = {{.name = "pin", .strength = 0.5}};
  join(frame, {{"post_0_0_0", "ground", "node_0_0_0", ""},
               {"beam_x_0_0_0", "post_0_0_0", "node_0_0_1", "pin"}});
  EXPECT_EQ(joint_names(frame), (Names{"post_0_0_0@ground", "beam_x_0_0_0@post_0_0_0",
                                       "slab_0_0_0@beam_x_0_0_0", "slab_0_0_0@beam_z_1_0_0",
                                       "slab_0_0_0@beam_x_0_1_0", "slab_0_0_0@beam_z_0_0_0"}));
  EXPECT_TRUE(frame.joints[0].strength.bearing);
  EXPECT_EQ(frame.joints[0].end_a, 0);
  EXPECT_EQ(frame.joints[1].end_b, 1);
  EXPECT_NEAR(frame.joints[1].strength.force.x, 0.5 * 53.81e-4 * 235e6, 1e-3);
}

TEST(FrameJoints, GivenOnesThatMakeNoSenseAreRefusedByName) {
  const Frame frame = bridge();
  struct Row {
    std::vector<GivenJoint> given;
    std::string reason;
  };
  const GivenJoint good{"east", "west", "node_1", ""};
  EXPECT_EQ(refusal(frame, {good}), "no error");
  for (const Row& row : std::vector<Row>{
           {{{"nord", "west", "node_1", ""}}, "there is no post or beam nord"},
           {{{"east", "nord", "node_1", ""}}, "there is no post or beam nord"},
           {{{"east", "west", "node_9", ""}}, "there is no node node_9"},
           {{{"east", "west", "node_0", ""}}, "east does not end at node node_0"},
           {{{"east", "west", "node_2", ""}}, "west does not end at node node_2"},
           {{{"east", "ground", "node_1", ""}}, "node node_1 is not a support"},
           {{{"east", "east", "node_1", ""}}, "a part cannot be joined to itself"},
           {{{"east", "west", "node_1", "glue"}}, "there is no joint class glue"},
           {{good, good}, "is given twice"},
           {{good, {"west", "east", "node_1", ""}}, "is given twice"},
       }) {
    const std::string error = refusal(frame, row.given);
    EXPECT_NE(error.find(row.reason), std::string::npos) << error;
    EXPECT_NE(error.find(row.given.back().of), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace sunder
