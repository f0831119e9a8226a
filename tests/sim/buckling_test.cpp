// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/buckling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace sunder {
namespace {

const SteelGrade kS235{.name = "s235"};

Section heb200() {
  return with_properties({.name = "HEB200",
                          .shape = "i",
                          .height = 0.2,
                          .width = 0.2,
                          .web = 0.009,
                          .flange = 0.015,
                          .radius = 0.018});
}

Section heb300() {
  return with_properties({.name = "HEB300",
                          .shape = "i",
                          .height = 0.3,
                          .width = 0.3,
                          .web = 0.011,
                          .flange = 0.019,
                          .radius = 0.027});
}

TEST(Buckling, GivesTheResistancesOfUnbracedPosts) {
  const Section post = heb200();
  EXPECT_NEAR(buckling_resistance(post, kS235, {3.5, 3.5}) / 1e3, 1289, 0.5);
  EXPECT_NEAR(buckling_resistance(post, kS235, {7, 7}) / 1e3, 594, 0.5);
  EXPECT_NEAR(buckling_resistance(post, kS235, {10.5, 10.5}) / 1e3, 303, 0.5);
}

TEST(Buckling, GivesTheTableOfTheReferenceBuilding) {
  struct Row {
    double length, euler, resistance;  // m, MN
  };
  for (const Row& row :
       {Row{3.5, 14.49, 2.97}, Row{7, 3.62, 1.93}, Row{10.5, 1.61, 1.13}, Row{14, 0.91, 0.71}}) {
    const FreeLength length{row.length, row.length};
    EXPECT_NEAR(euler_load(heb300(), kS235, length) / 1e6, row.euler, 0.005) << row.length;
    EXPECT_NEAR(buckling_resistance(heb300(), kS235, length) / 1e6, row.resistance, 0.005)
        << row.length;
  }
}

TEST(Buckling, EulerLoadFallsWithTheSquareOfTheLength) {
  const double one = euler_load(heb200(), kS235, {3.5, 3.5});
  EXPECT_DOUBLE_EQ(euler_load(heb200(), kS235, {7, 7}), one / 4);
  EXPECT_DOUBLE_EQ(euler_load(heb200(), kS235, {10.5, 10.5}), one / 9);
}

TEST(Buckling, TakesTheAxisThatGivesLess) {
  constexpr double kPi = std::numbers::pi;
  const Section post = heb300();
  EXPECT_DOUBLE_EQ(euler_load(post, kS235, {3.5, 3.5}), kPi * kPi * 210e9 * post.iz / 12.25);
  EXPECT_DOUBLE_EQ(euler_load(post, kS235, {14, 3.5}), kPi * kPi * 210e9 * post.iy / 196);
  // Braced about z, and with curve b about y.
  const double squash = post.area * 235e6;
  const double slenderness = std::sqrt(squash / (kPi * kPi * 210e9 * post.iy / 196));
  EXPECT_NEAR(buckling_resistance(post, kS235, {14, 0}),
              squash * buckling_reduction(slenderness, "b"), 1e-9 * squash);
}

TEST(Buckling, OfNoLengthIsSquashing) {
  EXPECT_EQ(buckling_resistance(heb200(), kS235, {0, 0}), heb200().area * 235e6);
  EXPECT_EQ(euler_load(heb200(), kS235, {0, 0}), std::numeric_limits<double>::infinity());
}

/// EN 1993-1-1, 6.3.1.2 from the imperfection that stands behind it (Ayrton and Perry): the outer
/// fibre of a bent column yields, (1 − χ)(1 − χ λ²) = η χ with η = α (λ − 0.2).
TEST(Buckling, ReductionSolvesTheEquationOfAyrtonAndPerry) {
  const struct {
    const char* curve;
    double factor;
  } kCurves[] = {{"a0", 0.13}, {"a", 0.21}, {"b", 0.34}, {"c", 0.49}, {"d", 0.76}};
  for (const auto& [curve, factor] : kCurves) {
    for (double slenderness = 0.21; slenderness < 4; slenderness += 0.01) {
      const double x = buckling_reduction(slenderness, curve);
      const double bent = factor * (slenderness - 0.2) * x;
      EXPECT_NEAR((1 - x) * (1 - x * slenderness * slenderness), bent, 1e-12)
          << curve << ' ' << slenderness;
      EXPECT_LT(x, 1);
      EXPECT_LT(x * slenderness * slenderness, 1) << "above Euler";
    }
  }
}

TEST(Buckling, ReductionIsOneForStockyPostsAndStartsWithoutStep) {
  for (const char* curve : {"a0", "a", "b", "c", "d"}) {
    EXPECT_EQ(buckling_reduction(0, curve), 1);
    EXPECT_EQ(buckling_reduction(0.2, curve), 1);
    EXPECT_NEAR(buckling_reduction(0.2 + 1e-9, curve), 1, 1e-8);
    double before = 1;
    for (double slenderness = 0; slenderness < 5; slenderness += 1e-3) {
      const double x = buckling_reduction(slenderness, curve);
      EXPECT_LE(x, before);
      EXPECT_LT(before - x, 2e-3) << curve << " steps at " << slenderness;
      before = x;
    }
  }
}

TEST(Buckling, WorseCurvesGiveLess) {
  for (double slenderness = 0.3; slenderness < 4; slenderness += 0.1) {
    double before = 1;
    for (const char* curve : {"a0", "a", "b", "c", "d"}) {
      const double x = buckling_reduction(slenderness, curve);
      EXPECT_LT(x, before) << curve << ' ' << slenderness;
      before = x;
    }
  }
}

}  // namespace
}  // namespace sunder
