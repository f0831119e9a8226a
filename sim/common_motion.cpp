// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/common_motion.hpp"

#include <algorithm>
#include <cmath>

namespace sunder {
namespace {

struct RigidMotion {
  Vec3 centre, velocity, spin;
  Vec3 at(Vec3 point) const { return velocity + cross(spin, point - centre); }
};

SymMat3 sum(const SymMat3& a, const SymMat3& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}

SymMat3 of_point(double mass, Vec3 r) {
  return {mass * (r.y * r.y + r.z * r.z),
          mass * (r.z * r.z + r.x * r.x),
          mass * (r.x * r.x + r.y * r.y),
          -mass * r.x * r.y,
          -mass * r.x * r.z,
          -mass * r.y * r.z};
}

// Of all bodies as one.
RigidMotion common_motion(std::span<Body* const> bodies) {
  RigidMotion motion;
  double mass = 0;
  for (const Body* body : bodies) {
    mass += body->mass;
    motion.centre = motion.centre + body->mass * body->centre;
    motion.velocity = motion.velocity + body->mass * body->velocity;
  }
  motion.centre = (1 / mass) * motion.centre;
  motion.velocity = (1 / mass) * motion.velocity;
  SymMat3 inertia;
  Vec3 angular;
  for (const Body* body : bodies) {
    const Vec3 r = body->centre - motion.centre;
    inertia = sum(inertia, sum(rotated(body->axes, body->inertia), of_point(body->mass, r)));
    angular = angular + body->angular_momentum(body->axes, body->spin) +
              body->mass * cross(r, body->velocity - motion.velocity);
  }
  motion.spin = inverse(inertia) * angular;
  return motion;
}

}  // namespace

double approach_common_motion(std::span<Body* const> bodies, double energy) {
  if (bodies.size() < 2 || !(energy > 0)) return 0;
  const RigidMotion motion = common_motion(bodies);
  double relative = 0;
  for (const Body* body : bodies) {
    const Vec3 v = body->velocity - motion.at(body->centre), w = body->spin - motion.spin;
    relative += (body->mass * dot(v, v) + dot(w, body->angular_momentum(body->axes, w))) / 2;
  }
  if (!(relative > 0)) return 0;
  const double share = std::sqrt(std::max(0.0, 1 - energy / relative));
  for (Body* body : bodies) {
    const Vec3 own = motion.at(body->centre);
    body->velocity = own + share * (body->velocity - own);
    body->spin = motion.spin + share * (body->spin - motion.spin);
  }
  return std::min(energy, relative);
}

}  // namespace sunder
