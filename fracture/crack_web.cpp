// SPDX-License-Identifier: GPL-3.0-or-later
// Damage polygons after the local damage algorithm of the destructible-frame paper (random corners
// at increasing angles, concave corners filled), with its gaps closed: see narrow_gaps.
#include "fracture/crack_web.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <set>
#include <sstream>
#include <utility>

#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "meshing/triangulate.hpp"
#include "meshing/trig.hpp"

namespace sunder {
namespace {

// Widest angle between neighbouring corners, turns: from half a turn on the polygon would miss its
// impact point, a little below it would pass so close that sectors become slivers.
constexpr double kWidestGap = 0.45;
// Narrowest, as a share of the mean: keeps corners apart on the lattice.
constexpr double kNarrowestGap = 0.05;
// Impacts nearer than this share of min_radius count as one.
constexpr double kSameImpact = 0.02;
// How far a crack that ends on another runs past it, lattice units; far above the rounding of the
// end point, far below what the wall's smallest cell can show.
constexpr double kOvershoot = 4;
// Lattice steps that the smallest feature must have.
constexpr double kSmallestFeature = 256;
// Beyond this a corner's coordinates are not exact in a double.
constexpr double kLargestRadius = 0x1p50;

// Independent random streams of one impact.
enum Stream : std::uint64_t {
  polygon_stream,
  ring_stream,
  start_stream,
  radial_stream,
  stream_count
};

struct Draws {
  std::uint64_t seed, element, next = 0;
  double unit() { return random_unit(seed, element, next++); }
  // Uniform in [low, high).
  double between(double low, double high) { return low + (high - low) * unit(); }
};

using Polygon = std::vector<Vec2>;
using Segment = CrackWeb::Segment;

Vec2 in_lattice(const Lattice& lattice, Vec2 metres) {
  return {(metres.x - lattice.origin.x) / lattice.step.x,
          (metres.y - lattice.origin.y) / lattice.step.y};
}

Vec2 snapped(Vec2 p) {
  return {std::nearbyint(p.x), std::nearbyint(p.y)};
}

LatticePoint as_lattice_point(Vec2 p) {
  return {std::llround(p.x), std::llround(p.y)};
}

// Metres to lattice units; the steps of both axes agree to 2^-20 on all but the longest strips.
double units_per_metre(const Lattice& lattice) {
  return 1 / std::max(lattice.step.x, lattice.step.y);
}

// ---------------------------------------------------------------------------------------------
// Checks

void check_params(const Lattice& lattice, const SpiderwebParams& params) {
  const auto fail = [](ErrorCode code, auto... parts) {
    std::ostringstream message;
    (message << ... << parts);
    throw Error(code, message.str());
  };
  if (params.min_points < 3)
    fail(ErrorCode::input, "min_points = ", params.min_points, " is below 3");
  if (params.max_points < params.min_points)
    fail(ErrorCode::input, "max_points = ", params.max_points,
         " is below min_points = ", params.min_points);
  if (!(params.min_radius > 0) || !(params.max_radius >= params.min_radius))
    fail(ErrorCode::input, "min_radius = ", params.min_radius,
         " and max_radius = ", params.max_radius, " must be positive and in this order");
  if (params.rings < 0 || params.radial < 0)
    fail(ErrorCode::input, "rings = ", params.rings, " and radial = ", params.radial,
         " must not be negative");
  const double smallest = kSmallestFeature / units_per_metre(lattice) *
                          static_cast<double>(params.rings + 1) *
                          static_cast<double>(params.max_points);
  if (params.min_radius < smallest)
    fail(ErrorCode::geometry, "min_radius = ", params.min_radius, " m is too small for a wall of ",
         static_cast<double>(lattice.width) * lattice.step.x, " m x ",
         static_cast<double>(lattice.height) * lattice.step.y, " m with ", params.rings,
         " rings and ", params.max_points, " points; at least ", smallest, " m");
  if (params.max_radius * units_per_metre(lattice) > kLargestRadius)
    fail(ErrorCode::geometry, "max_radius = ", params.max_radius, " m is more than ",
         kLargestRadius / units_per_metre(lattice), " m, far beyond the wall");
}

// The impact on the lattice. One that rounding put just outside the boundary moves onto it.
Vec2 place_impact(const LatticeRegion& region, Vec2 metres) {
  const Vec2 place = snapped(in_lattice(region.lattice, metres));
  const double limit = 2.0 * static_cast<double>(kMaxExtent);
  if (std::abs(place.x) < limit && std::abs(place.y) < limit) {
    const LatticePoint p = as_lattice_point(place);
    if (locate(region, p) >= 0) return place;
    for (std::int64_t dy = -1; dy <= 1; ++dy)
      for (std::int64_t dx = -1; dx <= 1; ++dx)
        if (locate(region, {p.x + dx, p.y + dy}) >= 0)
          return place + Vec2{static_cast<double>(dx), static_cast<double>(dy)};
  }
  std::ostringstream message;
  message << "impact (" << metres.x << ", " << metres.y
          << ") m lies outside the wall or in an opening; it must be on the wall";
  throw Error(ErrorCode::geometry, message.str());
}

// ---------------------------------------------------------------------------------------------
// Damage polygons

// Makes every gap between neighbouring angles (turns, increasing) wide enough and no wider than
// kWidestGap; what a gap loses the free ones share in proportion. True when a gap was half a turn
// or more.
bool narrow_gaps(std::vector<double>& angles) {
  const std::size_t n = angles.size();
  const double least = kNarrowestGap / static_cast<double>(n);
  for (std::size_t i = 1; i < n; ++i) angles[i] = std::max(angles[i], angles[i - 1] + least);
  angles[n - 1] = std::min(angles[n - 1], angles[0] + 1 - least);
  std::vector<double> gaps;
  for (std::size_t i = 0; i + 1 < n; ++i) gaps.push_back(angles[i + 1] - angles[i]);
  gaps.push_back(angles[0] + 1 - angles[n - 1]);
  const double widest = *std::ranges::max_element(gaps);
  if (widest <= kWidestGap) return false;
  // Widening the others may bring one of them to the limit in turn; three at it fill more than a
  // turn, so this ends.
  for (bool changed = true; changed;) {
    double fixed = 0, free = 0;
    for (double& gap : gaps) {
      gap = std::min(gap, kWidestGap);
      (gap == kWidestGap ? fixed : free) += gap;
    }
    changed = false;
    for (double& gap : gaps) {
      if (gap == kWidestGap) continue;
      gap *= (1 - fixed) / free;
      changed |= gap > kWidestGap;
    }
  }
  for (std::size_t i = 1; i < n; ++i) angles[i] = angles[i - 1] + gaps[i - 1];
  return widest >= 0.5;
}

// Corners at increasing angles around the impact, each strictly left of the one before as seen from
// it, exactly.
Polygon draw_polygon(const Lattice& lattice, Vec2 impact, const SpiderwebParams& params,
                     Draws draws, SpiderwebStats& stats) {
  const auto span = static_cast<double>(params.max_points - params.min_points + 1);
  const auto n =
      static_cast<std::size_t>(params.min_points + static_cast<std::int64_t>(draws.unit() * span));
  std::vector<double> angles, radii;
  for (std::size_t i = 0; i < n; ++i) {
    angles.push_back((static_cast<double>(i) + draws.unit() - 0.5) / static_cast<double>(n));
    radii.push_back(draws.between(params.min_radius, params.max_radius));
  }
  stats.draws_repaired += narrow_gaps(angles);
  Polygon corners;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 u = unit_at_turns(angles[i]);
    const Vec2 corner =
        snapped(impact + Vec2{radii[i] * u.x / lattice.step.x, radii[i] * u.y / lattice.step.y});
    if (corners.empty() || orientation(impact, corners.back(), corner) > 0)
      corners.push_back(corner);
  }
  assert(corners.size() >= 3 && orientation(impact, corners.back(), corners.front()) > 0);
  return corners;
}

// The paper's filling of concave corners: a triangle on each until none is left. `diagonals` gets
// the edges the triangles add.
Polygon fill_corners(Polygon polygon, std::vector<Segment>& diagonals, SpiderwebStats& stats) {
  std::size_t at = 0, convex = 0;
  while (convex < polygon.size()) {
    const std::size_t n = polygon.size();
    at %= n;
    const std::size_t before = (at + n - 1) % n, after = (at + 1) % n;
    if (orientation(polygon[before], polygon[at], polygon[after]) >= 0) {
      ++convex;
      ++at;
      continue;
    }
    diagonals.push_back({polygon[before], polygon[after]});
    ++stats.corners_filled;
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(at));
    convex = convex > 2 ? convex - 2 : 0;
    at = (at + polygon.size() - 1) % polygon.size();  // back to the edge before
  }
  return polygon;
}

