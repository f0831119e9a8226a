// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/joint_strength.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "sim/plastic_blocks.hpp"

namespace sunder {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Interaction kAll[] = {Interaction::box,       Interaction::linear, Interaction::ec3_i,
                                Interaction::ellipsoid, Interaction::bolt,   Interaction::mohr};

const SteelGrade kS235{.name = "s235"};

/// HEB200 without fillets, as the exact curve below.
Section heb200_of_plates() {
  return with_properties(
      {.name = "HEB200", .shape = "i", .height = 0.2, .width = 0.2, .web = 0.009, .flange = 0.015});
}

/// Six different resistances.
JointStrength any_strength(Interaction interaction) {
  return {.force = {100, 40, 60},
          .torque = {5, 20, 10},
          .interaction = interaction,
          .web_share = 0.25,
          .friction = 0.5};
}

double total(Interaction interaction, Vec3 force, Vec3 torque = {}) {
  return utilisation({force, torque}, any_strength(interaction)).total;
}

JointLoad times(double factor, const JointLoad& load) {
  return {factor * load.force, factor * load.torque};
}

JointLoad any_load(std::uint64_t seed) {
  std::uint64_t count = 0;
  // Half the components are small or nothing: the rules have corners there.
  const auto draw = [&](double size) {
    const double kind = random_unit(seed, count++), value = 2 * random_unit(seed, count++) - 1;
    return kind < 0.2 ? 0 : kind < 0.4 ? 1e-3 * size * value : size * value;
  };
  return {{draw(100), draw(40), draw(60)}, {draw(5), draw(20), draw(10)}};
}

TEST(JointStrength, OfEachRuleIsUsedUpOnItsSurface) {
  EXPECT_DOUBLE_EQ(total(Interaction::box, {-100, 40, 60}, {5, 20, -10}), 1);
  EXPECT_DOUBLE_EQ(total(Interaction::linear, {-50, 40, 60}, {5, 5, -2.5}), 1);
  EXPECT_DOUBLE_EQ(total(Interaction::ellipsoid, {-50, 20, 30}, {2.5, 0, 0}), 1);
  EXPECT_DOUBLE_EQ(total(Interaction::ellipsoid, {0, 24, 48}), 1);
  // M_N,y = 20 (1 − 0.5)/(1 − 0.125) at n = 0.5; M_N,z = 10 (1 − ((0.5 − 0.25)/0.75)²).
  EXPECT_DOUBLE_EQ(total(Interaction::ec3_i, {-50, 0, 0}, {0, 20 * 0.5 / 0.875, 0}), 1);
  EXPECT_NEAR(total(Interaction::ec3_i, {50, 0, 0}, {0, 0, 10 * (1 - 1.0 / 9)}), 1, 1e-13);
  EXPECT_DOUBLE_EQ(total(Interaction::ec3_i, {10, 0, 0}, {0, 12, 6.4}), 1);
  // β = 2.5: half of M_N,y squared leaves 0.75^(1/2.5) of M_N,z.
  EXPECT_NEAR(total(Interaction::ec3_i, {50, 0, 0},
                    {0, 10 * 0.5 / 0.875, 10 * (1 - 1.0 / 9) * std::pow(0.75, 0.4)}),
              1, 1e-13);
  EXPECT_DOUBLE_EQ(total(Interaction::bolt, {70, 20, 0}), 0.7 / 1.4 + 0.5);
  // |V| = 40 + 0.5 · 30 under a compression of 30.
  EXPECT_DOUBLE_EQ(total(Interaction::mohr, {-30, 55, 0}), 1);
  EXPECT_DOUBLE_EQ(total(Interaction::mohr, {-30, 0, 75}), 1);
  EXPECT_DOUBLE_EQ(total(Interaction::mohr, {30, 25, 0}), 1);
}

TEST(JointStrength, IsPositiveHomogeneousInTheLoad) {
  for (const Interaction rule : kAll) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
      const JointLoad load = any_load(seed);
      const Utilisation one = utilisation(load, any_strength(rule));
      for (const double factor : {1e-6, 0.3, 7.0}) {
        const Utilisation other = utilisation(times(factor, load), any_strength(rule));
        EXPECT_NEAR(other.total, factor * one.total, 1e-12 * factor * one.total)
            << name_of(rule) << " seed " << seed;
        EXPECT_EQ(other.component, one.component) << name_of(rule) << " seed " << seed;
      }
    }
  }
}

