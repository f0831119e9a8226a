// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/edge_blow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "meshing/elementary.hpp"

namespace sunder {
namespace {

constexpr double kPi = std::numbers::pi;

double contact_modulus(const Striker& striker, const Material& material) {
  const double a = (1 - striker.poisson_ratio * striker.poisson_ratio) / striker.youngs_modulus;
  const double b = (1 - material.poisson_ratio * material.poisson_ratio) / material.youngs_modulus;
  return 1 / (a + b);
}

double least_distance(const Striker& striker, double thickness) {
  return std::max(thickness / 2, striker.radius / 4);
}

}  // namespace

double edge_force_of(const Striker& striker, double speed, const Material& material) {
  if (!(material.youngs_modulus > 0)) return 0;
  const double stiffness = 4.0 / 3 * contact_modulus(striker, material) * std::sqrt(striker.radius);
  const double hertz =
      power_of(stiffness, 0.4) * power_of(1.25 * striker.mass * speed * speed, 0.6);
  const double crushing = 4 * material.compressive_strength * kPi * striker.radius * striker.radius;
  return material.compressive_strength > 0 ? std::min(hertz, crushing) : hertz;
}

double least_edge_force(const Striker& striker, double thickness, const Material& material) {
  if (!(material.tensile_strength > 0)) return std::numeric_limits<double>::infinity();
  return material.tensile_strength * kPi * least_distance(striker, thickness) * thickness;
}

Blow edge_blow_of(const Striker& striker, double speed, double thickness,
                  const Material& material) {
  Blow blow;
  blow.is_global = true;
  blow.ballistic_speed = std::numeric_limits<double>::infinity();
  if (!(material.youngs_modulus > 0) || !(speed > 0)) return blow;
  const double modulus = contact_modulus(striker, material);
  blow.force = edge_force_of(striker, speed, material);
  blow.duration =
      2.87 *
      power_of(striker.mass * striker.mass / (striker.radius * modulus * modulus * speed), 0.2);
  const double shear_speed =
      std::sqrt(material.youngs_modulus / (2 * (1 + material.poisson_ratio) * material.density));
  blow.engaged_radius = shear_speed * blow.duration;
  if (!(material.tensile_strength > 0)) return blow;
  const double needed = least_edge_force(striker, thickness, material);
  blow.utilisation = blow.force / needed;
  blow.crack_radius = blow.utilisation > 1
                          ? std::min(blow.force / (kPi * thickness * material.tensile_strength),
                                     blow.engaged_radius)
                          : 0;
  // The force grows with speed until crushing caps it: bisection on a bracket that holds it.
  double low = 0, high = 1e5;
  if (edge_force_of(striker, high, material) < needed) return blow;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (edge_force_of(striker, middle, material) < needed ? low : high) = middle;
  }
  blow.ballistic_speed = high;
  return blow;
}

double edge_utilisation_at(const Blow& blow, double distance, double thickness,
                           const Material& material) {
  if (!(material.tensile_strength > 0) || distance > blow.engaged_radius) return 0;
  const double r = std::max(distance, thickness / 2);
  return blow.force / (kPi * r * thickness * material.tensile_strength);
}

double splitting_force(double size, double thickness, const Material& material) {
  return kPi / 2 * material.tensile_strength * size * thickness;
}

}  // namespace sunder
