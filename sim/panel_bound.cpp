// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/panel_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sunder {
namespace {

/// Largest stress by that of a plate's simplest formula, over random networks, and 30 % more.
struct Shares {
  double strain, shear;     ///< E ε, E γ
  double curvature, twist;  ///< E κ t/2
  double move, lift;        ///< of one corner: E u/l, E t w/l²
  double tilt, drill;       ///< E t θ/l out of the plane, E θ in it
};
constexpr Shares kAllHeld{1, 5.5, 1.6, 1.05, 8, 5.5, 2.5, 3.2};
constexpr Shares kSomeFree{12, 5.5, 5.6, 3.7, 9, 8.5, 7, 3.2};  // corners of held and free edges
constexpr double kSlab = 1.6, kWall = 2.4;  // weight across the plane and in it, by formula

/// Four corners' values as their mean and their mean gradients.
struct Fit {
  double mean = 0, by_x = 0, by_y = 0;
  double at(Vec2 p) const { return mean + by_x * p.x + by_y * p.y; }
};
Fit fit(const std::array<double, 4>& v, Vec2 size) {
  return {(v[0] + v[1] + v[2] + v[3]) / 4, (v[1] + v[2] - v[0] - v[3]) / (2 * size.x),
          (v[2] + v[3] - v[0] - v[1]) / (2 * size.y)};
}

/// Of the corners' motion, as a stress in units of Young's modulus.
double motion_stress(const PanelPlate& plate, const PanelFreedoms& freedoms) {
  const bool all_held = std::ranges::all_of(plate.held, [](bool held) { return held; });
  const Shares& by = all_held ? kAllHeld : kSomeFree;
  const Vec2 half = 0.5 * plate.size;
  const std::array<Vec2, 4> at{Vec2{-half.x, -half.y}, {half.x, -half.y}, half, {-half.x, half.y}};
  std::array<std::array<double, 4>, 6> d{};  // by freedom and corner
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t i = 0; i < 6; ++i) d[i][c] = freedoms[6 * c + i];
  const Fit u = fit(d[0], plate.size), v = fit(d[1], plate.size);
  const Fit turn_x = fit(d[3], plate.size), turn_y = fit(d[4], plate.size);
  // w = ½ κ_x x² + ½ κ_y y² + κ_xy x y has the rotations θ_x = ∂w/∂y, θ_y = -∂w/∂x.
  const double kx = -turn_y.by_x, ky = turn_x.by_y, kxy = (turn_x.by_x - turn_y.by_y) / 2;
  std::array<double, 4> lift = d[2];
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec2 p = at[c];
    lift[c] -= kx * p.x * p.x / 2 + ky * p.y * p.y / 2 + kxy * p.x * p.y;
  }
  const Fit w = fit(lift, plate.size);
  const double spin = (v.by_x - u.by_y) / 2, t = plate.thickness;
  double sum = by.strain * (std::abs(u.by_x) + std::abs(v.by_y)) +
               by.shear * std::abs(u.by_y + v.by_x) +
               (by.curvature * (std::abs(kx) + std::abs(ky)) + by.twist * std::abs(kxy)) * t / 2;
  const double l = std::min(plate.size.x, plate.size.y);
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec2 p = at[c];
    sum += by.move / l * (std::abs(d[0][c] - u.at(p)) + std::abs(d[1][c] - v.at(p))) +
           by.lift * t / (l * l) * std::abs(lift[c] - w.at(p)) +
           by.tilt * t / l *
               (std::abs(d[3][c] - w.by_y - ky * p.y - kxy * p.x) +
                std::abs(d[4][c] + w.by_x + kx * p.x + kxy * p.y)) +
           by.drill * std::abs(d[5][c] - spin);
  }
  return sum;
}

/// Of the weight, per N/m³: as a strip between two opposite edges (W = t²/6, M = q L²/8), else as a
/// cantilever of the longest reach; in the plane as a beam as deep as the panel is wide.
double weight_stress(const PanelPlate& plate, Vec3 gravity) {
  const auto& held = plate.held;
  const Vec2 size = plate.size;
  const double t = plate.thickness, in_plane = std::hypot(gravity.x, gravity.y);
  double span = std::numeric_limits<double>::infinity(), depth = 0;
  if (held[0] && held[2]) {
    span = size.y;
    depth = size.x;
  }
  if (held[1] && held[3] && size.x < span) {
    span = size.x;
    depth = size.y;
  }
  double share = 0.75;
  if (std::isinf(span)) {
    const bool x = held[1] || held[3], y = held[0] || held[2];
    span = x && y ? length(size) : x ? size.x : size.y;
    depth = std::min(size.x, size.y);
    share = 3;
  }
  return kSlab * std::abs(gravity.z) * share * span * span / t +
         kWall * in_plane * (span + share * span * span / depth);
}

}  // namespace

double panel_stress_bound(const PanelPlate& plate, const Material& material,
                          const PanelFreedoms& freedoms, Vec3 gravity) {
  // The utilisation of a plane that has this stress both along and across, of either sign.
  const double ft = material.tensile_strength, fc = material.compressive_strength;
  const double per_stress = 1 / ft + 2 / std::sqrt(ft * fc) - 1 / fc;
  return per_stress * (material.youngs_modulus * motion_stress(plate, freedoms) +
                       material.density * weight_stress(plate, gravity));
}

}  // namespace sunder
