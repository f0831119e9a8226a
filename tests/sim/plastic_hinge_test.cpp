// SPDX-License-Identifier: GPL-3.0-or-later
// Plastic hinges: collapse loads and rotations against plastic theory in closed form, energy, bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/frame_solver.hpp"
#include "tests/sim/frames.hpp"

namespace sunder {
namespace {

/// Joints whose moments count alone: no axial force takes from them.
JointClass bending_class(const char* name, double capacity) {
  return {.name = name, .interaction = "box", .rotation_capacity = capacity};
}

double plastic_moment(const Frame& frame, std::uint32_t section) {
  return frame.sections[section].wpl_y * frame.steels[0].yield_strength;
}

constexpr std::uint32_t kHeb300 = 0, kIpe300 = 2;

/// A beam along x in two halves.
Frame halved_beam(double span, bool held_at_end, double capacity) {
  Frame frame = empty_frame();
  frame.classes = {bending_class("post", capacity), bending_class("beam", capacity),
                   built_in_classes()[2], built_in_classes()[3]};
  frame.nodes = {{"a", {0, 5, 0}, true}, {"m", {span / 2, 5, 0}}, {"b", {span, 5, 0}, held_at_end}};
  frame.members = {{.name = "left", .from = 0, .to = 1, .section = kIpe300},
                   {.name = "right", .from = 1, .to = 2, .section = kIpe300}};
  std::vector<GivenJoint> given = {{"left", "ground", "a", ""}, {"right", "left", "m", ""}};
  if (held_at_end) given.push_back({"right", "ground", "b", ""});
  join(frame, given);
  return frame;
}

/// Posts at x = 0 and `span`, a beam between their tops.
Frame portal(double span, double height) {
  Frame frame = empty_frame();
  frame.classes = {bending_class("post", 1), bending_class("beam", 1), built_in_classes()[2],
                   built_in_classes()[3]};
  frame.nodes = {{"a", {0, 0, 0}, true},
                 {"b", {span, 0, 0}, true},
                 {"c", {0, height, 0}},
                 {"d", {span, height, 0}}};
  using Kind = FrameMember::Kind;
  frame.members = {{.name = "left", .kind = Kind::post, .from = 0, .to = 2, .section = kHeb300},
                   {.name = "right", .kind = Kind::post, .from = 1, .to = 3, .section = kHeb300},
                   {.name = "beam", .from = 2, .to = 3, .section = kIpe300}};
  for (FrameMember& post : frame.members)
    if (post.kind == Kind::post) post.roll = 2 * std::atan(1.0);  // webs in the frame's plane
  join(frame);
  return frame;
}

/// How a frame went down under a load that grew from `first` by steps.
struct Push {
  double first_yield = 0, collapse = 0;
  std::size_t hinges = 0;
  double work = 0;  ///< of the hinges until the last step, J
};

template <class LoadsAt>
Push push(const Frame& frame, double last, double step, const LoadsAt& loads_at) {
  FrameSolver solver(frame);
  Push result;
  for (double size = step; size < last && solver.mechanisms().empty(); size += step) {
    solver.solve(loads_at(size));
    result.work = 0;
    for (const FrameSolver::Hinge& hinge : solver.hinges())
      result.work += dot(hinge.moment, hinge.rotation);
    for (bool changed = true; changed && solver.mechanisms().empty();) {
      std::vector<FrameSolver::Hinge> now = solver.hinges(), more;
      for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
        const JointLoad load = solver.joint_load(j);
        const double use = utilisation(load, frame.joints[j].strength).total;
        const bool is_hinge = std::ranges::count(now, j, &FrameSolver::Hinge::joint) > 0;
        if (use < 1 || is_hinge) continue;
        EXPECT_TRUE(solver.can_bend(j)) << frame.joints[j].name;
        more.push_back({j, 1 / use * Vec3{0, load.torque.y, load.torque.z}, {}, true});
      }
      changed = !more.empty();
      if (!changed) break;
      if (result.first_yield == 0) result.first_yield = size;
      result.collapse = size;
      solver.set_hinges(more);
      result.hinges = solver.hinges().size();
      solver.solve(loads_at(size));
    }
  }
  if (solver.mechanisms().empty()) result.collapse = 0;
  return result;
}

// q = 12 M/L² where the ends yield, 16 M/L² where the middle does, too (Baker, Horne, Heyman 1956).
TEST(PlasticHinge, FixedBeamYieldsAtItsEndsAndFallsWithItsMiddle) {
  constexpr double kSpan = 12;
  const Frame frame = halved_beam(kSpan, true, 1);
  const double weight = frame.steels[0].density * frame.sections[kIpe300].area;
  const double unit = plastic_moment(frame, kIpe300) / (kSpan * kSpan);
  const Push result = push(frame, 20, 0.002, [&](double q) {
    return FrameLoads{.gravity = {0, -q * unit / weight, 0}};
  });
  EXPECT_NEAR(result.first_yield, 12, 0.0021);
  EXPECT_NEAR(result.collapse, 16, 0.0021);
  EXPECT_EQ(result.hinges, 3u);
}

// Sway: H h = 2 M_post + 2 M_beam.
TEST(PlasticHinge, PortalSwaysAtTheLoadOfItsMechanism) {
  constexpr double kHeight = 4;
  const Frame frame = portal(6, kHeight);
  const double moments = plastic_moment(frame, kHeb300) + plastic_moment(frame, kIpe300);
  const double expected = 2 * moments / kHeight;
  const Push result = push(frame, 2 * expected, expected / 5000, [&](double h) {
    FrameLoads loads{.gravity = {}};
    loads.contacts.push_back({2, {0, kHeight, 0}, {h, 0, 0}});
    return loads;
  });
  EXPECT_NEAR(result.collapse, expected, 3e-4 * expected);
  EXPECT_LT(result.first_yield, 0.99 * expected);
  EXPECT_EQ(result.hinges, 4u);
}

// With one end held at M the other gets q L²/8 − M/2; M short of being fixed it turns by M L/(4 E
// I).
TEST(PlasticHinge, HeldMomentLeavesTheOtherEndItsShare) {
  constexpr double kSpan = 10;
  const Frame frame = halved_beam(kSpan, true, 1);
  const double weight = frame.steels[0].density * frame.sections[kIpe300].area;
  FrameSolver solver(frame, {.shear = false});
  const FrameLoads loads{.gravity = {0, -10, 0}};
  solver.solve(loads);
  const double q = 10 * weight, ql2 = q * kSpan * kSpan;
  const Vec3 held = 0.5 * Vec3{0, solver.joint_load(0).torque.y, 0};
  EXPECT_NEAR(std::fabs(held.y), ql2 / 24, 1e-9 * ql2);
  const FrameSolver::Hinge made{0, held, {}, true};
  solver.set_hinges({&made, 1});
  solver.solve(loads);
  EXPECT_NEAR(solver.joint_load(0).torque.y, held.y, 1e-12 * ql2);
  EXPECT_NEAR(std::fabs(solver.joint_load(2).torque.y), ql2 / 8 - ql2 / 48, 1e-9 * ql2);
  const double stiffness = frame.steels[0].youngs_modulus * frame.sections[kIpe300].iy;
  const FrameSolver::Hinge hinge = solver.hinges().at(0);
  EXPECT_NEAR(hinge.rotation.y, (held.y > 0 ? 1 : -1) * ql2 / 24 * kSpan / (4 * stiffness),
              1e-9 * ql2 * kSpan / stiffness);
  // Stiff at that rotation it stands as it is, and is straight again when turned back.
  FrameSolver::Hinge stiff = hinge;
  stiff.flows = false;
  solver.set_hinges({&stiff, 1});
  solver.solve(loads);
  EXPECT_NEAR(solver.joint_load(0).torque.y, held.y, 1e-9 * ql2);
  stiff.rotation = {};
  solver.set_hinges({&stiff, 1});
  solver.solve(loads);
  EXPECT_NEAR(solver.joint_load(0).torque.y, 2 * held.y, 1e-9 * ql2);
}

/// A cantilever in a ground that accelerates upward, `rate` g more in a second.
CollapseScene heavier_cantilever(double capacity, double rate, double duration) {
  CollapseScene scene;
  scene.frame = halved_beam(6, false, capacity);
  scene.rules.post_rule = "none";
  scene.simulation.solver = "hybrid";
  scene.simulation.duration = duration;
  scene.simulation.step = 0.002;
  scene.simulation.damping_mass = 0;
  scene.scenario.ground_motion.times = {0, duration};
  scene.scenario.ground_motion.accelerations = {{}, {0, 9.81 * rate * duration, 0}};
  return scene;
}

// Beyond M the rod turns about its foot: m L³/3 θ" = M r τ, so θ = r τ³ M/(2 m L³), τ seconds after
// it yields; the load grows by r M in a second.
TEST(PlasticHinge, CantileverTurnsAsFarAsItCanAndBreaks) {
  constexpr double kCapacity = 0.05, kRate = 2, kSpan = 6;
  const CollapseScene scene = heavier_cantilever(kCapacity, kRate, 12);
  const CollapseResult r = simulate_collapse(scene);
  const double moment = plastic_moment(scene.frame, kIpe300);
  const double mass = scene.frame.steels[0].density * scene.frame.sections[kIpe300].area;
  const double weight_moment = mass * 9.81 * kSpan * kSpan / 2;
  const double yield = (moment / weight_moment - 1) / kRate;
  ASSERT_GE(r.yielded_joints.size(), 1u);
  EXPECT_NEAR(r.yielded_joints[0].time, yield, 0.002 * yield);
  ASSERT_GE(r.broken_joints.size(), 1u);
  EXPECT_EQ(r.broken_joints[0].component, "rotation");
  EXPECT_EQ(r.broken_joints[0].joint, r.yielded_joints[0].joint);
  EXPECT_NEAR(r.yielded_joints[0].rotation, kCapacity, 0.05 * kCapacity);
  const double growth = kRate * weight_moment;
  const double later = std::cbrt(2 * kCapacity * mass * std::pow(kSpan, 3) / growth);
  EXPECT_NEAR(r.broken_joints[0].time - r.yielded_joints[0].time, later, 0.02 * later);
  EXPECT_NEAR(r.plastic, moment * r.yielded_joints[0].rotation, 0.02 * r.plastic);
}

TEST(PlasticHinge, BrittleJointsBreakWhereHingesTurn) {
  const CollapseScene scene = heavier_cantilever(0, 2, 12);
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_TRUE(r.yielded_joints.empty());
  ASSERT_GE(r.broken_joints.size(), 1u);
  EXPECT_EQ(r.broken_joints[0].component, "My");
  EXPECT_EQ(r.plastic, 0);
}

/// A building whose edge post is taken away.
CollapseScene post_removal(double capacity, std::size_t storeys = 4) {
  CollapseScene scene = regular_scene(3, 3, storeys);
  scene.frame.classes = built_in_classes();
  for (JointClass& each : scene.frame.classes) each.rotation_capacity = capacity;
  join(scene.frame);
  scene.simulation.solver = "hybrid";
  scene.simulation.duration = 1.5;
  scene.scenario.remove = {"post_1_0_0"};
  return scene;
}

// Dynamically its beams get 1.26 of what they can bear elastically.
TEST(PlasticHinge, BuildingThatBendsOutlivesThePostThatABrittleOneDoesNot) {
  const CollapseResult bends = simulate_collapse(post_removal(0.03));
  EXPECT_EQ(bends.parts_freed, 1u);
  EXPECT_EQ(std::ranges::count(bends.broken_joints, "removed", &JointBreak::mode),
            std::ssize(bends.broken_joints));
  for (const JointYield& each : bends.yielded_joints) EXPECT_LT(each.rotation, 0.01);
  const CollapseScene brittle = post_removal(0);
  EXPECT_GT(simulate_collapse(brittle).parts_freed, brittle.frame.part_count() / 2);
}

TEST(PlasticHinge, EnergyIsAccountedForToRounding) {
  CollapseResult r = simulate_collapse(post_removal(0.1));
  EXPECT_FALSE(r.yielded_joints.empty());
  EXPECT_GT(r.plastic, 0);
  EXPECT_LT(std::fabs(r.energy.numerical), 1e-9 * r.plastic);
  CollapseScene scene = post_removal(0.1, 1);
  scene.scenario.remove.clear();
  scene.scenario.load_rate = 20000;
  r = simulate_collapse(scene);
  EXPECT_FALSE(r.yielded_joints.empty());
  EXPECT_GT(r.plastic, 0);
  EXPECT_LT(std::fabs(r.energy.numerical), 1e-9 * std::fabs(r.energy_in));
}

TEST(PlasticHinge, EnergyOfAFrameInBalanceIsAccountedForToRounding) {
  CollapseScene scene = post_removal(0.1, 1);
  scene.scenario.remove.clear();
  scene.scenario.load_rate = 20000;
  scene.simulation.quasi_static = true;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_FALSE(r.yielded_joints.empty());
  EXPECT_GT(r.plastic, 0);
  EXPECT_GE(r.damping, 0);
  EXPECT_LT(std::fabs(r.energy.numerical), 1e-9 * std::fabs(r.energy_in));
}

/// Steps so long that a hinge turns back by more than it had turned.
TEST(PlasticHinge, ShakenToAndFroItOnlyTakes) {
  for (const double step : {0.002, 0.01, 0.03}) {
    CollapseScene scene = heavier_cantilever(3, 0, 1);
    scene.rules.breaking = true;
    scene.simulation.step = step;
    scene.scenario.ground_motion = {};
    for (int i = 0; i <= 20; ++i) {
      scene.scenario.ground_motion.times.push_back(0.05 * i);
      scene.scenario.ground_motion.accelerations.push_back({0, i % 2 == 0 ? 150.0 : -150.0, 0});
    }
    const CollapseResult r = simulate_collapse(scene);
    EXPECT_FALSE(r.yielded_joints.empty()) << step;
    EXPECT_GT(r.plastic, 0) << step;
    EXPECT_GE(r.damping, 0) << step;
    EXPECT_LT(std::fabs(r.energy.numerical), 1e-9 * r.plastic) << step;
  }
}

TEST(PlasticHinge, GivesTheSameBitsTwice) {
  const CollapseResult a = simulate_collapse(post_removal(0.1));
  const CollapseResult b = simulate_collapse(post_removal(0.1));
  EXPECT_EQ(a.hash, b.hash);
  EXPECT_EQ(a.plastic, b.plastic);
  ASSERT_EQ(a.yielded_joints.size(), b.yielded_joints.size());
  for (std::size_t i = 0; i < a.yielded_joints.size(); ++i) {
    EXPECT_EQ(a.yielded_joints[i].joint, b.yielded_joints[i].joint);
    EXPECT_EQ(a.yielded_joints[i].rotation, b.yielded_joints[i].rotation);
  }
}

TEST(PlasticHinge, WhatNobodyNeedsChangesNothing) {
  std::array<CollapseResult, 2> results;
  for (std::size_t i = 0; i < 2; ++i) {
    CollapseScene scene = post_removal(0.1 * static_cast<double>(i), 2);
    for (JointClass& each : scene.frame.classes) each.strength = 10;
    join(scene.frame);
    results[i] = simulate_collapse(scene);
    EXPECT_TRUE(results[i].yielded_joints.empty());
  }
  EXPECT_EQ(results[0].hash, results[1].hash);
  EXPECT_EQ(results[0].max_utilisation, results[1].max_utilisation);
  EXPECT_EQ(results[0].energy.strain, results[1].energy.strain);
}

TEST(PlasticHinge, BulletKnowsNone) {
  CollapseScene scene = post_removal(0, 1);
  scene.simulation.solver = "bullet";
  scene.simulation.duration = 0.1;
  const std::uint64_t hash = simulate_collapse(scene).hash;
  for (JointClass& each : scene.frame.classes) each.rotation_capacity = 0.1;
  const CollapseResult bent = simulate_collapse(scene);
  EXPECT_EQ(bent.hash, hash);
  EXPECT_TRUE(bent.yielded_joints.empty());
}

}  // namespace
}  // namespace sunder
