// SPDX-License-Identifier: GPL-3.0-or-later
// Separating axes and face clipping for prisms. Of two prisms only the sides, the caps, and the
// products of an outline or thickness direction of each can separate; a product counts only where
// both edges are extreme along it (an arc crossing on the Gauss map), which for a prism's outline
// edge is one sign test.
#include "sim/touch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr double kFaceBias = 5e-5;  // m; faces before edges, a's before b's: steadier contacts
constexpr double kParallelSquared = 1e-4;  // sin² below which two edges are taken as parallel
constexpr std::size_t kMaxTouches = 5;

struct Face {
  double gap = -std::numeric_limits<double>::infinity();
  std::size_t index = 0;  // side, then +z cap, -z cap
};

/// How b's frame sits in a's.
struct Relative {
  Axes axes;
  Vec3 offset;
};

Relative relative(const Place& a, const Place& b) {
  return {{into(a.axes, b.axes.x), into(a.axes, b.axes.y), into(a.axes, b.axes.z)},
          into(a.axes, b.centre - a.centre)};
}

void corners_of(const Hull& hull, const Relative& in, std::vector<Vec3>& corners) {
  corners.clear();
  for (const Hull::Side& side : hull.sides) {
    for (const double z : {hull.middle - hull.half, hull.middle + hull.half}) {
      corners.push_back(in.axes * Vec3{side.corner.x, side.corner.y, z} + in.offset);
    }
  }
}

/// The face of `hull` that separates the corners (in the hull's frame) best.
Face best_face(const Hull& hull, std::span<const Vec3> corners, double margin) {
  Face best;
  const auto offer = [&](double gap, std::size_t index) {
    if (gap > best.gap) best = {gap, index};
  };
  double low = corners[0].z, high = corners[0].z;
  for (const Vec3& c : corners) {
    low = std::min(low, c.z);
    high = std::max(high, c.z);
  }
  offer(low - (hull.middle + hull.half), hull.sides.size());
  offer(hull.middle - hull.half - high, hull.sides.size() + 1);
  for (std::size_t i = 0; i < hull.sides.size() && best.gap <= margin; ++i) {
    const Vec2 n = hull.sides[i].normal;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3& c : corners) nearest = std::min(nearest, n.x * c.x + n.y * c.y);
    offer(nearest - hull.sides[i].offset, i);
  }
  return best;
}

Vec3 face_normal(const Hull& hull, std::size_t face) {
  if (face < hull.sides.size()) return {hull.sides[face].normal.x, hull.sides[face].normal.y, 0};
  return {0, 0, face == hull.sides.size() ? 1.0 : -1.0};
}

/// Support of a hull along `axis` (its frame) if edge `index` (a side's; sides.size(): thickness)
/// is extreme along it; the edge's ends.
struct EdgeSupport {
  bool extreme = false;
  double value = 0;
  Vec3 from, to;
};

EdgeSupport support(const Hull& hull, std::size_t index, Vec3 axis) {
  const double lift = std::fabs(axis.z) * hull.half + axis.z * hull.middle;
  if (index < hull.sides.size()) {
    const Hull::Side& side = hull.sides[index];
    const double k = axis.x * side.normal.x + axis.y * side.normal.y;
    if (k <= 0) return {};
    const double z = hull.middle + (axis.z >= 0 ? hull.half : -hull.half);
    const Vec2 end = side.corner + side.length * side.along;
    return {true, k * side.offset + lift, {side.corner.x, side.corner.y, z}, {end.x, end.y, z}};
  }
  double best = -std::numeric_limits<double>::infinity();
  Vec2 at;
  for (const Hull::Side& side : hull.sides) {
    const double value = axis.x * side.corner.x + axis.y * side.corner.y;
    if (value > best) best = value, at = side.corner;
  }
  return {true,
          best + lift,
          {at.x, at.y, hull.middle - hull.half},
          {at.x, at.y, hull.middle + hull.half}};
}

struct EdgePair {
  double gap = -std::numeric_limits<double>::infinity();
  Vec3 axis;  // a's frame, from a to b
  EdgeSupport a, b;
};

Vec3 edge_direction(const Hull& hull, std::size_t index) {
  if (index == hull.sides.size()) return {0, 0, 1};
  return {hull.sides[index].along.x, hull.sides[index].along.y, 0};
}

