// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/buckling.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

// EN 1993-1-1, 6.3.1.2 and table 6.1.
namespace sunder {
namespace {

/// Critical load of a pinned column, infinite for length 0.
double critical_load(double youngs_modulus, double second_moment, double length) {
  constexpr double kPi = std::numbers::pi;
  return kPi * kPi * youngs_modulus * second_moment / (length * length);
}

double imperfection_factor(std::string_view curve) {
  constexpr std::array<std::pair<std::string_view, double>, 5> kFactors{
      {{"a0", 0.13}, {"a", 0.21}, {"b", 0.34}, {"c", 0.49}, {"d", 0.76}}};
  const auto found = std::find_if(kFactors.begin(), kFactors.end(),
                                  [&](const auto& each) { return each.first == curve; });
  assert(found != kFactors.end() && "a curve is a0, a, b, c or d");
  return found->second;
}

}  // namespace

double buckling_reduction(double slenderness, std::string_view curve) {
  if (slenderness <= 0.2) return 1;
  const double squared = slenderness * slenderness;
  const double phi = 0.5 * (1 + imperfection_factor(curve) * (slenderness - 0.2) + squared);
  return std::min(1.0, 1 / (phi + std::sqrt(phi * phi - squared)));
}

double euler_load(const Section& section, const SteelGrade& steel, const FreeLength& length) {
  return std::min(critical_load(steel.youngs_modulus, section.iy, length.about_y),
                  critical_load(steel.youngs_modulus, section.iz, length.about_z));
}

double buckling_resistance(const Section& section, const SteelGrade& steel,
                           const FreeLength& length) {
  const double squash = section.area * steel.yield_strength;
  const auto reduction = [&](double second_moment, double free_length, std::string_view curve) {
    const double critical = critical_load(steel.youngs_modulus, second_moment, free_length);
    return buckling_reduction(std::sqrt(squash / critical), curve);
  };
  return squash * std::min(reduction(section.iy, length.about_y, section.curve_y),
                           reduction(section.iz, length.about_z, section.curve_z));
}

}  // namespace sunder
