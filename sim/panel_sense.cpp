// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/panel_sense.hpp"

#include <algorithm>
#include <cmath>

namespace sunder {
namespace {

/// Measured responses are right to rounding alone.
constexpr double kRounding = 1 + 1e-6;
constexpr std::array<double, 4> kAlternating{1, -1, 1, -1};

double larger_way(ChunkNetwork& network, const PanelFreedoms& moved) {
  PanelFreedoms back = moved;
  for (double& value : back) value = -value;
  return kRounding * std::max(network.highest(moved), network.highest(back));
}

}  // namespace

/// Values at the corners are a + b x + c y + d (1, -1, 1, -1): d by what of the last is orthogonal
/// to the others, b and c by least squares of the rest, which they meet exactly.
PanelSense::PanelSense(ChunkNetwork& network, const PanelCorners& corners) {
  network.set_gravity({});
  network.set_contacts({});
  const Vec3 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  std::array<Vec2, 4> at{};
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    at[c] = {corners[c].x - middle.x, corners[c].y - middle.y};
    xx += at[c].x * at[c].x, xy += at[c].x * at[c].y, yy += at[c].y * at[c].y;
  }
  const double whole = xx * yy - xy * xy;
  Vec2 fit;
  for (std::size_t c = 0; c < 4; ++c) {
    slope_[c] = {(yy * at[c].x - xy * at[c].y) / whole, (xx * at[c].y - xy * at[c].x) / whole};
    fit = fit + kAlternating[c] * slope_[c];
  }
  double size = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    alternating_[c] = kAlternating[c] - dot(fit, at[c]);
    size += alternating_[c] * kAlternating[c];
  }
  for (double& value : alternating_) value /= size;
  for (std::size_t m = 0; m < 6; ++m) {
    PanelFreedoms strained{};
    for (std::size_t c = 0; c < 4; ++c) {
      if (m == 0) strained[6 * c] = at[c].x;
      if (m == 1) strained[6 * c + 1] = at[c].y;
      if (m == 2) strained[6 * c] = at[c].y;
      if (m >= 3) strained[6 * c + m - 3] = kAlternating[c];
    }
    of_strain_[m] = larger_way(network, strained);
  }
}

/// Stretch along x, along y, shear angle, and what alternates along x, y, z.
std::array<double, 6> PanelSense::strains_of(const PanelFreedoms& moved) const {
  std::array<double, 6> strain{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t c = 0; c < 4; ++c) strain[3 + i] += alternating_[c] * moved[6 * c + i];
  for (std::size_t c = 0; c < 4; ++c) {
    const double u = moved[6 * c] - strain[3] * kAlternating[c];
    const double v = moved[6 * c + 1] - strain[4] * kAlternating[c];
    strain[0] += slope_[c].x * u;
    strain[1] += slope_[c].y * v;
    strain[2] += slope_[c].y * u + slope_[c].x * v;
  }
  return strain;
}

double PanelSense::added(const PanelFreedoms& moved) const {
  const std::array<double, 6> strain = strains_of(moved);
  double sum = 0;
  for (std::size_t m = 0; m < strain.size(); ++m) sum += std::abs(strain[m]) * of_strain_[m];
  return sum;
}

}  // namespace sunder
