// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/rigid_world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "meshing/random.hpp"
#include "sim/spin.hpp"
#include "tests/sim/bodies.hpp"

namespace sunder {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGravity = 9.81;

Quaternion about_z(double angle) {
  return {0, 0, std::sin(angle / 2), std::cos(angle / 2)};
}

double energy(const RigidWorld& world) {
  return world.kinetic_energy() + world.potential_energy();
}

bool is_finite(Vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

TEST(RigidWorld, FallsOnTheParabolaWhateverTheStep) {
  for (const double dt : {1.0 / 30, 1.0 / 60, 1.0 / 240, 1.0 / 1000}) {
    RigidWorld world({.has_ground = false});
    BodyParams params = block_params(3, {0.1, 0.2, 0.3}, {1, 2, 3}, 1);
    params.velocity = {4, 5, 6};
    const BodyId id = add_block(world, params, {0.1, 0.2, 0.3});
    const int steps = static_cast<int>(std::lround(2 / dt));
    for (int i = 0; i < steps; ++i) world.step(dt);
    EXPECT_NEAR(world.centre(id).x, 9, 1e-11);
    EXPECT_NEAR(world.centre(id).y, 2 + 10 - kGravity * 2, 1e-11);
    EXPECT_NEAR(world.velocity(id).y, 5 - kGravity * 2, 1e-11);
  }
}

// Case of scpeters/benchmark; the expected spin is that of a Runge–Kutta run with tiny steps.
TEST(RigidWorld, SpinsFreelyAsTheEulerEquationsSay) {
  for (const double dt : {1.0 / 60, 1.0 / 1000}) {
    RigidWorld world({.gravity = 0, .has_ground = false});
    BodyParams params = block_params(10, {0.5, 0.2, 0.45}, {}, 1);
    params.inertia = {.xx = 0.80833, .yy = 0.68333, .zz = 0.14167};
    params.angular_velocity = {0.1, 5, 0.1};
    const BodyId id = add_block(world, params, {0.5, 0.2, 0.45});
    const double before = world.kinetic_energy();
    const Vec3 momentum = world.angular_momentum({});
    const int steps = static_cast<int>(std::lround(10 / dt));
    for (int i = 0; i < steps; ++i) world.step(dt);
    const Vec3 spin = into(axes_of(world.pose(id).rotation), world.angular_velocity(id));
    EXPECT_NEAR(spin.x, 2.75584, 0.01 * 2.75584);
    EXPECT_NEAR(spin.y, -3.73597, 0.01 * 3.73597);
    EXPECT_NEAR(spin.z, -3.16181, 0.01 * 3.16181);
    EXPECT_LT(std::fabs(world.kinetic_energy() / before - 1), 1e-5);
    // 10⁴ steps of rounding; nothing else.
    EXPECT_LT(length(world.angular_momentum({}) - momentum), 2e-11 * length(momentum));
    RecordProperty("energy_drift", std::to_string(world.kinetic_energy() / before - 1));
  }
}

TEST(RigidWorld, AcceptedOverlapIsNotPushedOut) {
  const Vec3 half{0.5, 0.5, 0.5};
  for (const bool accepted : {false, true}) {
    RigidWorld world({.sleep = false});
    const BodyId id = add_block(world, block_params(100, half, {0, 0.4, 0}, 1), half);
    if (accepted) world.accept_overlaps(id);
    const double before = energy(world);
    double contact = 0;
    for (int i = 0; i < 240; ++i) {
      world.step(1.0 / 240);
      contact += world.work().contact;
    }
    EXPECT_NEAR(world.centre(id).y, accepted ? 0.4 : 0.5, 2e-3);
    EXPECT_NEAR(energy(world) + contact, before, 1e-9 * before);
    if (!accepted) continue;
    EXPECT_GT(contact, -1e-9 * before);
    // Once it has been off the ground it meets it as it is.
    world.set_velocity(id, {0, 3, 0}, {});
    for (int i = 0; i < 480; ++i) world.step(1.0 / 240);
    EXPECT_NEAR(world.centre(id).y, 0.5, 2e-3);
  }
}

TEST(RigidWorld, WhatLiesOnASinkingColliderSinksAndGainsNothing) {
  const Vec3 half{0.5, 0.5, 0.5};
  RigidWorld world({.has_ground = false});
  const Prism prism = block(2, 0.5, 2);
  const BodyId floor = world.add_static({{0, -0.5, 0}, {}}, {&prism, 1}, {}, 0);
  const BodyId id = add_block(world, block_params(100, half, {0, 0.5, 0}, 1), half);
  const double before = energy(world);
  double contact = 0;
  for (int i = 1; i <= 480; ++i) {
    if (i <= 240) world.move_static(floor, {{0, -0.5 - 0.001 * i, 0}, {}});
    world.step(1.0 / 240);
    contact += world.work().contact;
  }
  EXPECT_NEAR(world.centre(id).y, 0.5 - 0.24, 2e-3);
  EXPECT_GT(contact, 0.99 * 100 * kGravity * 0.24);
  // Each millimetre ends in an approach at creeping speed.
  EXPECT_NEAR(energy(world) + contact, before, 1e-5 * before);
}

TEST(RigidWorld, BallMeetsChunkWithTheRestitutionAskedFor) {
  for (const double speed : {2.0, 20.0}) {
    for (const double dt : {1.0 / 60, 1.0 / 240, 1.0 / 1000}) {
      RigidWorld world({.gravity = 0, .has_ground = false});
      BodyParams ball = ball_params(260, 0.25, {0.01, 0.003, -1}, 1);
      ball.velocity = {0, 0, speed};
      ball.surface = {0, 0.5};
      const BodyId hitting = world.add_sphere(ball, 0.25);
      BodyParams params = block_params(40, {0.2, 0.2, 0.1}, {0.01, 0.003, 0}, 2);
      params.surface = {0, 0.5};
      const BodyId hit = add_block(world, params, {0.2, 0.2, 0.1});
      for (double t = 0; t < 2 / speed; t += dt) world.step(dt);
      EXPECT_NEAR(world.velocity(hitting).z, (260 - 0.5 * 40) / 300 * speed, 1e-6 * speed);
      EXPECT_NEAR(world.velocity(hit).z, 1.5 * 260 / 300 * speed, 1e-6 * speed);
    }
  }
}

TEST(RigidWorld, BouncesToTheSquareOfTheRestitutionAndNeverHigher) {
  for (const double e : {1.0, 0.7}) {
    for (const double dt : {1.0 / 60, 1.0 / 240, 1.0 / 480, 1.0 / 1000, 1.0 / 4000}) {
      RigidWorld world({.ground = {0.6, e}});
      BodyParams params = ball_params(10, 0.1, {0, 1.1, 0}, 1);
      params.surface = {0.6, e};
      const BodyId ball = world.add_sphere(params, 0.1);
      const double start = energy(world);
      std::vector<double> apexes;
      double rising = 0, most = 0;
      for (double t = 0; t < 1.5; t += dt) {
        world.step(dt);
        most = std::max(most, energy(world));
        const double v = world.velocity(ball).y;
        if (rising > 0 && v <= 0) {
          apexes.push_back(world.centre(ball).y - 0.1 + v * v / (2 * kGravity));
        }
        rising = v;
      }
      ASSERT_FALSE(apexes.empty());
      EXPECT_LT(most, start * (1 + 1e-12));
      for (std::size_t k = 0; k < apexes.size(); ++k) {
        const double expected = std::pow(e, 2 * (static_cast<double>(k) + 1));
        EXPECT_NEAR(apexes[k], expected, 1e-9) << "bounce " << k << " dt " << dt;
      }
    }
  }
}

TEST(RigidWorld, TowerOfTenStands) {
  RigidWorld world({.iterations = 20, .sleep = false});
  std::vector<BodyId> ids;
  for (int i = 0; i < 10; ++i) {
    BodyParams params = block_params(1000, {0.5, 0.5, 0.5}, {0, 0.5 + i, 0}, i + 1);
    ids.push_back(add_block(world, params, {0.5, 0.5, 0.5}));
  }
  for (int i = 0; i < 2400; ++i) world.step(1.0 / 240);
  for (const BodyId id : ids) {
    const Vec3 at = world.centre(id);
    EXPECT_LT(std::hypot(at.x, at.z), 0.01);
    EXPECT_LT(length(world.velocity(id)), 0.01);
  }
  EXPECT_NEAR(world.reaction().y * 240, 10 * 1000 * kGravity, 10);
}

/// A slab tilted by `angle` about z; its upper side passes through the origin.
void add_slope(RigidWorld& world, double angle, const Surface& surface) {
  const Prism slab = block(50, 0.5, 5);
  const Pose pose{{0.5 * std::sin(angle), -0.5 * std::cos(angle), 0}, about_z(angle)};
  world.add_static(pose, {&slab, 1}, surface, 1);
}

TEST(RigidWorld, BlockSlidesDownASlopeOrSticks) {
  const double angle = 30 * kPi / 180;
  for (const double friction : {0.0, 0.3, 0.55, 0.6}) {
    for (const double dt : {1.0 / 60, 1.0 / 240}) {
      RigidWorld world({.has_ground = false, .sleep = false});
      add_slope(world, angle, {friction, 0});
      const Vec3 up{-std::sin(angle), std::cos(angle), 0};
      BodyParams params = block_params(10, {0.3, 0.1, 0.2}, 0.1 * up, 2);
      params.pose.rotation = about_z(angle);
      params.surface = {friction, 0};
      const BodyId id = add_block(world, params, {0.3, 0.1, 0.2});
      const Vec3 start = world.centre(id);
      const int steps = static_cast<int>(std::lround(1 / dt));
      for (int i = 0; i < steps; ++i) world.step(dt);
      const double along =
          -dot(world.centre(id) - start, Vec3{std::cos(angle), std::sin(angle), 0});
      const double expected =
          std::max(0.0, kGravity * (std::sin(angle) - friction * std::cos(angle)) / 2);
      EXPECT_NEAR(along, expected, 1e-3 * kGravity) << "friction " << friction << " dt " << dt;
    }
  }
}

TEST(RigidWorld, BallRollsDownASlope) {
  const double angle = 20 * kPi / 180;
  for (const double dt : {1.0 / 60, 1.0 / 240}) {
    RigidWorld world({.has_ground = false, .sleep = false});
    add_slope(world, angle, {0.5, 0});
    const Vec3 up{-std::sin(angle), std::cos(angle), 0};
    BodyParams params = ball_params(5, 0.2, 0.2 * up, 2);
    params.surface = {0.5, 0};
    const BodyId id = world.add_sphere(params, 0.2);
    const int steps = static_cast<int>(std::lround(1 / dt));
    for (int i = 0; i < steps; ++i) world.step(dt);
    const double speed = length(world.velocity(id));
    EXPECT_NEAR(speed, 5.0 / 7 * kGravity * std::sin(angle), 1e-3 * speed);
    EXPECT_NEAR(length(world.angular_velocity(id)) * 0.2, speed, 1e-3 * speed);
  }
}

// Housner 1963: quarter period and loss at the first impact of a block that rocks on its edges.
TEST(RigidWorld, BlockRocksAsHousnerSays) {
  const double b = 0.2, h = 0.8;
  const double slenderness = std::atan(b / h), tilt = slenderness / 2;
  for (const double dt : {1.0 / 240, 1.0 / 1000}) {
    RigidWorld world({.ground = {1, 0}, .sleep = false});
    BodyParams params = block_params(500, {b, h, 0.2}, {}, 1);
    params.pose.rotation = about_z(-tilt);  // on its right edge, at the origin
    const Vec3 edge = axes_of(params.pose.rotation) * Vec3{b, -h, 0};
    params.pose.position = -1.0 * edge;
    params.surface = {1, 0};
    const BodyId id = add_block(world, params, {b, h, 0.2});
    double before = -tilt, quarter = 0, other_side = 0;
    for (double t = dt; t < 1.2; t += dt) {
      world.step(dt);
      const double angle = 2 * std::asin(world.pose(id).rotation.z);
      if (quarter == 0 && angle >= -1e-4) quarter = t - dt * (angle / (angle - before));
      other_side = std::max(other_side, angle);
      before = angle;
    }
    EXPECT_NEAR(quarter, 0.44167, 0.01 * 0.44167) << "dt " << dt;
    EXPECT_NEAR(other_side / tilt, 0.7734, 0.02) << "dt " << dt;
  }
}

TEST(RigidWorld, FreeCollisionsKeepMomentumAndBookEveryJoule) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RigidWorld world({.gravity = 0, .has_ground = false});
    for (int i = 0; i < 6; ++i) {
      const auto r = [&](int k) { return 2 * random_unit(seed, i, k) - 1; };
      BodyParams params = block_params(5 + 40 * random_unit(seed, i), {0.15, 0.15, 0.05},
                                       {0.7 * (i % 3), 0.6 * (i / 3), 0.1 * r(0)}, i + 1);
      params.velocity = {3 * (1 - i % 3) + r(1), 2 * (0.5 - i / 3) + r(2), r(3)};
      params.angular_velocity = {4 * r(4), 4 * r(5), 4 * r(6)};
      const Prism prism = chunk(0.2, 0.05, seed * 10 + i);
      world.add_body(params, {&prism, 1});
    }
    const Vec3 momentum = world.momentum();
    const double scale = 100, start = world.kinetic_energy();
    double booked = 0, impulses = 0;
    for (int i = 0; i < 240; ++i) {
      world.step(1.0 / 240);
      booked += world.work().contact + world.work().friction;
      for (const Contact& c : world.contacts()) impulses += c.impulse;
    }
    ASSERT_GT(impulses, 1) << "seed " << seed;
    EXPECT_LT(length(world.momentum() - momentum), 1e-12 * scale) << "seed " << seed;
    EXPECT_NEAR(world.kinetic_energy() + booked, start, 1e-6 * start) << "seed " << seed;
    EXPECT_LT(world.kinetic_energy(), start) << "seed " << seed;
  }
}

