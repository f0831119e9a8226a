// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/region.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "meshing/error.hpp"

namespace sunder {
namespace {

std::string text(Vec2 p) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "(%.9g, %.9g)", p.x, p.y);
  return buffer;
}

int sign(Int128 value) {
  return (value > 0) - (value < 0);
}

// Twice the area of (a, b, c), also for doubled coordinates.
int turn(LatticePoint a, LatticePoint b, LatticePoint c) {
  return sign(static_cast<Int128>(b.x - a.x) * (c.y - a.y) -
              static_cast<Int128>(b.y - a.y) * (c.x - a.x));
}

Vec2 to_double(LatticePoint p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y)};
}

bool between(std::int64_t a, std::int64_t value, std::int64_t b) {
  return std::min(a, b) <= value && value <= std::max(a, b);
}

bool on_segment(LatticePoint p, LatticePoint a, LatticePoint b) {
  return turn(a, b, p) == 0 && between(a.x, p.x, b.x) && between(a.y, p.y, b.y);
}

bool cross_properly(LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint d) {
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

bool touch(LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint d) {
  return cross_properly(a, b, c, d) || on_segment(a, c, d) || on_segment(b, c, d) ||
         on_segment(c, a, b) || on_segment(d, a, b);
}

using LatticeLoop = std::vector<LatticePoint>;

const LatticePoint& next(const LatticeLoop& loop, std::size_t i) {
  return loop[i + 1 == loop.size() ? 0 : i + 1];
}

Int128 twice_area(const LatticeLoop& loop) {
  Int128 sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    sum += static_cast<Int128>(cross(loop[i] - loop[0], next(loop, i) - loop[0]));
  return sum;
}

// +1 inside, 0 on the boundary, -1 outside a simple loop; crossing number on exact predicates.
int locate_in(const LatticeLoop& loop, LatticePoint p) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const LatticePoint a = loop[i], b = next(loop, i);
    if (on_segment(p, a, b)) return 0;
    if ((a.y > p.y) != (b.y > p.y) && (turn(a, b, p) > 0) == (b.y > a.y)) inside = !inside;
  }
  return inside ? 1 : -1;
}

LatticeLoop doubled(LatticeLoop loop) {
  for (LatticePoint& p : loop) p = {2 * p.x, 2 * p.y};
  return loop;
}

// How a loop's edges lie to another loop that they do not cross properly. Contacts are then corners
// of one of the two, so between contacts the middle of an edge decides for all of it.
struct EdgesAgainst {
  bool inside = false, outside = false;
  Vec2 at_inside, at_outside;  // doubled lattice coordinates of an example
};
EdgesAgainst compare(const LatticeLoop& loop, const LatticeLoop& other) {
  const LatticeLoop other2 = doubled(other);
  EdgesAgainst result;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const LatticePoint a = loop[i], b = next(loop, i);
    LatticeLoop stops{a, b};
    for (const LatticePoint& c : other)
      if (c != a && c != b && on_segment(c, a, b)) stops.push_back(c);
    std::sort(stops.begin(), stops.end(), [&](LatticePoint p, LatticePoint q) {
      return std::abs(p.x - a.x) + std::abs(p.y - a.y) < std::abs(q.x - a.x) + std::abs(q.y - a.y);
    });
    for (std::size_t s = 0; s + 1 < stops.size(); ++s) {
      const LatticePoint middle = stops[s] + stops[s + 1];
      const int where = locate_in(other2, middle);
      if (where > 0) result.inside = true, result.at_inside = to_double(middle);
      if (where < 0) result.outside = true, result.at_outside = to_double(middle);
    }
  }
  return result;
}

struct NamedLoop {
  std::string name;
  LatticeLoop points;
  Loop places;
};

class RegionCheck {
 public:
  RegionCheck(const Lattice& lattice, const std::string& what) : lattice_(lattice), what_(what) {}

