// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "sim/world_body.hpp"

class btTypedConstraint;

// Internal to the rigid world.
namespace sunder {

/// Keeps the relative pose of two bodies: three rows for the joint's point, three for its axes.
/// Bullet's own fixed constraint has the same six equations, but along the axes of the world and,
/// through Euler angles, of neither body; here each row is a component of the load.
struct RigidJoint {
  RigidJoint(Body& first, Body& second, const JointParams& params);
  ~RigidJoint();

  JointId id = 0;
  Body* a;
  Body* b;
  Vec3 point_a, point_b;  ///< from the centres of mass, design frames
  Axes axes_a, axes_b;    ///< design frames
  int rows;               ///< 6, or 3: its point only
  std::unique_ptr<btTypedConstraint> in_bullet;
  /// Drift is corrected by displacements that leave velocities alone, not by velocities (as Bullet
  /// does): only so do impulses that start from the last ones stay stable.
  bool corrects_apart = false;

  // Of the last step.
  Vec3 force, torque;  ///< impulses on a, joint's axes, N s and N m s; a warm start's guess
  double dt = 0;       ///< its length, s; 0: none yet
  Axes axes;           ///< world, when the impulses acted
  std::array<double, 6> drift{};  ///< of b against a along the rows then, m and rad
  Vec3 arm_a, arm_b;              ///< from the centres of mass to the middle between the two points
  std::uint32_t island = 0;       ///< slot of the island's first body

  /// Distance of the two bodies' ideas of the point now, m.
  double gap() const;
};

RigidJoint& joint_of(btTypedConstraint& constraint);

}  // namespace sunder
