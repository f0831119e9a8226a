// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies for tests and benchmarks of the rigid world.
#pragma once

#include <cmath>
#include <numbers>

#include "meshing/random.hpp"
#include "sim/rigid_world.hpp"

namespace sunder {

inline Prism block(double hx, double hy, double hz) {
  return {{{-hx, -hy}, {hx, -hy}, {hx, hy}, {-hx, hy}}, hz};
}

inline BodyParams block_params(double mass, Vec3 half, Vec3 at, std::uint64_t order) {
  BodyParams params;
  params.mass = mass;
  params.inertia = {.xx = mass / 3 * (half.y * half.y + half.z * half.z),
                    .yy = mass / 3 * (half.x * half.x + half.z * half.z),
                    .zz = mass / 3 * (half.x * half.x + half.y * half.y)};
  params.pose.position = at;
  params.order = order;
  return params;
}

inline BodyId add_block(RigidWorld& world, const BodyParams& params, Vec3 half) {
  const Prism prism = block(half.x, half.y, half.z);
  return world.add_body(params, {&prism, 1});
}

inline BodyParams ball_params(double mass, double radius, Vec3 at, std::uint64_t order) {
  BodyParams params;
  params.mass = mass;
  const double inertia = 0.4 * mass * radius * radius;
  params.inertia = {.xx = inertia, .yy = inertia, .zz = inertia};
  params.pose.position = at;
  params.order = order;
  return params;
}

/// A convex chunk of six corners, somewhat irregular.
inline Prism chunk(double radius, double half, std::uint64_t seed) {
  Prism prism{{}, half};
  for (int i = 0; i < 6; ++i) {
    const double turn = (i + 0.5 * random_unit(seed, i)) * std::numbers::pi / 3;
    prism.outline.push_back({radius * std::cos(turn), radius * std::sin(turn)});
  }
  return prism;
}

}  // namespace sunder