void try_edges(const Hull& a, std::size_t i, const Hull& b, std::size_t j, const Relative& b_in_a,
               Vec3 axis, EdgePair& best) {
  const EdgeSupport of_a = support(a, i, axis);
  if (!of_a.extreme) return;
  const EdgeSupport of_b = support(b, j, into(b_in_a.axes, -1.0 * axis));
  if (!of_b.extreme) return;
  const double gap = dot(axis, b_in_a.offset) - of_b.value - of_a.value;
  if (gap > best.gap) best = {gap, axis, of_a, of_b};
}

EdgePair best_edges(const Hull& a, const Hull& b, const Relative& b_in_a, double margin) {
  EdgePair best;
  for (std::size_t j = 0; j <= b.sides.size(); ++j) {
    const Vec3 along_b = b_in_a.axes * edge_direction(b, j);
    for (std::size_t i = 0; i <= a.sides.size(); ++i) {
      const Vec3 axis = cross(edge_direction(a, i), along_b);
      const double squared = dot(axis, axis);
      if (squared < kParallelSquared) continue;
      const Vec3 unit = (1 / std::sqrt(squared)) * axis;
      try_edges(a, i, b, j, b_in_a, unit, best);
      try_edges(a, i, b, j, b_in_a, -1.0 * unit, best);
      if (best.gap > margin) return best;
    }
  }
  return best;
}

/// The polygon of a hull's face, in the frame that `in` leads to.
void face_polygon(const Hull& hull, std::size_t face, const Relative& in,
                  std::vector<Vec3>& polygon) {
  polygon.clear();
  const auto add = [&](Vec2 p, double z) {
    polygon.push_back(in.axes * Vec3{p.x, p.y, z} + in.offset);
  };
  const double low = hull.middle - hull.half, high = hull.middle + hull.half;
  const std::size_t count = hull.sides.size();
  if (face >= count) {
    for (const Hull::Side& side : hull.sides) add(side.corner, face == count ? high : low);
    return;
  }
  const Vec2 from = hull.sides[face].corner;
  const Vec2 to = hull.sides[(face + 1) % count].corner;
  add(from, low), add(to, low), add(to, high), add(from, high);
}

/// Keeps what is below normal · x = offset (Sutherland & Hodgman).
void clip(std::vector<Vec3>& polygon, std::vector<Vec3>& spare, Vec3 normal, double offset) {
  spare.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 a = polygon[i], b = polygon[i + 1 == polygon.size() ? 0 : i + 1];
    const double da = dot(normal, a) - offset, db = dot(normal, b) - offset;
    if (da <= 0) spare.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) spare.push_back(a + (da / (da - db)) * (b - a));
  }
  polygon.swap(spare);
}

void clip_to_face(const Hull& hull, std::size_t face, std::vector<Vec3>& polygon,
                  std::vector<Vec3>& spare) {
  if (face >= hull.sides.size()) {
    for (const Hull::Side& side : hull.sides) {
      clip(polygon, spare, {side.normal.x, side.normal.y, 0}, side.offset);
    }
    return;
  }
  const Hull::Side& side = hull.sides[face];
  const Vec3 along{side.along.x, side.along.y, 0};
  const double start = dot(side.along, side.corner);
  clip(polygon, spare, along, start + side.length);
  clip(polygon, spare, -1.0 * along, -start);
  clip(polygon, spare, {0, 0, 1}, hull.middle + hull.half);
  clip(polygon, spare, {0, 0, -1}, hull.half - hull.middle);
}

/// Leaves the contacts that carry a face: far apart, and the deepest.
void reduce(std::vector<Touch>& touches, std::vector<Touch>& kept) {
  const auto best = [&](auto&& score) {
    std::size_t at = 0;
    double high = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < touches.size(); ++i) {
      const double value = score(touches[i]);
      if (value > high * (1 + 1e-9) || high == -std::numeric_limits<double>::infinity()) {
        high = value, at = i;
      }
    }
    return at;
  };
  const Vec3 n = touches[0].normal;
  const Vec3 origin = touches[0].point;
  const auto squared = [](Vec3 v) { return dot(v, v); };
  const std::size_t first = best([&](const Touch& t) { return squared(t.point - origin); });
  const Vec3 p = touches[first].point;
  const std::size_t second = best([&](const Touch& t) { return squared(t.point - p); });
  const Vec3 line = cross(n, touches[second].point - p);
  const std::size_t left = best([&](const Touch& t) { return dot(line, t.point - p); });
  const std::size_t right = best([&](const Touch& t) { return -dot(line, t.point - p); });
  const std::size_t deepest = best([](const Touch& t) { return -t.gap; });
  std::size_t chosen[kMaxTouches] = {first, second, left, right, deepest};
  std::sort(chosen, chosen + kMaxTouches);
  const auto* end = std::unique(chosen, chosen + kMaxTouches);
  for (const std::size_t* i = chosen; i != end; ++i) kept.push_back(touches[*i]);
}

