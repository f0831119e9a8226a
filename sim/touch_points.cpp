// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/touch_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sunder {
namespace {

Vec3 across(const TouchPoint& p, const TouchPoint& q) {
  const Vec3 d = q.at - p.at;
  return d - dot(d, p.normal) * p.normal;
}

/// True if q is nearer than p and stands before it.
bool hides(const TouchPoint& q, const TouchPoint& p) {
  const double ahead = p.gap - q.gap;
  const Vec3 d = across(p, q);
  return ahead > 0 && dot(d, d) <= ahead * ahead;
}

/// Index of the best by `score` (first of equals) among the points from `from` on.
template <typename Score>
std::size_t best_from(const std::vector<TouchPoint>& points, std::size_t from, Score&& score) {
  std::size_t best = from;
  double most = score(points[from]);
  for (std::size_t i = from + 1; i < points.size(); ++i) {
    const double s = score(points[i]);
    if (s > most) most = s, best = i;
  }
  return best;
}

}  // namespace

void keep_four(std::vector<TouchPoint>& points) {
  if (points.size() <= 4) return;
  std::vector<TouchPoint> seen;
  for (const TouchPoint& p : points) {
    const auto hides_p = [&](const TouchPoint& q) { return hides(q, p); };
    if (!std::any_of(points.begin(), points.end(), hides_p)) seen.push_back(p);
  }
  points.swap(seen);
  if (points.size() <= 4) return;
  const auto bring = [&](std::size_t to, std::size_t from) {
    std::rotate(points.begin() + to, points.begin() + from, points.begin() + from + 1);
  };
  const auto square = [](Vec3 v) { return dot(v, v); };
  bring(0, best_from(points, 0, [](const TouchPoint& p) { return -p.gap; }));
  bring(1, best_from(points, 1, [&](auto& p) { return square(across(points[0], p)); }));
  const Vec3 line = across(points[0], points[1]);
  const auto side = [&](const TouchPoint& p) {
    return dot(points[0].normal, cross(line, across(points[0], p)));
  };
  bring(2, best_from(points, 2, [&](auto& p) { return std::fabs(side(p)); }));
  // The fourth adds most to the triangle, whichever of its sides it is beyond.
  const double way = side(points[2]) < 0 ? -1 : 1;
  const std::array<TouchPoint, 3> corner{points[0], points[1], points[2]};
  const auto gain = [&](const TouchPoint& p) {
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 edge = across(corner[i], corner[(i + 1) % 3]);
      const double out = -way * dot(corner[0].normal, cross(edge, across(corner[i], p)));
      most = std::max(most, out);
    }
    return most;
  };
  bring(3, best_from(points, 3, gain));
  points.resize(4);
}

std::vector<Vec2> inset(const std::vector<Vec2>& outline, double by) {
  const std::size_t n = outline.size();
  std::vector<Vec2> corners(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 in = outline[i] - outline[(i + n - 1) % n], out = outline[(i + 1) % n] - outline[i];
    const Vec2 u = (1 / length(in)) * in, v = (1 / length(out)) * out;
    // Along the bisector, so that both sides are `by` away.
    const Vec2 p{-u.y, u.x}, q{-v.y, v.x};
    corners[i] = outline[i] + (by / (1 + dot(p, q))) * (p + q);
  }
  return corners;
}

double inner_radius(const std::vector<Vec2>& outline) {
  double area = 0;
  Vec2 moment;
  for (std::size_t i = 2; i < outline.size(); ++i) {
    const Vec2 a = outline[i - 1] - outline[0], b = outline[i] - outline[0];
    area += cross(a, b);
    moment = moment + (cross(a, b) / 3) * (a + b);
  }
  const Vec2 centroid = outline[0] + (1 / area) * moment;
  double least = length(outline[0] - centroid);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 side = outline[(i + 1) % outline.size()] - outline[i];
    least = std::min(least, cross(side, centroid - outline[i]) / length(side));
  }
  return least;
}

}  // namespace sunder
