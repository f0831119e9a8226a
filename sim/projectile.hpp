// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "meshing/field.hpp"
#include "meshing/vec.hpp"

namespace sunder {

/// A solid sphere that flies from a given time on. SI units, world frame.
struct Projectile {
  std::string name = "projectile";
  double radius = 0.25;  ///< m
  double mass = 514;     ///< kg
  Vec3 position;         ///< centre at `time`
  Vec3 velocity;         ///< at `time`, m/s
  double time = 0;       ///< s; before, it is not there
  double youngs_modulus = 210e9;  ///< Pa
  double poisson_ratio = 0.3;
  double friction = 0.5;     ///< Coulomb's µ; a pair takes the geometric mean of both
  double restitution = 0.5;  ///< a pair takes the geometric mean of both
};
/// The plain keys; position and velocity are read beside them.
template <>
std::span<const Field<Projectile>> fields();

}  // namespace sunder