// Exact but where an overlap had to be pushed out: that moves bodies without changing velocities.
TEST(RigidWorld, EccentricImpactKeepsAngularMomentum) {
  int exact = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RigidWorld world({.gravity = 0, .has_ground = false});
    const auto r = [&](int k) { return 2 * random_unit(seed, k) - 1; };
    BodyParams ball = ball_params(20, 0.1, {0.1 * r(0), 0.1 * r(1), 1}, 1);
    ball.velocity = {r(2), r(3), -10};
    ball.surface = {0.6, 0.5};
    world.add_sphere(ball, 0.1);
    BodyParams params = block_params(10, {0.15, 0.15, 0.05}, {}, 2);
    params.angular_velocity = {3 * r(4), 3 * r(5), 3 * r(6)};
    params.surface = {0.6, 0.5};
    const Prism prism = chunk(0.3, 0.05, seed);
    const BodyId hit = world.add_body(params, {&prism, 1});
    const Vec3 momentum = world.momentum(), angular = world.angular_momentum({1, 2, 3});
    for (int i = 0; i < 60; ++i) world.step(1.0 / 240);
    ASSERT_GT(length(world.velocity(hit)), 1) << "seed " << seed;
    EXPECT_LT(length(world.momentum() - momentum), 1e-12 * length(momentum)) << "seed " << seed;
    const double error = length(world.angular_momentum({1, 2, 3}) - angular) / length(angular);
    EXPECT_LT(error, 1e-4) << "seed " << seed;
    exact += error < 1e-12 ? 1 : 0;
  }
  EXPECT_GE(exact, 15);
}

