// SPDX-License-Identifier: GPL-3.0-or-later
// How fast frames fall apart, against an explicit program.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meshing/random.hpp"
#include "sim/collapse.hpp"
#include "sim/explicit_frame.hpp"
#include "sim/frame_solver.hpp"
#include "sim/frames.hpp"

namespace sunder {
namespace {

/// Beams carry 900 kg/m, posts themselves; joints alone fail, and what falls meets no ground.
CollapseScene bare(std::size_t posts, std::size_t rows, std::size_t storeys) {
  CollapseScene scene = regular_scene(posts, rows, storeys, {.slab_thickness = 0});
  SteelGrade heavy = scene.frame.steels[0];
  heavy.name = "heavy";
  heavy.density = 900 / scene.frame.sections[2].area;
  scene.frame.steels.push_back(heavy);
  for (FrameMember& member : scene.frame.members)
    if (member.kind == FrameMember::Kind::beam) member.steel = 1;
  scene.simulation.solver = "hybrid";
  scene.simulation.damping_mass = scene.simulation.damping_stiffness = 0;
  scene.simulation.ground = scene.simulation.sleep = false;
  scene.rules.post_rule = "none";
  scene.rules.members_divide = false;
  return scene;
}

void scale_strength(FrameJoint& joint, double factor) {
  joint.strength.force = factor * joint.strength.force;
  joint.strength.torque = factor * joint.strength.torque;
}

std::vector<JointLoad> loads_at_rest(const Frame& frame) {
  ExplicitFrame program(frame, {.breaking = false});
  program.run(1e-6);
  std::vector<JointLoad> loads;
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) loads.push_back(program.load(j));
  return loads;
}

// Static loads by two programs that share no code.
TEST(ExplicitFrame, CarriesAtRestWhatTheFrameSolverSays) {
  const CollapseScene scene = bare(3, 2, 2);
  const std::vector<JointLoad> loads = loads_at_rest(scene.frame);
  FrameSolver solver(scene.frame);
  solver.solve({});
  double largest = 0, worst = 0;
  for (std::uint32_t j = 0; j < loads.size(); ++j) {
    const JointLoad expected = solver.joint_load(j);
    largest = std::max(largest, length(expected.torque));
    worst = std::max({worst, length(loads[j].force - expected.force),
                      length(loads[j].torque - expected.torque)});
  }
  EXPECT_GT(largest, 1e4);
  EXPECT_LT(worst, 1e-6 * largest);
}

// Central differences keep the energy, also where joints part: nothing is lost when they do.
TEST(ExplicitFrame, KeepsTheEnergyOfAFrameThatFallsApart) {
  CollapseScene scene = bare(2, 2, 1);
  for (FrameJoint& joint : scene.frame.joints) scale_strength(joint, 0.4);
  const std::uint32_t post = part_named(scene.frame, "post_0_0_0");
  hand_over_joints(scene.frame, post);
  ExplicitFrame program(scene.frame, {.elements = 2, .step = 4e-5}, {post});
  const double before = program.energy();
  program.run(0.3);
  EXPECT_GT(program.breaks().size(), 3u);
  EXPECT_NEAR(program.energy(), before, 2e-3 * program.kinetic());
}

struct BeamEnds {
  double first = -1, second = -1;  // s; -1: it holds
};

/// A portal whose beam loses one end at time 0; the other one bears `share` of the moment of the
/// cantilever that is left, at rest.
CollapseScene half_held_beam(double share) {
  CollapseScene scene = bare(2, 2, 1);
  for (FrameJoint& joint : scene.frame.joints) scale_strength(joint, 1e3);
  const std::vector<JointLoad> rest = loads_at_rest(scene.frame);
  const std::uint32_t first = joint_named(scene.frame, "beam_x_0_0_0@post_0_0_0");
  scene.frame.joints[first].strength.torque.y = 0.99 * std::fabs(rest[first].torque.y);
  scene.frame.joints[joint_named(scene.frame, "beam_x_0_0_0@post_1_0_0")].strength.torque.y =
      share * 900 * 9.81 * 6 * 6 / 2;
  scene.simulation.duration = 0.5;
  return scene;
}

template <class Breaks>
BeamEnds ends_of(const CollapseScene& scene, const Breaks& breaks) {
  BeamEnds ends;
  for (const auto& each : breaks) {
    const std::string& name = scene.frame.joints[each.joint].name;
    if (name == "beam_x_0_0_0@post_0_0_0") ends.first = each.time;
    if (name == "beam_x_0_0_0@post_1_0_0") ends.second = each.time;
  }
  return ends;
}

// A beam that lost one end swings as a cantilever: the other end bears its weight as it comes
// down, later, and up to twice of what it would be at rest.
TEST(Cascade, TheOtherEndOfABeamBreaksWhenItHasSwungDown) {
  double sum = 0;
  for (const double share : {0.4, 0.6, 1.0, 1.4, 2.2}) {
    CollapseScene scene = half_held_beam(share);
    ExplicitFrame program(scene.frame, {.elements = 3, .step = 5e-5});
    program.run(scene.simulation.duration);
    const BeamEnds expected = ends_of(scene, program.breaks());
    EXPECT_EQ(expected.first, 0) << share;
    for (const double step : {1.0 / 240, 1.0 / 1920}) {
      scene.simulation.step = step;
      const BeamEnds found = ends_of(scene, simulate_collapse(scene).broken_joints);
      EXPECT_NEAR(found.first, 0, 1.01 * step) << share;
      if (expected.second < 0) {
        EXPECT_EQ(found.second, -1) << share;
        continue;
      }
      EXPECT_NEAR(found.second, expected.second, 0.2 * expected.second + step) << share;
      sum += std::fabs(found.second / expected.second - 1) / 8;
    }
  }
  EXPECT_LT(sum, 0.08);
}

/// Two storeys that lose a corner post, with joints that bear about twice what they do at rest.
CollapseScene weak_corner(std::uint64_t seed) {
  CollapseScene scene = bare(2, 2, 2);
  const std::vector<JointLoad> rest = loads_at_rest(scene.frame);
  double most = 0;
  for (std::uint32_t j = 0; j < rest.size(); ++j)
    most = std::max(most, utilisation(rest[j], scene.frame.joints[j].strength).total);
  for (std::uint32_t j = 0; j < rest.size(); ++j)
    scale_strength(scene.frame.joints[j], most / 0.5 * (0.9 + 0.2 * random_unit(seed, j)));
  scene.scenario.remove = {"post_0_0_0"};
  scene.simulation.damping_mass = 0.23;
  scene.simulation.duration = 0.3;
  return scene;
}

/// Of beams that lose both ends how long the second one holds longer, s.
template <class Breaks>
std::vector<double> delays_of(const CollapseScene& scene, const Breaks& breaks) {
  std::vector<double> first(scene.frame.members.size(), -1), delays;
  for (const auto& each : breaks) {
    const FrameJoint& joint = scene.frame.joints[each.joint];
    if (joint.kind != FrameJoint::Kind::beam_end) continue;
    if (first[joint.a] >= 0) {
      delays.push_back(each.time - first[joint.a]);
    } else {
      first[joint.a] = each.time;
    }
  }
  std::ranges::sort(delays);
  return delays;
}

double middle(const std::vector<double>& sorted) {
  return sorted.empty() ? 0 : sorted[sorted.size() / 2];
}

// Joints of the program are judged by their mean over 20 ms: what a frame's own springs carry knows
// nothing of the shocks that run through ideal members when something parts.
TEST(Cascade, GoesOnAsFastAsAnExplicitProgramSays) {
  std::vector<double> expected, found;
  std::size_t expected_count = 0, found_count = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const CollapseScene scene = weak_corner(seed);
    Frame frame = scene.frame;
    const std::uint32_t post = part_named(frame, "post_0_0_0");
    hand_over_joints(frame, post);
    ExplicitFrame program(frame, {.elements = 2, .step = 5e-5, .damping_mass = 0.23, .lag = 0.02},
                          {post});
    program.run(scene.simulation.duration);
    const CollapseResult r = simulate_collapse(scene);
    std::vector<JointBreak> breaks = r.broken_joints;
    std::erase_if(breaks, [](const JointBreak& b) { return b.mode != "strength"; });
    expected_count += program.breaks().size();
    found_count += breaks.size();
    for (const double delay : delays_of(scene, program.breaks())) expected.push_back(delay);
    for (const double delay : delays_of(scene, breaks)) found.push_back(delay);
  }
  std::ranges::sort(expected);
  std::ranges::sort(found);
  ASSERT_GT(found.size(), 10u);
  EXPECT_GT(middle(found), 0.6 * middle(expected));
  EXPECT_LT(middle(found), middle(expected));
  EXPECT_GT(found.front(), 0.01);
  EXPECT_NEAR(static_cast<double>(found_count), static_cast<double>(expected_count),
              0.3 * static_cast<double>(expected_count));
}

