// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/trig.hpp"

#include <array>
#include <limits>
#include <numbers>

namespace sunder {
namespace {

// Taylor polynomials on |x| <= pi/4: the first dropped terms are x^19/19! and x^20/20!, below
// 1e-19.
double sin_small(double x) {
  const double t = x * x;
  double sum = 0;
  for (int k = 17; k >= 3; k -= 2) sum = (1 + sum) * -t / (k * (k - 1));
  return x + x * sum;
}

double cos_small(double x) {
  const double t = x * x;
  double sum = 0;
  for (int k = 18; k >= 2; k -= 2) sum = (1 + sum) * -t / (k * (k - 1));
  return 1 + sum;
}

}  // namespace

Vec2 unit_at_turns(double turns) {
  const double fraction = turns - std::floor(turns);
  const int quarter = static_cast<int>(std::floor(fraction * 4 + 0.5));
  const double angle = (fraction - quarter * 0.25) * (2 * std::numbers::pi);
  const double c = cos_small(angle), s = sin_small(angle);
  switch (quarter & 3) {
    case 0: return {c, s};
    case 1: return {-s, c};
    case 2: return {-c, -s};
    default: return {s, -c};
  }
}

// The sine of an angle is its own series or the cosine's, by its quarter; what the cosine's has
// more of is a division by infinity, which leaves 0.
void sines_at_turns(std::span<double, kSines> values) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  static constexpr double kDivisors[9][2] = {
      {kNone, 18 * 17},   {17 * 16, 16 * 15}, {15 * 14, 14 * 13},
      {13 * 12, 12 * 11}, {11 * 10, 10 * 9},  {9 * 8, 8 * 7},
      {7 * 6, 6 * 5},     {5 * 4, 4 * 3},     {3 * 2, 2 * 1}};
  std::array<double, kSines> x{}, t{}, sum{};
  std::array<std::size_t, kSines> quarter{};
  for (std::size_t j = 0; j < kSines; ++j) {
    const double fraction = values[j] - std::floor(values[j]);
    const double nearest = std::floor(fraction * 4 + 0.5);
    quarter[j] = static_cast<std::size_t>(nearest);
    x[j] = (fraction - nearest * 0.25) * (2 * std::numbers::pi);
    t[j] = x[j] * x[j];
  }
  for (const auto& divisors : kDivisors)
    for (std::size_t j = 0; j < kSines; ++j)
      sum[j] = (1 + sum[j]) * -t[j] / divisors[quarter[j] % 2];
  for (std::size_t j = 0; j < kSines; ++j) {
    const double size = quarter[j] % 2 == 0 ? x[j] + x[j] * sum[j] : 1 + sum[j];
    values[j] = (quarter[j] & 2) == 0 ? size : -size;
  }
}

}  // namespace sunder
