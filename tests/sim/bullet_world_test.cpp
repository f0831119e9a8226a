// SPDX-License-Identifier: GPL-3.0-or-later
// What the rigid world must do beyond rigid_world_test: fast and oblique impacts at coarse steps,
// friction as a cone, the energy ledger to rounding, and worlds that are hard on a contact solver.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "meshing/random.hpp"
#include "sim/principal_axes.hpp"
#include "sim/rigid_world.hpp"
#include "sim/spin.hpp"
#include "sim/touch_points.hpp"
#include "tests/sim/bodies.hpp"

namespace sunder {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGravity = 9.81;

double energy(const RigidWorld& world) {
  return world.kinetic_energy() + world.potential_energy();
}

bool is_finite(Vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Quaternion tilt(Vec3 axis, double angle) {
  const double s = std::sin(angle / 2) / length(axis);
  return {s * axis.x, s * axis.y, s * axis.z, std::cos(angle / 2)};
}

TEST(BulletWorld, BallsThatHitObliquelyPartAlongTheNormalOfTheImpact) {
  const double radius = 0.1, offset = 0.12, speed = 20, m = 3, n = 5, e = 0.6;
  for (const double dt : {1.0 / 30, 1.0 / 60, 1.0 / 240, 1.0 / 1000}) {
    RigidWorld world({.gravity = 0, .has_ground = false});
    BodyParams params = ball_params(m, radius, {-1, offset, 0}, 1);
    params.velocity = {speed, 0, 0};
    params.surface = {0, e};
    const BodyId flying = world.add_sphere(params, radius);
    params = ball_params(n, radius, {}, 2);
    params.surface = {0, e};
    const BodyId struck = world.add_sphere(params, radius);
    for (double t = 0; t < 0.2; t += dt) world.step(dt);
    const Vec3 normal{-std::sqrt(1 - 0.36), 0.6, 0};  // from the struck one, sine 0.12 / 0.2
    const double impulse = (1 + e) * speed * -normal.x * m * n / (m + n);
    const Vec3 expected = (-impulse / n) * normal;
    EXPECT_LT(length(world.velocity(struck) - expected), 1e-6 * speed) << "dt " << dt;
    const Vec3 momentum = m * world.velocity(flying) + n * world.velocity(struck);
    EXPECT_LT(length(momentum - Vec3{m * speed, 0, 0}), 1e-12 * m * speed) << "dt " << dt;
  }
}

// A ball that meets a corner off its centre: the rebound must not depend on the step, though the
// nearest point moves along the corner while the ball comes.
TEST(BulletWorld, BallBouncesOffACornerTheSameWhateverTheStep) {
  std::vector<Vec3> rebounds;
  for (const double dt : {1.0 / 4000, 1.0 / 240, 1.0 / 60, 1.0 / 30}) {
    RigidWorld world({.gravity = 0, .has_ground = false});
    const Prism prism = block(0.5, 0.5, 0.5);
    world.add_static({}, {&prism, 1}, {0, 1}, 1);
    BodyParams params = ball_params(3, 0.2, {-2, 0.6, 0}, 2);
    params.velocity = {20, 0, 0};
    params.surface = {0, 1};
    const BodyId ball = world.add_sphere(params, 0.2);
    for (double t = 0; t < 0.2; t += dt) world.step(dt);
    rebounds.push_back(world.velocity(ball));
    EXPECT_NEAR(length(rebounds.back()), 20, 1e-9) << "dt " << dt;
    EXPECT_LT(length(rebounds.back() - rebounds.front()), 1e-3) << "dt " << dt;
  }
  // The corner is sharp but for a rounding of a millimetre: normal (-√3/2, 1/2).
  EXPECT_LT(length(rebounds[0] - Vec3{-10, 17.3205, 0}), 0.2);
}

TEST(BulletWorld, BallPassesACornerWithoutTouchingIt) {
  for (const double dt : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
    for (const double clearance : {0.003, 0.02, 0.1}) {
      RigidWorld world({.gravity = 0, .has_ground = false});
      const Prism prism = block(0.5, 0.5, 0.5);
      world.add_static({}, {&prism, 1}, {0.5, 0.5}, 1);
      BodyParams params = ball_params(3, 0.2, {-5, 0.7 + clearance, 0.1}, 2);
      params.velocity = {50, 0, 0};
      const BodyId ball = world.add_sphere(params, 0.2);
      for (double t = 0; t < 0.2; t += dt) {
        world.step(dt);
        EXPECT_TRUE(world.contacts().empty()) << "dt " << dt << " clearance " << clearance;
      }
      EXPECT_EQ(world.velocity(ball), (Vec3{50, 0, 0}));
    }
  }
}

TEST(BulletWorld, NothingFastGoesThroughAThinWall) {
  for (const double speed : {50.0, 300.0}) {
    for (const double dt : {1.0 / 30, 1.0 / 240}) {
      RigidWorld world({.gravity = 0, .has_ground = false});
      const Prism prism = block(2, 2, 0.0005);
      world.add_static({}, {&prism, 1}, {0, 0}, 1);
      BodyParams ball = ball_params(3, 0.05, {0.3, 0.2, -1.03}, 2);
      ball.velocity = {0, 0, speed};
      const BodyId round = world.add_sphere(ball, 0.05);
      BodyParams cube = block_params(3, {0.05, 0.05, 0.05}, {-1, 0.2, -1.03}, 3);
      cube.velocity = {0, 0, speed};
      const BodyId square = add_block(world, cube, {0.05, 0.05, 0.05});
      for (int i = 0; i < 60; ++i) world.step(dt);
      EXPECT_NEAR(world.centre(round).z, -0.0505, 2e-3) << speed << " " << dt;
      EXPECT_NEAR(world.centre(square).z, -0.0505, 2e-3) << speed << " " << dt;
    }
  }
}

TEST(BulletWorld, ChunksThatTouchAtBirthStayWhereTheyAre) {
  RigidWorld world({.gravity = 0, .has_ground = false, .sleep = false});
  std::vector<BodyId> ids;
  for (int i = 0; i < 25; ++i) {
    // Six-sided bricks of a wall: neighbours share whole faces.
    const double x = 0.3 * (i % 5) + 0.15 * (i / 5 % 2), y = 0.2 * (i / 5);
    const Prism prism{{{x, y},
                       {x + 0.15, y - 0.02},
                       {x + 0.3, y},
                       {x + 0.3, y + 0.2},
                       {x + 0.15, y + 0.18},
                       {x, y + 0.2}},
                      0.1};
    BodyParams params = block_params(20, {0.15, 0.1, 0.1}, {}, i + 1);
    params.centroid = {x + 0.15, y + 0.09, 0};
    Prism shape = prism;
    if (shape.outline[4].y < y + 0.2) shape.outline.erase(shape.outline.begin() + 4);
    ids.push_back(world.add_body(params, {&shape, 1}));
  }
  double impulses = 0;
  for (int i = 0; i < 240; ++i) {
    world.step(1.0 / 240);
    for (const Contact& c : world.contacts()) impulses += c.impulse;
  }
  EXPECT_LT(world.kinetic_energy(), 1e-20);
  EXPECT_LT(impulses, 1e-9);
}

TEST(BulletWorld, FrictionBrakesTheSameInEveryDirection) {
  for (int k = 0; k < 8; ++k) {
    RigidWorld world({.ground = {0.4, 0}, .sleep = false});
    BodyParams params = block_params(10, {0.3, 0.05, 0.3}, {0, 0.05, 0}, 1);
    const Vec3 way{std::cos(0.3 + k), 0, std::sin(0.3 + k)};
    params.velocity = 4 * way;
    params.surface = {0.4, 0};
    const BodyId id = add_block(world, params, {0.3, 0.05, 0.3});
    for (int i = 0; i < 360; ++i) world.step(1.0 / 240);
    const Vec3 gone = world.centre(id) - Vec3{0, 0.05, 0};
    EXPECT_NEAR(dot(gone, way), 16 / (2 * 0.4 * kGravity), 2e-3) << k;
    EXPECT_LT(length(gone - dot(gone, way) * way), 2e-3) << k;
    EXPECT_LT(length(world.velocity(id)), 1e-9) << k;
  }
}

TEST(BulletWorld, EveryJouleIsBookedAlsoWhereThingsBounceAndOverlap) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    RigidWorld world({.ground = {0.5, 0.4}, .sleep = seed % 2 == 0});
    for (int i = 0; i < 10; ++i) {
      const auto r = [&](int k) { return 2 * random_unit(seed, i, k) - 1; };
      BodyParams params = block_params(5 + 40 * random_unit(seed, i), {0.15, 0.15, 0.05},
                                       {0.2 * (i % 3), 0.25 + 0.25 * (i / 3), 0.1 * r(0)}, i + 1);
      params.velocity = {r(1), r(2), r(3)};
      params.angular_velocity = {4 * r(4), 4 * r(5), 4 * r(6)};
      params.surface = {0.5, 0.5};
      const Prism prism = chunk(0.2, 0.05, seed * 10 + i);
      if (i % 4 == 3) {
        world.add_sphere(params, 0.12);
      } else {
        world.add_body(params, {&prism, 1});
      }
    }
    const double start = energy(world);
    double worst = 0, before = start;
    for (int i = 0; i < 480; ++i) {
      world.step(1.0 / 240);
      const double now = energy(world), lost = world.work().contact + world.work().friction;
      worst = std::max(worst, std::fabs(now - before + lost));
      before = now;
    }
    EXPECT_LT(worst, 1e-11 * start) << "seed " << seed;  // what Runge–Kutta loses in a step
    EXPECT_LT(energy(world), start) << "seed " << seed;
  }
}

