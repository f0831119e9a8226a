// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "io/strip_order.hpp"
#include "sim/pose.hpp"

namespace sunder {

/// Smallest distance along a ray from the eye at which it is inside a prism; none if it misses.
inline std::optional<double> hit_of(const StripSolid& solid, Vec3 direction) {
  const Vec3 d = rotate(conjugate(solid.pose.rotation), direction);
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  const auto clip = [&](double height, double slope) {  // inside where height + t slope <= 0
    if (slope == 0) {
      if (height > 0) leave = -1;
    } else if (slope < 0) {
      enter = std::max(enter, -height / slope);
    } else {
      leave = std::min(leave, -height / slope);
    }
  };
  clip(solid.eye.z - solid.half, d.z);
  clip(-solid.eye.z - solid.half, -d.z);
  for (std::size_t i = 0; i < solid.outline.size(); ++i) {
    const Vec2 p = solid.outline[i], q = solid.outline[(i + 1) % solid.outline.size()];
    const Vec2 n{q.y - p.y, p.x - q.x};
    clip(n.x * (solid.eye.x - p.x) + n.y * (solid.eye.y - p.y), n.x * d.x + n.y * d.y);
  }
  if (enter > leave) return std::nullopt;
  return enter;
}

/// Lines of sight from the eye on which an order paints the nearest solid last, or does not.
struct Sights {
  std::size_t right = 0, wrong = 0;
};
inline Sights look_along(std::span<const Vec3> rays, std::span<const StripSolid> solids,
                         std::span<const std::uint32_t> order) {
  Sights result;
  for (const Vec3 ray : rays) {
    double nearest = std::numeric_limits<double>::infinity(), of_last = -1;
    for (const std::uint32_t i : order) {
      const std::optional<double> hit = hit_of(solids[i], ray);
      if (!hit) continue;
      nearest = std::min(nearest, *hit);
      of_last = *hit;
    }
    if (of_last >= 0) ++(of_last == nearest ? result.right : result.wrong);
  }
  return result;
}

}  // namespace sunder