TEST(JointStrength, TotalIsNotLessThanEitherHalfAlone) {
  for (const Interaction rule : {Interaction::box, Interaction::linear, Interaction::ec3_i,
                                 Interaction::ellipsoid, Interaction::bolt}) {
    for (std::uint64_t seed = 1; seed <= 500; ++seed) {
      const JointLoad load = any_load(seed);
      const Utilisation all = utilisation(load, any_strength(rule));
      EXPECT_GE(all.total * (1 + 1e-14), std::max(all.force, all.torque)) << "seed " << seed;
      EXPECT_EQ(all.force, utilisation({load.force, {}}, any_strength(rule)).total);
      EXPECT_EQ(all.torque, utilisation({{}, load.torque}, any_strength(rule)).total);
    }
  }
}

/// Left side of EN 1993-1-1, (6.41), written down as the standard has it.
double left_side(const JointLoad& load, const JointStrength& r) {
  const double n = std::abs(load.force.x) / r.force.x, a = r.web_share;
  const double my = r.torque.y * std::min(1.0, (1 - n) / (1 - 0.5 * a));
  const double mz = n <= a ? r.torque.z : r.torque.z * (1 - std::pow((n - a) / (1 - a), 2));
  return std::pow(std::abs(load.torque.y) / my, 2) +
         std::pow(std::abs(load.torque.z) / mz, std::max(1.0, 5 * n));
}

TEST(JointStrength, OfEc3DividesTheLoadOntoTheSurfaceOfTheStandard) {
  for (const double share : {0.0, 0.1, 0.25, 0.5}) {
    JointStrength strength = any_strength(Interaction::ec3_i);
    strength.web_share = share;
    for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
      JointLoad load = any_load(seed);
      load.force.y = load.force.z = load.torque.x = 0;
      if (load.torque == Vec3{}) continue;
      const double divisor = utilisation(load, strength).total;
      // Rounding of N counts by what is left beside it.
      const double rest = 1 - std::abs(load.force.x) / (divisor * strength.force.x);
      EXPECT_NEAR(left_side(times(1 / divisor, load), strength), 1, 1e-13 / rest)
          << "share " << share << " seed " << seed;
      for (double part = 0.02; part < 0.99; part += 0.04) {  // no surface further in
        EXPECT_LT(left_side(times(part / divisor, load), strength), 1)
            << "share " << share << " seed " << seed << " part " << part;
      }
    }
  }
}

TEST(JointStrength, OfEc3IsExactForComponentsOfAnySize) {
  // N near N_pl beside next to no M_y: M_N,z is nearly nothing too.
  std::vector<JointLoad> loads{{{-5.131e6, 0, 0}, {0, 1.148e-10, 474616}}};
  for (std::uint64_t seed = 1; seed <= 5000; ++seed) {
    std::uint64_t count = 0;
    const auto draw = [&]() { return std::pow(10, -15 + 22 * random_unit(seed, count++)); };
    loads.push_back({{draw(), 0, 0}, {0, draw(), draw()}});
  }
  for (const JointLoad& load : loads) {
    const JointStrength strength = any_strength(Interaction::ec3_i);
    const double divisor = utilisation(load, strength).total;
    EXPECT_NEAR(utilisation(times(1 / divisor, load), strength).total, 1, 1e-12)
        << load.force.x << ' ' << load.torque.y << ' ' << load.torque.z;
    const double n = load.force.x / 100, mz = load.torque.z / 10;  // (6.38) with M_z alone
    JointLoad alone = load;
    alone.torque.y = 0;
    const double only = utilisation(alone, strength).total, rest = (1 - n / only) / 0.75;
    if (rest < 1 && rest > 1e-4) {
      EXPECT_NEAR(mz / only / (rest * (2 - rest)), 1, 1e-10) << n << ' ' << mz;
    }
  }
}

