// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/contact_solver.hpp"

#include <algorithm>
#include <cmath>

namespace sunder {
namespace {

ContactRow row(Vec3 direction, Vec3 arm_a, Vec3 arm_b, const SolverBody& a, const SolverBody& b) {
  const Vec3 turn_a = cross(arm_a, direction), turn_b = cross(arm_b, direction);
  return {direction, turn_a, turn_b, a.inverse_inertia * turn_a, b.inverse_inertia * turn_b};
}

double coupling(const ContactRow& r, const ContactRow& s, double inverse_masses) {
  return inverse_masses * dot(r.direction, s.direction) + dot(r.arm_a, s.spin_a) +
         dot(r.arm_b, s.spin_b);
}

double speed(const ContactRow& r, const SolverBody& a, const SolverBody& b) {
  return dot(r.direction, a.velocity - b.velocity) + dot(r.arm_a, a.spin) - dot(r.arm_b, b.spin);
}

void add(Vec3& sum, double s, const Vec3& v) {
  sum.x += s * v.x;
  sum.y += s * v.y;
  sum.z += s * v.z;
}

void apply(const ContactRow& r, double impulse, SolverBody& a, SolverBody& b) {
  add(a.velocity, impulse * a.inverse_mass, r.direction);
  add(a.spin, impulse, r.spin_a);
  add(b.velocity, -impulse * b.inverse_mass, r.direction);
  add(b.spin, -impulse, r.spin_b);
}

void solve_friction(ContactPoint& p, SolverBody& a, SolverBody& b) {
  const double limit = p.friction * p.impulse;
  const double u = speed(p.along, a, b), v = speed(p.across, a, b);
  double along = p.impulse_along - (p.k_aa * u + p.k_ac * v);
  double across = p.impulse_across - (p.k_ac * u + p.k_cc * v);
  if (along * along + across * across > limit * limit) {
    // It slides. An isotropic step, so that the fixed point is friction against the velocity.
    along = p.impulse_along - p.slide_mass * u;
    across = p.impulse_across - p.slide_mass * v;
    const double size = std::sqrt(along * along + across * across);
    const double s = size > limit ? limit / size : 1;
    along *= s;
    across *= s;
  }
  apply(p.along, along - p.impulse_along, a, b);
  apply(p.across, across - p.impulse_across, a, b);
  p.impulse_along = along;
  p.impulse_across = across;
}

void solve_normal(ContactPoint& p, SolverBody& a, SolverBody& b) {
  const double wanted = p.impulse - p.normal_mass * (speed(p.normal, a, b) - p.bound);
  const double impulse = std::max(0.0, wanted);
  apply(p.normal, impulse - p.impulse, a, b);
  p.impulse = impulse;
}

void solve_point(ContactPoint& p, std::span<SolverBody> bodies) {
  SolverBody& a = bodies[p.a];
  SolverBody& b = bodies[p.b];
  if (p.impulse > 0 || p.impulse_along != 0 || p.impulse_across != 0) solve_friction(p, a, b);
  solve_normal(p, a, b);
}

void solve_overlap(ContactPoint& p, std::span<SolverBody> bodies) {
  SolverBody& a = bodies[p.a];
  SolverBody& b = bodies[p.b];
  const ContactRow& r = p.normal;
  const double moved =
      dot(r.direction, a.push - b.push) + dot(r.arm_a, a.turn) - dot(r.arm_b, b.turn);
  const double total = std::max(0.0, p.push_impulse + p.normal_mass * (p.push_out - moved));
  const double change = total - p.push_impulse;
  p.push_impulse = total;
  add(a.push, change * a.inverse_mass, r.direction);
  add(a.turn, change, r.spin_a);
  add(b.push, -change * b.inverse_mass, r.direction);
  add(b.turn, -change, r.spin_b);
}

template <typename Solve>
void sweep(std::span<ContactPoint> points, int sweeps, Solve&& solve) {
  for (int i = 0; i < sweeps; ++i) {
    if (i % 2 == 0) {
      for (ContactPoint& p : points) solve(p);
    } else {
      for (std::size_t k = points.size(); k-- > 0;) solve(points[k]);
    }
  }
}

}  // namespace

void prepare(ContactPoint& p, std::span<const SolverBody> bodies, Vec3 normal, Vec3 arm_a,
             Vec3 arm_b) {
  const SolverBody& a = bodies[p.a];
  const SolverBody& b = bodies[p.b];
  const Vec3 other = std::fabs(normal.y) < 0.7 ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
  Vec3 along = cross(other, normal);
  along = (1 / length(along)) * along;
  p.normal = row(normal, arm_a, arm_b, a, b);
  p.along = row(along, arm_a, arm_b, a, b);
  p.across = row(cross(normal, along), arm_a, arm_b, a, b);
  const double inverse_masses = a.inverse_mass + b.inverse_mass;
  p.normal_mass = 1 / coupling(p.normal, p.normal, inverse_masses);
  const double aa = coupling(p.along, p.along, inverse_masses);
  const double ac = coupling(p.along, p.across, inverse_masses);
  const double cc = coupling(p.across, p.across, inverse_masses);
  const double s = 1 / (aa * cc - ac * ac);
  p.k_aa = s * cc;
  p.k_ac = -s * ac;
  p.k_cc = s * aa;
  p.slide_mass = 2 / (aa + cc + std::sqrt((aa - cc) * (aa - cc) + 4 * ac * ac));
}

void warm_start(std::span<const ContactPoint> points, std::span<SolverBody> bodies) {
  for (const ContactPoint& p : points) {
    SolverBody& a = bodies[p.a];
    SolverBody& b = bodies[p.b];
    apply(p.normal, p.given + p.impulse, a, b);
    apply(p.along, p.given_along + p.impulse_along, a, b);
    apply(p.across, p.given_across + p.impulse_across, a, b);
  }
}

void solve_velocities(std::span<ContactPoint> points, std::span<SolverBody> bodies, int sweeps) {
  sweep(points, sweeps, [&](ContactPoint& p) { solve_point(p, bodies); });
}

void solve_overlaps(std::span<ContactPoint> points, std::span<SolverBody> bodies, int sweeps) {
  sweep(points, sweeps, [&](ContactPoint& p) { solve_overlap(p, bodies); });
}

}  // namespace sunder
