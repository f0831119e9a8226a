// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/panel_edges.hpp"

#include <limits>

namespace sunder {
namespace {

Vec3 nearest_point(Vec3 a, Vec3 b, Vec3 place) {
  const Vec3 edge = b - a;
  return a + std::clamp(dot(place - a, edge) / dot(edge, edge), 0.0, 1.0) * edge;
}

}  // namespace

std::uint32_t edge_of(const PanelCorners& corners, Vec3 place, Vec3 outward) {
  const Vec3 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  std::uint32_t best = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (const bool any : {false, true}) {
    for (std::uint32_t k = 0; k < 4; ++k) {
      const Vec3 a = corners[k], b = corners[(k + 1) % 4];
      const Vec3 out = nearest_point(a, b, middle) - middle;
      if (!any && dot(out, outward) < 0.5 * length(out)) continue;
      const double distance = length(nearest_point(a, b, place) - place);
      if (distance >= nearest) continue;
      nearest = distance;
      best = k;
    }
    if (nearest < std::numeric_limits<double>::infinity()) break;
  }
  return best;
}

EdgeMotion edge_motion(const PanelCorners& corners, std::uint32_t edge, Vec3 place) {
  const Vec3 a = corners[edge], b = corners[(edge + 1) % 4];
  const double size = length(b - a);
  const Vec3 e = (1 / size) * (b - a);
  const Vec3 axis_point = nearest_point(a, b, place), arm = place - axis_point;
  const double s = dot(axis_point - a, e) / size;
  // Cubic shapes of end displacement and end slope, and their derivatives by length.
  const double move[2] = {1 - s * s * (3 - 2 * s), s * s * (3 - 2 * s)};
  const double turn[2] = {size * s * (1 - s) * (1 - s), -size * s * s * (1 - s)};
  const double move_slope[2] = {-6 * s * (1 - s) / size, 6 * s * (1 - s) / size};
  const double turn_slope[2] = {(1 - s) * (1 - 3 * s), s * (3 * s - 2)};
  EdgeMotion motion{};
  for (int end = 0; end < 2; ++end) {
    const double linear = end == 0 ? 1 - s : s;
    for (int i = 0; i < 6; ++i) {
      const Vec3 unit{i % 3 == 0 ? 1.0 : 0, i % 3 == 1 ? 1.0 : 0, i % 3 == 2 ? 1.0 : 0};
      const Vec3 along = dot(unit, e) * e, across = unit - along;
      Vec3 moved, slope, twist;
      if (i < 3) {
        moved = linear * along + move[end] * across;
        slope = move_slope[end] * across;
      } else {
        moved = turn[end] * cross(across, e);
        slope = turn_slope[end] * cross(across, e);
        twist = linear * along;
      }
      const Vec3 turned = twist + cross(e, slope);
      const Vec3 at = moved + cross(turned, arm);
      const double six[6] = {at.x, at.y, at.z, turned.x, turned.y, turned.z};
      for (std::size_t r = 0; r < 6; ++r) motion[r][static_cast<std::size_t>(6 * end + i)] = six[r];
    }
  }
  return motion;
}

}  // namespace sunder