TEST(BulletWorld, DeepOverlapComesApartWithoutSpeed) {
  RigidWorld world({.gravity = 0, .has_ground = false, .sleep = false});
  std::vector<BodyId> ids;
  for (int i = 0; i < 4; ++i) {
    ids.push_back(add_block(
        world, block_params(10, {0.2, 0.2, 0.2}, {0.15 * i, 0.05 * i, 0}, i + 1), {0.2, 0.2, 0.2}));
  }
  double fastest = 0;
  for (int i = 0; i < 960; ++i) {
    world.step(1.0 / 240);
    for (const BodyId id : ids) fastest = std::max(fastest, length(world.velocity(id)));
  }
  EXPECT_LT(fastest, 0.02);
  for (int i = 1; i < 4; ++i) {
    const Vec3 d = world.centre(ids[i]) - world.centre(ids[i - 1]);
    EXPECT_GT(std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)}), 0.37);
  }
}

// The same body, described in another frame: the principal axes are found, not given.
TEST(BulletWorld, MotionDoesNotDependOnTheFrameOfTheDescription) {
  const auto run = [](const Quaternion& frame) {
    RigidWorld world({.iterations = 40, .sleep = false});
    const Vec3 half{0.3, 0.1, 0.2};
    BodyParams params = block_params(10, half, {}, 1);
    const Axes back = axes_of(conjugate(frame));
    params.inertia = rotated(back, params.inertia);
    params.pose = {{0, 1, 0}, tilt({1, 2, 3}, 0.7) * frame};
    params.angular_velocity = {1, 6, 2};
    params.surface = {0.5, 0.3};
    // Turned about z the block stays a prism of the frame.
    Prism prism = block(half.x, half.y, half.z);
    for (Vec2& p : prism.outline) {
      const Vec3 q = back * Vec3{p.x, p.y, 0};
      p = {q.x, q.y};
    }
    const BodyId id = world.add_body(params, {&prism, 1});
    for (int i = 0; i < 120; ++i) world.step(1.0 / 240);
    return world.centre(id);
  };
  const Vec3 plain = run({});
  EXPECT_LT(length(run(tilt({0, 0, 1}, 0.4)) - plain), 1e-6);
  EXPECT_LT(length(run(tilt({0, 0, 1}, -1.1)) - plain), 1e-6);
}

