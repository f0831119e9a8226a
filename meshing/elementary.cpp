// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/elementary.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

// Sums of two doubles after T. J. Dekker, "A floating-point technique for extending the available
// precision", Numerische Mathematik 18, 1971 (with Knuth's two-sum); they need no FMA and are
// wrong if the compiler is allowed to reorder or contract.
namespace sunder {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

// ln 2; the upper part has 42 bits, so that its product with any exponent is exact.
constexpr double kLog2High = 0x1.62e42fefa38p-1, kLog2Low = 0x1.ef35793c7673p-45;

/// high + low, |low| at most half an ulp of high.
struct Pair {
  double high = 0, low = 0;
};

Pair fast_sum(double a, double b) {  // |a| >= |b| or a = 0
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

Pair sum_of(double a, double b) {
  const double sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

Pair product_of(double a, double b) {
  constexpr double kSplit = 0x1p27 + 1;
  const double ta = kSplit * a, tb = kSplit * b;
  const double a1 = ta - (ta - a), b1 = tb - (tb - b);
  const double a2 = a - a1, b2 = b - b1;
  const double product = a * b;
  return {product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2};
}

Pair operator+(Pair a, Pair b) {
  const Pair sum = sum_of(a.high, b.high);
  return fast_sum(sum.high, sum.low + (a.low + b.low));
}

Pair operator*(Pair a, Pair b) {
  const Pair product = product_of(a.high, b.high);
  return fast_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

Pair operator/(Pair a, Pair b) {
  const double quotient = a.high / b.high;
  const Pair back = product_of(quotient, b.high);
  const double rest = ((a.high - back.high) - back.low) + (a.low - quotient * b.low);
  return fast_sum(quotient, rest / b.high);
}

double power_of_two(int exponent) {  // a normal one: -1022 .. 1023
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

/// ln x of a positive, finite x: x = 2^k m with m in [√½, √2), ln m = 2 artanh((m - 1)/(m + 1)).
Pair log_pair(double x) {
  int k = 0;
  if (x < std::numeric_limits<double>::min()) {
    x *= 0x1p54;
    k = -54;
  }
  const auto bits = std::bit_cast<std::uint64_t>(x);
  k += static_cast<int>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & 0xfffffffffffffu) | (std::uint64_t{1023} << 52));
  if (m > 0x1.6a09e667f3bcdp0) {
    m *= 0.5;
    ++k;
  }
  const Pair s = Pair{m - 1, 0} / sum_of(m, 1);
  const Pair square = s * s;  // < 0.02944; the first dropped term is below 1e-22 of the sum
  Pair sum;
  for (int i = 27; i >= 1; i -= 2)
    sum = sum * square + Pair{1, 0} / Pair{static_cast<double>(i), 0};
  const Pair log_m = Pair{2 * s.high, 2 * s.low} * sum;
  return fast_sum(k * kLog2High, k * kLog2Low) + log_m;
}

/// e^(x.high + x.low): 2^k e^r, |r| <= ½ ln 2, by Taylor's polynomial.
double exp_pair(Pair x) {
  if (!(x.high < 710)) return x.high >= 710 ? kInfinity : kNotANumber;
  if (x.high < -746) return 0;
  const int k = static_cast<int>(std::floor(x.high * 0x1.71547652b82fep0 + 0.5));
  const double r = (x.high - k * kLog2High) + (x.low - k * kLog2Low);
  double sum = 0;  // of r^3/3! …; the first dropped term, r^16/16!, is below 3e-21
  for (int i = 15; i >= 3; --i) sum = (1 + sum) * r / i;
  const double value = 1 + (r + 0.5 * r * r * (1 + sum));
  const int half = k / 2;  // in two steps: 2^k itself may be no normal number
  return value * power_of_two(half) * power_of_two(k - half);
}

}  // namespace

double exp_of(double x) {
  return exp_pair({x, 0});
}

double log_of(double x) {
  if (!(x > 0)) return x == 0 ? -kInfinity : kNotANumber;
  if (x == kInfinity) return x;
  return log_pair(x).high;
}

double power_of(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (!(x >= 0) || y != y) return kNotANumber;
  if (x == 0 || x == kInfinity) return (x == 0) == (y > 0) ? 0 : kInfinity;
  const Pair log_x = log_pair(x);
  const double rough = log_x.high * y;
  if (rough > 800) return kInfinity;
  if (rough < -800) return 0;
  return exp_pair(log_x * Pair{y, 0});
}

}  // namespace sunder
