// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/panel_sense.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sunder {
namespace {

/// Measured responses are right to rounding alone.
constexpr double kRounding = 1 + 1e-6;
constexpr std::size_t kLift = 2, kTurnX = 3, kTurnY = 4;

double larger_way(ChunkNetwork& network, const PanelFreedoms& moved) {
  PanelFreedoms back = moved;
  for (double& value : back) value = -value;
  return kRounding * std::max(network.highest(moved), network.highest(back));
}

}  // namespace

PanelSense::PanelSense(ChunkNetwork& network, const PanelCorners& corners) {
  network.set_gravity({});
  network.set_contacts({});
  const Vec3 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec2 p = at_[c] = {corners[c].x - middle.x, corners[c].y - middle.y};
    // Height of the surface w, θ_x = ∂w/∂y and θ_y = -∂w/∂x.
    const std::array<std::array<double, 3>, kModes> of_corner{{{1, 0, 0},
                                                               {p.x, 0, -1},
                                                               {p.y, 1, 0},
                                                               {p.x * p.x / 2, 0, -p.x},
                                                               {p.y * p.y / 2, p.y, 0},
                                                               {p.x * p.y, p.x, -p.y}}};
    for (std::size_t m = 0; m < kModes; ++m)
      for (std::size_t i = 0; i < 3; ++i) modes_[m][6 * c + kLift + i] = of_corner[m][i];
  }
  for (std::size_t m = 0; m < kModes; ++m) of_mode_[m] = larger_way(network, modes_[m]);
  of_freedom_.fill(std::numeric_limits<double>::infinity());
  for (std::size_t c = 0; c < 4; ++c)
    for (const std::size_t i : {kLift, kTurnX, kTurnY}) {
      PanelFreedoms unit{};
      unit[6 * c + i] = 1;
      of_freedom_[6 * c + i] = larger_way(network, unit);
    }
}

double PanelSense::added(const PanelFreedoms& moved) const {
  PanelFreedoms left = moved;
  double sum = 0;
  const auto take = [&](std::size_t m, double share) {
    for (std::size_t i = 0; i < left.size(); ++i) left[i] -= share * modes_[m][i];
    sum += std::abs(share) * of_mode_[m];
  };
  const double wide = at_[1].x + at_[2].x - at_[0].x - at_[3].x;
  const double high = at_[2].y + at_[3].y - at_[0].y - at_[1].y;
  const auto by_x = [&](std::size_t i) {
    return (left[6 + i] + left[12 + i] - left[i] - left[18 + i]) / wide;
  };
  const auto by_y = [&](std::size_t i) {
    return (left[12 + i] + left[18 + i] - left[i] - left[6 + i]) / high;
  };
  const double kx = -by_x(kTurnY), ky = by_y(kTurnX), kxy = (by_x(kTurnX) - by_y(kTurnY)) / 2;
  take(3, kx);
  take(4, ky);
  take(5, kxy);
  const double tilt_x = by_x(kLift), tilt_y = by_y(kLift);
  take(1, tilt_x);
  take(2, tilt_y);
  take(0, (left[kLift] + left[6 + kLift] + left[12 + kLift] + left[18 + kLift]) / 4);
  for (std::size_t i = 0; i < left.size(); ++i)
    if (left[i] != 0) sum += std::abs(left[i]) * of_freedom_[i];
  return sum;
}

}  // namespace sunder