TEST(BulletWorld, PoseIsThatOfTheDescription) {
  RigidWorld world({});
  BodyParams params = block_params(10, {0.2, 0.2, 0.2}, {1, 2, 3}, 1);
  params.inertia = {.xx = 1, .yy = 1.2, .zz = 1.5, .xy = 0.1, .xz = -0.2, .yz = 0.05};
  params.centroid = {5, 6, 0};
  params.pose.rotation = tilt({1, 1, 0}, 0.5);
  const Prism prism{{{4.8, 5.8}, {5.2, 5.8}, {5.2, 6.2}, {4.8, 6.2}}, 0.2};
  const BodyId id = world.add_body(params, {&prism, 1});
  EXPECT_LT(length(world.pose(id).position - params.pose.position), 1e-14);
  EXPECT_LT(length(world.centre(id) - params.pose * params.centroid), 1e-14);
  const RigidWorld::Bounds bounds = world.bounds(id);
  EXPECT_LT(length(0.5 * (bounds.low + bounds.high) - world.centre(id)), 1e-14);
}

/// Poses of bodies of several prisms and balls thrown together.
std::vector<Pose> heap(bool backwards, bool far) {
  RigidWorld world({.iterations = 10});
  std::vector<BodyId> gone;
  std::vector<BodyId> ids(12);
  for (int k = 0; k < 12; ++k) {
    const int i = backwards ? 11 - k : k;
    if (far) {
      const Prism prism = chunk(0.3, 0.1, i);
      gone.push_back(world.add_static({{30.0 + i, 0, 9}, {}}, {&prism, 1}, {}, 500 + i));
    }
    BodyParams params = block_params(10 + i, {0.15, 0.15, 0.05},
                                     {0.3 * (i % 2), 0.4 + 0.4 * (i / 2), 0.02 * (i % 3)}, i + 1);
    params.angular_velocity = {0, 1, 0.3 * (i % 5)};
    std::vector<Prism> parts(1 + i % 3, chunk(0.15, 0.06, i));
    for (std::size_t p = 0; p < parts.size(); ++p) {
      for (Vec2& corner : parts[p].outline) corner.x += 0.25 * (static_cast<double>(p) - 0.5);
    }
    ids[i] = i % 4 == 3 ? world.add_sphere(params, 0.15) : world.add_body(params, parts);
  }
  for (int i = 0; i < 400; ++i) {
    world.step(1.0 / 240);
    if (i == 100) {
      for (const BodyId id : gone) world.remove(id);
    }
  }
  std::vector<Pose> poses;
  for (const BodyId id : ids) poses.push_back(world.pose(id));
  return poses;
}