Polygon convex_hull(Polygon points) {
  const auto before = [](Vec2 a, Vec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  const auto chain = [](const auto first, const auto last) {
    Polygon hull;
    for (auto p = first; p != last; ++p) {
      while (hull.size() >= 2 && orientation(hull[hull.size() - 2], hull.back(), *p) < 0)
        hull.pop_back();
      hull.push_back(*p);
    }
    hull.pop_back();
    return hull;
  };
  Polygon hull = chain(points.begin(), points.end());
  const Polygon upper = chain(points.rbegin(), points.rend());
  hull.insert(hull.end(), upper.begin(), upper.end());
  return hull;
}

bool has_separating_edge(const Polygon& a, const Polygon& b) {
  for (std::size_t k = 0; k < a.size(); ++k) {
    const Vec2 p = a[k], q = a[(k + 1) % a.size()];
    if (std::ranges::all_of(b, [&](Vec2 r) { return orientation(p, q, r) < 0; })) return true;
  }
  return false;
}

// Merges overlapping or touching hulls into convex ones until none do.
void group_zones(CrackWeb& web) {
  struct Group {
    Polygon hull;
    Box box;
    std::vector<std::size_t> members;
  };
  std::vector<Group> groups;
  for (std::size_t k = 0; k < web.zones.size(); ++k)
    groups.push_back({web.zones[k].hull, bounding_box(web.zones[k].hull), {k}});
  const auto overlap = [](const Group& a, const Group& b) {
    return a.box.low.x <= b.box.high.x && b.box.low.x <= a.box.high.x &&
           a.box.low.y <= b.box.high.y && b.box.low.y <= a.box.high.y &&
           !has_separating_edge(a.hull, b.hull) && !has_separating_edge(b.hull, a.hull);
  };
  for (std::size_t i = 0; i < groups.size();) {
    std::size_t j = 0;
    while (j < groups.size() && (j == i || !overlap(groups[i], groups[j]))) ++j;
    if (j == groups.size()) {
      ++i;
      continue;
    }
    Group& a = groups[std::min(i, j)];
    const Group& b = groups[std::max(i, j)];
    a.hull.insert(a.hull.end(), b.hull.begin(), b.hull.end());
    a.hull = convex_hull(std::move(a.hull));
    a.box = bounding_box(a.hull);
    a.members.insert(a.members.end(), b.members.begin(), b.members.end());
    groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(std::max(i, j)));
    i = std::min(i, j);  // the grown hull may reach others now
  }
  for (Group& group : groups) {
    for (const std::size_t k : group.members)
      web.zones[k].group = static_cast<std::uint32_t>(web.hulls.size());
    web.hulls.push_back(std::move(group.hull));
  }
}

