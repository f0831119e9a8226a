// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/wall.hpp"

#include <array>
#include <cmath>

#include "fracture/sites.hpp"
#include "meshing/trig.hpp"

namespace sunder {
namespace {

constexpr Range kCell{1e-6, 1e4};        // m
constexpr Range kJitter{0, 1};           // share of a cell
constexpr Range kCount{1, kMaxCells};    // cells
constexpr Range kCoordinate{-1e6, 1e6};  // m
constexpr Range kRadius{1e-6, 1e6};      // m
constexpr Range kThickness{1e-9, 1e4};   // m
constexpr Range kMinCell{0, 1e4};        // m

constexpr std::string_view kSides[] = {"bottom", "left", "right", "top"};

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
      a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

bool is_quarter_turns(double degrees) {
  return std::remainder(degrees, 90.0) == 0;
}

/// Rotations that map the axes onto the axes have quaternions of 0, 1/2, sqrt(1/2) and 1 only.
double snapped(double component) {
  for (const double exact : {0.0, 0.5, std::sqrt(0.5), 1.0}) {
    if (std::abs(std::abs(component) - exact) < 1e-9) return std::copysign(exact, component);
  }
  return component;
}

/// Of the two quaternions of a rotation the one whose last component that is not 0 is positive.
Quaternion canonical(Quaternion q) {
  const std::array<double, 4> parts{q.w, q.z, q.y, q.x};
  double sign = 1;
  for (const double part : parts) {
    if (part == 0) continue;
    sign = part < 0 ? -1 : 1;
    break;
  }
  // + 0.0 turns a negative zero into zero.
  return {sign * q.x + 0.0, sign * q.y + 0.0, sign * q.z + 0.0, sign * q.w + 0.0};
}

}  // namespace

Quaternion rotation_from_degrees(Vec3 degrees) {
  // A quaternion turns by twice its angle; whole double turns are taken off before anything rounds.
  const auto half_angle = [](double angle) { return unit_at_turns(std::fmod(angle, 720.0) / 720); };
  const Vec2 x = half_angle(degrees.x), y = half_angle(degrees.y), z = half_angle(degrees.z);
  Quaternion q = product({0, 0, z.y, z.x}, product({0, y.y, 0, y.x}, {x.y, 0, 0, x.x}));
  if (is_quarter_turns(degrees.x) && is_quarter_turns(degrees.y) && is_quarter_turns(degrees.z)) {
    q = {snapped(q.x), snapped(q.y), snapped(q.z), snapped(q.w)};
  }
  return canonical(q);
}

Vec3 rotate(const Quaternion& rotation, Vec3 vector) {
  const Vec3 axis{rotation.x, rotation.y, rotation.z};
  const Vec3 twice = 2.0 * cross(axis, vector);
  return vector + rotation.w * twice + cross(axis, twice);
}

Wall with_local_origin(Wall wall) {
  if (wall.region.outline.empty()) return wall;
  const Vec2 low = bounding_box(wall.region.outline).low;
  if (low == Vec2{}) return wall;
  const auto move = [&](std::vector<Vec2>& points) {
    for (Vec2& p : points) p = p - low;
  };
  move(wall.region.outline);
  for (Loop& opening : wall.region.openings) move(opening);
  if (auto* sites = std::get_if<VoronoiSitesParams>(&wall.pattern)) move(sites->sites);
  if (auto* focus = std::get_if<VoronoiFocusParams>(&wall.pattern)) move(focus->points);
  if (auto* web = std::get_if<SpiderwebParams>(&wall.pattern)) move(web->impacts);
  wall.position = wall.position + rotate(wall.rotation, {low.x, low.y, 0});
  return wall;
}

template <>
std::span<const Field<VoronoiGridParams>> fields() {
  using P = VoronoiGridParams;
  static const Field<P> table[] = {
      {"cell", &P::cell, "m", "Size of the grid cells; each holds one site.", kCell},
      {"jitter", &P::jitter, "", "Part of its grid cell a site may lie in; 0 is the centre.",
       kJitter},
  };
  return table;
}

template <>
std::span<const Field<VoronoiSitesParams>> fields() {
  using P = VoronoiSitesParams;
  static const Field<P> table[] = {
      {.name = "sites",
       .member = &P::sites,
       .unit = "m",
       .effect = "The sites, each inside the box around the wall.",
       .range = kCoordinate,
       .required = true},
  };
  return table;
}

template <>
std::span<const Field<VoronoiRandomParams>> fields() {
  using P = VoronoiRandomParams;
  static const Field<P> table[] = {
      {"count", &P::count, "", "Sites, drawn uniformly over the box around the wall.", kCount},
  };
  return table;
}

template <>
std::span<const Field<VoronoiFocusParams>> fields() {
  using P = VoronoiFocusParams;
  static const Field<P> table[] = {
      {.name = "points",
       .member = &P::points,
       .unit = "m",
       .effect = "Focus points, around which sites lie denser.",
       .range = kCoordinate,
       .required = true},
      {"count", &P::count, "", "Sites in all.", kCount},
      {"radius", &P::radius, "m", "How far around a focus point its sites reach.", kRadius},
      {"share",
       &P::share,
       "",
       "Part of the sites drawn around focus points; the rest is uniform.",
       {0, 1}},
  };
  return table;
}

template <>
std::span<const Field<QuadGridParams>> fields() {
  using P = QuadGridParams;
  static const Field<P> table[] = {
      {"cell", &P::cell, "m", "Size of the grid cells; each becomes one quad.", kCell},
      {"jitter", &P::jitter, "", "How far a grid point may move, in half cells.", kJitter},
  };
  return table;
}

template <>
std::span<const Field<SpiderwebParams>> fields() {
  using P = SpiderwebParams;
  static const Field<P> table[] = {
      {"impacts", &P::impacts, "m",
       "Impact points inside the wall, each the centre of a damage polygon; `sunder impact` adds "
       "those of its hits.",
       kCoordinate},
      {"min_points", &P::min_points, "", "Fewest corners of a damage polygon.", {3, 1000}},
      {"max_points",
       &P::max_points,
       "",
       "Most corners of a damage polygon, at least min_points.",
       {3, 1000}},
      {"min_radius", &P::min_radius, "m", "Least distance of a corner from the impact point.",
       kRadius},
      {"max_radius", &P::max_radius, "m",
       "Largest distance of a corner from the impact point, at least min_radius.", kRadius},
      {"rings", &P::rings, "", "Ring cracks inside the damage polygon.", {0, 100}},
      {"radial", &P::radial, "", "Radial cracks that run on from the damage polygon.", {0, 1000}},
      {"reach", &P::reach, "m", "How far radial cracks run from the impact point.", kRadius},
      {"rest_cell", &P::rest_cell, "m", "Size of the cells outside the damage.", kCell},
  };
  return table;
}

template <>
std::span<const Field<Wall>> fields() {
  using P = Wall;
  static const Field<P> table[] = {
      {"name", &P::name, "",
       "Begins the names of its chunks; letters, digits, _ and - only, at most 40, unlike every "
       "other wall's. Left out: wall, wall_2, wall_3 …"},
      {"thickness", &P::thickness, "m", "Along z, half of it on either side of z = 0.", kThickness},
      {"material", &P::material, "", "A built-in material or one of the scene's materials."},
      {"min_cell", &P::min_cell, "m",
       "A cell of less area than min_cell² is merged into the neighbour with which it shares the "
       "longest edge. Left out: a tenth of the pattern's cell size.",
       kMinCell},
      {.name = "anchors",
       .member = &P::anchors,
       .unit = "",
       .effect = "Sides of the outline that the world holds.",
       .choices = kSides},
      {"asset", &P::asset, "",
       "A file that `sunder fracture` wrote, relative to the scene and inside its folder, instead "
       "of outline, openings and pattern."},
  };
  return table;
}

}  // namespace sunder
