// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/penetration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meshing/elementary.hpp"

namespace sunder {
namespace {

constexpr double kFastest = 1e5;

/// NDRC's G, in SI units; UKAEA starts from the same number.
double impact_factor(const ConcreteShot& shot) {
  return 3.8e-5 * shot.nose * shot.mass / (shot.diameter * std::sqrt(shot.compressive_strength)) *
         power_of(shot.speed / shot.diameter, 1.8);
}

Penetration scaled(Penetration by_diameter, double diameter) {
  return {by_diameter.depth * diameter, by_diameter.perforation * diameter,
          by_diameter.scabbing * diameter};
}

/// d H²/M to the power 2/3: what CEA-EDF and UKAEA share.
double slab_factor(double mass, double diameter, double thickness) {
  return power_of(diameter * thickness * thickness / mass, 2.0 / 3.0);
}

double ukaea_scale(const ConcreteShot& shot) {
  return 1.3 * power_of(shot.density, 1.0 / 6.0) *
         std::sqrt(std::min(shot.compressive_strength, 37e6)) * std::sqrt(shot.reinforcement + 0.3);
}

/// UKAEA's speed above 70 m/s is V (1 + (V/500)²); it jumps there, by 2 %.
double ukaea_speed(double plain) {
  return plain <= 70 ? plain : plain * (1 + (plain / 500) * (plain / 500));
}

/// Least speed of [0, kFastest] at which `perforation` reaches `thickness`.
template <typename Perforation>
double least_speed(const Perforation& perforation, double thickness) {
  double low = 0, high = kFastest;
  if (perforation(high) < thickness) return std::numeric_limits<double>::infinity();
  for (double middle = high / 2; low < middle && middle < high; middle = low + (high - low) / 2) {
    (perforation(middle) < thickness ? low : high) = middle;
  }
  return high;
}

}  // namespace

Penetration ndrc(const ConcreteShot& shot) {
  if (!(shot.speed > 0)) return {0, 0, 0};
  const double factor = impact_factor(shot);
  const double x = factor <= 1 ? 2 * std::sqrt(factor) : factor + 1;
  const double e = x <= 1.35 ? 3.19 * x - 0.718 * x * x : 1.32 + 1.24 * x;
  const double s = x <= 0.65 ? 7.91 * x - 5.06 * x * x : 2.12 + 1.36 * x;
  return scaled({x, e, s}, shot.diameter);
}

Penetration hughes(const ConcreteShot& shot) {
  if (!(shot.speed > 0)) return {0, 0, 0};
  const double impact = shot.mass * shot.speed * shot.speed /
                        (shot.diameter * shot.diameter * shot.diameter * shot.tensile_strength);
  const double x = 0.19 * shot.hughes_nose * impact / (1 + 12.3 * log_of(1 + 0.03 * impact));
  const double e = x < 0.7 ? 3.6 * x : 1.58 * x + 1.4;
  const double s = x < 0.7 ? 5 * x : 1.74 * x + 2.3;
  return scaled({x, e, s}, shot.diameter);
}

Penetration cea_edf(const ConcreteShot& shot) {
  if (!(shot.speed > 0)) return {-1, 0, -1};
  const double e = 0.82 * std::sqrt(shot.mass / shot.diameter) * power_of(shot.speed, 0.75) /
                   (power_of(shot.density, 0.125) * power_of(shot.compressive_strength, 0.375));
  return {-1, e, -1};
}

Penetration ukaea(const ConcreteShot& shot) {
  if (!(shot.speed > 0)) return {0, 0, 0};
  const double factor = impact_factor(shot);
  double x = factor + 0.9395;
  if (factor <= 1.0605) x = std::sqrt(4 * factor - 0.242);
  if (factor <= 0.0726) x = 0.275 - std::sqrt(0.0756 - factor);
  double low = 0, high = shot.speed;  // the plain speed: ukaea_speed grows faster than it
  for (double middle = high / 2; low < middle && middle < high; middle = low + (high - low) / 2) {
    (ukaea_speed(middle) < shot.speed ? low : high) = middle;
  }
  const double scale = ukaea_scale(shot) * slab_factor(shot.mass, shot.diameter, 1);
  return {x * shot.diameter, power_of(high / scale, 0.75),
          5.3 * power_of(factor, 0.33) * shot.diameter};
}

double BallisticBand::low() const {
  return std::min({ndrc, hughes, cea_edf, ukaea});
}
double BallisticBand::high() const {
  return std::max({ndrc, hughes, cea_edf, ukaea});
}

BallisticBand ballistic_band(const ConcreteShot& shot, double thickness) {
  ConcreteShot at = shot;
  const auto speed_of = [&](Penetration (*formula)(const ConcreteShot&)) {
    return least_speed(
        [&](double speed) {
          at.speed = speed;
          return formula(at).perforation;
        },
        thickness);
  };
  return {speed_of(ndrc), speed_of(hughes),
          cea_edf_ballistic_speed(shot.mass, shot.diameter, thickness, shot.compressive_strength,
                                  shot.density),
          ukaea_speed(ukaea_scale(shot) * slab_factor(shot.mass, shot.diameter, thickness))};
}

double ndrc_ballistic_speed(const ConcreteShot& shot, double thickness) {
  constexpr double kBranch = 1.35;  // x/d, where the perforation formula changes
  const double h = thickness / shot.diameter;
  const double x = h <= 1.32 + 1.24 * kBranch
                       ? (3.19 - std::sqrt(std::max(3.19 * 3.19 - 4 * 0.718 * h, 0.0))) / 1.436
                       : (h - 1.32) / 1.24;
  const double factor = x <= 2 ? x * x / 4 : x - 1;
  const double scale = 3.8e-5 * shot.nose * shot.mass /
                       (shot.diameter * std::sqrt(shot.compressive_strength));
  return shot.diameter * power_of(factor / scale, 1 / 1.8);
}

double cea_edf_ballistic_speed(double mass, double diameter, double thickness,
                               double compressive_strength, double density) {
  return 1.3 * power_of(density, 1.0 / 6.0) * std::sqrt(compressive_strength) *
         slab_factor(mass, diameter, thickness);
}

}  // namespace sunder
