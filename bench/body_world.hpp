// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "sim/rigid_world.hpp"

namespace sunder {

/// A box, or a ball if it has a radius. Inertia of a solid of even density.
struct LooseBody {
  double mass = 1;     ///< kg
  Vec3 half = {};      ///< of the box, m
  double radius = 0;   ///< of the ball, m
  Vec3 centre = {};    ///< world, m
  double turn = 0;     ///< of the body about world z, rad
  Vec3 velocity = {};  ///< m/s
  Vec3 spin = {};      ///< world, rad/s
};

struct BodyWorldParams {
  int iterations = 20;
  double gravity = 9.81;         ///< along -y, m/s²
  bool has_ground = true;        ///< the half-space y <= 0
  Surface surface = {0.6, 0.1};  ///< of every pair: coefficients, not those of a side
};

/// Boxes and balls that move, for whatever engine carries them. Bodies count from 0; none sleeps.
class BodyWorld {
 public:
  virtual ~BodyWorld() = default;
  virtual void add(const LooseBody& body) = 0;
  /// A plane through the origin that falls towards -x by `angle`, rad.
  virtual void add_slope(double angle) = 0;
  virtual void step(double dt) = 0;
  virtual Vec3 centre(std::size_t body) const = 0;
  virtual Vec3 velocity(std::size_t body) const = 0;
  virtual Vec3 spin(std::size_t body) const = 0;  ///< world, rad/s
  virtual Quaternion rotation(std::size_t body) const = 0;
};

/// An engine and its name in tables.
struct Engine {
  std::string name;
  std::function<std::unique_ptr<BodyWorld>(const BodyWorldParams&)> make;
};
Engine our_engine();
Engine bullet_engine();  ///< Bullet 3 itself, default world, boxes and spheres as its own shapes
Engine ode_engine();     ///< Open Dynamics Engine, quick step, its own boxes and spheres

/// Principal moments about the centre, kg m².
Vec3 moments_of(const LooseBody& body);

}  // namespace sunder
