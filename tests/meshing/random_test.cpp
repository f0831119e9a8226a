// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "meshing/trig.hpp"

namespace sunder {
namespace {

TEST(Random, TheSequenceNeverChanges) {
  // Golden: printed once from this code; assets are reproducible only while it stays.
  EXPECT_EQ(random_bits(1, 2, 3), 0x07E013981790D210u);
}

TEST(Random, UnitDrawsAreUniform) {
  constexpr int kDraws = 1 << 20, kBins = 256;
  std::array<int, kBins> bins{};
  for (int i = 0; i < kDraws; ++i)
    ++bins[static_cast<std::size_t>(random_unit(7, static_cast<std::uint64_t>(i)) * kBins)];
  double chi2 = 0;
  const double expected = double{kDraws} / kBins;
  for (const int bin : bins) chi2 += (bin - expected) * (bin - expected) / expected;
  EXPECT_NEAR(chi2, kBins - 1, 5 * std::sqrt(2.0 * kBins));
}

TEST(Random, NeighbouringKeysShareNoBits) {
  // Each output bit flips with probability 1/2 when any input bit flips.
  std::uint64_t flips = 0, tests = 0;
  for (std::uint64_t element = 0; element < 2000; ++element)
    for (int bit = 0; bit < 20; ++bit) {
      flips += std::popcount(random_bits(3, element) ^ random_bits(3, element ^ (1u << bit)));
      tests += 64;
    }
  EXPECT_NEAR(static_cast<double>(flips) / static_cast<double>(tests), 0.5, 0.002);
}

TEST(Trig, UnitVectorsMatchTheLibraryAndAreExactAtQuarters) {
  for (int i = -2000; i <= 2000; ++i) {
    const double turns = i / 997.0;
    const Vec2 p = unit_at_turns(turns);
    const long double angle = 2 * std::numbers::pi_v<long double> * static_cast<long double>(turns);
    EXPECT_NEAR(p.x, static_cast<double>(std::cos(angle)), 1e-15) << turns;
    EXPECT_NEAR(p.y, static_cast<double>(std::sin(angle)), 1e-15) << turns;
  }
  EXPECT_EQ(unit_at_turns(0.25), (Vec2{0, 1}));
  EXPECT_EQ(unit_at_turns(-0.5), (Vec2{-1, 0}));
  EXPECT_EQ(unit_at_turns(7), (Vec2{1, 0}));
}

TEST(Trig, SixSinesHaveTheBitsOfEach) {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    std::array<double, kSines> values{};
    for (std::uint64_t k = 0; k < kSines; ++k)
      values[k] =
          i < 9 ? (static_cast<double>(i) - 4) / (k < 3 ? 4 : 8) : 200 * random_unit(1, i, k) - 100;
    const auto turns = values;
    sines_at_turns(values);
    for (std::size_t k = 0; k < kSines; ++k)
      EXPECT_EQ(std::bit_cast<std::uint64_t>(values[k]),
                std::bit_cast<std::uint64_t>(unit_at_turns(turns[k]).y))
          << turns[k];
  }
}

}  // namespace
}  // namespace sunder