// ---------------------------------------------------------------------------------------------
// Cracks

// Part of the line from `a` along `d` as parameters; empty when low >= high.
struct Interval {
  double low, high;
  // Keeps where value + slope * t <= 0.
  void clip(double value, double slope) {
    if (slope > 0)
      high = std::min(high, -value / slope);
    else if (slope < 0)
      low = std::max(low, -value / slope);
    else if (value > 0)
      high = low;
  }
  bool empty() const { return !(low < high); }
};

// Keeps of a + t d what is nearer to `own` than to `other`.
void clip_to_nearer(Interval& part, Vec2 a, Vec2 d, Vec2 own, Vec2 other) {
  const Vec2 axis = other - own, middle = 0.5 * (own + other);
  part.clip(dot(a - middle, axis), dot(d, axis));
}

void clip_to_convex(Interval& part, Vec2 a, Vec2 d, const Polygon& polygon) {
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 edge = polygon[(k + 1) % polygon.size()] - polygon[k];
    part.clip(-cross(edge, a - polygon[k]), -cross(edge, d));
  }
}

class WebBuilder {
 public:
  WebBuilder(const LatticeRegion& region, const SpiderwebParams& params, double spacing,
             std::uint64_t seed, CrackWeb& web)
      : region_(region), params_(params), spacing_(spacing), seed_(seed), web_(web) {
    const double margin =
        0.25 * static_cast<double>(std::max(region.lattice.width, region.lattice.height));
    const auto width = static_cast<double>(region.lattice.width);
    const auto height = static_cast<double>(region.lattice.height);
    frame_ = {{-margin, -margin},
              {width + margin, -margin},
              {width + margin, height + margin},
              {-margin, height + margin}};
    for (std::uint32_t e = 0; e < region.edge_count(); ++e)
      stops_.push_back({corner(e), corner(region.next(e))});
  }

