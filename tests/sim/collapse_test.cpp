// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/collapse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "meshing/error.hpp"
#include "sim/frames.hpp"
#include "sim/post_stability.hpp"

namespace sunder {
namespace {

std::size_t count_of(const CollapseResult& result, std::string_view mode) {
  return static_cast<std::size_t>(
      std::ranges::count(result.broken_joints, mode, &JointBreak::mode));
}

Projectile ball(double mass, Vec3 position, Vec3 velocity) {
  Projectile p;
  p.name = "ball";
  p.radius = 0.5;
  p.mass = mass;
  p.position = position;
  p.velocity = velocity;
  return p;
}

TEST(Collapse, BuildingAtRestStandsOnItsSupports) {
  CollapseScene scene = regular_scene(3, 3, 3);
  scene.simulation.duration = 0.5;
  scene.simulation.settle = 3;
  const CollapseResult result = simulate_collapse(scene);
  double mass = 0;
  for (std::uint32_t part = 0; part < scene.frame.part_count(); ++part)
    mass += solid_of(scene.frame, part).mass;
  EXPECT_NEAR(result.weight, mass * 9.81, 1e-6);
  ASSERT_EQ(result.supports.size(), 9u);
  EXPECT_LT(result.reaction_error, 1e-4);
  EXPECT_LT(result.sag_max, 5e-4) << "rigid members do not sag";
  EXPECT_LT(result.utilisation_at_rest, 1);
  EXPECT_TRUE(result.broken_joints.empty());
  EXPECT_EQ(result.parts_freed, 0u);
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_GT(result.body_steps_asleep, 0u);
}

TEST(Collapse, EnergyAndMomentumAreAccounted) {
  CollapseScene scene = regular_scene(2, 2, 3);
  scene.projectiles = {ball(4000, {-3, 3.6, 0.2}, {25, 0, 0})};
  scene.simulation.duration = 2.5;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_GT(r.parts_freed, 5u);
  EXPECT_LT(r.energy.potential, -1e5) << "it came down";
  EXPECT_LT(std::fabs(r.energy.numerical), 1e-6 * -r.energy.potential);
  EXPECT_LT(r.momentum_error, 1e-10);
  EXPECT_GT(r.energy.contact, 0);
  EXPECT_TRUE(r.projectiles[0].hit);
  EXPECT_NEAR(r.projectiles[0].speed_before, 25, 0.5);
  EXPECT_GT(count_of(r, "hit"), 0u);
}

TEST(Collapse, SameSceneSameBitsAlsoWithoutSkipping) {
  CollapseScene scene = regular_scene(2, 3, 2);
  scene.projectiles = {ball(2000, {-3, 4, 0.2}, {20, 0, 0})};
  scene.projectiles[0].time = 0.1;
  scene.simulation.duration = 1;
  scene.simulation.settle = 3;
  const CollapseResult one = simulate_collapse(scene), two = simulate_collapse(scene);
  const CollapseResult all = simulate_collapse(scene, {.skip = false});
  EXPECT_EQ(one.hash, two.hash);
  EXPECT_EQ(one.hash, all.hash);
  EXPECT_EQ(one.broken_joints.size(), all.broken_joints.size());
  EXPECT_EQ(one.max_utilisation, all.max_utilisation);
  EXPECT_GT(one.joint_steps_not_read, 0u);
  EXPECT_EQ(all.joint_steps_not_read, 0u);
}

TEST(Collapse, RemovedPostTakesItsJointsAlong) {
  CollapseScene scene = regular_scene(3, 2, 2);
  scene.scenario.remove = {"post_1_0_0"};
  scene.simulation.duration = 0.3;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_EQ(count_of(r, "removed"), 2u) << "foot and splice; the beams meet the post above";
  EXPECT_EQ(count_of(r, "strength"), 0u);
  const std::uint32_t post = part_named(scene.frame, "post_1_0_0");
  EXPECT_EQ(r.recording.parts[post].removed, 0);
  EXPECT_TRUE(std::isinf(r.recording.parts[post - 1].removed));
  scene.scenario.remove = {"post_9_9_9"};
  EXPECT_THROW(simulate_collapse(scene), Error);
}

/// The upper one first: what the lower one carried does not go to one that is gone.
TEST(Collapse, PostsOfAColumnMayBeRemovedInAnyOrder) {
  for (const char* solver : {"bullet", "hybrid"}) {
    CollapseScene scene = regular_scene(2, 2, 2);
    scene.simulation.solver = solver;
    scene.rules.breaking = false;
    scene.scenario.remove = {"post_0_1_1", "post_0_1_0"};
    scene.simulation.duration = 0.05;
    const CollapseResult r = simulate_collapse(scene);
    int intact = 0;
    for (const char* name : {"beam_x_0_1_0@post_0_1_0", "beam_z_0_0_0@post_0_1_0"}) {
      ASSERT_NE(joint_named(scene.frame, name), kNoPart);
      intact += std::isinf(r.recording.joints[joint_named(scene.frame, name)].broken);
    }
    EXPECT_EQ(intact, 1) << solver << ": one beam took the post's place for the other";
    EXPECT_LT(r.momentum_error, 1e-10);
  }
}

/// The paper's rule: a splice fails when the last beam joint at it is gone.
TEST(Collapse, SpliceWithoutBeamsFailsByThePapersRule) {
  CollapseScene scene = regular_scene(2, 2, 3);
  scene.rules.post_rule = "unbraced";
  scene.scenario.remove = {"beam_x_0_0_0", "beam_z_0_0_0"};
  scene.simulation.duration = 0.02;
  const CollapseResult r = simulate_collapse(scene);
  ASSERT_EQ(count_of(r, "unbraced"), 1u);
  const auto found = std::ranges::find(r.broken_joints, "unbraced", &JointBreak::mode);
  EXPECT_EQ(scene.frame.joints[found->joint].name, "post_0_0_1@post_0_0_0");
  EXPECT_EQ(found->rule, "paper");
  scene.rules.post_rule = "none";
  EXPECT_EQ(count_of(simulate_collapse(scene), "unbraced"), 0u);
}

/// A slab on four posts, its load rising until a post buckles. Rigid bodies share the load unevenly
/// (nothing tells them how), so the first post fails below a quarter of the whole.
TEST(Collapse, RisingLoadBreaksThePostThatReachesItsBucklingResistance) {
  for (const std::string rule : {"ec3", "euler"}) {
    StoreyParams storey;
    storey.height = 10.5;
    storey.post_section = "HEB200";
    CollapseScene scene = regular_scene(2, 2, 1, storey);
    for (FrameJoint& joint : scene.frame.joints) {
      joint.strength.force = 1e3 * joint.strength.force;
      joint.strength.torque = 1e3 * joint.strength.torque;
    }
    scene.rules.post_rule = rule;
    scene.scenario.load_rate = 20000;
    scene.simulation.duration = 2.5;
    scene.simulation.history_step = scene.simulation.step;
    const CollapseResult r = simulate_collapse(scene);
    ASSERT_FALSE(r.broken_joints.empty());
    const JointBreak& first = r.broken_joints[0];
    EXPECT_EQ(first.mode, "buckling");
    EXPECT_EQ(first.rule, rule);
    const Section& section = scene.frame.sections[1];
    const SteelGrade& steel = scene.frame.steels[0];
    const double resistance = rule == "ec3" ? buckling_resistance(section, steel, {10.5, 10.5})
                                            : euler_load(section, steel, {10.5, 10.5});
    // The sample before the break: largest force at a foot.
    const Recording& recording = r.recording;
    const auto at = std::ranges::lower_bound(recording.sample_times, first.time - 1e-9);
    const std::size_t sample = static_cast<std::size_t>(at - recording.sample_times.begin()) - 1;
    double largest = 0;
    for (std::uint32_t j = 0; j < recording.joints.size(); ++j)
      if (recording.joints[j].part_b == kNoTrack)
        largest = std::max(
            largest,
            -static_cast<double>(recording.samples[sample * recording.joints.size() + j].force[0]));
    EXPECT_NEAR(largest, resistance, 0.01 * resistance) << rule;
    const double even = (4 * resistance - r.weight) / 36;
    EXPECT_LE(r.first_failure_load, even);
    EXPECT_GE(r.first_failure_load, 0.7 * even);
  }
}

/// Ground that accelerates steadily drags the building along: base shear = mass × acceleration.
TEST(Collapse, ShakenGroundShearsTheBase) {
  CollapseScene scene = regular_scene(2, 2, 1);
  scene.rules.breaking = false;
  scene.scenario.ground_motion = {{0, 1}, {{2, 0, 0}, {2, 0, 0}}};
  scene.simulation.duration = 1;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_NEAR(r.reactions[0], r.weight / 9.81 * 2, 1e-3 * r.weight / 9.81 * 2);
  EXPECT_NEAR(r.reactions[1], r.weight, 1e-3 * r.weight);
}

TEST(Collapse, GroundMotionIsLinearBetweenItsTimes) {
  const GroundMotion motion{{0, 1, 3}, {{0, 0, 0}, {2, 0, 4}, {0, 6, 0}}};
  EXPECT_EQ(motion.at(0.5), (Vec3{1, 0, 2}));
  EXPECT_EQ(motion.at(2), (Vec3{1, 3, 2}));
  EXPECT_EQ(motion.at(5), (Vec3{}));
  EXPECT_EQ(GroundMotion{}.at(1), (Vec3{}));
}

TEST(Collapse, UnbreakableBuildingKeepsAllJoints) {
  CollapseScene scene = regular_scene(2, 2, 2);
  scene.rules.breaking = false;
  scene.projectiles = {ball(5000, {-3, 3.4, 0.1}, {30, 0, 0})};
  scene.simulation.duration = 0.5;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_TRUE(r.broken_joints.empty());
  EXPECT_GT(r.max_utilisation, 1) << "it would have broken";
  EXPECT_TRUE(r.projectiles[0].hit);
}

TEST(Collapse, WeakJointsBreakAtRestAndAreTold) {
  CollapseScene scene = regular_scene(2, 2, 1);
  for (FrameJoint& joint : scene.frame.joints)
    if (joint.kind == FrameJoint::Kind::slab) joint.strength.force = {1e3, 1e3, 1e3};
  scene.simulation.duration = 0.1;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_EQ(r.broken_at_rest, 4u);
  EXPECT_GT(r.utilisation_at_rest, 10);
  EXPECT_FALSE(r.warnings.empty());
}

/// One that fell asleep while it settled is judged as well, whether its history is kept or not.
TEST(Collapse, WeakJointsOfASleepingBuildingBreakAtRest) {
  CollapseScene scene = regular_scene(2, 2, 1);
  for (FrameJoint& joint : scene.frame.joints)
    if (joint.kind == FrameJoint::Kind::slab) joint.strength.force = {1e3, 1e3, 1e3};
  scene.simulation.settle = 3;
  scene.simulation.duration = 0.1;
  for (const bool skip : {true, false}) {
    for (const bool keep_history : {true, false}) {
      const CollapseResult r =
          simulate_collapse(scene, {.skip = skip, .keep_history = keep_history});
      EXPECT_EQ(r.broken_at_rest, 4u) << "skip " << skip << ", history " << keep_history;
    }
  }
}

TEST(Collapse, OverloadedPostOfASleepingBuildingBuckles) {
  CollapseScene scene = regular_scene(2, 2, 1);
  for (FrameJoint& joint : scene.frame.joints) joint.strength.force.x *= 100;
  for (SteelGrade& steel : scene.frame.steels) steel.yield_strength = 1e5;
  scene.simulation.settle = 3;
  scene.simulation.duration = 0.1;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_GT(r.utilisation_at_rest, 1) << "of a post: joints have the strength they had";
  EXPECT_GT(count_of(r, "buckling"), 0u);
}

TEST(Collapse, NothingFollowsARemovalInAnUnbreakableBuilding) {
  CollapseScene scene = regular_scene(2, 2, 3);
  scene.rules.post_rule = "unbraced";
  scene.rules.breaking = false;
  scene.scenario.remove = {"beam_x_0_0_0", "beam_z_0_0_0"};
  scene.simulation.duration = 0.02;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_EQ(count_of(r, "removed"), r.broken_joints.size());
}

TEST(Collapse, RemovalIsNotTheFailureThatARisingLoadCauses) {
  CollapseScene scene = regular_scene(2, 2, 1);
  for (FrameSlab& slab : scene.frame.slabs) slab.live_load = 500;
  scene.scenario.remove = {"beam_x_0_0_0"};
  scene.scenario.load_rate = 1;
  scene.rules.breaking = false;
  scene.simulation.duration = 0.02;
  EXPECT_EQ(simulate_collapse(scene).first_failure_load, 0);
}

TEST(Collapse, WithoutGravityTheReportIsFinite) {
  CollapseScene scene = regular_scene(2, 2, 1);
  scene.simulation.gravity = 0;
  scene.simulation.duration = 0.02;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_EQ(r.weight, 0);
  EXPECT_EQ(r.reaction_error, 0);
}

/// A ball that appears far away, just after a step began, changes nothing: no step becomes so short
/// that its loads are noise.
TEST(Collapse, TimeOfAFarBallIsNotFelt) {
  CollapseScene scene = regular_scene(2, 2, 2);
  scene.rules.load_time = 0;
  scene.simulation.sleep = false;
  scene.simulation.duration = 0.1;
  const double alone = simulate_collapse(scene).max_utilisation;
  scene.projectiles = {ball(1, {-200, 50, 0}, {0, 0, 0})};
  scene.projectiles[0].time = 0.05 + 1e-12;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_LT(r.max_utilisation, 1.5 * alone);
  EXPECT_TRUE(r.broken_joints.empty());
}

TEST(Collapse, MomentumErrorOfABuildingAtRestIsRounding) {
  CollapseScene scene = regular_scene(2, 2, 1);
  scene.simulation.settle = 3;
  scene.simulation.sleep = false;
  scene.simulation.duration = 0.1;
  EXPECT_LT(simulate_collapse(scene).momentum_error, 1e-12);
}

TEST(Collapse, HistoryHoldsTheLoadsOfIntactJoints) {
  CollapseScene scene = regular_scene(2, 2, 1);
  scene.simulation.duration = 0.5;
  scene.simulation.settle = 3;
  const CollapseResult r = simulate_collapse(scene);
  const Recording& recording = r.recording;
  ASSERT_EQ(recording.samples.size(), recording.sample_times.size() * recording.joints.size());
  EXPECT_NEAR(static_cast<double>(recording.sample_times.size()), 16, 1);
  for (std::size_t t = 0; t < recording.sample_times.size(); ++t) {
    double sum = 0;
    for (std::uint32_t j = 0; j < recording.joints.size(); ++j) {
      const JointSample& sample = recording.samples[t * recording.joints.size() + j];
      EXPECT_GT(sample.utilisation, 0);
      if (recording.joints[j].part_b == kNoTrack) sum += sample.force[0];
    }
    EXPECT_NEAR(sum, -r.weight, 1e-4 * r.weight) << "compression is negative";
  }
}

TEST(Collapse, BallInsideTheBuildingIsRefused) {
  CollapseScene scene = regular_scene(2, 2, 1);
  scene.projectiles = {ball(100, {0, 1.5, 0}, {1, 0, 0})};
  try {
    simulate_collapse(scene);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("inside \"post_0_0_0\""), std::string::npos)
        << error.what();
  }
}

// ---------------------------------------------------------------------------------------------
// Posts and their bracing, without any motion.

TEST(PostStability, FreeLengthGrowsWithEachStoreyThatLostItsBeams) {
  const CollapseScene scene = regular_scene(2, 2, 4);
  const Frame& frame = scene.frame;
  PostStability posts(frame, "ec3");
  const std::uint32_t post = part_named(frame, "post_0_0_0");
  EXPECT_DOUBLE_EQ(posts.free_length(post).about_y, 3.5);
  const double braced = posts.resistance(post);
  posts.break_joint(joint_named(frame, "beam_x_0_0_0@post_0_0_0"));
  // The web lies along z: buckling about y moves the post along z, which the other beam still
  // holds.
  EXPECT_DOUBLE_EQ(posts.free_length(post).about_y, 3.5);
  EXPECT_DOUBLE_EQ(posts.free_length(post).about_z, 7);
  EXPECT_LT(posts.resistance(post), braced);
  posts.break_joint(joint_named(frame, "beam_z_0_0_0@post_0_0_0"));
  EXPECT_DOUBLE_EQ(posts.free_length(post).about_y, 7);
  posts.break_joint(joint_named(frame, "beam_x_0_0_1@post_0_0_1"));
  posts.break_joint(joint_named(frame, "beam_z_0_0_1@post_0_0_1"));
  EXPECT_DOUBLE_EQ(posts.free_length(post).about_z, 10.5);
  EXPECT_DOUBLE_EQ(posts.free_length(part_named(frame, "post_0_0_2")).about_z, 10.5);
  EXPECT_DOUBLE_EQ(posts.free_length(part_named(frame, "post_0_0_3")).about_z, 3.5);
  const auto& section = frame.sections[0];
  EXPECT_DOUBLE_EQ(posts.resistance(post),
                   buckling_resistance(section, frame.steels[0], {10.5, 10.5}));
  PostStability euler(frame, "euler");
  EXPECT_DOUBLE_EQ(euler.resistance(post), section.area * 235e6) << "no more than it squashes at";
  for (const char* beam : {"beam_x_0_0_0@post_0_0_0", "beam_z_0_0_0@post_0_0_0",
                           "beam_x_0_0_1@post_0_0_1", "beam_z_0_0_1@post_0_0_1"})
    euler.break_joint(joint_named(frame, beam));
  EXPECT_DOUBLE_EQ(euler.resistance(post), euler_load(section, frame.steels[0], {10.5, 10.5}));
  EXPECT_TRUE(std::isinf(PostStability(frame, "none").resistance(post)));
}

TEST(PostStability, FreeEndDoublesTheLength) {
  const CollapseScene scene = regular_scene(2, 2, 2);
  const Frame& frame = scene.frame;
  PostStability posts(frame, "ec3");
  const std::uint32_t post = part_named(frame, "post_0_0_1");
  for (const char* beam : {"beam_x_0_0_1@post_0_0_1", "beam_z_0_0_1@post_0_0_1"})
    posts.break_joint(joint_named(frame, beam));
  EXPECT_DOUBLE_EQ(posts.free_length(post).about_y, 7) << "a cantilever above the first floor";
  posts.break_joint(joint_named(frame, "post_0_0_1@post_0_0_0"));
  EXPECT_DOUBLE_EQ(posts.free_length(post).about_y, 7) << "the beams below hold the joint's node";
}

/// Two posts that lean on each other: neither goes on in the other, and the walk along them ends.
TEST(PostStability, LeaningPostsEndWhereTheyMeet) {
  CollapseScene scene = regular_scene(2, 2, 1);
  Frame& frame = scene.frame;
  frame.slabs.clear();
  frame.nodes = {{"a", {0, 0, 0}, true}, {"b", {4, 0, 0}, true}, {"top", {2, 4, 0}, false}};
  frame.members = {{"left", FrameMember::Kind::post, 0, 2, 0, 0, 0},
                   {"right", FrameMember::Kind::post, 1, 2, 0, 0, 0}};
  join(frame);
  PostStability posts(frame, "ec3");
  const double length = std::sqrt(20.0);
  for (const std::uint32_t post : {0u, 1u})
    EXPECT_DOUBLE_EQ(posts.free_length(post).about_y, 2 * length) << "nothing holds the top";
  posts.break_joint(joint_named(frame, "right@left"));
  EXPECT_DOUBLE_EQ(posts.free_length(0).about_z, 2 * length);
}

TEST(PostStability, LongFreeLengthBucklesAtItsMiddle) {
  const CollapseScene scene = regular_scene(2, 2, 4);
  const Frame& frame = scene.frame;
  PostStability posts(frame, "ec3");
  const std::uint32_t post = part_named(frame, "post_0_0_0");
  EXPECT_EQ(posts.joints_of_buckling(post).size(), 4u) << "foot, splice, two beams";
  for (const char* beam : {"beam_x_0_0_0@post_0_0_0", "beam_z_0_0_0@post_0_0_0"})
    posts.break_joint(joint_named(frame, beam));
  EXPECT_EQ(posts.joints_of_buckling(post),
            std::vector{joint_named(frame, "post_0_0_1@post_0_0_0")});
  EXPECT_EQ(posts.joints_of_buckling(part_named(frame, "post_0_0_1")),
            posts.joints_of_buckling(post));
}

TEST(PostStability, BeamWhoseFarEndBrokeBracesNothing) {
  const CollapseScene scene = regular_scene(2, 2, 2);
  const Frame& frame = scene.frame;
  PostStability posts(frame, "ec3");
  const std::uint32_t post = part_named(frame, "post_0_0_0");
  EXPECT_DOUBLE_EQ(posts.free_length(post).about_z, 3.5);
  const double braced = posts.resistance(post);
  posts.break_joint(joint_named(frame, "beam_x_0_0_0@post_1_0_0"));
  EXPECT_DOUBLE_EQ(posts.free_length(post).about_z, 7);
  EXPECT_LT(posts.resistance(post), braced) << "what was known of the other column is forgotten";
}

TEST(PostStability, LongestUnbracedColumnBreaksNearestToItsMiddle) {
  const CollapseScene scene = regular_scene(2, 2, 5);
  const Frame& frame = scene.frame;
  PostStability posts(frame, "ec3");
  for (const char* storey : {"0", "1", "2"})
    for (const char* beam : {"beam_x_0_0_", "beam_z_0_0_"})
      posts.break_joint(joint_named(frame, std::string(beam) + storey + "@post_0_0_" + storey));
  for (const char* post : {"post_0_0_0", "post_0_0_1", "post_0_0_2", "post_0_0_3"})
    EXPECT_EQ(posts.joints_of_buckling(part_named(frame, post)),
              std::vector{joint_named(frame, "post_0_0_2@post_0_0_1")});
}

/// A post is checked by the joint at its foot, whichever of the two parts the joint is named after.
TEST(PostStability, FootIsFoundOnEitherSide) {
  CollapseScene scene = regular_scene(2, 2, 2);
  std::vector<GivenJoint> given;
  for (const FrameJoint& joint : scene.frame.joints) {
    if (joint.node == kNoPart) continue;
    const std::string a = scene.frame.part_name(joint.a);
    const std::string b = joint.b == kNoPart ? "ground" : scene.frame.part_name(joint.b);
    const bool turned = joint.kind == FrameJoint::Kind::splice;
    given.push_back({turned ? b : a, turned ? a : b, scene.frame.nodes[joint.node].name, ""});
  }
  join(scene.frame, given);
  const PostStability posts(scene.frame, "ec3");
  const std::uint32_t upper = part_named(scene.frame, "post_0_0_1");
  ASSERT_NE(posts.foot(upper), kNoPart);
  EXPECT_EQ(scene.frame.joints[posts.foot(upper)].name, "post_0_0_0@post_0_0_1");
}

}  // namespace
}  // namespace sunder
