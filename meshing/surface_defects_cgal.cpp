// SPDX-License-Identifier: GPL-3.0-or-later
// The decisions of a surface's diagnosis, by CGAL's exact predicates.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Intersections_3/Segment_3_Triangle_3.h>
#include <CGAL/Intersections_3/Triangle_3_Triangle_3.h>

#include <algorithm>

#include "meshing/surface_predicates.hpp"

namespace sunder {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

Point point(Vec3 p) {
  return {p.x, p.y, p.z};
}

// On which side of the plane of t both points strictly lie; 0 if they do not lie on one side.
int common_side(const std::array<Point, 3>& t, const Point& p, const Point& q) {
  const int a = CGAL::orientation(t[0], t[1], t[2], p);
  return a != 0 && CGAL::orientation(t[0], t[1], t[2], q) == a ? a : 0;
}

bool meets(const std::array<Point, 3>& t, const Point& p, const Point& q) {
  return CGAL::do_intersect(Kernel::Triangle_3(t[0], t[1], t[2]), Kernel::Segment_3(p, q));
}

// The corners turned so that the one at `first` comes first.
std::array<Point, 3> turned(std::span<const Vec3> v, const Corners& t, std::uint32_t first) {
  return {point(v[t[first]]), point(v[t[(first + 1) % 3]]), point(v[t[(first + 2) % 3]])};
}

// Triangles with one common corner, which comes first in both.
bool meet_at_corner(const std::array<Point, 3>& a, const std::array<Point, 3>& b) {
  if (common_side(a, b[1], b[2]) != 0 || common_side(b, a[1], a[2]) != 0) return false;
  return meets(a, b[1], b[2]) || meets(b, a[1], a[2]);
}

// Triangles with a common edge pq and their third corners.
bool fold_over(const Point& p, const Point& q, const Point& a, const Point& b) {
  return CGAL::orientation(p, q, a, b) == 0 &&
         CGAL::coplanar_orientation(p, q, a, b) == CGAL::POSITIVE;
}

// Sign of (b - a) × (p - a) in the yz plane with p moved by (e, e²).
int side_in_yz(Vec3 a, Vec3 b, Vec3 p) {
  const int side = CGAL::orientation(Kernel::Point_2(a.y, a.z), Kernel::Point_2(b.y, b.z),
                                     Kernel::Point_2(p.y, p.z));
  if (side != 0) return side;
  if (a.z != b.z) return b.z < a.z ? 1 : -1;
  return b.y > a.y ? 1 : b.y < a.y ? -1 : 0;
}

}  // namespace

bool is_flat(Vec3 a, Vec3 b, Vec3 c) {
  return CGAL::collinear(point(a), point(b), point(c));
}

bool meet_apart(std::span<const Vec3> v, const Corners& a, const Corners& b) {
  std::uint32_t shared = 0, in_a = 0, in_b = 0;  // where the last shared corner is
  std::uint32_t free_a = 3, free_b = 3;          // sums of indices that are not shared
  for (std::uint32_t i = 0; i < 3; ++i)
    for (std::uint32_t k = 0; k < 3; ++k)
      if (a[i] == b[k]) {
        ++shared;
        in_a = i;
        in_b = k;
        free_a -= i;
        free_b -= k;
      }
  if (shared == 2)
    return fold_over(point(v[a[(free_a + 1) % 3]]), point(v[a[(free_a + 2) % 3]]),
                     point(v[a[free_a]]), point(v[b[free_b]]));
  if (shared == 1) return meet_at_corner(turned(v, a, in_a), turned(v, b, in_b));
  const auto t = turned(v, a, 0), u = turned(v, b, 0);
  const int side = common_side(t, u[0], u[1]);
  if (side != 0 && common_side(t, u[1], u[2]) == side) return false;
  return CGAL::do_intersect(Kernel::Triangle_3(t[0], t[1], t[2]),
                            Kernel::Triangle_3(u[0], u[1], u[2]));
}

int crossing(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  if (std::max({a.x, b.x, c.x}) < p.x) return 0;
  const int side = side_in_yz(a, b, p);
  if (side == 0 || side_in_yz(b, c, p) != side || side_in_yz(c, a, p) != side) return 0;
  // In front of the plane for the ray if p is behind it as seen along x.
  const int above = CGAL::orientation(point(a), point(b), point(c), point(p));
  return above == -side ? side : 0;
}

}  // namespace sunder