// A plate of many parts on its narrow edge, hit; blocks and balls on it and about it.
void add_crowd(RigidWorld& world, std::uint64_t seed) {
  const auto r = [&](std::uint64_t k) { return random_unit(seed, k); };
  const Vec3 plate{0.3 + r(2), 0.5 + r(3), 0.004 + 0.02 * r(4)};
  std::vector<Prism> parts;
  const int count = 1 + static_cast<int>(20 * r(5));
  for (int i = 0; i < count; ++i) {
    const double low = plate.x * (2.0 * i / count - 1),
                 high = plate.x * (2.0 * (i + 1) / count - 1);
    parts.push_back(
        {{{low, -plate.y}, {high, -plate.y}, {high, plate.y}, {low, plate.y}}, plate.z});
  }
  BodyParams standing = block_params(5000 * plate.x * plate.y * plate.z, plate, {0, plate.y, 0}, 1);
  standing.angular_velocity = {0.2 * r(6), 0.1 * r(7), 0.1 * (r(8) - 0.5)};
  world.add_body(standing, parts);
  for (std::uint64_t i = 0; i < 5; ++i) {
    const auto draw = [&](std::uint64_t k) { return random_unit(seed, i + 1, k); };
    const double size = 0.05 + 0.1 * draw(0);
    const Vec3 at{0.5 * static_cast<double>(i) - 1, size * (1 + draw(1)), 0.4 + 0.2 * draw(2)};
    BodyParams params = block_params(1 + 50 * draw(3), {size, size, size}, at, i + 2);
    params.velocity = {draw(4) - 0.5, 0, -4 * draw(5)};
    params.surface = {draw(6), draw(7)};
    if (i % 2 == 0) {
      add_block(world, params, {size, size, size});
    } else {
      world.add_sphere(params, size);
    }
  }
}

