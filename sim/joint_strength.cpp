// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/joint_strength.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "meshing/error.hpp"

namespace sunder {
namespace {

double ratio(double load, double resistance) {
  return load == 0 ? 0 : std::abs(load) / resistance;
}

double root_of_squares(double a, double b, double c = 0) {
  return std::sqrt(a * a + b * b + c * c);
}

/// Each component by its resistance, 0 where the rule does not count it.
struct Shares {
  double n = 0;  ///< negative: compression, of mohr only
  double vy = 0, vz = 0;
  double shear = 0;  ///< what bolt and mohr make of V; of mohr with N tan φ
  double t = 0, my = 0, mz = 0;
};

/// |V| + N tan φ by the resistance along V; by the weaker one when there is no V.
double slide(const JointLoad& load, const JointStrength& strength, double vy, double vz) {
  const double shear = root_of_squares(load.force.y, load.force.z);
  const double demand = shear + load.force.x * strength.friction;
  if (demand <= 0) return 0;
  if (shear == 0) return ratio(demand, std::min(strength.force.y, strength.force.z));
  return root_of_squares(vy, vz) * (demand / shear);
}

double normal_share(const JointLoad& load, const JointStrength& strength) {
  const double n = ratio(load.force.x, strength.force.x);
  if (load.force.x >= 0) return n;
  switch (strength.interaction) {
    case Interaction::bolt: return 0;
    // Without a tensile resistance there is no measure of how far compression closes the edge.
    case Interaction::mohr: return strength.force.x > 0 ? -n : 0;
    default: return strength.bearing ? 0 : n;
  }
}

Shares shares_of(const JointLoad& load, const JointStrength& strength) {
  Shares s;
  s.n = normal_share(load, strength);
  s.vy = ratio(load.force.y, strength.force.y);
  s.vz = ratio(load.force.z, strength.force.z);
  s.shear = strength.interaction == Interaction::mohr ? slide(load, strength, s.vy, s.vz)
                                                      : root_of_squares(s.vy, s.vz);
  s.t = ratio(load.torque.x, strength.torque.x);
  s.my = ratio(load.torque.y, strength.torque.y);
  s.mz = ratio(load.torque.z, strength.torque.z);
  return s;
}

/// x^y of x >= 0 and 1 <= y <= 5 to about 1e-14 of itself, from + − × / and the exponent's bits
/// alone: the same everywhere, as power_of, which is several times as dear for its last digits.
double quick_power(double x, double y) {
  constexpr double kLn2 = std::numbers::ln2;
  constexpr int kLogTerms = 11, kExpTerms = 14;
  if (x == 0) return 0;
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < std::numbers::sqrt2 / 2) mantissa *= 2, --exponent;
  const double s = (mantissa - 1) / (mantissa + 1);  // ln(mantissa) = 2 artanh(s), |s| < 0.172
  double artanh = 0;
  for (int i = 2 * kLogTerms - 1; i >= 1; i -= 2) artanh = artanh * s * s + 1.0 / i;
  const double twos = y * (exponent + 2 * s * artanh / kLn2);
  const double whole = std::floor(twos + 0.5), rest = (twos - whole) * kLn2;
  double power = 1;
  for (int i = kExpTerms; i >= 1; --i) power = 1 + power * rest * (1.0 / i);
  return std::ldexp(power, static_cast<int>(whole));
}

/// EN 1993-1-1, (6.41), of the load divided by `divisor`, as 1/√(left side) − 1: nearly straight in
/// the divisor, −1 where nothing is left beside N, cut at 1.
double reserve(const Shares& s, double web_share, double divisor) {
  const double n = s.n / divisor;
  if (n >= 1) return -1;
  const double rest = std::min(1.0, (1 - n) / (1 - web_share));
  const double y = s.my / divisor / std::min(1.0, (1 - n) / (1 - 0.5 * web_share));  // (6.36)
  const double z = s.mz / divisor / (rest * (2 - rest));  // (6.38), exact where n is near 1
  const double left = y * y + (5 * n <= 1 ? z : quick_power(z, 5 * n));
  return std::min(1.0, 1 / std::sqrt(left) - 1);
}

/// The divisor that puts N, M_y, M_z on the surface of 6.2.9.1, between those of N with M_y alone
/// and of the linear rule, by regula falsi (Illinois). There is only one: with the share p = z^β of
/// M_z, (6.41) grows by more than 2 (1 − p) + p ln p + p >= 1 per unit of ln(load) where it is 1.
double bending_and_axial(const Shares& s, double web_share) {
  constexpr double kTolerance = 1e-14;
  const double with_my = std::max(s.my, s.n + (1 - 0.5 * web_share) * s.my);  // (6.36)
  if (s.mz == 0) return with_my;
  // N so small that it reduces nothing and the exponent is 1: (6.41) is a quadratic.
  const double of_bending = 0.5 * (s.mz + root_of_squares(s.mz, 2 * s.my));
  if (s.n <= of_bending * std::min(0.5 * web_share, 0.2)) return of_bending;
  double low = std::max(with_my, s.mz), high = s.n + s.my + s.mz;
  if (!std::isfinite(high)) return high;
  double at_low = reserve(s, web_share, low), at_high = reserve(s, web_share, high);
  if (at_low >= 0) return low;
  if (at_high <= 0) return high;
  int moved = 0;  // the end that moved last
  while (high - low > kTolerance * high) {
    const double middle = high - at_high * (high - low) / (at_high - at_low);
    const double at_middle = reserve(s, web_share, middle);
    if (std::abs(at_middle) < kTolerance) return middle;
    const int side = at_middle < 0 ? -1 : 1;
    (side < 0 ? low : high) = middle;
    (side < 0 ? at_low : at_high) = at_middle;
    if (side == moved) (side < 0 ? at_high : at_low) *= 0.5;
    moved = side;
  }
  return high;
}

/// What a rule makes of N, M_y, M_z, of the shears and T, and of all.
struct Demand {
  double normal = 0, shear = 0, total = 0;
};

Demand demand_of(const Shares& s, const JointStrength& strength) {
  const double largest_shear = std::max({s.vy, s.vz, s.t});
  const auto larger = [](double normal, double shear) {
    return Demand{normal, shear, std::max(normal, shear)};
  };
  switch (strength.interaction) {
    case Interaction::box: return larger(std::max({s.n, s.my, s.mz}), largest_shear);
    case Interaction::linear: return larger(s.n + s.my + s.mz, largest_shear);
    case Interaction::ec3_i: return larger(bending_and_axial(s, strength.web_share), largest_shear);
    case Interaction::mohr: return larger(s.n + s.my + s.mz, s.shear + s.t);
    case Interaction::bolt: {
      const double tension = s.n + s.my + s.mz, shear = s.shear + s.t;
      return {tension, shear, std::max(shear + tension / 1.4, tension)};
    }
    case Interaction::ellipsoid: break;
  }
  return {std::max({s.n, s.my, s.mz}), largest_shear,
          root_of_squares(root_of_squares(s.n, s.my, s.mz), root_of_squares(s.vy, s.vz, s.t))};
}

std::string_view largest_of(const Shares& s, const Demand& demand) {
  if (demand.total == 0) return {};
  if (demand.shear > demand.normal) {
    const double pulled = s.shear - root_of_squares(s.vy, s.vz);  // of mohr: by N tan φ
    if (pulled > std::max({s.vy, s.vz, s.t})) return "N";
    if (s.t > std::max(s.vy, s.vz)) return "T";
    return s.vy > s.vz ? "Vy" : "Vz";
  }
  if (s.n >= std::max(s.my, s.mz)) return "N";
  return s.my >= s.mz ? "My" : "Mz";
}

}  // namespace