// What parted first bore its strength, and so much of the ground's push has come through it: what
// is left does not get all of it.
TEST(Cascade, APieceThatIsStoppedFallsApartByAndBy) {
  CollapseScene scene = bare(2, 2, 2);
  for (FrameJoint& joint : scene.frame.joints)
    if (joint.kind == FrameJoint::Kind::base) {
      scale_strength(joint, 1e-6);
      joint.strength.bearing = false;
    }
  scene.simulation.ground = true;
  scene.simulation.ground_height = -1;  // falls for 0.45 s
  scene.simulation.duration = 0.8;
  const CollapseResult r = simulate_collapse(scene);
  std::vector<JointBreak> breaks = r.broken_joints;
  std::erase_if(breaks, [](const JointBreak& b) { return b.time < 0.4; });
  ASSERT_GT(breaks.size(), 8u);
  EXPECT_GT(breaks.front().utilisation, 10) << "it was stopped at once";
  for (const JointBreak& b : breaks) EXPECT_LT(b.utilisation, 1.1 * breaks.front().utilisation);
  const auto at_once = std::ranges::count(breaks, breaks.front().time, &JointBreak::time);
  EXPECT_LT(4 * at_once, static_cast<std::ptrdiff_t>(3 * breaks.size()));
  EXPECT_LT(std::fabs(r.energy.numerical), 1e-8 * std::fabs(r.energy.potential));
  EXPECT_LT(r.momentum_error, 1e-12);
}

}  // namespace
}  // namespace sunder