TEST(RigidWorld, ContactsGiveNoEnergyHoweverCoarseTheStep) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const double dt = 0.001 * std::pow(50, random_unit(seed, 9));
    const int iterations = 1 + static_cast<int>(30 * random_unit(seed, 10));
    RigidWorld world({.iterations = iterations, .sleep = seed % 2 == 0});
    add_crowd(world, seed);
    const double start = energy(world);
    double taken = 0, least = 0, worst = 0;
    for (double time = 0; time < 0.6; time += dt) {
      const double before = energy(world);
      world.step(dt);
      const double lost = world.work().contact + world.work().friction;
      worst = std::max(worst, std::fabs(energy(world) - before + lost));
      taken += lost;
      least = std::min(least, taken);
    }
    EXPECT_GT(least, -1e-9 * start) << "seed " << seed << ", step " << dt;
    EXPECT_LT(worst, 1e-9 * start) << "seed " << seed << ", step " << dt;
  }
}

TEST(RigidWorld, BodiesThatStickForAMomentKeepTheirMomenta) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RigidWorld world({.gravity = 0, .has_ground = false});
    std::vector<BodyId> ids;
    for (std::uint64_t i = 0; i < 2 + seed % 4; ++i) {
      const auto r = [&](std::uint64_t k) { return random_unit(seed, i, k); };
      const Vec3 half{0.05 + r(0), 0.05 + r(1), 0.05 + r(2)};
      BodyParams params =
          block_params(1 + 20 * r(3), half, {5.0 * static_cast<double>(i), r(4), r(5)}, i + 1);
      params.pose.rotation = normalised({r(6), r(7), 1, r(8)});
      params.velocity = {r(9), 3 * r(10), -r(11)};
      params.angular_velocity = {r(12), r(13), -4 * r(14)};
      ids.push_back(add_block(world, params, half));
    }
    const Vec3 momentum = world.momentum(), angular = world.angular_momentum({1, 2, 3});
    const double before = world.kinetic_energy();
    const double asked = 0.3 * before;
    const double first = world.slow_together(ids, asked);
    EXPECT_NEAR(before - world.kinetic_energy(), first, 1e-12 * before);
    EXPECT_LE(first, asked * (1 + 1e-12));
    const double middle = world.kinetic_energy();
    const double rest = world.slow_together(ids, 10 * before);
    EXPECT_NEAR(middle - world.kinetic_energy(), rest, 1e-12 * before);
    EXPECT_TRUE(first == asked || rest < 1e-12 * before) << "all, or all there is";
    EXPECT_LT(length(world.momentum() - momentum), 1e-12 * length(momentum));
    EXPECT_LT(length(world.angular_momentum({1, 2, 3}) - angular), 1e-11 * length(angular));
    // They move as one then.
    const Vec3 spin = world.angular_velocity(ids[0]);
    for (const BodyId id : ids) {
      EXPECT_LT(length(world.angular_velocity(id) - spin), 1e-12);
      EXPECT_LT(length(world.velocity(id) - world.velocity_at(ids[0], world.centre(id))), 1e-11);
    }
    EXPECT_LT(world.slow_together(ids, before), 1e-12 * before);
  }
}

