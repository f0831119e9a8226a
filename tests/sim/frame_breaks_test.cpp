// SPDX-License-Identifier: GPL-3.0-or-later
// What breaks leave of a standing frame's motion and energy, and what does not stand any more.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sim/frame_motion.hpp"
#include "sim/frames.hpp"

namespace sunder {
namespace {

CollapseScene hybrid_scene(std::size_t posts, std::size_t rows, std::size_t storeys) {
  CollapseScene scene = regular_scene(posts, rows, storeys);
  scene.simulation.solver = "hybrid";
  return scene;
}

/// Without the run: a motion whose joints the test breaks.
struct Rig {
  explicit Rig(const CollapseScene& given)
      : scene(given), solids(solids_of(scene.frame)), world(WorldParams{}) {
    motion = elastic_motion(scene, world, solids);
    motion->settle({});
  }
  void steps(int count) {
    for (; count > 0; --count) {
      world.step(scene.simulation.step);
      now += scene.simulation.step;
      motion->follow(now, scene.simulation.step, true);
    }
  }
  /// With all that cannot hold any more then.
  void cut(std::vector<std::uint32_t> joints) {
    while (!joints.empty()) {
      for (const std::uint32_t j : joints) motion->break_joint(j, true);
      broken.insert(broken.end(), joints.begin(), joints.end());
      motion->settle_breaks();
      joints = motion->unheld_joints();
    }
  }
  bool is_broken(std::uint32_t joint) const { return std::ranges::count(broken, joint) > 0; }
  CollapseScene scene;
  std::vector<PartSolid> solids;
  RigidWorld world;
  std::unique_ptr<FrameMotion> motion;
  std::vector<std::uint32_t> broken;
  double now = 0;
};

// Slabs and the ends of members are carried by other masses after a break, which move otherwise.
TEST(FrameBreaks, NoBreakOfARingingFrameGivesEnergy) {
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    Rig rig(hybrid_scene(3, 2, 2));
    std::mt19937 random(seed);
    double last = 0;
    for (int i = 0; i < 12; ++i) {
      const auto j = static_cast<std::uint32_t>(random() % rig.scene.frame.joints.size());
      if (rig.is_broken(j)) continue;
      rig.cut({j});
      const double now = rig.motion->losses().fracture;
      EXPECT_GE(now, last - 1e-6) << "seed " << seed << ", break " << i;
      last = now;
      rig.steps(5);
    }
    EXPECT_GT(last, 1) << "seed " << seed;
  }
}

// The beams there hang on one another from then on: where they were.
TEST(FrameBreaks, NodeStaysWhereItWasWhenItsPostIsTakenAway) {
  Rig rig(hybrid_scene(2, 2, 3));
  const std::uint32_t post = part_named(rig.scene.frame, "post_0_0_2");
  const std::uint32_t node = rig.scene.frame.members[post].to;
  rig.motion->rejoin(hand_over_joints(rig.scene.frame, post));
  const Vec3 before = rig.motion->displacement(node);
  ASSERT_LT(before.y, 0);
  std::vector<std::uint32_t> joints;
  for (std::uint32_t j = 0; j < rig.scene.frame.joints.size(); ++j)
    if (rig.scene.frame.joints[j].a == post || rig.scene.frame.joints[j].b == post)
      joints.push_back(j);
  rig.cut(joints);
  EXPECT_EQ(rig.motion->displacement(node), before);
  EXPECT_GE(rig.motion->losses().fracture, 0);
}

// The slab goes, and with it what bent the beam between its hinges: they do not turn back.
TEST(FrameBreaks, HingesGiveNothingBackWhenTheirLoadGoes) {
  CollapseScene scene = hybrid_scene(2, 2, 1);
  for (JointClass& joint : scene.frame.classes) joint.rotation_capacity = 0.2;
  Rig rig(scene);
  const Frame& frame = rig.scene.frame;
  std::vector<std::uint32_t> of_slab;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
    if (frame.joints[j].a == frame.slab_part(0)) of_slab.push_back(j);
  for (const char* name : {"beam_x_0_0_0@post_0_0_0", "beam_x_0_0_0@post_1_0_0"}) {
    const std::uint32_t j = joint_named(frame, name);
    const Vec3 moment = rig.motion->load(j).torque;
    ASSERT_TRUE(rig.motion->yield(j, {0, 0.5 * moment.y, 0.5 * moment.z}));
  }
  rig.motion->settle_breaks();
  rig.steps(3);
  const double plastic = rig.motion->losses().plastic, fracture = rig.motion->losses().fracture;
  ASSERT_GT(plastic, 1);
  rig.cut(of_slab);
  EXPECT_GE(rig.motion->losses().plastic, plastic * (1 - 1e-12));
  EXPECT_GE(rig.motion->losses().fracture, fracture - 1e-9 * plastic);
}

/// Two beams in line between two posts, on hinges, with a third post under the middle.
CollapseScene three_hinges() {
  CollapseScene scene;
  scene.simulation.solver = "hybrid";
  Frame& frame = scene.frame;
  frame = empty_frame();
  frame.nodes = {{"left", {0, 0, 0}, true},   {"top_left", {0, 3.5, 0}, false},
                 {"middle", {5, 0, 0}, true}, {"top", {5, 3.5, 0}, false},
                 {"right", {10, 0, 0}, true}, {"top_right", {10, 3.5, 0}, false}};
  using Kind = FrameMember::Kind;
  frame.members = {{"post_left", Kind::post, 0, 1, 0, 0, 0},
                   {"prop", Kind::post, 2, 3, 0, 0, 0},
                   {"post_right", Kind::post, 4, 5, 0, 0, 0},
                   {"beam_left", Kind::beam, 1, 3, 2, 0, 0},
                   {"beam_right", Kind::beam, 3, 5, 2, 0, 0}};
  frame.classes = built_in_classes();
  join(frame);
  for (const FrameJoint& joint : frame.joints)
    if (frame.members[joint.a].kind == Kind::beam) frame.classes[joint.joint_class].rigid = false;
  scene.scenario.remove = {"prop"};
  scene.simulation.duration = 0.7;
  return scene;
}

// Without the prop three hinges are in line: nothing holds the beams, at rest or in time.
TEST(FrameBreaks, BeamsOnThreeHingesInLineFall) {
  for (const bool quasi_static : {true, false}) {
    CollapseScene scene = three_hinges();
    scene.simulation.quasi_static = quasi_static;
    const CollapseResult r = simulate_collapse(scene);
    const auto by = [&](std::string_view mode) {
      return std::ranges::count(r.broken_joints, mode, &JointBreak::mode);
    };
    EXPECT_GE(by("mechanism"), 1) << quasi_static;
    EXPECT_EQ(by("mechanism") + by("removed") + by("unheld"),
              static_cast<long>(r.broken_joints.size()));
    EXPECT_EQ(r.parts_freed, 3u) << "the prop, the beams; the posts stand";
    EXPECT_LT(r.max_utilisation, 1);
    EXPECT_GE(r.energy.fracture, 0);
    EXPECT_LT(std::fabs(r.energy.numerical), 1e-9 * std::fabs(r.energy.potential));
    EXPECT_EQ(r.broken_joints.back().time < 0.01, quasi_static) << "in time they fall first";
  }
}

// As long as it stands on its prop it stands.
TEST(FrameBreaks, BeamsOnAPropStand) {
  CollapseScene scene = three_hinges();
  scene.scenario.remove.clear();
  scene.simulation.duration = 0.1;
  EXPECT_TRUE(simulate_collapse(scene).broken_joints.empty());
}

// In balance at any time nothing that a blow breaks gives energy, and no work goes unseen.
TEST(FrameBreaks, BlowOnAFrameInBalanceKeepsTheBooks) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
    };
    CollapseScene scene = hybrid_scene(2, 2, 2);
    scene.simulation.quasi_static = true;
    scene.projectiles.resize(1);
    scene.projectiles[0] = {.name = "ball",
                            .radius = 0.5,
                            .mass = between(500, 5000),
                            .position = {-1, between(1, 6), between(0, 6)},
                            .velocity = {between(5, 40), 0, 0}};
    scene.simulation.duration = 0.15;
    const CollapseResult r = simulate_collapse(scene);
    EXPECT_LT(std::fabs(r.energy.contact), 2 * r.energy_in) << "seed " << seed;
    EXPECT_GE(r.energy.fracture, -1e-6 * r.energy_in) << "seed " << seed;
    EXPECT_LT(std::fabs(r.energy.numerical), 1e-8 * r.energy_in) << "seed " << seed;
  }
}

}  // namespace
}  // namespace sunder
