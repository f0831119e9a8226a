// SPDX-License-Identifier: GPL-3.0-or-later
// What has come loose: which parts hang together and hold, pieces as frames of their own, what
// touches them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sim/frame_solver.hpp"
#include "sim/frame_touches.hpp"
#include "sim/frames.hpp"
#include "sim/part_links.hpp"
#include "sim/sub_frame.hpp"

namespace sunder {
namespace {

Frame building(std::size_t storeys) {
  StoreyParams storey;
  storey.wall_thickness = 0.1;
  return regular_scene(3, 3, storeys, storey).frame;
}

double difference(const JointLoad& a, const JointLoad& b) {
  return length(a.force - b.force) + length(a.torque - b.torque);
}

/// All that is above the lowest storey, cut off.
struct Top {
  Top(const Frame& frame, const std::vector<PartSolid>& solids) : links(frame) {
    const auto is_high = [&](std::uint32_t part) {
      return part != kNoPart && solids[part].centre.y > 4.2;
    };
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
      if (is_high(frame.joints[j].a) != is_high(frame.joints[j].b)) cut.push_back(j);
    for (const std::uint32_t j : cut) links.cut(j);
    for (std::uint32_t part = 0; part < solids.size(); ++part)
      if (is_high(part)) parts.push_back(part);
  }
  PartLinks links;
  std::vector<std::uint32_t> cut, parts;
};

TEST(SubFrame, PieceCarriesAloneWhatItCarriesInTheWhole) {
  const Frame frame = building(4);
  const std::vector<PartSolid> solids = solids_of(frame);
  const Top top(frame, solids);
  ASSERT_EQ(top.links.components(top.parts).size(), 1u);
  const SubFrame sub = sub_frame(frame, top.parts, top.links.joints_within(top.parts));
  FrameSolver whole(frame);
  whole.break_joints(top.cut);
  FrameSolverParams params;
  params.free = true;
  for (const std::uint32_t part : top.parts)
    if (part >= frame.wall_part(0)) params.wall_mass.push_back(solids[part].mass);
  FrameSolver own(sub.frame, params);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> spread(-1, 1);
  const auto vector = [&] { return Vec3{spread(random), spread(random), spread(random)}; };
  for (int round = 0; round < 5; ++round) {
    FrameLoads of_whole, of_own;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t part = top.parts[random() % top.parts.size()];
      const Vec3 point = solids[part].centre + 0.3 * vector(), force = 1e4 * vector();
      of_whole.contacts.push_back({part, point, force});
      of_own.contacts.push_back({sub.part(part), point, force});
    }
    const Vec3 spin = vector();
    of_whole.spins.push_back({top.parts[0], spin});
    of_own.spins.push_back({0, spin});
    whole.solve(of_whole);
    own.solve(of_own);
    double largest = 0, worst = 0;
    for (std::uint32_t i = 0; i < sub.joints.size(); ++i) {
      const JointLoad expected = whole.joint_load(sub.joints[i]);
      largest = std::max(largest, difference(expected, {}));
      worst = std::max(worst, difference(own.joint_load(i), expected));
    }
    EXPECT_GT(largest, 100);
    EXPECT_LT(worst, 1e-7 * largest);
  }
}

TEST(SubFrame, KnowsItsNumbersAndForgetsWhatIsNotInIt) {
  const Frame frame = building(2);
  const std::uint32_t slab = frame.slab_part(0), beam = frame.slabs[0].beams[0];
  const std::vector<std::uint32_t> parts{beam, slab};
  const SubFrame sub = sub_frame(frame, parts, PartLinks(frame).joints_within(std::array{slab}));
  ASSERT_EQ(sub.frame.part_count(), 2u);
  EXPECT_EQ(sub.part(slab), 1u);
  EXPECT_EQ(sub.part(beam + 1), kNoPart);
  EXPECT_EQ(sub.frame.part_name(1), frame.part_name(slab));
  EXPECT_EQ(sub.frame.slabs[0].beams[0], 0u);
  EXPECT_EQ(sub.frame.slabs[0].beams[2], kNoPart);
  EXPECT_EQ(sub.frame.sections.size(), 1u);
}

/// Of random breaks, by the solver that holds everything.
TEST(PartLinks, FindsWhatNothingHoldsAsTheFrameSolverDoes) {
  Frame frame = building(2);
  for (JointClass& each : frame.classes) each.rigid = each.name != "beam";
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    PartLinks links(frame);
    FrameSolver solver(frame);
    std::vector<std::uint32_t> broken;
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j)
      if (frame.joints[j].b == kNoPart || random() % 3 == 0) broken.push_back(j);
    for (const std::uint32_t j : broken) links.cut(j);
    solver.break_joints(broken);
    EXPECT_EQ(links.broken(), broken);
    std::vector<std::uint32_t> members;
    for (std::uint32_t part = 0; part < frame.wall_part(0); ++part) members.push_back(part);
    std::vector<std::uint32_t> expected = solver.loose_parts();
    std::erase_if(expected, [&](std::uint32_t part) { return part >= frame.wall_part(0); });
    EXPECT_EQ(links.unheld(members), expected) << "seed " << seed;
    EXPECT_GT(expected.size(), 0u);
  }
}

