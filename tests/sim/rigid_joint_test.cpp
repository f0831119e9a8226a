// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/bodies.hpp"
#include "sim/rigid_world.hpp"

namespace sunder {
namespace {

constexpr double kStep = 1.0 / 240;
constexpr double kGravity = 9.81;

BodyId add_box(RigidWorld& world, Vec3 half, double mass, Vec3 centre, Vec3 velocity = {},
               Vec3 spin = {}) {
  BodyParams params = block_params(mass, half, centre, world.body_count() + 1);
  params.velocity = velocity;
  params.angular_velocity = spin;
  return add_block(world, params, half);
}

void run(RigidWorld& world, double seconds) {
  for (int i = 0; i < std::lround(seconds / kStep); ++i) world.step(kStep);
}

struct Chain {
  std::vector<BodyId> bodies;
  std::vector<JointId> joints;  ///< the first one holds body 0 on the world
};
/// Boxes in a row along x from the origin at height 2 m, each fixed to the one before.
Chain cantilever(RigidWorld& world, int count, double total_length, double mass) {
  Chain chain;
  const double l = total_length / count;
  for (int i = 0; i < count; ++i) {
    chain.bodies.push_back(add_box(world, {l / 2, 0.1, 0.1}, mass, {(i + 0.5) * l, 2, 0}));
    const BodyId before = i == 0 ? kGround : chain.bodies[static_cast<std::size_t>(i) - 1];
    chain.joints.push_back(world.add_joint({chain.bodies.back(), before, {i * l, 2, 0}, {}}));
  }
  return chain;
}

TEST(RigidJoint, RootOfACantileverCarriesItsWeightAndMoment) {
  for (const int count : {1, 2, 8}) {
    for (const JointSolver solver :
         {JointSolver::sequential_impulse, JointSolver::nncg, JointSolver::dantzig}) {
      RigidWorld world({.iterations = 200, .joint_solver = solver, .sleep = false});
      const Chain chain = cantilever(world, count, 4, 400.0 / count);
      run(world, 3);
      const JointReaction root = world.joint_reaction(chain.joints[0]);
      EXPECT_NEAR(root.force.y, 3924, 1e-4 * 3924) << count;
      EXPECT_NEAR(root.torque.z, 7848, 2e-4 * 7848) << count;
      EXPECT_NEAR(length(root.force), 3924, 1e-4 * 3924);
      EXPECT_LT(root.gap, 1e-4);
      EXPECT_EQ(world.solver_fallbacks(), 0u);
    }
  }
}

TEST(RigidJoint, ColumnCarriesWhatIsAboveEachJoint) {
  RigidWorld world({.iterations = 30, .sleep = false});
  const Axes up{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  std::vector<JointId> joints;
  BodyId below = kGround;
  for (int i = 0; i < 12; ++i) {
    const BodyId post = add_box(world, {0.1, 1.75, 0.1}, 600, {0, 3.5 * i + 1.75, 0});
    joints.push_back(world.add_joint({post, below, {0, 3.5 * i, 0}, up}));
    below = post;
  }
  run(world, 4);
  for (int i = 0; i < 12; ++i) {
    const double weight = (12 - i) * 600 * kGravity;
    EXPECT_NEAR(world.joint_reaction(joints[static_cast<std::size_t>(i)]).force.x, weight,
                1e-6 * weight);
  }
  EXPECT_NEAR(world.centre(below).y, 12 * 3.5 - 1.75, 1e-6);
}

TEST(RigidJoint, JoinedBodiesFlyAsOne) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const bool warm = seed % 2 == 0;
    RigidWorld world({.iterations = 50, .warm_start = warm, .has_ground = false, .sleep = false});
    const auto random = [&](std::uint64_t n) { return 2 * random_unit(seed, n) - 1; };
    const BodyId a = add_box(world, {0.5, 0.1, 0.2}, 3, {0, 0, 0},
                             {random(1), random(2), random(3)}, {random(4), random(5), random(6)});
    const BodyId b =
        add_box(world, {0.2, 0.4, 0.1}, 50, {0.7, 0.2, 0}, {random(7), random(8), random(9)},
                {random(10), random(11), random(12)});
    world.add_joint({a, b, {0.5, 0.1, 0}, {}});
    const Vec3 momentum = world.momentum();
    const Vec3 start = (1.0 / 53) * (3 * world.centre(a) + 50 * world.centre(b));
    const auto spin = [&] {
      const Vec3 middle = (1.0 / 53) * (3 * world.centre(a) + 50 * world.centre(b));
      return world.angular_momentum(middle);
    };
    const Vec3 angular = spin();
    const double seconds = 2;
    run(world, seconds);
    const Vec3 fall{0, -kGravity * seconds, 0};
    EXPECT_LT(length(world.momentum() - momentum - 53 * fall), 1e-9) << "seed " << seed;
    // Displacements that take drift away move mass without changing velocities.
    const double drift = warm ? 1e-2 : 1e-9;
    EXPECT_LT(length(spin() - angular), drift * length(angular)) << "seed " << seed;
    const Vec3 end = (1.0 / 53) * (3 * world.centre(a) + 50 * world.centre(b));
    const Vec3 path = (seconds / 53) * momentum + (seconds / 2) * fall;
    EXPECT_LT(length(end - start - path), 1e-9) << "seed " << seed;
    EXPECT_LT(world.joint_reaction(0).gap, 2e-4) << "seed " << seed;
  }
}

TEST(RigidJoint, EnergyIsAccounted) {
  for (const bool warm : {true, false}) {
    RigidWorld world({.iterations = 20, .warm_start = warm, .sleep = false});
    cantilever(world, 8, 4, 50);
    const BodyId ball = add_box(world, {0.1, 0.1, 0.1}, 20, {3.5, 2.5, 0}, {0, -5, 0});
    ASSERT_TRUE(world.is_awake(ball));
    const double start = world.kinetic_energy() + world.potential_energy();
    double lost = 0;
    for (int i = 0; i < 480; ++i) {
      world.step(kStep);
      const StepWork work = world.work();
      lost += work.contact + work.friction + work.joint;
    }
    const double end = world.kinetic_energy() + world.potential_energy();
    EXPECT_NEAR(end + lost, start, 1e-8 * start) << (warm ? "warm" : "cold");
  }
}

/// A slab 3 m high that topples about its hinged foot from 0.05 rad off the vertical: quarter turn
/// after 1.8938 s at 3.1301 rad/s (ω² = 3 g (cos θ0 − cos θ)/L and its quadrature).
TEST(RigidJoint, HingedSlabTopples) {
  RigidWorld world({.iterations = 50, .has_ground = false, .sleep = false});
  const double tilt = 0.05, length = 3;
  BodyParams params = block_params(600, {0.01, length / 2, 0.01}, {}, 1);
  params.pose.rotation = {0, 0, std::sin(-tilt / 2), std::cos(tilt / 2)};
  params.pose.position = {length / 2 * std::sin(tilt), length / 2 * std::cos(tilt), 0};
  const BodyId slab = add_block(world, params, {0.01, length / 2, 0.01});
  const JointId hinge = world.add_joint({slab, kGround, {0, 0, 0}, {}, false});
  double time = 0, height = 0;
  const double step = 1.0 / 1000;
  do {
    height = world.centre(slab).y;
    world.step(step);
    time += step;
  } while (world.centre(slab).y > 0);
  const double share = height / (height - world.centre(slab).y);
  EXPECT_NEAR(time - step + share * step, 1.8938, 2e-3);
  EXPECT_NEAR(-world.angular_velocity(slab).z, 3.1301, 2e-3);
  EXPECT_EQ(world.joint_reaction(hinge).torque, Vec3{});
  EXPECT_LT(world.joint_reaction(hinge).gap, 1e-4);
}

TEST(RigidJoint, RemovedJointLetsGo) {
  RigidWorld world({.iterations = 100, .sleep = false});
  const Chain chain = cantilever(world, 2, 2, 50);
  run(world, 2);
  world.remove_joint(chain.joints[1]);
  const double height = world.centre(chain.bodies[1]).y;
  run(world, 0.25);
  EXPECT_NEAR(world.centre(chain.bodies[1]).y, height - kGravity / 2 / 16, 1e-6);
  EXPECT_NEAR(world.joint_reaction(chain.joints[0]).force.y, 50 * kGravity, 0.1);
}

TEST(RigidJoint, JoinedNeighboursDoNotCollide) {
  RigidWorld world({.iterations = 20, .has_ground = false, .sleep = false});
  const BodyId a = add_box(world, {0.5, 0.1, 0.1}, 1, {0, 0, 0});
  const BodyId b = add_box(world, {0.5, 0.1, 0.1}, 1, {0.8, 0, 0});
  const BodyId c = add_box(world, {0.1, 0.5, 0.1}, 1, {0.4, 0.1, 0});
  const JointId ab = world.add_joint({a, b, {0.4, 0, 0}, {}});
  world.add_joint({c, b, {0.4, 0, 0}, {}});
  run(world, 0.2);
  EXPECT_EQ(world.overlap(), 0);
  world.remove_joint(ab);
  const double before = world.centre(a).x;
  run(world, 0.2);
  EXPECT_GT(world.overlap(), 0.005) << "a and b are pushed apart, but slowly";
  EXPECT_LT(world.centre(a).x, before - 0.05);
}

TEST(RigidJoint, SeparatedBodiesFallThroughEachOther) {
  RigidWorld world({.iterations = 20});
  const BodyId lower = add_box(world, {0.5, 0.5, 0.5}, 10, {0, 0.5, 0});
  const BodyId upper = add_box(world, {0.5, 0.5, 0.5}, 10, {0, 1.6, 0});
  world.separate(upper, lower);
  run(world, 2);
  EXPECT_NEAR(world.centre(upper).y, 0.5, 2e-3);
  EXPECT_NEAR(world.centre(lower).y, 0.5, 2e-3);
}

TEST(RigidJoint, WhatHangsTogetherSleepsAndWakesTogether) {
  RigidWorld world({.iterations = 200});
  const Chain chain = cantilever(world, 6, 3, 20);
  run(world, 6);
  EXPECT_TRUE(world.awake().empty());
  const double root = world.joint_reaction(chain.joints[0]).torque.z;
  EXPECT_NEAR(root, 6 * 20 * kGravity * 1.5, 1e-3 * root) << "loads are kept asleep";
  add_box(world, {0.1, 0.1, 0.1}, 5, {2.8, 2.4, 0}, {0, -3, 0});
  run(world, 0.2);
  EXPECT_EQ(world.awake().size(), 7u);
}

TEST(RigidJoint, MovingGroundShakesTheBase) {
  RigidWorld world({.iterations = 100, .sleep = false});
  const BodyId block = add_box(world, {0.5, 1, 0.5}, 200, {0, 1, 0});
  const JointId base = world.add_joint({block, kGround, {0, 0, 0}, {}});
  world.set_gravity({-3, -kGravity, 0});  // the ground accelerates along +x
  run(world, 1);
  const JointReaction reaction = world.joint_reaction(base);
  EXPECT_NEAR(reaction.force.x, 600, 1e-6);
  EXPECT_NEAR(reaction.force.y, 200 * kGravity, 1e-6);
  EXPECT_NEAR(reaction.torque.z, -600, 1e-6) << "the push passes 1 m above the base";
}

TEST(RigidJoint, MassCanGrow) {
  RigidWorld world({.iterations = 50});
  const Chain chain = cantilever(world, 1, 2, 100);
  run(world, 0.5);
  world.set_mass(chain.bodies[0], 250);
  run(world, 0.5);
  EXPECT_NEAR(world.joint_reaction(chain.joints[0]).force.y, 250 * kGravity, 1e-6);
  EXPECT_NEAR(world.potential_energy(), 250 * kGravity * 2, 1e-3);
}

/// Without warm start a tower of joints sags by what ten iterations cannot solve; with it, not.
TEST(RigidJoint, WarmStartTakesTheSagAway) {
  const auto sag = [](bool warm) {
    RigidWorld world({.iterations = 10, .warm_start = warm, .sleep = false});
    BodyId below = kGround;
    for (int i = 0; i < 10; ++i) {
      const BodyId post = add_box(world, {0.1, 0.5, 0.1}, i == 9 ? 5000 : 100, {0, i + 0.5, 0});
      world.add_joint({post, below, {0, 1.0 * i, 0}, {}});
      below = post;
    }
    run(world, 3);
    return 9.5 - world.centre(below).y;
  };
  EXPECT_GT(sag(false), 0.01);
  EXPECT_LT(std::fabs(sag(true)), 1e-3);
}

}  // namespace
}  // namespace sunder