TEST(RigidWorld, BouncingBallsBookEveryJoule) {
  RigidWorld world({.ground = {0.5, 0.5}});
  for (int i = 0; i < 3; ++i) {
    BodyParams params = ball_params(5, 0.2, {0.05 * i, 0.6 + 0.9 * i, 0.03 * i}, i + 1);
    params.surface = {0.5, 0.6};
    params.angular_velocity = {5, 0, 3};
    world.add_sphere(params, 0.2);
  }
  double worst = 0;
  const double start = energy(world);
  for (int i = 0; i < 480; ++i) {
    const double before = energy(world);
    world.step(1.0 / 240);
    const StepWork work = world.work();
    worst = std::max(worst, std::fabs(energy(world) - before + work.contact + work.friction));
  }
  EXPECT_LT(worst, 1e-12 * start);
  EXPECT_LT(energy(world), start / 2);
}

/// Poses of a pile of thirty chunks after 300 steps; far colliders must not matter, nor the order
/// of insertion.
std::vector<Pose> pile(bool backwards, int far_colliders) {
  RigidWorld world({});
  const auto add_far = [&](int from, int to) {
    for (int i = from; i < to; ++i) {
      const Prism prism = chunk(0.3, 0.1, i);
      world.add_static({{20.0 + i % 20, 0.3 * (i / 20), 30}, {}}, {&prism, 1}, {}, 1000 + i);
    }
  };
  add_far(0, far_colliders / 2);
  std::vector<BodyId> ids(30);
  for (int k = 0; k < 30; ++k) {
    const int i = backwards ? 29 - (7 * k) % 30 : k;
    BodyParams params = block_params(10 + i, {0.15, 0.15, 0.05},
                                     {0.3 * (i % 4), 0.3 + 0.32 * (i / 4), 0.02 * (i % 3)}, i + 1);
    params.angular_velocity = {0, 1, 0.3 * (i % 5)};
    const Prism prism = chunk(0.2, 0.06, i);
    ids[i] = world.add_body(params, {&prism, 1});
  }
  add_far(far_colliders / 2, far_colliders);
  for (int i = 0; i < 300; ++i) world.step(1.0 / 240);
  std::vector<Pose> poses;
  for (const BodyId id : ids) poses.push_back(world.pose(id));
  return poses;
}