TEST(JointStrength, OfEc3LiesBetweenBoxAndLinear) {
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    const JointLoad load = any_load(seed);
    const double box = utilisation(load, any_strength(Interaction::box)).total;
    const double ec3 = utilisation(load, any_strength(Interaction::ec3_i)).total;
    const double linear = utilisation(load, any_strength(Interaction::linear)).total;
    EXPECT_LE(box, ec3 * (1 + 1e-14)) << "seed " << seed;
    EXPECT_LE(ec3, linear * (1 + 1e-14)) << "seed " << seed;
  }
}

JointLoad axial_and_moment(const JointStrength& strength, double n, double m) {
  return {{n * strength.force.x, 0, 0}, {0, m * strength.torque.y, 0}};
}

/// How far the rule lets go in the direction (n, m), in units of N_pl and M_pl.
double capacity(const Section& section, Interaction rule, double n, double m) {
  const JointStrength strength = section_strength(section, kS235, rule);
  return std::hypot(n, m) / utilisation(axial_and_moment(strength, n, m), strength).total;
}

/// M/M_pl left at N/N_pl = 0.5, by bisection on the utilisation.
double moment_at_half(Interaction rule) {
  const JointStrength strength = section_strength(heb200_of_plates(), kS235, rule);
  double low = 0, high = 2;
  for (int i = 0; i < 60; ++i) {
    const double m = (low + high) / 2;
    (utilisation(axial_and_moment(strength, 0.5, m), strength).total <= 1 ? low : high) = m;
  }
  return low;
}