void append(std::vector<Touch>& touches, std::vector<Touch>& found) {
  if (touches.size() <= kMaxTouches) {
    found.insert(found.end(), touches.begin(), touches.end());
  } else {
    reduce(touches, found);
  }
}

/// Contacts of the reference hull's face with the other; `flip`: the reference is b.
void touch_face(const Hull& hull, const Place& at, std::size_t face, const Hull& other,
                const Relative& other_in, bool flip, double margin, TouchScratch& scratch,
                std::vector<Touch>& found) {
  const Vec3 normal = face_normal(hull, face);
  const Vec3 facing = into(other_in.axes, normal);
  std::size_t incident = 0;
  double most = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < other.sides.size() + 2; ++i) {
    const double value = dot(facing, face_normal(other, i));
    if (value < most - 1e-9) most = value, incident = i;
  }
  face_polygon(other, incident, other_in, scratch.polygon);
  clip_to_face(hull, face, scratch.polygon, scratch.clipped);
  const double offset = face < hull.sides.size()
                            ? hull.sides[face].offset
                            : hull.half + (face == hull.sides.size() ? hull.middle : -hull.middle);
  const Vec3 outwards = at.axes * normal;
  scratch.touches.clear();
  for (const Vec3& p : scratch.polygon) {
    const double gap = dot(normal, p) - offset;
    if (gap > margin) continue;
    scratch.touches.push_back({at.axes * (p - (gap / 2) * normal) + at.centre,
                               flip ? outwards : -1.0 * outwards, gap,
                               flip ? Touch::Owner::a : Touch::Owner::b});
  }
  append(scratch.touches, found);
}

/// Middle of the shortest connection of two segments that are not parallel.
Vec3 between_edges(const EdgeSupport& a, Vec3 b_from, Vec3 b_to) {
  const Vec3 u = a.to - a.from, v = b_to - b_from, w = a.from - b_from;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const double s = std::clamp((uv * vw - vv * uw) / (uu * vv - uv * uv), 0.0, 1.0);
  const double t = std::clamp((uv * s + vw) / vv, 0.0, 1.0);
  return 0.5 * (a.from + s * u + b_from + t * v);
}

}  // namespace

Hull hull_of(std::span<const Vec2> outline, double half_thickness, Vec3 centroid) {
  if (outline.size() < 3 || !(half_thickness > 0)) {
    throw Error(ErrorCode::geometry,
                "a prism needs at least three corners and a thickness above 0");
  }
  Hull hull;
  hull.middle = -centroid.z;
  hull.half = half_thickness;
  hull.sides.reserve(outline.size());
  const Vec2 shift{centroid.x, centroid.y};
  Vec2 low = outline[0] - shift, high = low;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 a = outline[i] - shift;
    const Vec2 edge = outline[i + 1 == outline.size() ? 0 : i + 1] - outline[i];
    const double long_by = length(edge);
    if (!(long_by > 0)) {
      throw Error(ErrorCode::geometry, "a prism's outline has two equal corners in a row");
    }
    const Vec2 along = (1 / long_by) * edge;
    const Vec2 normal{along.y, -along.x};
    hull.sides.push_back({a, along, normal, dot(normal, a), long_by});
    low = {std::min(low.x, a.x), std::min(low.y, a.y)};
    high = {std::max(high.x, a.x), std::max(high.y, a.y)};
  }
  hull.centre = {(low.x + high.x) / 2, (low.y + high.y) / 2, hull.middle};
  double furthest = 0;
  for (const Hull::Side& side : hull.sides) {
    const Vec2 d = side.corner - Vec2{hull.centre.x, hull.centre.y};
    furthest = std::max(furthest, dot(d, d));
  }
  hull.reach = std::sqrt(furthest + half_thickness * half_thickness);
  return hull;
}