TEST(RigidWorld, NeitherOrderOfInsertionNorWhatIsFarAwayChangesABit) {
  const std::vector<Pose> plain = pile(false, 0);
  EXPECT_EQ(plain, pile(true, 0));
  EXPECT_EQ(plain, pile(false, 500));
  EXPECT_EQ(plain, pile(true, 500));
}

TEST(RigidWorld, RestingBodiesSleepAndWakeWhenTheirSupportGoes) {
  RigidWorld world({});
  std::vector<BodyId> ids;
  for (int i = 0; i < 3; ++i) {
    ids.push_back(add_block(world, block_params(10, {0.2, 0.2, 0.2}, {0, 0.2 + 0.4 * i, 0}, i + 1),
                            {0.2, 0.2, 0.2}));
  }
  for (int i = 0; i < 240; ++i) world.step(1.0 / 240);
  EXPECT_TRUE(world.awake().empty());
  world.remove(ids[0]);
  EXPECT_TRUE(world.is_awake(ids[1]));
  for (int i = 0; i < 480; ++i) world.step(1.0 / 240);
  EXPECT_NEAR(world.centre(ids[1]).y, 0.2, 2e-3);
  EXPECT_NEAR(world.centre(ids[2]).y, 0.6, 2e-3);
  EXPECT_TRUE(world.awake().empty());
  world.apply_impulse(ids[2], {50, 0, 0}, world.centre(ids[2]));
  EXPECT_TRUE(world.is_awake(ids[2]));
  EXPECT_NEAR(world.velocity(ids[2]).x, 5, 1e-12);
}

