// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/elementary.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "meshing/random.hpp"

namespace sunder {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBound = 1e-15;

// The C library's 80-bit functions as the oracle: 11 bits more than a double.
double error(double value, long double expected) {
  static_assert(std::numeric_limits<long double>::digits >= 64);
  return static_cast<double>(std::fabs((value - expected) / expected));
}

struct Draws {
  std::uint64_t seed = 1, count = 0;
  double operator()(double low, double high) {
    return low + (high - low) * random_unit(seed, count++);
  }
};

TEST(Elementary, ExpIsTheLibrarysTo1e15) {
  Draws draw{1};
  for (int i = 0; i < 200000; ++i) {
    const double x = i % 2 ? draw(-708, 709.7) : draw(-1, 1);
    ASSERT_LT(error(exp_of(x), std::exp(static_cast<long double>(x))), kBound) << x;
  }
}

TEST(Elementary, LogIsTheLibrarysTo1e15OverAllMagnitudesAndNearOne) {
  Draws draw{2};
  for (int i = 0; i < 100000; ++i) {
    const double x = i % 2 ? std::exp(draw(-700, 700)) : 1 + std::exp(draw(-36, 0));
    if (x == 1) continue;
    ASSERT_LT(error(log_of(x), std::log(static_cast<long double>(x))), kBound) << x;
    const double below = 1 - std::exp(draw(-36, -0.7));
    if (below == 1) continue;
    ASSERT_LT(error(log_of(below), std::log(static_cast<long double>(below))), kBound) << below;
  }
}

TEST(Elementary, PowerIsTheLibrarysTo1e15) {
  Draws draw{3};
  for (int i = 0; i < 100000; ++i) {
    const double x = std::exp(draw(-200, 200)), y = draw(-1, 1) * 700 / std::fabs(std::log(x));
    const long double expected = std::pow(static_cast<long double>(x), static_cast<long double>(y));
    ASSERT_LT(error(power_of(x, y), expected), kBound) << x << " ^ " << y;
  }
}

TEST(Elementary, PowersOfTwoAndSmallWholePowersAreExact) {
  for (int k = -1022; k < 1024; ++k) {
    EXPECT_EQ(power_of(2, k), std::ldexp(1.0, k));
  }
  for (int x = 2; x <= 30; ++x) {
    EXPECT_EQ(power_of(x, 2), x * x);
    EXPECT_EQ(power_of(x * x, 0.5), x);
    EXPECT_EQ(power_of(x, -1), 1.0 / x);
  }
  EXPECT_EQ(exp_of(0), 1);
  EXPECT_EQ(log_of(1), 0);
  EXPECT_EQ(power_of(10, 3), 1000);
}

TEST(Elementary, SpecialValuesAreTheLibrarys) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double max = std::numeric_limits<double>::max();
  const double tiny = std::numeric_limits<double>::denorm_min();
  const auto same = [](double a, double b) { return a == b || (a != a && b != b); };
  const double values[] = {0,   -0.0, tiny, 1e-310,    1e-300,     0.5, 1,    2,
                           710, 1e18, max,  kInfinity, -kInfinity, nan, -746, -1};
  for (const double x : values) {
    EXPECT_TRUE(same(exp_of(x), std::exp(x)) || error(exp_of(x), std::exp(x)) < kBound) << x;
    EXPECT_TRUE(same(log_of(x), std::log(x)) || error(log_of(x), std::log(x)) < kBound) << x;
    if (x < 0 || std::signbit(x)) continue;
    for (const double y : values) {
      const double expected = std::pow(x, y), power = power_of(x, y);
      EXPECT_TRUE(same(power, expected) || error(power, expected) < kBound) << x << " ^ " << y;
    }
  }
  EXPECT_TRUE(std::isnan(power_of(-2, 2)));
  EXPECT_TRUE(std::isnan(power_of(-2, 0.5)));
}

TEST(Elementary, DenormalResultsAreRight) {
  for (double x = -744; x < -708; x += 0.37) {
    const double expected = std::exp(x), unit = std::numeric_limits<double>::denorm_min();
    EXPECT_NEAR(exp_of(x), expected, std::fmax(unit, kBound * expected)) << x;
  }
}

// The number was printed by this test; a build that contracts to FMA or reorders changes it.
TEST(Elementary, GivesTheSameBitsInEveryBuild) {
  Draws draw{4};
  std::uint64_t hash = 0;
  for (int i = 0; i < 10000; ++i) {
    const double x = draw(0, 100), y = draw(-20, 20);
    for (const double value : {exp_of(y), log_of(x), power_of(x, y)}) {
      hash = mix_bits(hash ^ std::bit_cast<std::uint64_t>(value));
    }
  }
  EXPECT_EQ(hash, 16083093707476412500u);
}

TEST(Elementary, GrowsWithItsArgument) {
  double exp_before = 0, log_before = -kInfinity;
  for (int i = 1; i < 100000; ++i) {
    const double x = i * 1e-3;
    EXPECT_GT(exp_of(x), exp_before);
    EXPECT_GT(log_of(x), log_before);
    exp_before = exp_of(x), log_before = log_of(x);
  }
}

}  // namespace
}  // namespace sunder
