// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/rigid_body.hpp"

#include <algorithm>
#include <cmath>

namespace sunder {
namespace {

constexpr std::size_t kManyHulls = 8;  // from here on a tree beats a loop

Vec3 least(Vec3 a, Vec3 b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
Vec3 most(Vec3 a, Vec3 b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
Vec3 magnitudes(Vec3 v) {
  return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)};
}

Box3 hull_box(const Hull& hull, const Place& at) {
  const Vec3 middle = at.centre + hull.middle * at.axes.z;
  const Vec3 depth = hull.half * magnitudes(at.axes.z);
  Box3 box;
  bool first = true;
  for (const Hull::Side& side : hull.sides) {
    const Vec3 p = middle + side.corner.x * at.axes.x + side.corner.y * at.axes.y;
    box = first ? Box3{p, p} : Box3{least(box.low, p), most(box.high, p)};
    first = false;
  }
  return {box.low - depth, box.high + depth};
}

Box3 merged(const Box3& a, const Box3& b) {
  return {least(a.low, b.low), most(a.high, b.high)};
}

/// Numbers of a's hulls that may come near a ball (a's frame), ascending.
void hulls_near(const Shape& shape, Vec3 centre, double radius, std::vector<std::uint32_t>& near) {
  near.clear();
  if (shape.tree) {
    shape.tree->find(grown({centre, centre}, radius), near);
    std::sort(near.begin(), near.end());
    return;
  }
  for (std::uint32_t i = 0; i < shape.hulls.size(); ++i) {
    const Vec3 d = shape.hulls[i].centre - centre;
    const double reach = shape.hulls[i].reach + radius;
    if (dot(d, d) <= reach * reach) near.push_back(i);
  }
}

/// Calls `visit(i, j)` for hulls of `few` and `many` whose bounding spheres are nearer than margin.
template <typename Visit>
void for_near_hulls(const Shape& few, const Place& at_few, const Shape& many, const Place& at_many,
                    double margin, Visit&& visit) {
  std::vector<std::uint32_t> near;
  for (std::uint32_t i = 0; i < few.hulls.size(); ++i) {
    const Vec3 world = at_few.axes * few.hulls[i].centre + at_few.centre;
    const Vec3 centre = into(at_many.axes, world - at_many.centre);
    if (!overlap(grown({centre, centre}, few.hulls[i].reach + margin), many.box)) continue;
    hulls_near(many, centre, few.hulls[i].reach + margin, near);
    for (const std::uint32_t j : near) visit(i, j);
  }
}

void touch_with_ground(const Place& at_ground, const Shape& b, const Place& at_b, double margin,
                       TouchScratch& scratch, std::vector<PartTouch>& found) {
  const double height = at_ground.centre.y;
  if (b.radius > 0) {
    const double gap = at_b.centre.y - b.radius - height;
    if (gap > margin) return;
    const Vec3 point{at_b.centre.x, height + gap / 2, at_b.centre.z};
    found.push_back({{point, {0, -1, 0}, gap, Touch::Owner::b}, 0, 0});
    return;
  }
  std::vector<Touch> touches;
  for (std::uint32_t i = 0; i < b.hulls.size(); ++i) {
    touches.clear();
    touch_ground(height, b.hulls[i], at_b, margin, scratch, touches);
    for (const Touch& touch : touches) found.push_back({touch, 0, i});
  }
}

void touch_with_sphere(const Shape& a, const Place& at_a, const Shape& sphere,
                       const Place& at_sphere, double margin, std::vector<PartTouch>& found) {
  std::vector<std::uint32_t> near;
  const Vec3 centre = into(at_a.axes, at_sphere.centre - at_a.centre);
  hulls_near(a, centre, sphere.radius + margin, near);
  std::vector<Touch> touches;
  for (const std::uint32_t i : near) {
    touches.clear();
    touch_sphere(a.hulls[i], at_a, at_sphere.centre, sphere.radius, margin, touches);
    for (const Touch& touch : touches) found.push_back({touch, i, 0});
  }
}

void touch_prisms(const Shape& a, const Place& at_a, const Shape& b, const Place& at_b,
                  double margin, TouchScratch& scratch, std::vector<PartTouch>& found) {
  std::vector<Touch> touches;
  const auto visit = [&](std::uint32_t i, std::uint32_t j) {
    touches.clear();
    touch_hulls(a.hulls[i], at_a, b.hulls[j], at_b, margin, scratch, touches);
    for (const Touch& touch : touches) found.push_back({touch, i, j});
  };
  if (a.hulls.size() > b.hulls.size()) {
    for_near_hulls(b, at_b, a, at_a, margin, [&](auto j, auto i) { visit(i, j); });
  } else {
    for_near_hulls(a, at_a, b, at_b, margin, visit);
  }
}

void turn_round(std::vector<PartTouch>& found, std::size_t from) {
  for (std::size_t i = from; i < found.size(); ++i) {
    Touch& touch = found[i].touch;
    touch.normal = -1.0 * touch.normal;
    if (touch.owner != Touch::Owner::both) {
      touch.owner = touch.owner == Touch::Owner::a ? Touch::Owner::b : Touch::Owner::a;
    }
    std::swap(found[i].part_a, found[i].part_b);
  }
}

}  // namespace

Shape shape_of(std::span<const Prism> parts, Vec3 centroid) {
  Shape shape;
  shape.hulls.reserve(parts.size());
  if (parts.size() > kManyHulls) shape.tree = std::make_unique<BoxTree>();
  for (const Prism& part : parts) {
    const Hull hull = hull_of(part.outline, part.half_thickness, centroid);
    const Box3 box = hull_box(hull, {});
    shape.box = shape.hulls.empty() ? box : merged(shape.box, box);
    if (shape.tree) shape.tree->insert(box, static_cast<std::uint32_t>(shape.hulls.size()));
    shape.reach = std::max(shape.reach, length(hull.centre) + hull.reach);
    shape.hulls.push_back(hull);
  }
  return shape;
}

Box3 world_box(const Shape& shape, const Place& at) {
  if (shape.radius > 0) return grown({at.centre, at.centre}, shape.radius);
  if (shape.hulls.size() == 1) return hull_box(shape.hulls[0], at);
  const Vec3 middle = at.axes * (0.5 * (shape.box.low + shape.box.high)) + at.centre;
  const Vec3 half = 0.5 * (shape.box.high - shape.box.low);
  const Vec3 around = half.x * magnitudes(at.axes.x) + half.y * magnitudes(at.axes.y) +
                      half.z * magnitudes(at.axes.z);
  return {middle - around, middle + around};
}

Box3 tight_box(const Shape& shape, const Place& at) {
  if (shape.hulls.empty()) return world_box(shape, at);
  Box3 box = hull_box(shape.hulls[0], at);
  for (const Hull& hull : shape.hulls) box = merged(box, hull_box(hull, at));
  return box;
}

void touch_shapes(const Shape& a, const Place& at_a, const Shape& b, const Place& at_b,
                  double margin, TouchScratch& scratch, std::vector<PartTouch>& found) {
  const std::size_t from = found.size();
  if (a.is_ground) {
    touch_with_ground(at_a, b, at_b, margin, scratch, found);
  } else if (b.is_ground) {
    touch_with_ground(at_b, a, at_a, margin, scratch, found);
    turn_round(found, from);
  } else if (a.radius > 0 && b.radius > 0) {
    std::vector<Touch> touches;
    touch_spheres(at_a.centre, a.radius, at_b.centre, b.radius, margin, touches);
    for (const Touch& touch : touches) found.push_back({touch, 0, 0});
  } else if (b.radius > 0) {
    touch_with_sphere(a, at_a, b, at_b, margin, found);
  } else if (a.radius > 0) {
    touch_with_sphere(b, at_b, a, at_a, margin, found);
    turn_round(found, from);
  } else {
    touch_prisms(a, at_a, b, at_b, margin, scratch, found);
  }
  std::stable_sort(found.begin() + static_cast<std::ptrdiff_t>(from), found.end(),
                   [](const PartTouch& x, const PartTouch& y) {
                     return x.part_a != y.part_a ? x.part_a < y.part_a : x.part_b < y.part_b;
                   });
}

}  // namespace sunder