TEST(JointStrength, LeavesTheMomentsOfTheReferenceAtHalfTheAxialLoad) {
  EXPECT_NEAR(moment_at_half(Interaction::ec3_i), 0.557, 0.0005);
  EXPECT_NEAR(moment_at_half(Interaction::linear), 0.5, 1e-12);
  EXPECT_NEAR(moment_at_half(Interaction::ellipsoid), std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(moment_at_half(Interaction::box), 1, 1e-12);
}

TEST(JointStrength, IsComparedToTheExactBlocks) {
  const Section s = heb200_of_plates();
  // The axis lies in a flange: half the rest of the area at either end, x thick.
  const double x = 0.25 * s.area / s.width, moment = s.width * x * (s.height - x) / s.wpl_y;
  EXPECT_NEAR(moment, 0.578, 0.001);  // the reference cuts 0.5787 off
  const Plastic found = exact_strength(s, 0.5, moment);
  EXPECT_NEAR(found.axial, 0.5, 1e-12);
  EXPECT_NEAR(found.moment, moment, 1e-12);
  // In the web, EN 1993-1-1's (6.36) without its factor: 1 − n² A²/(4 W_pl t_w).
  const Plastic web = plastic_blocks(s, -0.05);
  EXPECT_NEAR(web.moment / s.wpl_y, 1 - web.axial * web.axial / (4 * s.wpl_y * s.web), 1e-12);
}

/// Error of a rule's capacity over 17 directions, 5° to 85° from N alone towards M alone.
struct Spread {
  double low = kInfinity, high = -kInfinity;
};
Spread spread_of(Interaction rule, const Section& section) {
  Spread spread;
  for (int degrees = 5; degrees <= 85; degrees += 5) {
    const double turn = std::numbers::pi / 180 * degrees, n = std::cos(turn), m = std::sin(turn);
    const Plastic exact = exact_strength(section, n, m);
    const double error = capacity(section, rule, n, m) / std::hypot(exact.axial, exact.moment) - 1;
    spread = {std::min(spread.low, error), std::max(spread.high, error)};
  }
  return spread;
}

TEST(JointStrength, ErrsByRuleAsTheReferenceSays) {
  const Section section = heb200_of_plates();
  const auto expect_spread = [&](Interaction rule, double low, double high) {
    const Spread spread = spread_of(rule, section);
    EXPECT_NEAR(spread.low, low, 0.006) << name_of(rule);
    EXPECT_NEAR(spread.high, high, 0.006) << name_of(rule);
  };
  expect_spread(Interaction::box, 0.02, 0.86);
  expect_spread(Interaction::ellipsoid, 0.02, 0.32);
  expect_spread(Interaction::linear, -0.09, -0.01);
  expect_spread(Interaction::ec3_i, -0.02, 0.02);
}

TEST(JointStrength, OfBoltsIsThatOfTheTable) {
  // M20 8.8: A_s = 245 mm², f_ub = 800 MPa, γ_M2 = 1.25 (EN 1993-1-8, table 3.4).
  const double tension = 0.9 * 800e6 * 245e-6 / 1.25, shear = 0.6 * 800e6 * 245e-6 / 1.25;
  EXPECT_NEAR(tension, 141.1e3, 50);
  EXPECT_NEAR(shear, 94.1e3, 50);
  const JointStrength bolt{.force = {tension, shear, shear},
                           .torque = {kInfinity, kInfinity, kInfinity},
                           .interaction = Interaction::bolt};
  const auto used = [&](double n, double vy, double vz) {
    return utilisation({{n, vy, vz}, {1e9, 1e9, 1e9}}, bolt).total;
  };
  EXPECT_DOUBLE_EQ(used(tension, 0, 0), 1);
  EXPECT_DOUBLE_EQ(used(0, 0.6 * shear, -0.8 * shear), 1);
  EXPECT_DOUBLE_EQ(used(-10 * tension, shear, 0), 1);
  EXPECT_NEAR(used(70.56e3, 60.48e3, 0), 1, 1e-12);  // half the tension leaves 1 − 0.5/1.4 of 94.08
  EXPECT_DOUBLE_EQ(used(tension, shear * (1 - 1 / 1.4), 0), 1);  // the corner of both conditions
}

TEST(JointStrength, OfBoltsTakesMomentsAsTensionOfTheOutermost) {
  JointStrength bolts = any_strength(Interaction::bolt);
  EXPECT_DOUBLE_EQ(utilisation({{50, 0, 0}, {0, 5, 2.5}}, bolts).total, 1);
  EXPECT_DOUBLE_EQ(utilisation({{0, 20, 0}, {2.5, 0, 0}}, bolts).total, 1);
}

TEST(JointStrength, OfMohrIsAConeWithACutOff) {
  const double friction = 0.5;
  // Shear by compression: c + σ tan φ in every direction, c the ellipse of the two resistances.
  for (double turn = 0; turn < 6; turn += 0.5) {
    const Vec3 along{0, std::cos(turn), std::sin(turn)};
    const double cohesion = 1 / std::hypot(along.y / 40, along.z / 60);
    for (const double n : {-200.0, -30.0, 0.0, 30.0}) {
      const double shear = cohesion - n * friction;
      const Vec3 load = shear * along + Vec3{n, 0, 0};
      EXPECT_NEAR(total(Interaction::mohr, load), 1, 1e-12) << turn << ' ' << n;
    }
  }
  EXPECT_EQ(total(Interaction::mohr, {-1e6, 40, 60}), 0);  // friction holds it
  JointStrength turned = any_strength(Interaction::mohr);
  std::swap(turned.force.y, turned.force.z);
  EXPECT_DOUBLE_EQ(utilisation({{80, 0, 0}, {}}, turned).total, 1);
  EXPECT_DOUBLE_EQ(total(Interaction::mohr, {80, 0, 0}), 1);               // tip: 40/0.5
  EXPECT_DOUBLE_EQ(total(Interaction::mohr, {60, 0, 0}, {0, 8, 0}), 1);    // 0.6 + 0.4, cut off
  EXPECT_DOUBLE_EQ(total(Interaction::mohr, {-60, 0, 0}, {0, 32, 0}), 1);  // pressed together
  EXPECT_DOUBLE_EQ(total(Interaction::mohr, {0, 20, 0}, {2.5, 0, 0}), 1);
}

TEST(JointStrength, OfADryMohrJointIsFrictionAlone) {
  JointStrength dry{.interaction = Interaction::mohr, .friction = 0.6};
  EXPECT_EQ(utilisation({{-100, 60, 0}, {}}, dry).total, 0);
  EXPECT_EQ(utilisation({{-100, 61, 0}, {}}, dry).total, kInfinity);
  EXPECT_EQ(utilisation({{1e-9, 0, 0}, {}}, dry).total, kInfinity);
  EXPECT_EQ(utilisation({{-100, 0, 0}, {0, 1, 0}}, dry).total, kInfinity);
}

TEST(JointStrength, WithBearingPassesCompressionOn) {
  for (const Interaction rule :
       {Interaction::box, Interaction::linear, Interaction::ec3_i, Interaction::ellipsoid}) {
    JointStrength strength = any_strength(rule);
    strength.bearing = true;
    EXPECT_EQ(utilisation({{-1e9, 0, 0}, {}}, strength).total, 0) << name_of(rule);
    EXPECT_DOUBLE_EQ(utilisation({{100, 0, 0}, {}}, strength).total, 1) << name_of(rule);
    EXPECT_DOUBLE_EQ(utilisation({{-1e9, 0, 0}, {0, 20, 0}}, strength).total, 1) << name_of(rule);
    strength.bearing = false;
    EXPECT_DOUBLE_EQ(utilisation({{-100, 0, 0}, {}}, strength).total, 1) << name_of(rule);
  }
}

TEST(JointStrength, NeverFailsTheWayThatIsInfinitelyStrong) {
  for (const Interaction rule : kAll) {
    JointStrength strength = any_strength(rule);
    strength.force = strength.torque = {kInfinity, kInfinity, kInfinity};
    const Utilisation found = utilisation({{1e9, -1e9, 1e9}, {-1e9, 1e9, 1e9}}, strength);
    EXPECT_EQ(found.total, 0) << name_of(rule);
    EXPECT_EQ(found.component, "") << name_of(rule);
    strength.torque.y = 20;
    EXPECT_DOUBLE_EQ(utilisation({{1e9, 1e9, 1e9}, {1e9, 10, 1e9}}, strength).total, 0.5)
        << name_of(rule);
  }
}

TEST(JointStrength, WithoutLoadIsNotUsed) {
  for (const Interaction rule : kAll) {
    for (const JointStrength& strength : {any_strength(rule), JointStrength{.interaction = rule}}) {
      const Utilisation found = utilisation({}, strength);
      EXPECT_EQ(found.total, 0) << name_of(rule);
      EXPECT_EQ(found.force, 0) << name_of(rule);
      EXPECT_EQ(found.torque, 0) << name_of(rule);
      EXPECT_EQ(found.component, "") << name_of(rule);
    }
  }
}

TEST(JointStrength, OfNothingIsInfinitelyUsedByAnyLoad) {
  for (const Interaction rule : kAll) {
    for (int without = 0; without < 6; ++without) {
      for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        JointStrength strength = any_strength(rule);
        strength.friction = 0;  // tension would use the weaker shear resistance
        double* const resistances[] = {&strength.force.x,  &strength.force.y,  &strength.force.z,
                                       &strength.torque.x, &strength.torque.y, &strength.torque.z};
        *resistances[without] = 0;
        JointLoad load = any_load(seed);
        double* const loads[] = {&load.force.x,  &load.force.y,  &load.force.z,
                                 &load.torque.x, &load.torque.y, &load.torque.z};
        load.force.x = std::abs(load.force.x);  // tension counts in every rule
        const bool is_loaded = *loads[without] != 0;
        const Utilisation found = utilisation(load, strength);
        EXPECT_EQ(found.total == kInfinity, is_loaded) << name_of(rule) << ' ' << without;
        EXPECT_FALSE(std::isnan(found.total + found.force + found.torque)) << name_of(rule);
      }
    }
  }
}