TEST(RigidWorld, ABallWakesWhatItHits) {
  RigidWorld world({});
  const BodyId low =
      add_block(world, block_params(10, {0.2, 0.2, 0.2}, {0, 0.2, 0}, 1), {0.2, 0.2, 0.2});
  for (int i = 0; i < 240; ++i) world.step(1.0 / 240);
  ASSERT_FALSE(world.is_awake(low));
  BodyParams params = ball_params(20, 0.1, {-1, 0.2, 0}, 2);
  params.velocity = {10, 0, 0};
  world.add_sphere(params, 0.1);
  for (int i = 0; i < 60; ++i) world.step(1.0 / 240);
  EXPECT_GT(world.centre(low).x, 0.1);
}

TEST(RigidWorld, NothingSleepsInTheAir) {
  RigidWorld world({.gravity = 0.01, .has_ground = false});
  const BodyId id =
      add_block(world, block_params(10, {0.2, 0.2, 0.2}, {0, 5, 0}, 1), {0.2, 0.2, 0.2});
  for (int i = 0; i < 480; ++i) world.step(1.0 / 240);
  EXPECT_TRUE(world.is_awake(id));
  EXPECT_NEAR(world.centre(id).y, 5 - 0.01 * 2, 1e-12);
}

TEST(RigidWorld, ContactsAndReactionCarryTheWeight) {
  RigidWorld world({.sleep = false});
  for (int i = 0; i < 4; ++i) {
    add_block(world, block_params(10, {0.2, 0.2, 0.2}, {0, 0.2 + 0.4 * i, 0}, i + 1),
              {0.2, 0.2, 0.2});
  }
  const double dt = 1.0 / 240;
  for (int i = 0; i < 480; ++i) world.step(dt);
  EXPECT_NEAR(world.reaction().y, 40 * kGravity * dt, 1e-6);
  double on_third = 0;
  for (const Contact& c : world.contacts()) {
    EXPECT_LT(c.a, c.b);
    EXPECT_NEAR(length(c.normal), 1, 1e-12);
    EXPECT_LT(c.normal.y, -0.999);  // from the upper to the lower
    if (c.a == 2 && c.b == 3) on_third += c.impulse;
  }
  EXPECT_NEAR(on_third, 20 * kGravity * dt, 1e-6);
}

