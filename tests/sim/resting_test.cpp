// SPDX-License-Identifier: GPL-3.0-or-later
// What lies still: how hard it presses on what it lies on, and that it can be merged.
#include "sim/resting.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meshing/random.hpp"
#include "sim/bodies.hpp"
#include "sim/frame_motion.hpp"
#include "sim/frames.hpp"

namespace sunder {
namespace {

constexpr double kGravity = 9.81, kStep = 1.0 / 240;

/// A floor, and irregular chunks dropped on it in a heap.
struct Heap {
  explicit Heap(int count, std::uint32_t max_bodies = 0, std::uint64_t seed = 1, double height = 3)
      : world({.max_bodies = max_bodies}) {
    const Prism slab = block(4, 0.1, 4);
    floor = world.add_static({{0, height - 0.1, 0}, {}}, {&slab, 1}, {0.6, 0.1}, 1);
    for (int i = 0; i < count; ++i) {
      const auto at = [&](std::uint64_t k) { return random_unit(seed, 10 * i + k) - 0.5; };
      BodyParams params =
          block_params(20 + 40 * random_unit(seed, 10 * i), {0.2, 0.2, 0.1},
                       {1.2 * at(1), height + 0.3 + 0.25 * (i / 4), 1.2 * at(2)}, 10 + i);
      mass += params.mass;
      const Prism prism = chunk(0.2, 0.1, seed + static_cast<std::uint64_t>(i));
      ids.push_back(world.add_body(params, {&prism, 1}));
    }
  }
  void run(double seconds) {
    for (int i = 0; i < std::lround(seconds / kStep); ++i) world.step(kStep);
  }
  /// Of what is awake and what sleeps, on the floor, N.
  Vec3 load() const {
    Vec3 sum;
    for (const RestingLoad& load : world.resting())
      if (load.on == floor) sum = sum + load.force;
    for (const Contact& contact : world.contacts()) {
      const Vec3 on_a = contact.impulse * contact.normal + contact.tangential;
      if (contact.a == floor) sum = sum + (1 / kStep) * on_a;
      if (contact.b == floor) sum = sum - (1 / kStep) * on_a;
    }
    return sum;
  }
  std::vector<Pose> poses() const {
    std::vector<Pose> result;
    for (const BodyId id : ids) result.push_back(world.pose(id));
    return result;
  }
  RigidWorld world;
  BodyId floor = kNoBody;
  std::vector<BodyId> ids;
  double mass = 0;
};

TEST(Resting, AHeapThatSleepsPressesWithItsWeight) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Heap heap(16, 0, seed);
    heap.run(5);
    ASSERT_TRUE(heap.world.awake().empty()) << "seed " << seed;
    EXPECT_NEAR(heap.load().y / (heap.mass * kGravity), -1, 1e-5) << "seed " << seed;
    EXPECT_LT(std::hypot(heap.load().x, heap.load().z), 0.02 * heap.mass * kGravity);
  }
}

TEST(Resting, InACrowdOneThatNeverRestsKeepsOnlyItsNeighboursAwake) {
  RigidWorld world({});
  std::vector<BodyId> row;
  for (int i = 0; i < 70; ++i)
    row.push_back(add_block(world, block_params(10, {0.2, 0.2, 0.2}, {0.4 * i, 0.2, 0}, 10 + i),
                            {0.2, 0.2, 0.2}));
  for (int i = 0; i < 320; ++i) {
    world.set_velocity(row[0], {0, 0, i % 2 == 0 ? 0.05 : -0.05}, {});
    world.step(kStep);
  }
  EXPECT_TRUE(world.is_awake(row[0]));
  EXPECT_LE(world.awake().size(), 4u);
}

TEST(Resting, AStackPressesWhereItStands) {
  RigidWorld world({.has_ground = false});
  const Prism slab = block(1, 0.1, 1);
  const BodyId floor = world.add_static({{0, -0.1, 0}, {}}, {&slab, 1}, {0.6, 0.1}, 1);
  for (int i = 0; i < 4; ++i)
    add_block(world, block_params(10, {0.2, 0.2, 0.2}, {0.3, 0.2 + 0.4 * i, 0.5}, 10 + i),
              {0.2, 0.2, 0.2});
  for (int i = 0; i < 400; ++i) world.step(kStep);
  ASSERT_TRUE(world.awake().empty());
  Vec3 sum, moment;
  for (const RestingLoad& load : world.resting()) {
    EXPECT_EQ(load.on, floor);
    sum = sum + load.force;
    moment = moment - load.force.y * load.point;
  }
  EXPECT_NEAR(sum.y, -40 * kGravity, 1e-4);
  EXPECT_NEAR(moment.x / -sum.y, 0.3, 0.01);
  EXPECT_NEAR(moment.z / -sum.y, 0.5, 0.01);
}