  // Edges of the groups' hulls. Long ones are split, for the triangles beside them; those that more
  // radial cracks start from than the zone has corners are split there.
  void add_hulls() {
    plan_radial_starts();
    for (std::uint32_t group = 0; group < web_.hulls.size(); ++group) {
      const Polygon& hull = web_.hulls[group];
      for (std::size_t k = 0; k < hull.size(); ++k) {
        const Vec2 a = hull[k], b = hull[(k + 1) % hull.size()];
        seen_.insert(key(a, b));
        Polygon between = splits_[group][k];
        const double count = std::min(1e4, std::ceil(length(b - a) / (1.5 * spacing_)));
        for (double i = 1; between.empty() && i < count; ++i)
          between.push_back(a + (i / count) * (b - a));
        between.push_back(b);
        Vec2 from = a;
        for (const Vec2 to : between) add_outer(std::exchange(from, to), to);
      }
    }
  }

  // Sector edges and rings of one zone, its polygon's edges and filled corners.
  void add_zone(std::size_t k, const Polygon& corners, const std::vector<Segment>& diagonals) {
    const std::size_t n = corners.size();
    const std::vector<Polygon> spokes = place_rings(k, corners);
    for (std::size_t i = 0; i < n; ++i) {
      const Polygon& spoke = spokes[i];
      const Polygon& next = spokes[(i + 1) % n];
      for (std::size_t j = 1; j < spoke.size(); ++j) {
        add_clipped(k, spoke[j - 1], spoke[j]);
        add_clipped(k, spoke[j], next[j]);  // the last ring is the polygon itself
      }
    }
    for (const Segment& d : diagonals) add_clipped(k, d.a, d.b);
  }

  // The lines where the zones of a group meet.
  void add_seams() {
    for (std::size_t k = 0; k < web_.zones.size(); ++k)
      for (std::size_t l = k + 1; l < web_.zones.size(); ++l)
        if (web_.zones[k].group == web_.zones[l].group) add_seam(k, l);
  }

  void add_radial_cracks(std::size_t k) {
    Draws draws{seed_, stream_count * k + radial_stream};
    for (const Vec2 start : starts_[k]) run_radial(k, start, draws);
  }

 private:
  static std::array<double, 4> key(Vec2 a, Vec2 b) {
    if (b.x < a.x || (b.x == a.x && b.y < a.y)) std::swap(a, b);
    return {a.x, a.y, b.x, b.y};
  }
  Vec2 corner(std::uint32_t c) const {
    return {static_cast<double>(region_.corners[c].x), static_cast<double>(region_.corners[c].y)};
  }