std::string_view name_of(Interaction interaction) {
  return kInteractionNames[static_cast<std::size_t>(interaction)];
}

Interaction interaction_named(std::string_view name) {
  const auto found = std::find(kInteractionNames.begin(), kInteractionNames.end(), name);
  if (found == kInteractionNames.end()) {
    std::string message = "unknown interaction \"" + std::string(name) + "\", valid:";
    for (const std::string_view each : kInteractionNames) message += ' ' + std::string(each);
    throw Error(ErrorCode::input, message);
  }
  return static_cast<Interaction>(found - kInteractionNames.begin());
}

Utilisation utilisation(const JointLoad& load, const JointStrength& strength) {
  const Shares all = shares_of(load, strength);
  Shares of_force = all, of_torque = all;
  of_force.t = of_force.my = of_force.mz = 0;
  of_torque.n = of_torque.vy = of_torque.vz = of_torque.shear = 0;
  const Demand demand = demand_of(all, strength);
  return {demand_of(of_force, strength).total, demand_of(of_torque, strength).total, demand.total,
          largest_of(all, demand)};
}

double web_share_of(const Section& section) {
  if (section.shape != "i") return 0;
  const double web = section.area - 2 * section.width * section.flange;
  return std::clamp(web / section.area, 0.0, 0.5);
}

JointStrength section_strength(const Section& section, const SteelGrade& steel,
                               Interaction interaction, double factor) {
  if (interaction == Interaction::ec3_i && section.shape != "i") {
    throw Error(ErrorCode::input, "the interaction ec3-i is for sections of shape i, \"" +
                                      section.name + "\" is " + section.shape +
                                      ", valid: linear, box, ellipsoid");
  }
  const double yield = factor * steel.yield_strength, shear = yield / std::numbers::sqrt3;
  JointStrength strength;
  strength.force = {section.area * yield, section.avy * shear, section.avz * shear};
  strength.torque = {section.wt * shear, section.wpl_y * yield, section.wpl_z * yield};
  strength.interaction = interaction;
  strength.web_share = web_share_of(section);
  return strength;
}

}  // namespace sunder