TEST(Resting, NothingPressesOnceItIsAwakeOrGone) {
  Heap heap(4);
  heap.run(4);
  ASSERT_TRUE(heap.world.awake().empty());
  for (const BodyId id : heap.ids) heap.world.wake(id);
  EXPECT_TRUE(heap.world.resting().empty());
  heap.run(2);
  EXPECT_NEAR(heap.load().y / (heap.mass * kGravity), -1, 1e-5);
  for (const BodyId id : heap.ids) heap.world.remove(id);
  EXPECT_TRUE(heap.world.resting().empty());
}

TEST(Resting, RubbleOnASlabStaysInTheFeetOfTheFrame) {
  CollapseScene scene = regular_scene(2, 2, 1);
  scene.simulation.solver = "hybrid";
  const std::vector<PartSolid> solids = solids_of(scene.frame);
  RigidWorld world({});
  const auto motion = elastic_motion(scene, world, solids);
  motion->settle({});
  const auto feet = [&] {
    double sum = 0;
    for (std::uint32_t j = 0; j < scene.frame.joints.size(); ++j) {
      const FrameJoint& joint = scene.frame.joints[j];
      if (joint.b == kNoPart) sum += (joint.axes * motion->load(j).force).y;
    }
    return sum;
  };
  const double before = feet();
  double mass = 0, now = 0;
  for (int i = 0; i < 12; ++i) {
    const auto at = [&](std::uint64_t k) { return random_unit(5, 10 * i + k) - 0.5; };
    const BodyParams params = block_params(
        300, {0.2, 0.2, 0.1}, {3 + 1.2 * at(1), 3.9 + 0.25 * (i / 3), 3 + 1.2 * at(2)}, 1000 + i);
    const Prism prism = chunk(0.2, 0.1, 5 + static_cast<std::uint64_t>(i));
    world.add_body(params, {&prism, 1});
    mass += params.mass;
  }
  for (int i = 0; i < 8 * 240; ++i) {
    world.step(kStep);
    motion->follow(now += kStep, kStep, true);
  }
  ASSERT_TRUE(world.awake().empty());
  EXPECT_NEAR((before - feet()) / (mass * kGravity), 1, 1e-6);
}

TEST(Resting, MergingBodiesAtRestMovesNothing) {
  Heap plain(24), merged(24, 10);
  for (int i = 0; i < 5; ++i) {
    plain.run(1);
    merged.run(1);
    EXPECT_EQ(plain.poses(), merged.poses());
  }
  EXPECT_EQ(merged.world.merged_count(), 14u);
  EXPECT_EQ(merged.world.body_count(), 24u);
  EXPECT_EQ(plain.world.merged_count(), 0u);
  EXPECT_EQ(plain.load(), merged.load());
}

TEST(Resting, WhatIsMergedDoesNotWakeByAHit) {
  Heap heap(24, 4);
  heap.run(5);
  const std::uint32_t merged = heap.world.merged_count();
  ASSERT_EQ(merged, 20u);
  const std::vector<Pose> before = heap.poses();
  BodyParams ball = ball_params(500, 0.2, {-3, 3.3, 0}, 5);
  ball.velocity = {10, 0, 0};
  heap.world.add_sphere(ball, 0.2);
  heap.run(1);
  std::uint32_t moved = 0;
  for (std::size_t i = 0; i < before.size(); ++i) moved += heap.poses()[i] != before[i];
  EXPECT_LE(moved, 4u);
}

TEST(Resting, WhatIsMergedFallsWhenItsSupportGoes) {
  Heap heap(24, 1);
  heap.run(5);
  ASSERT_EQ(heap.world.merged_count(), 23u);
  heap.world.remove(heap.floor);
  heap.run(0.1);
  for (const BodyId id : heap.ids) EXPECT_TRUE(heap.world.is_awake(id));
  heap.run(5);
  for (const BodyId id : heap.ids) EXPECT_LT(heap.world.centre(id).y, 1.5);
}

TEST(Resting, ABodyThatIsTakenFromAMergedHeapFreesWhatLiesOnIt) {
  Heap plain(24), merged(24, 1);
  plain.run(5);
  merged.run(5);
  ASSERT_EQ(merged.world.merged_count(), 23u);
  for (const std::size_t i : {0u, 1u, 2u, 3u}) {
    plain.world.remove(plain.ids[i]);
    merged.world.remove(merged.ids[i]);
  }
  const auto highest = [](const Heap& heap) {
    double y = 0;
    for (std::size_t i = 4; i < heap.ids.size(); ++i)
      y = std::max(y, heap.world.centre(heap.ids[i]).y);
    return y;
  };
  plain.run(4);
  merged.run(4);
  EXPECT_NEAR(highest(plain), highest(merged), 0.1);
}

}  // namespace
}  // namespace sunder