  NamedLoop snap(const Loop& loop, const std::string& name, bool counter_clockwise) const {
    NamedLoop result{name, {}, loop};
    if (loop.size() < 3)
      fail(name + " has " + std::to_string(loop.size()) + " corners, a polygon needs at least 3");
    for (const Vec2& p : loop) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y))
        fail(name + " has a corner that is not finite");
      result.points.push_back(lattice_.nearest(p));
    }
    check_simple(result);
    if (twice_area(result.points) < 0) {
      std::reverse(result.points.begin() + 1, result.points.end());
      std::reverse(result.places.begin() + 1, result.places.end());
    }
    if (!counter_clockwise) {
      std::reverse(result.points.begin() + 1, result.points.end());
      std::reverse(result.places.begin() + 1, result.places.end());
    }
    return result;
  }

  void check_simple(const NamedLoop& loop) const {
    const std::size_t size = loop.points.size();
    for (std::size_t i = 0; i < size; ++i)
      if (loop.points[i] == next(loop.points, i))
        fail(loop.name + " corners " + std::to_string(i) + " and " +
             std::to_string((i + 1) % size) + " are nearer than the wall can resolve, at " +
             text(loop.places[i]));
    for (std::size_t i = 0; i < size; ++i) {
      const LatticePoint a = loop.points[i], b = next(loop.points, i);
      for (std::size_t j = i + 1; j < size; ++j) {
        const LatticePoint c = loop.points[j], d = next(loop.points, j);
        const bool follows = j == i + 1, precedes = i == 0 && j + 1 == size;
        const bool bad = follows && precedes ? false
                         : follows           ? on_segment(d, a, b) || on_segment(a, c, d)
                         : precedes          ? on_segment(c, a, b) || on_segment(b, c, d)
                                             : touch(a, b, c, d);
        if (bad)
          fail(loop.name + " meets itself: edge " + std::to_string(i) + " from " +
               text(loop.places[i]) + " and edge " + std::to_string(j) + " from " +
               text(loop.places[j]) + "; a polygon must be simple");
      }
    }
    if (twice_area(loop.points) == 0) fail(loop.name + " has no area");
  }

  void check_inside(const NamedLoop& opening, const NamedLoop& outline) const {
    check_not_crossing(opening, outline);
    const EdgesAgainst edges = compare(opening.points, outline.points);
    if (edges.outside)
      fail(opening.name + " leaves the outline near " + text(metres(edges.at_outside)) +
           "; an opening may touch the outline but not cross it");
    if (!edges.inside && !compare(outline.points, opening.points).outside)
      fail(opening.name + " leaves nothing of the wall");
  }

  void check_apart(const NamedLoop& a, const NamedLoop& b) const {
    check_not_crossing(a, b);
    const EdgesAgainst first = compare(a.points, b.points), second = compare(b.points, a.points);
    if (first.inside || second.inside || !first.outside)
      fail(a.name + " and " + b.name + " overlap near " +
           text(metres(first.inside    ? first.at_inside
                       : second.inside ? second.at_inside
                                       : to_double(a.points[0] + a.points[0]))) +
           "; openings may touch but not overlap");
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorCode::geometry, what_ + ": " + message);
  }

 private:
  Vec2 metres(Vec2 doubled_point) const { return lattice_.to_metres(0.5 * doubled_point); }

  void check_not_crossing(const NamedLoop& a, const NamedLoop& b) const {
    for (std::size_t i = 0; i < a.points.size(); ++i)
      for (std::size_t j = 0; j < b.points.size(); ++j)
        if (cross_properly(a.points[i], next(a.points, i), b.points[j], next(b.points, j)))
          fail(a.name + " crosses " + b.name + ": edge " + std::to_string(i) + " from " +
               text(a.places[i]) + " and edge " + std::to_string(j) + " from " + text(b.places[j]));
  }

  const Lattice& lattice_;
  const std::string& what_;
};

// Below this part of the region's size what nearly touches is meant to touch: float32 files could
// not tell the gap, and decimals that meet on paper meet this well.
constexpr double kTouch = 0x1p-20;

// Makes corners that nearly meet meet, and puts corners that nearly lie on an edge of another loop
// on it, as a corner of that loop: from here on all contacts are exact.
class Contacts {
 public:
  Contacts(std::vector<NamedLoop>& loops, const Lattice& lattice)
      : loops_(loops),
        reach_(
            std::max(2.0, kTouch * static_cast<double>(std::max(lattice.width, lattice.height)))) {}

  void settle() {
    for (std::size_t later = 1; later < loops_.size(); ++later)
      for (std::size_t earlier = 0; earlier < later; ++earlier)
        move_corners(loops_[later], loops_[earlier]);
    std::vector<NamedLoop> split;
    for (const NamedLoop& loop : loops_) split.push_back(with_corners_of_others(loop));
    loops_ = std::move(split);
  }

 private:
  void move_corners(NamedLoop& loop, const NamedLoop& to) const {
    for (std::size_t i = 0; i < loop.points.size(); ++i)
      for (std::size_t j = 0; j < to.points.size(); ++j) {
        const Vec2 d = to_double(loop.points[i] - to.points[j]);
        if (dot(d, d) > reach_ * reach_) continue;
        loop.points[i] = to.points[j];
        loop.places[i] = to.places[j];
      }
  }

  NamedLoop with_corners_of_others(const NamedLoop& loop) const {
    struct Stop {
      double along;
      LatticePoint point;
      Vec2 place;
    };
    NamedLoop result{loop.name, {}, {}};
    for (std::size_t i = 0; i < loop.points.size(); ++i) {
      const LatticePoint a = loop.points[i];
      const Vec2 edge = to_double(next(loop.points, i) - a);
      std::vector<Stop> stops;
      for (const NamedLoop& other : loops_)
        for (std::size_t j = 0; &other != &loop && j < other.points.size(); ++j) {
          const Vec2 d = to_double(other.points[j] - a);
          const double along = dot(d, edge), off = cross(edge, d), square = dot(edge, edge);
          const bool near = off != 0 && off * off <= reach_ * reach_ * square;
          if (near && along > 0 && along < square && other.points[j] != next(loop.points, i))
            stops.push_back({along, other.points[j], other.places[j]});
        }
      std::ranges::sort(stops, {},
                        [](const Stop& stop) { return std::tuple(stop.along, stop.point); });
      result.points.push_back(a);
      result.places.push_back(loop.places[i]);
      for (const Stop& stop : stops) {
        if (stop.point == result.points.back()) continue;
        result.points.push_back(stop.point);
        result.places.push_back(stop.place);
      }
    }
    return result;
  }