TEST(BulletWorld, NeitherOrderOfInsertionNorRemovalFarAwayChangesABit) {
  const std::vector<Pose> plain = heap(false, false);
  EXPECT_EQ(plain, heap(true, false));
  EXPECT_EQ(plain, heap(false, true));
  EXPECT_EQ(plain, heap(true, true));
}

TEST(BulletWorld, TenThousandChunksAtOnce) {
  RigidWorld world({.iterations = 4});
  std::vector<BodyId> ids;
  for (int i = 0; i < 10000; ++i) {
    const Vec3 at{0.35 * (i % 22), 0.15 + 0.35 * (i / 484), 0.13 * (i / 22 % 22)};
    const Prism prism = chunk(0.2, 0.06, i);
    ids.push_back(world.add_body(block_params(10, {0.15, 0.15, 0.06}, at, i + 1), {&prism, 1}));
  }
  for (int i = 0; i < 3; ++i) world.step(1.0 / 120);
  ASSERT_GT(world.contacts().size(), 1000u);
  for (const BodyId id : ids) {
    ASSERT_TRUE(is_finite(world.centre(id)));
    ASSERT_LT(length(world.velocity(id)), 5);
  }
}

TEST(BulletWorld, ExemptBodyMeetsOnlyBallsAndTheGround) {
  RigidWorld world({});
  const Prism shelf = block(0.5, 0.05, 0.5);
  world.add_static({{0, 1, 0}, {}}, {&shelf, 1}, {}, 1);
  const BodyId id =
      add_block(world, block_params(5, {0.1, 0.1, 0.1}, {0, 1.5, 0}, 2), {0.1, 0.1, 0.1});
  world.exempt(id, 0.6);  // falls through the shelf within 0.43 s
  for (int i = 0; i < 240; ++i) world.step(1.0 / 240);
  EXPECT_NEAR(world.centre(id).y, 0.1, 2e-3);
  const BodyId next =
      add_block(world, block_params(5, {0.1, 0.1, 0.1}, {0, 1.5, 0}, 3), {0.1, 0.1, 0.1});
  for (int i = 0; i < 240; ++i) world.step(1.0 / 240);
  EXPECT_NEAR(world.centre(next).y, 1.15, 2e-3);
}

TEST(BulletWorld, RemovalInTheMiddleOfAPileIsSafe) {
  RigidWorld world({});
  std::vector<BodyId> ids;
  for (int i = 0; i < 20; ++i) {
    ids.push_back(add_block(world,
                            block_params(10, {0.2, 0.1, 0.2}, {0.01 * i, 0.1 + 0.2 * i, 0}, i + 1),
                            {0.2, 0.1, 0.2}));
  }
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < 30; ++k) world.step(1.0 / 120);
    world.remove(ids[(7 * i) % 20]);
    EXPECT_EQ(world.body_count(), 19u - i);
  }
  world.step(1.0 / 120);
  EXPECT_TRUE(world.awake().empty());
  EXPECT_TRUE(world.contacts().empty());
}