  // What lies far outside the wall is cut off: coordinates stay near the lattice's.
  void add(Vec2 a, Vec2 b) {
    Interval part{0, 1};
    clip_to_convex(part, a, b - a, frame_);
    if (part.empty()) return;
    const Vec2 from = part.low > 0 ? a + part.low * (b - a) : a;
    const Vec2 to = part.high < 1 ? a + part.high * (b - a) : b;
    if (!(from == to)) web_.cracks.push_back({from, to});
  }
  void add_outer(Vec2 a, Vec2 b) {
    if (a == b) return;
    add(a, b);
    web_.outer_cracks.push_back({a, b});
    stops_.push_back({a, b});
  }
  // Adds what is nearer to impact k than to the others of its group.
  void add_clipped(std::size_t k, Vec2 a, Vec2 b) {
    if (a == b || !seen_.insert(key(a, b)).second) return;
    Interval part{0, 1};
    for (std::size_t l = 0; l < web_.zones.size(); ++l)
      if (l != k && web_.zones[l].group == web_.zones[k].group)
        clip_to_nearer(part, a, b - a, web_.zones[k].impact, web_.zones[l].impact);
    if (!part.empty()) add_part(a, b - a, part, {0, 1});
  }
  // Adds a part of a + t d; an end that is not an end of `whole` runs past by kOvershoot.
  void add_part(Vec2 a, Vec2 d, Interval part, Interval whole) {
    const double more = kOvershoot / length(d);
    add(part.low > whole.low ? a + (part.low - more) * d : a + part.low * d,
        part.high < whole.high ? a + (part.high + more) * d : a + part.high * d);
  }

  // Points on each sector edge from the impact outward: the rings, then the corner. Rings widen
  // outward and waver by a quarter of their distance.
  std::vector<Polygon> place_rings(std::size_t k, const Polygon& corners) const {
    const Vec2 impact = web_.zones[k].impact;
    Draws draws{seed_, stream_count * k + ring_stream};
    std::vector<Polygon> spokes;
    for (const Vec2 c : corners) {
      Polygon& spoke = spokes.emplace_back(Polygon{impact});
      for (std::int64_t j = 1; j <= params_.rings; ++j) {
        const double f = (static_cast<double>(j) + draws.between(-0.25, 0.25)) /
                         static_cast<double>(params_.rings + 1);
        spoke.push_back(snapped(impact + f * (0.6 + 0.4 * f) * (c - impact)));
      }
      spoke.push_back(c);
    }
    return spokes;
  }

  void add_seam(std::size_t k, std::size_t l) {
    const CrackWeb::Zone &own = web_.zones[k], &other = web_.zones[l];
    const Vec2 middle = 0.5 * (own.impact + other.impact), axis = other.impact - own.impact;
    const Vec2 d = (1 / length(axis)) * Vec2{-axis.y, axis.x};
    Interval seam{-kLargestRadius, kLargestRadius};
    for (std::size_t m = 0; m < web_.zones.size(); ++m)
      if (m != k && m != l && web_.zones[m].group == own.group)
        clip_to_nearer(seam, middle, d, own.impact, web_.zones[m].impact);
    Interval first = seam, second = seam;
    clip_to_convex(first, middle, d, own.hull);
    clip_to_convex(second, middle, d, other.hull);
    if (second.empty() || (!first.empty() && second.low < first.low)) std::swap(first, second);
    if (first.empty()) return;
    if (!second.empty() && second.low <= first.high) {  // one crack rather than two on one line
      first.high = std::max(first.high, second.high);
      second.high = second.low;
    }
    const Interval whole{-2 * kLargestRadius, 2 * kLargestRadius};
    add_part(middle, d, first, whole);
    if (!second.empty()) add_part(middle, d, second, whole);
  }

