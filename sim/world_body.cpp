// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/world_body.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sunder {
namespace {

constexpr double kSleepSpeed = 0.05;  // m/s
constexpr double kSleepSpin = 0.1;    // rad/s
constexpr double kMinRest = 0.05;     // of a step, at least, left after an impact for bounds

Vec3 velocity_at_arm(const Body& body, Vec3 arm) {
  return body.awake ? body.velocity_before + cross(body.spin_before, arm) : Vec3{};
}

}  // namespace

std::unique_ptr<Body> moving_body(const BodyParams& params, const PrincipalAxes& principal,
                                  Solid solid) {
  auto body = std::make_unique<Body>(std::move(solid));
  body->moves = true;
  body->order = params.order;
  body->mass = params.mass;
  body->inertia = params.inertia;
  body->inverse_inertia = inverse(params.inertia);
  body->principal = principal;
  body->centroid = params.centroid;
  body->surface = params.surface;
  body->rotation = normalised(params.pose.rotation);
  body->axes = axes_of(body->rotation);
  body->centre = body->axes * params.centroid + params.pose.position;
  body->velocity = params.velocity;
  body->spin = params.angular_velocity;
  return body;
}

bool is_slow(const Body& body, double share) {
  const double v = share * kSleepSpeed, w = share * kSleepSpin;
  return dot(body.velocity, body.velocity) < v * v && dot(body.spin, body.spin) < w * w;
}
double sweep(const Body& body, double dt) {
  return body.awake ? std::min(length(body.spin) * dt, 2.0) * body.solid.reach() : 0;
}

void set_approach(Meeting& m, Vec3 gravity, double dt) {
  const Vec3 arm_a = m.point + (m.origin - m.a->centre);
  const Vec3 arm_b = m.point + (m.origin - m.b->centre);
  m.closing = -dot(m.normal, velocity_at_arm(*m.a, arm_a) - velocity_at_arm(*m.b, arm_b));
  const double share = (m.a->awake ? 1.0 : 0.0) - (m.b->awake ? 1.0 : 0.0);
  m.pull = -share * dot(m.normal, gravity);
  m.arrives = false;
  double time = 0;
  if (m.gap > 0) {
    const double squared = m.closing * m.closing + 2 * m.pull * m.gap;
    const double sum = squared < 0 ? 0 : m.closing + std::sqrt(squared);
    if (!(sum > 0)) return;
    time = 2 * m.gap / sum;
  }
  const double speed = m.closing + m.pull * time;
  if (!(time < dt) || speed < kCreep + dt * length(gravity)) return;
  m.arrives = true;
  m.arrival_time = time;
  m.arrival_speed = speed;
}

void drift_to_impulses(Body& body, Vec3 gravity) {
  const double t = body.contact_time;
  body.shift = t * body.velocity_before + (t * t / 2) * gravity;
  const Vec3 l = body.angular_momentum(body.axes, body.spin_before);
  body.rotation_then = spun(body.rotation, body.inverse_inertia, l, t);
  body.axes_then = axes_of(body.rotation_then);
  body.spin_then = body.spin_at(body.axes_then, l);
}

void place_point(Meeting& m, double dt) {
  // Both bodies' copies of the point, carried to where the impulses act, relative to m.origin.
  const auto carried = [&](const Body& body) {
    if (!body.awake) return m.point;
    if (body.solid.radius() > 0)
      return m.point + body.shift;  // wherever it rolls, below its centre
    const Vec3 from = body.centre - m.origin;
    return from + body.shift + body.axes_then * into(body.axes, m.point - from);
  };
  const auto centre_then = [&](const Body& body) {
    return body.centre - m.origin + (body.awake ? body.shift : Vec3{});
  };
  const Vec3 on_a = carried(*m.a), on_b = carried(*m.b);
  m.gap_then = m.gap + dot(m.normal, on_a - on_b);
  // A ball's lowest point and a corner on the ground go where their body goes.
  const bool a_leads = m.a->solid.radius() > 0,
             b_leads = m.b->solid.radius() > 0 || m.a->is_ground();
  const Vec3 middle = a_leads == b_leads ? 0.5 * (on_a + on_b) : (a_leads ? on_a : on_b);
  m.arm_a = middle - centre_then(*m.a);
  m.arm_b = middle - centre_then(*m.b);
  if (m.gap > 0) {
    double rest = kMinRest * dt;
    if (m.a->awake) rest = std::max(rest, dt - m.a->contact_time);
    if (m.b->awake) rest = std::max(rest, dt - m.b->contact_time);
    m.bound = std::min(0.0, std::max(-m.gap_then / rest, -m.gap / dt));
  }
}

void grant_overlap(const Meeting& m, Vec3 gravity) {
  const auto is_new = [](const Body& body) { return body.awake && body.is_new; };
  if (!(m.gap < 0) || !(is_new(*m.a) || is_new(*m.b))) return;
  for (Body* body : {m.a, m.b})
    if (body->awake) body->granted = std::max(body->granted, -m.gap * length(gravity) * body->mass);
}

void bound_pushes(std::span<Body* const> bodies, double taken, Vec3 gravity) {
  double mass = 0, lift = 0;
  for (Body* body : bodies) {
    mass += body->mass;
    lift -= body->mass * dot(gravity, body->push);
    taken += std::exchange(body->taken, 0) + std::exchange(body->granted, 0);
  }
  if (lift > 0 && lift > taken) {
    const double share = std::max(taken, 0.0) / lift;
    for (Body* body : bodies) {
      body->push = share * body->push;
      body->turn = share * body->turn;
    }
    lift *= share;
  }
  for (Body* body : bodies) body->taken = (taken - lift) * (body->mass / mass);
}

double advance(Body& body, Vec3 gravity, double dt) {
  const bool met = body.slot != 0;
  const double rest = met ? dt - body.contact_time : dt;
  const Axes axes = met ? body.axes_then : body.axes;
  const Quaternion rotation = met ? body.rotation_then : body.rotation;
  body.velocity = met ? body.velocity_after : body.velocity_before + dt * gravity;
  const Vec3 l = body.angular_momentum(axes, met ? body.spin_after : body.spin_before);
  const Vec3 before = met ? body.shift : Vec3{};
  body.centre = body.centre + before + rest * body.velocity - (rest * rest / 2) * gravity;
  body.rotation = spun(rotation, body.inverse_inertia, l, rest);
  body.axes = axes_of(body.rotation);
  body.spin = body.spin_at(body.axes, l);
  if (!met || (body.push == Vec3{} && body.turn == Vec3{})) return 0;
  body.centre = body.centre + body.push;
  const Vec3 spin = into(body.axes, body.spin);
  body.rotation = turned(body.rotation, body.turn);
  body.axes = axes_of(body.rotation);
  body.spin = body.axes * spin;  // turned along: pushing out adds no energy
  return -body.mass * dot(gravity, body.push);
}

}  // namespace sunder
