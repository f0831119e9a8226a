// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "sim/projectile.hpp"
#include "sim/rigid_world.hpp"

namespace sunder {

/// Keys of the contact order: projectiles, then what stands, then bodies, oldest first.
constexpr std::uint64_t kShotOrder = std::uint64_t{1} << 60;
constexpr std::uint64_t kStandingOrder = std::uint64_t{2} << 60;
constexpr std::uint64_t kMovingOrder = std::uint64_t{3} << 60;

/// A projectile as it starts; `index` among the scene's.
inline BodyParams body_of(const Projectile& p, std::uint32_t index) {
  BodyParams body;
  body.mass = p.mass;
  const double inertia = 0.4 * p.mass * p.radius * p.radius;
  body.inertia = {inertia, inertia, inertia, 0, 0, 0};
  body.pose.position = p.position;
  body.velocity = p.velocity;
  body.surface = {p.friction, p.restitution};
  body.order = kShotOrder + index;
  return body;
}

}  // namespace sunder