void touch_hulls(const Hull& a, const Place& at_a, const Hull& b, const Place& at_b, double margin,
                 TouchScratch& scratch, std::vector<Touch>& found) {
  const Relative b_in_a = relative(at_a, at_b);
  corners_of(b, b_in_a, scratch.corners_b);
  const Face on_a = best_face(a, scratch.corners_b, margin);
  if (on_a.gap > margin) return;
  const Relative a_in_b = relative(at_b, at_a);
  corners_of(a, a_in_b, scratch.corners_a);
  const Face on_b = best_face(b, scratch.corners_a, margin);
  if (on_b.gap > margin) return;
  const EdgePair edges = best_edges(a, b, b_in_a, margin);
  if (edges.gap > margin) return;
  const double face_gap = std::max(on_a.gap, on_b.gap);
  const auto touch_edges = [&] {
    const auto in_a = [&](Vec3 p) { return b_in_a.axes * p + b_in_a.offset; };
    const Vec3 point = between_edges(edges.a, in_a(edges.b.from), in_a(edges.b.to));
    found.push_back({at_a.axes * point + at_a.centre, at_a.axes * (-1.0 * edges.axis), edges.gap,
                     Touch::Owner::both});
  };
  if (edges.gap > face_gap + kFaceBias) return touch_edges();
  const std::size_t before = found.size();
  if (on_b.gap > on_a.gap + kFaceBias) {
    touch_face(b, at_b, on_b.index, a, a_in_b, true, margin, scratch, found);
  } else {
    touch_face(a, at_a, on_a.index, b, b_in_a, false, margin, scratch, found);
  }
  // The faces miss each other: the nearest features are edges after all.
  if (found.size() == before && edges.gap > face_gap - kFaceBias) touch_edges();
}

void touch_sphere(const Hull& a, const Place& at_a, Vec3 centre, double radius, double margin,
                  std::vector<Touch>& found) {
  const Vec3 p = into(at_a.axes, centre - at_a.centre);
  const Face face = best_face(a, {&p, 1}, radius + margin);
  if (face.gap > radius + margin) return;
  Vec3 nearest = p - face.gap * face_normal(a, face.index);
  double distance = face.gap;
  Vec3 outwards = face_normal(a, face.index);
  if (face.gap > 0) {  // outside: the nearest point of the outline, at the nearest height
    Vec2 at{p.x, p.y};
    double least = std::numeric_limits<double>::infinity();
    bool inside = true;
    for (const Hull::Side& side : a.sides)
      inside &= p.x * side.normal.x + p.y * side.normal.y <= side.offset;
    for (const Hull::Side& side : a.sides) {
      if (inside) break;
      const Vec2 d = Vec2{p.x, p.y} - side.corner;
      const Vec2 foot = side.corner + std::clamp(dot(d, side.along), 0.0, side.length) * side.along;
      const Vec2 off = Vec2{p.x, p.y} - foot;
      if (dot(off, off) < least) least = dot(off, off), at = foot;
    }
    nearest = {at.x, at.y, std::clamp(p.z, a.middle - a.half, a.middle + a.half)};
    const Vec3 off = p - nearest;
    distance = length(off);
    outwards = (1 / distance) * off;
  }
  const double gap = distance - radius;
  if (gap > margin) return;
  found.push_back({at_a.axes * (nearest + (gap / 2) * outwards) + at_a.centre,
                   at_a.axes * (-1.0 * outwards), gap, Touch::Owner::b});
}

void touch_spheres(Vec3 centre_a, double radius_a, Vec3 centre_b, double radius_b, double margin,
                   std::vector<Touch>& found) {
  const Vec3 d = centre_a - centre_b;
  const double distance = length(d);
  const double gap = distance - radius_a - radius_b;
  if (gap > margin) return;
  const Vec3 normal = distance > 0 ? (1 / distance) * d : Vec3{0, 1, 0};
  found.push_back({centre_b + (radius_b + gap / 2) * normal, normal, gap, Touch::Owner::both});
}

void touch_ground(double height, const Hull& b, const Place& at_b, double margin,
                  TouchScratch& scratch, std::vector<Touch>& found) {
  if ((at_b.axes * b.centre + at_b.centre).y - b.reach > height + margin) return;
  corners_of(b, {at_b.axes, at_b.centre}, scratch.corners_b);
  scratch.touches.clear();
  for (const Vec3& corner : scratch.corners_b) {
    const double gap = corner.y - height;
    if (gap > margin) continue;
    scratch.touches.push_back(
        {{corner.x, corner.y - gap / 2, corner.z}, {0, -1, 0}, gap, Touch::Owner::b});
  }
  append(scratch.touches, found);
}

}  // namespace sunder