/// F' = (f − F)/τ by the implicit rule.
TEST(FrameTouches, ForceFollowsImpulsesByItsLag) {
  constexpr double kStep = 0.005, kLag = 0.02, kForce = 1e3;
  FrameTouches touches(5);
  double lagged = 0;
  for (int step = 0; step < 100; ++step) {
    touches.add(3, {1, 2, 3}, {kForce * kStep / 2, 0, 0}, 0);
    touches.add(3, {3, 2, 3}, {kForce * kStep / 2, 0, 0}, 0);
    const double before = lagged;
    lagged = (lagged + kStep / kLag * kForce) / (1 + kStep / kLag);
    const std::vector<std::uint32_t> changed = touches.end_step(kStep, kLag, 0.01);
    EXPECT_EQ(changed.size(), lagged - before > 0.01 * before ? 1u : 0u) << step;
    ASSERT_EQ(touches.active().size(), 1u);
    EXPECT_NEAR(touches.load_on(3).force.x, lagged, 1e-9 * kForce);
    EXPECT_NEAR(touches.load_on(3).point.x, 2, 1e-12);
  }
  EXPECT_NEAR(lagged, kForce, 1e-6 * kForce);
  int left = 0;
  for (; !touches.active().empty(); ++left) touches.end_step(kStep, kLag, 0.01);
  EXPECT_EQ(left, std::ceil(std::log(kForce) / std::log(1 + kStep / kLag)));  // to 1 N
}

// A push that stays: a tenth of it is borne, and the rest comes with a quarter of the lag.
TEST(FrameTouches, WhatIsHeldBackComesByAndBy) {
  constexpr double kStep = 0.005, kLag = 0.02, kForce = 1e3;
  FrameTouches touches(1);
  const auto push = [&] {
    touches.add(0, {}, {kForce * kStep, 0, 0}, 0);
    touches.end_step(kStep, kLag, 1e-6);
    return touches.load_on(0).force.x;
  };
  for (int step = 0; step < 200; ++step) push();
  EXPECT_NEAR(touches.load_on(0).force.x, kForce, 1e-9 * kForce);
  touches.hold_back(0, 0.1);
  EXPECT_NEAR(touches.load_on(0).force.x, 0.1 * kForce, 1e-9 * kForce);
  double missing = 0.9;
  for (int step = 0; step < 12; ++step) {
    missing /= 1 + kStep / (kLag / 4);
    EXPECT_NEAR(push(), (1 - missing) * kForce, 1e-9 * kForce) << step;
  }
}

TEST(FrameTouches, WhatIsForgottenPressesNoMore) {
  FrameTouches touches(3);
  for (const std::uint32_t part : {2u, 0u}) touches.add(part, {}, {100, 0, 0}, 1);
  EXPECT_EQ(touches.end_step(0.01, 0.02, 0.01), (std::vector<std::uint32_t>{0, 2}));
  touches.forget(0);
  ASSERT_EQ(touches.active().size(), 1u);
  EXPECT_EQ(touches.active()[0], 2u);
  touches.limit(2, 0);
  EXPECT_TRUE(touches.active().empty());
  EXPECT_EQ(touches[2].borne, 0);
}

}  // namespace
}  // namespace sunder
