// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/closed_forms.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

namespace sunder {
namespace {

constexpr double kGravity = 9.81, kPi = std::numbers::pi;

int steps_in(double time, double dt) {
  return static_cast<int>(std::lround(time / dt));
}

std::unique_ptr<BodyWorld> world_of(const Engine& engine, const Fineness& fineness,
                                    BodyWorldParams params) {
  params.iterations = fineness.iterations;
  return engine.make(params);
}

AccuracyRow row_of(const char* name, const Fineness& fineness) {
  return {.name = name,
          .step = step_text(fineness.step),
          .iterations = std::to_string(fineness.iterations)};
}

/// Angular momentum in the world's axes.
Vec3 momentum_of(const BodyWorld& world, std::size_t body, Vec3 moments) {
  const Axes axes = axes_of(world.rotation(body));
  const Vec3 spin = into(axes, world.spin(body));
  return axes * Vec3{moments.x * spin.x, moments.y * spin.y, moments.z * spin.z};
}

double energy_of(const BodyWorld& world, std::size_t body, const LooseBody& as) {
  const Vec3 v = world.velocity(body);
  return (as.mass * dot(v, v) + dot(world.spin(body), momentum_of(world, body, moments_of(as)))) /
         2;
}

double first_apex(const Engine& engine, const Fineness& fineness, double e) {
  const auto world = world_of(engine, fineness, {.surface = {0.6, e}});
  world->add({.mass = 10, .radius = 0.1, .centre = {0, 1.1, 0}});
  double rising = 0;
  for (int i = 0; i < steps_in(2, fineness.step); ++i) {
    world->step(fineness.step);
    const double v = world->velocity(0).y;
    if (rising > 0 && v <= 0) return world->centre(0).y - 0.1 + v * v / (2 * kGravity);
    rising = v;
  }
  return 0;
}

double fall(const Engine& engine, const Fineness& fineness) {
  const auto world = world_of(engine, fineness, {.has_ground = false});
  world->add({.mass = 3, .half = {0.1, 0.2, 0.3}});
  for (int i = 0; i < steps_in(2, fineness.step); ++i) world->step(fineness.step);
  return -world->centre(0).y;
}

/// Way down a slope of 30° in a second.
double slide(const Engine& engine, const Fineness& fineness, double friction) {
  const double angle = kPi / 6;
  const auto world = world_of(engine, fineness, {.has_ground = false, .surface = {friction, 0}});
  world->add_slope(angle);
  world->add({.mass = 10,
              .half = {0.3, 0.1, 0.2},
              .centre = {-0.1 * std::sin(angle), 0.1 * std::cos(angle), 0},
              .turn = angle});
  const Vec3 start = world->centre(0);
  for (int i = 0; i < steps_in(1, fineness.step); ++i) world->step(fineness.step);
  return -dot(world->centre(0) - start, Vec3{std::cos(angle), std::sin(angle), 0});
}

/// Speed of a ball after a second on a slope of 20°.
double roll(const Engine& engine, const Fineness& fineness) {
  const double angle = kPi / 9;
  const auto world = world_of(engine, fineness, {.has_ground = false, .surface = {0.5, 0}});
  world->add_slope(angle);
  world->add(
      {.mass = 5, .radius = 0.2, .centre = {-0.2 * std::sin(angle), 0.2 * std::cos(angle), 0}});
  for (int i = 0; i < steps_in(1, fineness.step); ++i) world->step(fineness.step);
  return length(world->velocity(0));
}

/// A block of half sizes b, h that stands on its right lower edge at the origin, tilted by `tilt`
/// to the left of its upright place (negative: to the right).
LooseBody tilted(double b, double h, double tilt) {
  const double c = std::cos(tilt), s = std::sin(tilt);
  return {.mass = 500,
          .half = {b, h, 0.2},
          .centre = {-(c * b - s * h), s * b + c * h, 0},
          .turn = -tilt};
}

double tilt_of(const BodyWorld& world) {
  return 2 * std::asin(world.rotation(0).z);
}

}  // namespace

double AccuracyRow::error() const {
  return std::abs(measured - expected) / (expected != 0 ? std::abs(expected) : scale);
}

std::string step_text(double step) {
  return "1/" + std::to_string(std::lround(1 / step)) + " s";
}

AccuracyRows head_on(const Engine& engine, double speed, const Fineness& fineness) {
  const auto world =
      world_of(engine, fineness, {.gravity = 0, .has_ground = false, .surface = {0, 0.5}});
  const LooseBody ball{
      .mass = 260, .radius = 0.25, .centre = {0.01, 0.003, -1}, .velocity = {0, 0, speed}};
  const LooseBody chunk{.mass = 40, .half = {0.2, 0.2, 0.1}, .centre = {0.01, 0.003, 0}};
  world->add(ball);
  world->add(chunk);
  for (int i = 0; i < steps_in(2 / speed, fineness.step); ++i) world->step(fineness.step);
  char name[80];
  std::snprintf(name, sizeof name, "260 kg ball on a 40 kg chunk, e = 0.5, %g m/s", speed);
  AccuracyRow first = row_of(name, fineness), second = first, energy = first;
  first.quantity = "v1', m/s";
  first.measured = world->velocity(0).z, first.expected = (260 - 0.5 * 40) / 300 * speed;
  second.quantity = "v2', m/s";
  second.measured = world->velocity(1).z, second.expected = 1.5 * 260 / 300 * speed;
  energy.quantity = "KE'/KE";
  energy.measured = (energy_of(*world, 0, ball) + energy_of(*world, 1, chunk)) /
                    (0.5 * ball.mass * speed * speed);
  energy.expected = 1 - 0.75 * 40 / 300;
  return {first, second, energy};
}

// scpeters/benchmark's box; the spin after 10 s is that of a Runge–Kutta run with tiny steps, to
// six digits. (With moments rounded to five digits it would be 0.003 rad/s away.)
AccuracyRows free_spin(const Engine& engine, const Fineness& fineness) {
  const auto world = world_of(engine, fineness, {.gravity = 0, .has_ground = false});
  const LooseBody box{.mass = 10, .half = {0.05, 0.2, 0.45}, .spin = {0.1, 5, 0.1}};
  world->add(box);
  const double energy = energy_of(*world, 0, box);
  const Vec3 moments = moments_of(box), momentum = momentum_of(*world, 0, moments);
  double worst_energy = 0, worst_momentum = 0;
  for (int i = 0; i < steps_in(10, fineness.step); ++i) {
    world->step(fineness.step);
    worst_energy = std::max(worst_energy, std::abs(energy_of(*world, 0, box) / energy - 1));
    worst_momentum = std::max(worst_momentum, length(momentum_of(*world, 0, moments) - momentum));
  }
  const Vec3 known{2.75584, -3.73597, -3.16181};
  const Vec3 now = into(axes_of(world->rotation(0)), world->spin(0));
  AccuracyRow lost = row_of("box spinning freely, 10 s", fineness), turned = lost, off = lost;
  lost.quantity = "largest ΔE/E", lost.measured = worst_energy;
  turned.quantity = "largest ΔL/L", turned.measured = worst_momentum / length(momentum);
  off.quantity = "ω at the end off, rad/s", off.measured = length(now - known);
  off.source = "Runge–Kutta, own", off.scale = length(known);
  return {lost, turned, off};
}

AccuracyRows tower(const Engine& engine, const Fineness& fineness) {
  const auto world = world_of(engine, fineness, {});
  for (int i = 0; i < 10; ++i)
    world->add({.mass = 1000, .half = {0.5, 0.5, 0.5}, .centre = {0, 0.5 + i, 0}});
  for (int i = 0; i < steps_in(10, fineness.step); ++i) world->step(fineness.step);
  AccuracyRow lean = row_of("tower of ten 1 t cubes, 10 s, no sleep", fineness), speed = lean,
              top = lean;
  for (std::size_t i = 0; i < 10; ++i) {
    const Vec3 at = world->centre(i);
    lean.measured = std::max(lean.measured, std::hypot(at.x, at.z));
    speed.measured = std::max(speed.measured, length(world->velocity(i)));
  }
  lean.quantity = "lean, m";
  speed.quantity = "speed left, m/s", speed.scale = std::sqrt(kGravity);
  top.quantity = "top, m", top.measured = world->centre(9).y, top.expected = 9.5;
  return {lean, speed, top};
}

AccuracyRows heavy_on_light(const Engine& engine, double ratio, const Fineness& fineness) {
  const auto world = world_of(engine, fineness, {});
  for (const int i : {0, 1})
    world->add({.mass = i == 0 ? 1.0 : ratio, .half = {0.5, 0.5, 0.5}, .centre = {0, 0.5 + i, 0}});
  for (int i = 0; i < steps_in(5, fineness.step); ++i) world->step(fineness.step);
  char name[80];
  std::snprintf(name, sizeof name, "cube of %g kg on a cube of 1 kg, 5 s", ratio);
  AccuracyRow top = row_of(name, fineness), aside = top;
  top.quantity = "top, m", top.measured = world->centre(1).y, top.expected = 1.5;
  const Vec3 below = world->centre(0);
  aside.quantity = "lower cube aside, m", aside.measured = std::hypot(below.x, below.z);
  return {top, aside};
}

AccuracyRows plain_motion(const Engine& engine, const Fineness& fineness) {
  AccuracyRows rows;
  const auto add = [&](const char* name, const char* quantity, double measured, double expected) {
    AccuracyRow row = row_of(name, fineness);
    row.quantity = quantity, row.measured = measured, row.expected = expected;
    rows.push_back(row);
  };
  add("free fall, 2 s", "way, m", fall(engine, fineness), kGravity * 2);
  add("bounce from 1 m, e = 1", "first apex, m", first_apex(engine, fineness, 1), 1);
  add("bounce from 1 m, e = 0.7", "first apex, m", first_apex(engine, fineness, 0.7), 0.49);
  add("block on a slope of 30°, µ = 0.3", "way in 1 s, m", slide(engine, fineness, 0.3),
      kGravity * (0.5 - 0.3 * std::sqrt(0.75)) / 2);
  add("the same, µ = 0.6: sticks", "way in 1 s, m", slide(engine, fineness, 0.6), 0);
  rows.back().scale = kGravity / 4;  // without friction
  add("ball on a slope of 20°, µ = 0.5", "speed after 1 s, m/s", roll(engine, fineness),
      5.0 / 7 * kGravity * std::sin(kPi / 9));
  return rows;
}

AccuracyRows rocking(const Engine& engine, const Fineness& fineness) {
  const double b = 0.2, h = 0.8, tilt = std::atan(b / h) / 2, dt = fineness.step;
  const auto world = world_of(engine, fineness, {.surface = {1, 0}});
  world->add(tilted(b, h, tilt));
  double before = -tilt, quarter = 0, other_side = 0;
  for (int i = 1; i <= steps_in(1.2, dt); ++i) {
    world->step(dt);
    const double angle = tilt_of(*world), t = i * dt;
    if (quarter == 0 && angle >= -1e-4) quarter = t - dt * (angle / (angle - before));
    other_side = std::max(other_side, angle);
    before = angle;
  }
  AccuracyRow time = row_of("rocking block 0.4 × 1.6 m, half of its limit angle", fineness);
  time.source = "Housner 1963";
  AccuracyRow left = time;
  time.quantity = "quarter period, s", time.measured = quarter, time.expected = 0.44167;
  left.quantity = "amplitude after / before", left.measured = other_side / tilt;
  left.expected = 0.7734;
  return {time, left};
}

// A wall 3 m high and 0.2 m thick, 0.05 rad beyond its balance, about its lower edge. Friction
// holds that edge for any µ > 0.37 until the wall leans by 48°; so it is timed to 45°.
AccuracyRows toppling(const Engine& engine, const Fineness& fineness) {
  const double b = 0.1, h = 1.5, limit = std::atan(b / h), start = 0.05, dt = fineness.step;
  const double end = kPi / 4, radius = std::hypot(b, h);
  const auto spin_at = [&](double angle) {
    return std::sqrt(1.5 * kGravity / radius * (std::cos(start) - std::cos(angle)));
  };
  AccuracyRow time = row_of("toppling wall 3 × 0.2 m, from 0.05 rad to 45°", fineness);
  time.source = "energy, quadrature";
  AccuracyRow spin = time;
  time.quantity = "time, s";
  spin.quantity = "angular speed, rad/s", spin.expected = spin_at(end);
  constexpr int kParts = 20000;  // angle = start + s² takes the singularity out of ∫ dθ/ω
  const double root = std::sqrt(end - start);
  for (int i = 0; i < kParts; ++i) {
    const double s = root * (i + 0.5) / kParts;
    time.expected += 2 * s / spin_at(start + s * s) * root / kParts;
  }
  const auto world = world_of(engine, fineness, {.surface = {1, 0}});
  world->add(tilted(b, h, limit + start));
  double before = start;
  for (int i = 1; i <= steps_in(3, dt) && time.measured == 0; ++i) {
    const double spin_before = length(world->spin(0));
    world->step(dt);
    const double angle = -tilt_of(*world) - limit, after = length(world->spin(0));
    if (angle >= end) {
      const double left = (angle - end) / (angle - before);
      time.measured = i * dt - dt * left;
      spin.measured = after - (after - spin_before) * left;
    }
    before = angle;
  }
  return {time, spin};
}

AccuracyRows closed_forms(const Engine& engine, const Fineness& fineness) {
  AccuracyRows rows;
  for (const AccuracyRows& more :
       {head_on(engine, 2, fineness), head_on(engine, 20, fineness), plain_motion(engine, fineness),
        tower(engine, fineness), rocking(engine, fineness), toppling(engine, fineness)})
    rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

const AccuracyRow& worst(const AccuracyRows& rows) {
  return *std::ranges::max_element(rows, {}, [](const AccuracyRow& row) {
    return std::isfinite(row.error()) ? row.error() : std::numeric_limits<double>::infinity();
  });
}

}  // namespace sunder
