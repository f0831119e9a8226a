// SPDX-License-Identifier: GPL-3.0-or-later
// Closed forms of rigid-body mechanics against sim/rigid_world.hpp, over steps and iterations.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <vector>

#include "bench/impact_accuracy.hpp"
#include "sim/rigid_world.hpp"
#include "sim/spin.hpp"
#include "tests/sim/bodies.hpp"

namespace sunder {

std::string step_text(double step) {
  return "1/" + std::to_string(std::lround(1 / step)) + " s";
}

void print_accuracy_header() {
  std::printf(
      "\n| case | quantity | step | iterations | measured | expected | error | source |\n"
      "|---|---|---|---|---|---|---|---|\n");
}

void print_accuracy_row(const AccuracyRow& row) {
  const double off = std::abs(row.measured - row.expected);
  std::printf("| %s | %s | %s | %s | %.7g | %.7g | %.1e%s | %s |\n", row.name.c_str(),
              row.quantity.c_str(), row.step.c_str(), row.iterations.c_str(), row.measured,
              row.expected, row.expected != 0 ? off / std::abs(row.expected) : off,
              row.expected != 0 ? "" : " abs.", row.source.c_str());
  std::fflush(stdout);
}

namespace {

constexpr double kGravity = 9.81;
constexpr double kSteps[] = {1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 1000};

Quaternion about_z(double angle) {
  return {0, 0, std::sin(angle / 2), std::cos(angle / 2)};
}

int steps_in(double time, double dt) {
  return static_cast<int>(std::lround(time / dt));
}

void head_on(double speed, double dt) {
  RigidWorld world({.gravity = 0, .has_ground = false});
  BodyParams ball = ball_params(260, 0.25, {0.01, 0.003, -1}, 1);
  ball.velocity = {0, 0, speed};
  ball.surface = {0, 0.5};
  const BodyId hitting = world.add_sphere(ball, 0.25);
  BodyParams params = block_params(40, {0.2, 0.2, 0.1}, {0.01, 0.003, 0}, 2);
  params.surface = {0, 0.5};
  const BodyId hit = add_block(world, params, {0.2, 0.2, 0.1});
  const double before = world.kinetic_energy();
  for (int i = 0; i < steps_in(2 / speed, dt); ++i) world.step(dt);
  char name[80];
  std::snprintf(name, sizeof name, "260 kg ball on a 40 kg chunk, e = 0.5, %g m/s", speed);
  AccuracyRow row{.name = name, .quantity = "v1', m/s", .step = step_text(dt), .iterations = "20"};
  row.measured = world.velocity(hitting).z, row.expected = (260 - 0.5 * 40) / 300 * speed;
  print_accuracy_row(row);
  row.quantity = "v2', m/s";
  row.measured = world.velocity(hit).z, row.expected = 1.5 * 260 / 300 * speed;
  print_accuracy_row(row);
  row.quantity = "KE'/KE";
  row.measured = world.kinetic_energy() / before, row.expected = 1 - 0.75 * 40 / 300;
  print_accuracy_row(row);
}

// scpeters/benchmark's box; the spin after 10 s is that of a Runge–Kutta run with tiny steps, to
// six digits. (With moments rounded to five digits it would be 0.003 rad/s away.)
void spin(double dt) {
  RigidWorld world({.gravity = 0, .has_ground = false});
  BodyParams params = block_params(10, {0.5, 0.2, 0.45}, {}, 1);
  params.inertia = {.xx = 2.425 / 3, .yy = 2.05 / 3, .zz = 0.425 / 3};
  params.angular_velocity = {0.1, 5, 0.1};
  const BodyId id = add_block(world, params, {0.5, 0.2, 0.45});
  const double energy = world.kinetic_energy();
  const Vec3 momentum = world.angular_momentum({});
  double worst_energy = 0, worst_momentum = 0;
  for (int i = 0; i < steps_in(10, dt); ++i) {
    world.step(dt);
    worst_energy = std::max(worst_energy, std::abs(world.kinetic_energy() / energy - 1));
    worst_momentum = std::max(worst_momentum, length(world.angular_momentum({}) - momentum));
  }
  const Vec3 now = into(axes_of(world.pose(id).rotation), world.angular_velocity(id));
  AccuracyRow row{.name = "box spinning freely, 10 s", .step = step_text(dt), .iterations = "20"};
  row.quantity = "largest ΔE/E", row.measured = worst_energy;
  print_accuracy_row(row);
  row.quantity = "largest ΔL/L", row.measured = worst_momentum / length(momentum);
  print_accuracy_row(row);
  row.quantity = "ω at the end off, rad/s";
  row.measured = length(now - Vec3{2.75584, -3.73597, -3.16181});
  row.source = "Runge–Kutta, own";
  print_accuracy_row(row);
}

void tower(double dt, int iterations) {
  RigidWorld world({.iterations = iterations, .sleep = false});
  std::vector<BodyId> ids;
  for (int i = 0; i < 10; ++i)
    ids.push_back(add_block(world, block_params(1000, {0.5, 0.5, 0.5}, {0, 0.5 + i, 0}, i + 1),
                            {0.5, 0.5, 0.5}));
  for (int i = 0; i < steps_in(10, dt); ++i) world.step(dt);
  double lean = 0, speed = 0;
  for (const BodyId id : ids) {
    const Vec3 at = world.centre(id);
    lean = std::max(lean, std::hypot(at.x, at.z));
    speed = std::max(speed, length(world.velocity(id)));
  }
  AccuracyRow row{.name = "tower of ten 1 t cubes, 10 s, no sleep",
                  .step = step_text(dt),
                  .iterations = std::to_string(iterations)};
  row.quantity = "lean, m", row.measured = lean;
  print_accuracy_row(row);
  row.quantity = "speed left, m/s", row.measured = speed;
  print_accuracy_row(row);
  row.quantity = "top, m", row.measured = world.centre(ids[9]).y, row.expected = 9.5;
  print_accuracy_row(row);
}

double first_apex(double dt, int iterations, double e) {
  RigidWorld world({.iterations = iterations, .ground = {0.6, e}});
  BodyParams params = ball_params(10, 0.1, {0, 1.1, 0}, 1);
  params.surface = {0.6, e};
  const BodyId ball = world.add_sphere(params, 0.1);
  double rising = 0;
  for (int i = 0; i < steps_in(2, dt); ++i) {
    world.step(dt);
    const double v = world.velocity(ball).y;
    if (rising > 0 && v <= 0) return world.centre(ball).y - 0.1 + v * v / (2 * kGravity);
    rising = v;
  }
  return 0;
}

double fall(double dt, int iterations) {
  RigidWorld world({.iterations = iterations, .has_ground = false});
  const BodyId id = add_block(world, block_params(3, {0.1, 0.2, 0.3}, {}, 1), {0.1, 0.2, 0.3});
  for (int i = 0; i < steps_in(2, dt); ++i) world.step(dt);
  return -world.centre(id).y;
}

void add_slope(RigidWorld& world, double angle, const Surface& surface) {
  const Prism slab{{{-50, -0.5}, {50, -0.5}, {50, 0.5}, {-50, 0.5}}, 5};
  const Pose pose{{0.5 * std::sin(angle), -0.5 * std::cos(angle), 0}, about_z(angle)};
  world.add_static(pose, {&slab, 1}, surface, 1);
}

/// Way down a slope of 30° in a second.
double slide(double dt, int iterations, double friction) {
  const double angle = std::numbers::pi / 6;
  RigidWorld world({.iterations = iterations, .has_ground = false, .sleep = false});
  add_slope(world, angle, {friction, 0});
  BodyParams params =
      block_params(10, {0.3, 0.1, 0.2}, {-0.1 * std::sin(angle), 0.1 * std::cos(angle), 0}, 2);
  params.pose.rotation = about_z(angle);
  params.surface = {friction, 0};
  const BodyId id = add_block(world, params, {0.3, 0.1, 0.2});
  const Vec3 start = world.centre(id);
  for (int i = 0; i < steps_in(1, dt); ++i) world.step(dt);
  return -dot(world.centre(id) - start, Vec3{std::cos(angle), std::sin(angle), 0});
}

/// Speed of a ball after a second on a slope of 20°.
double roll(double dt, int iterations) {
  const double angle = std::numbers::pi / 9;
  RigidWorld world({.iterations = iterations, .has_ground = false, .sleep = false});
  add_slope(world, angle, {0.5, 0});
  BodyParams params = ball_params(5, 0.2, {-0.2 * std::sin(angle), 0.2 * std::cos(angle), 0}, 2);
  params.surface = {0.5, 0};
  const BodyId id = world.add_sphere(params, 0.2);
  for (int i = 0; i < steps_in(1, dt); ++i) world.step(dt);
  return length(world.velocity(id));
}

/// The worst of 10, 20 and 50 iterations.
void over_iterations(AccuracyRow row, const std::function<double(double, int)>& measure) {
  for (const double dt : kSteps) {
    row.step = step_text(dt);
    row.iterations = "10, 20, 50: worst";
    row.measured = row.expected;
    for (const int iterations : {10, 20, 50}) {
      const double found = measure(dt, iterations);
      if (std::abs(found - row.expected) >= std::abs(row.measured - row.expected))
        row.measured = found;
    }
    print_accuracy_row(row);
  }
}

void plain_motion() {
  over_iterations({.name = "free fall, 2 s", .quantity = "way, m", .expected = kGravity * 2}, fall);
  for (const double e : {1.0, 0.7})
    over_iterations({.name = e == 1 ? "bounce from 1 m, e = 1" : "bounce from 1 m, e = 0.7",
                     .quantity = "first apex, m",
                     .expected = e * e},
                    [&](double dt, int n) { return first_apex(dt, n, e); });
  for (const double friction : {0.3, 0.6}) {
    const double pull = 0.5 - friction * std::sqrt(0.75);
    over_iterations(
        {.name = friction < 0.5 ? "block on a slope of 30°, µ = 0.3" : "the same, µ = 0.6: sticks",
         .quantity = "way in 1 s, m",
         .expected = std::max(0.0, kGravity * pull / 2)},
        [&](double dt, int n) { return slide(dt, n, friction); });
  }
  over_iterations({.name = "ball on a slope of 20°, µ = 0.5",
                   .quantity = "speed after 1 s, m/s",
                   .expected = 5.0 / 7 * kGravity * std::sin(std::numbers::pi / 9)},
                  roll);
}

/// A block of half sizes b, h that stands on its right lower edge at the origin, tilted by `tilt`
/// to the left of its upright place (negative: to the right).
BodyId add_tilted(RigidWorld& world, double b, double h, double tilt) {
  BodyParams params = block_params(500, {b, h, 0.2}, {}, 1);
  params.pose.rotation = about_z(-tilt);
  params.pose.position = -1.0 * (axes_of(params.pose.rotation) * Vec3{b, -h, 0});
  params.surface = {1, 0};
  return add_block(world, params, {b, h, 0.2});
}

double tilt_of(const RigidWorld& world, BodyId id) {
  return 2 * std::asin(world.pose(id).rotation.z);
}

// Housner 1963: a block that rocks on its edges.
void rock(double dt) {
  const double b = 0.2, h = 0.8, tilt = std::atan(b / h) / 2;
  RigidWorld world({.ground = {1, 0}, .sleep = false});
  const BodyId id = add_tilted(world, b, h, tilt);
  double before = -tilt, quarter = 0, other_side = 0;
  for (int i = 1; i <= steps_in(1.2, dt); ++i) {
    world.step(dt);
    const double angle = tilt_of(world, id), t = i * dt;
    if (quarter == 0 && angle >= -1e-4) quarter = t - dt * (angle / (angle - before));
    other_side = std::max(other_side, angle);
    before = angle;
  }
  AccuracyRow row{.name = "rocking block 0.4 × 1.6 m, half of its limit angle",
                  .step = step_text(dt),
                  .iterations = "20",
                  .source = "Housner 1963"};
  row.quantity = "quarter period, s", row.measured = quarter, row.expected = 0.44167;
  print_accuracy_row(row);
  row.quantity = "amplitude after / before", row.measured = other_side / tilt;
  row.expected = 0.7734;
  print_accuracy_row(row);
}

// A wall 3 m high and 0.2 m thick, 0.05 rad beyond its balance, about its lower edge. Friction
// holds that edge for any µ > 0.37 until the wall leans by 48°; so it is timed to 45°.
void topple(double dt) {
  const double b = 0.1, h = 1.5, limit = std::atan(b / h), start = 0.05;
  const double end = std::numbers::pi / 4, radius = std::hypot(b, h);
  const auto spin_at = [&](double angle) {
    return std::sqrt(1.5 * kGravity / radius * (std::cos(start) - std::cos(angle)));
  };
  double time = 0;  // angle = start + s² takes the singularity out of ∫ dθ/ω
  constexpr int kParts = 20000;
  const double root = std::sqrt(end - start);
  for (int i = 0; i < kParts; ++i) {
    const double s = root * (i + 0.5) / kParts;
    time += 2 * s / spin_at(start + s * s) * root / kParts;
  }
  RigidWorld world({.ground = {1, 0}, .sleep = false});
  const BodyId id = add_tilted(world, b, h, limit + start);
  double found = 0, spin = 0, before = start;
  for (int i = 1; i <= steps_in(3, dt) && found == 0; ++i) {
    const double spin_before = length(world.angular_velocity(id));
    world.step(dt);
    const double angle = -tilt_of(world, id) - limit, after = length(world.angular_velocity(id));
    if (angle >= end) {
      const double left = (angle - end) / (angle - before);
      found = i * dt - dt * left;
      spin = after - (after - spin_before) * left;
    }
    before = angle;
  }
  AccuracyRow row{.name = "toppling wall 3 × 0.2 m, from 0.05 rad to 45°",
                  .step = step_text(dt),
                  .iterations = "20",
                  .source = "energy, quadrature"};
  row.quantity = "time, s", row.measured = found, row.expected = time;
  print_accuracy_row(row);
  row.quantity = "angular speed, rad/s", row.measured = spin, row.expected = spin_at(end);
  print_accuracy_row(row);
}

}  // namespace

void measure_rigid_world() {
  std::printf("\n## Bodies alone\n");
  print_accuracy_header();
  for (const double speed : {2.0, 20.0})
    for (const double dt : {1.0 / 60, 1.0 / 240, 1.0 / 1000}) head_on(speed, dt);
  print_accuracy_header();
  for (const double dt : {1.0 / 60, 1.0 / 240, 1.0 / 1000, 1.0 / 4000}) spin(dt);
  print_accuracy_header();
  for (const double dt : kSteps)
    for (const int iterations : {10, 20, 50}) tower(dt, iterations);
  print_accuracy_header();
  plain_motion();
  print_accuracy_header();
  for (const double dt : kSteps) rock(dt);
  for (const double dt : kSteps) topple(dt);
}

}  // namespace sunder