  // Where the radial cracks of each zone leave its group's hull: some of its corners, or all of
  // them and points on its longest edges. A zone that the group covers in part gets its share of
  // cracks.
  void plan_radial_starts() {
    starts_.resize(web_.zones.size());
    splits_.resize(web_.hulls.size());
    for (std::size_t g = 0; g < web_.hulls.size(); ++g) splits_[g].resize(web_.hulls[g].size());
    for (std::size_t k = 0; k < web_.zones.size() && params_.radial > 0; ++k) {
      const CrackWeb::Zone& zone = web_.zones[k];
      const Polygon& hull = web_.hulls[zone.group];
      std::vector<std::size_t> corners;  // of the group's hull that are this zone's
      for (std::size_t c = 0; c < hull.size(); ++c)
        if (std::ranges::find(zone.hull, hull[c]) != zone.hull.end()) corners.push_back(c);
      const std::size_t wanted =
          (static_cast<std::size_t>(params_.radial) * corners.size() + zone.hull.size() / 2) /
          zone.hull.size();
      Draws draws{seed_, stream_count * k + start_stream};
      const double share = static_cast<double>(corners.size()) / static_cast<double>(wanted);
      const double first = draws.unit();
      for (std::size_t i = 0; i < std::min(wanted, corners.size()); ++i)
        starts_[k].push_back(
            hull[corners[share <= 1 ? i
                                    : static_cast<std::size_t>((static_cast<double>(i) + first) *
                                                               share)]]);
      if (wanted > corners.size()) split_edges(k, corners, wanted - corners.size(), draws);
    }
  }
  // Spreads `count` more starts over the edges between two of the zone's corners.
  void split_edges(std::size_t k, const std::vector<std::size_t>& corners, std::size_t count,
                   Draws& draws) {
    const std::uint32_t group = web_.zones[k].group;
    const Polygon& hull = web_.hulls[group];
    std::vector<std::pair<std::size_t, std::size_t>> parts;  // edge and its number of parts
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (corners[(i + 1) % corners.size()] == (corners[i] + 1) % hull.size())
        parts.emplace_back(corners[i], 1);
    if (parts.empty()) return;
    const auto edge = [&](std::size_t e) { return hull[(e + 1) % hull.size()] - hull[e]; };
    const auto part_length = [&](const auto& p) {
      return length(edge(p.first)) / static_cast<double>(p.second);
    };
    for (std::size_t i = 0; i < count; ++i)
      ++std::ranges::max_element(parts, {}, part_length)->second;
    for (const auto& [e, part_count] : parts)
      for (std::size_t i = 1; i < part_count; ++i) {
        const double t =
            (static_cast<double>(i) + draws.between(-0.15, 0.15)) / static_cast<double>(part_count);
        const Vec2 start = hull[e] + t * edge(e);
        splits_[group][e].push_back(start);
        starts_[k].push_back(start);
      }
  }

  // A slightly kinked crack away from the impact, to the first crack or border it meets.
  void run_radial(std::size_t k, Vec2 start, Draws& draws) {
    if (!is_in_region(start)) return;
    const Vec2 out = start - web_.zones[k].impact;
    const double reach = std::min(kLargestRadius, params_.reach * units_per_metre(region_.lattice));
    double left = reach * draws.between(0.6, 1) - length(out);
    Vec2 direction = (1 / length(out)) * out;
    Vec2 at = start;
    for (bool first = true; left > 0.3 * spacing_; first = false) {
      const double step = std::min(left, spacing_ * draws.between(0.5, 0.9));
      const Vec2 kink = unit_at_turns(first ? 0 : draws.between(-0.02, 0.02));
      const Vec2 drift = unit_at_turns(first ? 0 : draws.between(-0.006, 0.006));
      const auto turned = [](Vec2 d, Vec2 by) {
        return Vec2{d.x * by.x - d.y * by.y, d.x * by.y + d.y * by.x};
      };
      direction = turned(direction, drift);
      const Vec2 to = snapped(at + step * turned(direction, kink));
      const double hit = first_stop(at, to);
      if (hit < 1) {
        const Vec2 d = to - at;
        add_outer(at, at + (hit + kOvershoot / length(d)) * d);
        return;
      }
      add_outer(at, to);
      at = to;
      left -= step;
    }
  }
  bool is_in_region(Vec2 p) const {
    const double limit = 2.0 * static_cast<double>(kMaxExtent);
    return std::abs(p.x) < limit && std::abs(p.y) < limit &&
           locate(region_, as_lattice_point(p)) > 0;
  }

