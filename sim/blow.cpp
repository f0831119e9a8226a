// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/blow.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "meshing/elementary.hpp"
#include "sim/penetration.hpp"

// Plate: L. Cremer, M. Heckl, "Structure-Borne Sound" (point impedance); the moment under a step
// force is derived in docs/impact.md. Sphere: H. Hertz, "Über die Berührung fester elastischer
// Körper", 1882.
namespace sunder {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFastest = 1e5;                  // m/s; what needs more never breaks
constexpr double kStrengthRatio = 10;             // f_c / f_t where only one is known
constexpr double kReach = 2.2458379342675405;     // 4 e^-γ
constexpr double kHertzTime = 2.868265699195333;  // (15/16)^0.4 2√π Γ(1.4)/Γ(0.9)

struct Strengths {
  double tensile = 0, compressive = 0;
};

Strengths strengths_of(const Material& material) {
  const double tensile = material.tensile_strength, compressive = material.compressive_strength;
  return {tensile > 0 ? tensile : compressive / kStrengthRatio,
          compressive > 0 ? compressive : tensile * kStrengthRatio};
}

/// σ(r) / ln(R_e/r).
double stress_factor(double force, double thickness, const Material& material) {
  return 6 / (thickness * thickness) * force * (1 + material.poisson_ratio) /
         (4 * std::numbers::pi);
}

/// A striker and a plate that touch, as functions of the speed.
class Contact {
 public:
  Contact(const Striker& striker, double thickness, const Material& material)
      : striker_(striker), thickness_(thickness), material_(material) {
    const auto compliance = [](double modulus, double ratio) {
      return (1 - ratio * ratio) / modulus;
    };
    const double plate = compliance(material.youngs_modulus, material.poisson_ratio);
    const double modulus = 1 / (plate + compliance(striker.youngs_modulus, striker.poisson_ratio));
    const double stiffness = thickness * thickness * thickness / (12 * plate);
    const double surface_mass = material.density * thickness;
    impedance_ = 8 * std::sqrt(stiffness * surface_mass);
    wave_ = kReach * std::sqrt(stiffness / surface_mass);
    hertz_ = power_of(4.0 / 3 * modulus * std::sqrt(striker.radius), 0.4);
    hertz_time_ = kHertzTime *
                  power_of(striker.mass * striker.mass / (striker.radius * modulus * modulus), 0.2);
    if (material.compressive_strength > 0) {
      crushing_force_ =
          4 * material.compressive_strength * std::numbers::pi * striker.radius * striker.radius;
      const double energy = power_of(crushing_force_ / hertz_, 5.0 / 3);
      crushing_speed_ =
          std::max(crushing_force_ / impedance_, std::sqrt(energy / (1.25 * striker.mass)));
    }
  }

  double force(double speed) const {
    const double hertz = hertz_ * power_of(1.25 * striker_.mass * speed * speed, 0.6);
    return std::min({impedance_ * speed, hertz, crushing_force_});
  }

  double duration(double speed) const {
    const double elastic = std::min(speed, crushing_speed_);
    const double time = striker_.mass / impedance_ + hertz_time_ / power_of(elastic, 0.2);
    return speed > crushing_speed_ ? time + striker_.mass * (speed - elastic) / crushing_force_
                                   : time;
  }

  double engaged_radius(double speed) const { return std::sqrt(wave_ * duration(speed)); }

  /// Stress at the contact.
  double stress(double speed) const {
    const double reach = engaged_radius(speed);
    const double inner = std::min(std::max(thickness_ / 2, striker_.radius / 4), reach / 4);
    return stress_factor(force(speed), thickness_, material_) * log_of(reach / inner);
  }

  /// Least speed with that stress at the contact; infinity: none below kFastest.
  double speed_of(double stress_wanted) const {
    double low = 0, high = kFastest;
    if (!(stress(high) >= stress_wanted)) return kInfinity;
    for (double middle = high / 2; low < middle && middle < high; middle = low + (high - low) / 2) {
      (stress(middle) < stress_wanted ? low : high) = middle;
    }
    return high;
  }

