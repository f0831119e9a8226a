// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/panel_edges.hpp"

#include <cmath>
#include <limits>

namespace sunder {
namespace {

Vec3 nearest_point(Vec3 a, Vec3 b, Vec3 place) {
  const Vec3 edge = b - a;
  return a + std::clamp(dot(place - a, edge) / dot(edge, edge), 0.0, 1.0) * edge;
}

/// Bilinear shapes of four corners at a place of the square from -1 to 1, and their slopes there.
struct Shapes {
  std::array<double, 4> value{}, by_first{}, by_second{};
};

Shapes shapes_at(double first, double second) {
  Shapes n;
  for (std::size_t i = 0; i < 4; ++i) {
    const double p = i == 1 || i == 2 ? 1 : -1, q = i < 2 ? -1 : 1;
    n.value[i] = (1 + p * first) * (1 + q * second) / 4;
    n.by_first[i] = p * (1 + q * second) / 4;
    n.by_second[i] = q * (1 + p * first) / 4;
  }
  return n;
}

Vec3 weighted(const PanelCorners& corners, const std::array<double, 4>& share) {
  Vec3 sum;
  for (std::size_t i = 0; i < 4; ++i) sum = sum + share[i] * corners[i];
  return sum;
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

EdgeMotion surface_motion(const PanelCorners& corners, Vec3 place) {
  constexpr int kMostRounds = 20;  // Newton's; one for parallelograms
  constexpr double kNear = 1e-15;
  Shapes n;
  Vec3 along, up;
  double first = 0, second = 0, area = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    n = shapes_at(first, second);
    along = weighted(corners, n.by_first);
    up = weighted(corners, n.by_second);
    area = along.x * up.y - along.y * up.x;
    const Vec3 miss = place - weighted(corners, n.value);
    const double by_first = (miss.x * up.y - miss.y * up.x) / area;
    const double by_second = (along.x * miss.y - along.y * miss.x) / area;
    if (std::abs(by_first) + std::abs(by_second) < kNear) break;
    first += by_first;
    second += by_second;
  }
  EdgeMotion motion{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double by_x = (n.by_first[i] * up.y - n.by_second[i] * along.y) / area;
    const double by_y = (n.by_second[i] * along.x - n.by_first[i] * up.x) / area;
    for (std::size_t k = 0; k < 3; ++k) motion[k][3 * i + k] = n.value[i];
    motion[3][3 * i + 2] = by_y;
    motion[4][3 * i + 2] = -by_x;
    motion[5][3 * i] = -by_y / 2;
    motion[5][3 * i + 1] = by_x / 2;
  }
  return motion;
}

}  // namespace sunder