  // Parameter of the first crack or border that a → b properly crosses; 1: none.
  double first_stop(Vec2 a, Vec2 b) const {
    double first = 1;
    const double low_x = std::min(a.x, b.x), high_x = std::max(a.x, b.x);
    const double low_y = std::min(a.y, b.y), high_y = std::max(a.y, b.y);
    for (const Segment& s : stops_) {
      if (std::max(s.a.x, s.b.x) < low_x || std::min(s.a.x, s.b.x) > high_x ||
          std::max(s.a.y, s.b.y) < low_y || std::min(s.a.y, s.b.y) > high_y)
        continue;
      if (orientation(s.a, s.b, a) * orientation(s.a, s.b, b) >= 0 ||
          orientation(a, b, s.a) * orientation(a, b, s.b) >= 0)
        continue;
      const Vec2 edge = s.b - s.a;
      first = std::min(first, cross(edge, s.a - a) / cross(edge, b - a));
    }
    return first;
  }

  const LatticeRegion& region_;
  const SpiderwebParams& params_;
  double spacing_;
  std::uint64_t seed_;
  CrackWeb& web_;
  Polygon frame_;
  std::vector<Segment> stops_;                // what radial cracks may not cross
  std::vector<Polygon> starts_;               // of radial cracks, per zone
  std::vector<std::vector<Polygon>> splits_;  // points on the edges of each group's hull
  std::set<std::array<double, 4>> seen_;      // segments already added, by their unclipped ends
};

}  // namespace

bool is_in_convex(const std::vector<Vec2>& polygon, Vec2 point) {
  for (std::size_t k = 0; k < polygon.size(); ++k)
    if (orientation(polygon[k], polygon[(k + 1) % polygon.size()], point) < 0) return false;
  return true;
}

bool is_damaged(const CrackWeb& web, Vec2 point) {
  const CrackWeb::Zone* nearest = nullptr;
  double least = 0;
  for (const CrackWeb::Zone& zone : web.zones) {
    const Vec2 d = point - zone.impact;
    if (nearest && !(dot(d, d) < least)) continue;
    if (!is_in_convex(web.hulls[zone.group], point)) continue;
    nearest = &zone;
    least = dot(d, d);
  }
  return nearest && is_in_convex(nearest->hull, point);
}

CrackWeb plan_cracks(const LatticeRegion& region, const SpiderwebParams& params, double spacing,
                     std::uint64_t seed, SpiderwebStats& stats) {
  check_params(region.lattice, params);
  CrackWeb web;
  const double same = kSameImpact * params.min_radius * units_per_metre(region.lattice);
  for (const Vec2 metres : params.impacts) {
    const Vec2 impact = place_impact(region, metres);
    if (std::ranges::all_of(web.zones,
                            [&](const auto& z) { return length(z.impact - impact) > same; }))
      web.zones.push_back({impact, {}, 0});
  }
  std::vector<Polygon> polygons;
  std::vector<std::vector<Segment>> diagonals(web.zones.size());
  for (std::size_t k = 0; k < web.zones.size(); ++k) {
    const Draws draws{seed, stream_count * k + polygon_stream};
    polygons.push_back(draw_polygon(region.lattice, web.zones[k].impact, params, draws, stats));
    web.zones[k].hull = fill_corners(polygons[k], diagonals[k], stats);
  }
  group_zones(web);
  stats.polygons = static_cast<std::uint32_t>(web.hulls.size());
  WebBuilder builder(region, params, spacing, seed, web);
  builder.add_hulls();
  web.inner_begin = web.cracks.size();
  for (std::size_t k = 0; k < web.zones.size(); ++k) builder.add_zone(k, polygons[k], diagonals[k]);
  builder.add_seams();
  web.radial_begin = web.cracks.size();
  for (std::size_t k = 0; k < web.zones.size(); ++k) builder.add_radial_cracks(k);
  return web;
}

}  // namespace sunder
