// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/trig.hpp"

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

}  // namespace sunder