// Sequential impulses creep here: with few sweeps the light one is pressed into the ground and out
// again at the side, but without a jump.
TEST(BulletWorld, ATonOnAKilogramStandsWithManySweepsAndIsCalmWithFew) {
  for (const int iterations : {4, 20, 500}) {
    RigidWorld world({.iterations = iterations, .sleep = false});
    const BodyId low =
        add_block(world, block_params(1, {0.2, 0.2, 0.2}, {0, 0.2, 0}, 1), {0.2, 0.2, 0.2});
    const BodyId top =
        add_block(world, block_params(1000, {0.2, 0.2, 0.2}, {0, 0.6, 0}, 2), {0.2, 0.2, 0.2});
    double fastest = 0;
    for (int i = 0; i < 480; ++i) {
      world.step(1.0 / 240);
      fastest = std::max({fastest, length(world.velocity(low)), length(world.velocity(top))});
    }
    EXPECT_LT(fastest, 5) << iterations;
    EXPECT_NEAR(world.reaction().y * 240, 1001 * kGravity, 1) << iterations;
    if (iterations == 500) {
      EXPECT_NEAR(world.centre(top).y, 0.6, 0.02);
    }
  }
}

TEST(PrincipalAxes, AreOrthonormalAndDiagonaliseTheMatrix) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const auto r = [&](int k) { return 2 * random_unit(seed, k) - 1; };
    const SymMat3 m{2 + r(0), 2 + r(1), 2 + r(2), r(3), r(4), r(5)};
    const PrincipalAxes p = principal_axes(m);
    EXPECT_LT(length(m * p.axes.x - p.moments.x * p.axes.x), 1e-14) << "seed " << seed;
    EXPECT_LT(length(m * p.axes.y - p.moments.y * p.axes.y), 1e-14) << "seed " << seed;
    EXPECT_LT(length(m * p.axes.z - p.moments.z * p.axes.z), 1e-14) << "seed " << seed;
    EXPECT_LT(length(cross(p.axes.x, p.axes.y) - p.axes.z), 1e-14) << "seed " << seed;
  }
  EXPECT_EQ(principal_axes({3, 1, 2, 0, 0, 0}).moments, (Vec3{3, 1, 2}));
}

TEST(TouchPoints, FourThatCarryWhatAllWould) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    std::vector<TouchPoint> points;
    for (int i = 0; i < 12; ++i) {
      const double turn = (i + random_unit(seed, i)) * kPi / 6;
      points.push_back({{std::cos(turn), 0, std::sin(turn)}, {0, 1, 0}, 0});
    }
    std::vector<TouchPoint> kept = points;
    keep_four(kept);
    ASSERT_EQ(kept.size(), 4u);
    // The quadrilateral covers most of the disc's inscribed square.
    double area = 0;
    std::sort(kept.begin(), kept.end(), [](const TouchPoint& a, const TouchPoint& b) {
      return std::atan2(a.at.z, a.at.x) < std::atan2(b.at.z, b.at.x);
    });
    for (int i = 0; i < 4; ++i) {
      const Vec3 a = kept[i].at, b = kept[(i + 1) % 4].at;
      area += (a.x * b.z - a.z * b.x) / 2;
    }
    EXPECT_GT(area, 0.85 * 2) << "seed " << seed;
  }
}

TEST(TouchPoints, ADeeperPointHidesThoseBehindIt) {
  std::vector<TouchPoint> points;
  for (const double gap : {0.01, 0.0}) {
    for (int i = 0; i < 4; ++i) {
      points.push_back({{i < 2 ? 0.0 : 1.0, gap, i % 2 == 0 ? 0.0 : 1.0}, {0, 1, 0}, gap});
    }
  }
  keep_four(points);
  ASSERT_EQ(points.size(), 4u);
  for (const TouchPoint& p : points) EXPECT_EQ(p.gap, 0);
}

TEST(TouchPoints, InsetMovesEverySideByTheSame) {
  const std::vector<Vec2> outline = chunk(1, 1, 7).outline;
  const std::vector<Vec2> inner = inset(outline, 0.01);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 a = outline[i], side = outline[(i + 1) % outline.size()] - a;
    EXPECT_NEAR(cross(side, inner[i] - a) / length(side), 0.01, 1e-15);
    EXPECT_NEAR(cross(side, inner[(i + 1) % outline.size()] - a) / length(side), 0.01, 1e-15);
  }
  EXPECT_NEAR(inner_radius({{0, 0}, {4, 0}, {4, 2}, {0, 2}}), 1, 1e-15);
}

}  // namespace
}  // namespace sunder