TEST(JointStrength, NamesTheComponentThatDecides) {
  const auto component = [](Interaction rule, Vec3 force, Vec3 torque = {}) {
    return utilisation({force, torque}, any_strength(rule)).component;
  };
  for (const Interaction rule : kAll) {
    EXPECT_EQ(component(rule, {90, 1, 1}, {1, 1, 1}), "N") << name_of(rule);
    EXPECT_EQ(component(rule, {1, 39, 1}, {0.1, 1, 1}), "Vy") << name_of(rule);
    EXPECT_EQ(component(rule, {1, 1, -59}, {0.1, 1, 1}), "Vz") << name_of(rule);
    EXPECT_EQ(component(rule, {1, 0.1, 0.1}, {-5, 1, 1}), "T") << name_of(rule);
    EXPECT_EQ(component(rule, {1, 1, 1}, {0.1, 19, -1}), "My") << name_of(rule);
    EXPECT_EQ(component(rule, {1, 1, 1}, {0.1, 1, -9}), "Mz") << name_of(rule);
  }
  // Three halves make more than a shear of 0.9.
  EXPECT_EQ(component(Interaction::linear, {50, 36, 0}, {0, 11, 5}), "My");
  EXPECT_EQ(component(Interaction::box, {50, 36, 0}, {0, 11, 5}), "Vy");
}