TEST(RigidWorld, OneBodyOfManyPrismsIsOneBody) {
  RigidWorld world({});
  std::vector<Prism> parts;
  for (int i = 0; i < 20; ++i) {
    const double x = 0.2 * i - 2;
    parts.push_back({{{x, -0.1}, {x + 0.2, -0.1}, {x + 0.2, 0.1}, {x, 0.1}}, 0.1});
  }
  const BodyId beam = world.add_body(block_params(100, {2, 0.1, 0.1}, {0, 0.5, 0}, 1), parts);
  const BodyId ball = world.add_sphere(ball_params(5, 0.1, {0.73, 1.2, 0}, 2), 0.1);
  for (int i = 0; i < 720; ++i) world.step(1.0 / 240);
  EXPECT_NEAR(world.centre(beam).y, 0.1, 2e-3);
  EXPECT_NEAR(world.centre(ball).y, 0.3, 5e-3);
  EXPECT_EQ(world.body_count(), 2u);
}

struct Stress {
  double dt, half, offset, ratio;
  int iterations;
};

/// Thrown together, overlapping from the start: nothing may explode.
std::string run(const Stress& s) {
  RigidWorld world({.iterations = s.iterations});
  std::vector<BodyId> ids;
  for (int i = 0; i < 8; ++i) {
    const double mass = i % 2 == 0 ? 1 : s.ratio;
    const Vec3 at{s.offset + 0.15 * (i % 3), 0.2 + 0.12 * i, 0.5 * s.half * (i % 2)};
    const BodyParams params = block_params(mass, {0.15, 0.15, std::max(s.half, 0.02)}, at, i + 1);
    const Prism prism = chunk(0.2, s.half, i);
    ids.push_back(world.add_body(params, {&prism, 1}));
  }
  const double available = world.potential_energy();
  const int steps = static_cast<int>(0.4 / s.dt);
  for (int i = 0; i < steps; ++i) {
    world.step(s.dt);
    for (const BodyId id : ids) {
      if (!is_finite(world.centre(id)) || !is_finite(world.velocity(id))) return "not a number";
      if (world.centre(id).y < -1) return "sinks";
    }
    if (world.kinetic_energy() > available) return "explodes";
  }
  return "";
}

TEST(RigidWorld, StaysCalmOverTheGridOfStresses) {
  for (const double dt : {1.0 / 30, 1.0 / 120, 1.0 / 1000}) {
    for (const double half : {0.0005, 0.05, 0.5}) {
      for (const double offset : {0.0, 1e4}) {
        for (const double ratio : {1.0, 1000.0}) {
          for (const int iterations : {4, 20}) {
            const std::string fault = run({dt, half, offset, ratio, iterations});
            EXPECT_EQ(fault, "") << "dt " << dt << " half " << half << " offset " << offset
                                 << " ratio " << ratio << " iterations " << iterations;
          }
        }
      }
    }
  }
  EXPECT_EQ(run({1.0 / 30, 0.05, 0, 1000, 500}), "");
}

// Angular momentum alone allows a needle energies that differ by its inertias' ratio, here 10⁴.
TEST(RigidWorld, NeedleKeepsItsEnergyHoweverFastItSpins) {
  for (const double spin : {10.0, 1e3, 1e5})
    for (const double dt : {1.0 / 30, 1.0 / 240}) {
      RigidWorld world({.gravity = 0, .has_ground = false});
      BodyParams needle;
      needle.mass = 1;
      needle.inertia = {1e-6, 1e-2, 1e-2, 0, 0, 0};
      needle.angular_velocity = {0.7 * spin, 0.6 * spin, 0.4 * spin};
      const Prism box{{{-0.17, -0.002}, {0.17, -0.002}, {0.17, 0.002}, {-0.17, 0.002}}, 0.002};
      world.add_body(needle, std::span(&box, 1));
      const double before = world.kinetic_energy();
      const Vec3 momentum = world.angular_momentum({});
      for (int i = 0; i < 30; ++i) world.step(dt);
      EXPECT_NEAR(world.kinetic_energy() / before, 1, 1e-3) << spin << ' ' << dt;
      EXPECT_LT(length(world.angular_momentum({}) - momentum), 1e-9 * length(momentum));
    }
}

}  // namespace
}  // namespace sunder