 private:
  Striker striker_;
  double thickness_ = 0;
  const Material& material_;
  double impedance_ = 0, wave_ = 0, hertz_ = 0, hertz_time_ = 0;
  double crushing_force_ = kInfinity, crushing_speed_ = kInfinity;
};

bool is_heavy(const Striker& striker, double thickness, const Material& material) {
  return striker.mass > std::numbers::pi * material.density * thickness * thickness * thickness;
}

void set_local(Blow& blow, const Striker& striker, double speed, double thickness,
               const Material& material) {
  const double compressive = strengths_of(material).compressive;
  ConcreteShot shot;
  shot.mass = striker.mass;
  shot.diameter = 2 * striker.radius;
  shot.compressive_strength = compressive;
  blow.ballistic_speed = compressive > 0 ? ndrc_ballistic_speed(shot, thickness) : kInfinity;
  const double ratio = speed / blow.ballistic_speed;
  blow.utilisation = ratio * ratio;
  if (speed > blow.ballistic_speed) blow.crack_radius = striker.radius + thickness / 2;
}

void set_global(Blow& blow, const Contact& contact, double speed, double thickness,
                const Material& material) {
  const double strength = strengths_of(material).tensile;
  blow.ballistic_speed = strength > 0 ? contact.speed_of(strength) : kInfinity;
  if (!(strength > 0) || !(speed > 0)) return;
  blow.utilisation = contact.stress(speed) / strength;
  if (blow.utilisation <= 1) return;
  blow.crack_radius =
      blow.engaged_radius * exp_of(-strength / stress_factor(blow.force, thickness, material));
}

}  // namespace

Blow blow_of(const Striker& striker, double speed, double thickness, const Material& material) {
  assert(striker.mass > 0 && striker.radius > 0 && striker.youngs_modulus > 0);
  assert(thickness > 0 && material.density > 0 && speed == speed);
  Blow blow;
  speed = std::max(speed, 0.0);
  if (!(material.youngs_modulus > 0) || !(material.poisson_ratio > -1)) {
    set_local(blow, striker, speed, thickness, material);
    return blow;
  }
  const Contact contact(striker, thickness, material);
  if (speed > 0) {
    blow.force = contact.force(speed);
    blow.duration = contact.duration(speed);
    blow.engaged_radius = contact.engaged_radius(speed);
  }
  blow.is_global = is_heavy(striker, thickness, material);
  if (blow.is_global) {
    set_global(blow, contact, speed, thickness, material);
  } else {
    set_local(blow, striker, speed, thickness, material);
  }
  return blow;
}

double utilisation_of(const Striker& striker, double speed, double thickness,
                      const Material& material) {
  const bool is_bending = material.youngs_modulus > 0 && material.poisson_ratio > -1 &&
                          is_heavy(striker, thickness, material);
  const double strength = strengths_of(material).tensile;
  if (!is_bending) return blow_of(striker, speed, thickness, material).utilisation;
  if (!(strength > 0) || !(speed > 0)) return 0;
  return Contact(striker, thickness, material).stress(speed) / strength;
}

double utilisation_at(const Blow& blow, double distance, double thickness,
                      const Material& material) {
  const double strength = strengths_of(material).tensile;
  if (!blow.is_global || !(strength > 0) || distance >= blow.engaged_radius) return 0;
  if (!(distance > 0)) return blow.utilisation;
  const double stress =
      stress_factor(blow.force, thickness, material) * log_of(blow.engaged_radius / distance);
  return std::min(stress / strength, blow.utilisation);
}

double residual_speed(double mass, double plug_mass, double speed, double ballistic_speed) {
  if (!(speed > ballistic_speed)) return 0;
  return mass / (mass + plug_mass) *
         std::sqrt((speed - ballistic_speed) * (speed + ballistic_speed));
}

double radial_crack_count(double speed, double thickness, const Material& material) {
  constexpr double kFewest = 3, kFit = 4.07;
  if (!(speed > 0) || !(material.youngs_modulus > 0) || !(material.fracture_energy > 0)) {
    return kFewest;
  }
  const double wave_speed = std::sqrt(material.youngs_modulus / material.density);
  const double toughness =
      std::sqrt(std::sqrt(material.youngs_modulus * thickness / material.fracture_energy));
  return std::max(kFewest, kFit * toughness * std::sqrt(speed / wave_speed));
}

}  // namespace sunder