  std::vector<NamedLoop>& loops_;
  double reach_;  // lattice units
};

}  // namespace

Loop rectangle(Vec2 size, Vec2 at) {
  return {at, {at.x + size.x, at.y}, at + size, {at.x, at.y + size.y}};
}

double area(std::span<const Vec2> loop) {
  double sum = 0;
  for (std::size_t i = 2; i < loop.size(); ++i)
    sum += cross(loop[i - 1] - loop[0], loop[i] - loop[0]);
  return sum / 2;
}

double area(const Region& region) {
  double sum = std::abs(area(std::span(region.outline)));
  for (const Loop& opening : region.openings) sum -= std::abs(area(std::span(opening)));
  return sum;
}

Box bounding_box(std::span<const Vec2> loop) {
  assert(!loop.empty());
  Box box{loop[0], loop[0]};
  for (const Vec2& p : loop) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
  }
  return box;
}

std::uint32_t LatticeRegion::loop_of(std::uint32_t corner) const {
  const auto after = std::upper_bound(loop_begin.begin(), loop_begin.end(), corner);
  return static_cast<std::uint32_t>(after - loop_begin.begin()) - 1;
}

std::uint32_t LatticeRegion::next(std::uint32_t corner) const {
  const std::uint32_t loop = loop_of(corner);
  return corner + 1 == loop_begin[loop + 1] ? loop_begin[loop] : corner + 1;
}

bool LatticeRegion::is_box() const {
  if (edge_count() != 4) return false;
  const LatticePoint far{lattice.width, lattice.height};
  return corners[0] == LatticePoint{} && corners[1] == LatticePoint{far.x, 0} &&
         corners[2] == far && corners[3] == LatticePoint{0, far.y};
}

LatticeRegion make_lattice_region(const Region& region, const Lattice& lattice,
                                  const std::string& what) {
  const RegionCheck check(lattice, what);
  std::size_t corners = region.outline.size();
  for (const Loop& opening : region.openings) corners += opening.size();
  if (corners > kMaxCorners)
    check.fail("outline and openings have " + std::to_string(corners) + " corners, at most " +
               std::to_string(kMaxCorners) + " are possible");
  std::vector<NamedLoop> loops{check.snap(region.outline, "the outline", true)};
  // A corner beyond the box by less than a lattice step is on it: 0.1 + 0.2 is above 0.3.
  const Box exact = bounding_box(region.outline);
  const Box box{exact.low - lattice.step, exact.high + lattice.step};
  for (std::size_t i = 0; i < region.openings.size(); ++i) {
    loops.push_back(check.snap(region.openings[i], "opening " + std::to_string(i), false));
    for (const Vec2& p : region.openings[i])
      if (p.x < box.low.x || p.y < box.low.y || p.x > box.high.x || p.y > box.high.y)
        check.fail("opening " + std::to_string(i) + " has a corner at " + text(p) +
                   " outside the outline; an opening may touch the outline but not cross it");
  }
  if (loops.size() > 1) Contacts(loops, lattice).settle();
  for (std::size_t i = 1; i < loops.size(); ++i) {
    check.check_simple(loops[i]);
    for (std::size_t j = 1; j < i; ++j) check.check_apart(loops[j], loops[i]);
    check.check_inside(loops[i], loops[0]);
  }
  LatticeRegion result{lattice, {}, {}, {0}};
  Int128 left = 0;
  for (NamedLoop& loop : loops) {
    for (Vec2& p : loop.places)
      p = {std::clamp(p.x, exact.low.x, exact.high.x), std::clamp(p.y, exact.low.y, exact.high.y)};
    result.corners.insert(result.corners.end(), loop.points.begin(), loop.points.end());
    result.places.insert(result.places.end(), loop.places.begin(), loop.places.end());
    result.loop_begin.push_back(result.edge_count());
    left += twice_area(loop.points);
  }
  if (left <= 0) check.fail("the openings leave nothing of the wall");
  return result;
}

double area(const LatticeRegion& region) {
  double sum = 0;
  for (std::uint32_t l = 0; l < region.loop_count(); ++l)
    sum +=
        area(std::span(region.places)
                 .subspan(region.loop_begin[l], region.loop_begin[l + 1] - region.loop_begin[l]));
  return sum;
}

int locate(const LatticeRegion& region, LatticePoint point) {
  int where = 1;
  for (std::uint32_t l = 0; l < region.loop_count(); ++l) {
    const LatticeLoop loop(region.corners.begin() + region.loop_begin[l],
                           region.corners.begin() + region.loop_begin[l + 1]);
    const int side = l == 0 ? locate_in(loop, point) : -locate_in(loop, point);
    if (side == 0) return 0;
    where = std::min(where, side);
  }
  return where;
}

}  // namespace sunder