TEST(JointStrength, OfASectionIsItsPlasticResistance) {
  const Section section = with_properties({.name = "HEB200",
                                           .shape = "i",
                                           .height = 0.2,
                                           .width = 0.2,
                                           .web = 0.009,
                                           .flange = 0.015,
                                           .radius = 0.018});
  const JointStrength strength = section_strength(section, kS235, Interaction::ec3_i);
  EXPECT_NEAR(strength.force.x, 1835e3, 500);
  EXPECT_NEAR(strength.force.z, 337e3, 500);
  EXPECT_NEAR(strength.torque.y, 151.0e3, 50);
  EXPECT_NEAR(strength.torque.z, 71.9e3, 50);
  EXPECT_DOUBLE_EQ(strength.force.y, section.avy * 235e6 / std::numbers::sqrt3);
  EXPECT_DOUBLE_EQ(strength.torque.x, section.wt * 235e6 / std::numbers::sqrt3);
  EXPECT_DOUBLE_EQ(strength.web_share, (section.area - 2 * 0.2 * 0.015) / section.area);
  const JointStrength half = section_strength(section, kS235, Interaction::box, 0.5);
  EXPECT_EQ(half.force, 0.5 * strength.force);
  EXPECT_EQ(half.torque, 0.5 * strength.torque);
  EXPECT_EQ(half.interaction, Interaction::box);
}

TEST(JointStrength, OfEc3IsForSectionsOfShapeI) {
  const Section tube = with_properties(
      {.name = "SHS100x5", .shape = "rhs", .height = 0.1, .width = 0.1, .web = 0.005});
  EXPECT_THROW(section_strength(tube, kS235, Interaction::ec3_i), Error);
  EXPECT_NO_THROW(section_strength(tube, kS235, Interaction::linear));
  // A web of more than half the area counts as half.
  const Section tall =
      with_properties({.shape = "i", .height = 1, .width = 0.1, .web = 0.02, .flange = 0.02});
  EXPECT_EQ(section_strength(tall, kS235, Interaction::ec3_i).web_share, 0.5);
}

TEST(JointStrength, OfARuleHasItsName) {
  for (const Interaction rule : kAll) EXPECT_EQ(interaction_named(name_of(rule)), rule);
  EXPECT_EQ(interaction_named("ec3-i"), Interaction::ec3_i);
  try {
    interaction_named("elipsoid");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "unknown interaction \"elipsoid\", valid: box linear ec3-i ellipsoid bolt mohr");
  }
}

}  // namespace
}  // namespace sunder
