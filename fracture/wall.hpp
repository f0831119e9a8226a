// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "fracture/spiderweb.hpp"
#include "meshing/field.hpp"
#include "meshing/region.hpp"
#include "meshing/vec.hpp"

namespace sunder {

/// One site per grid cell of about `cell` metres.
struct VoronoiGridParams {
  double cell = 0.3;
  double jitter = 1.0;
};
/// Sites given by hand, wall coordinates in metres.
struct VoronoiSitesParams {
  std::vector<Vec2> sites;
};
/// Independent uniform sites.
struct VoronoiRandomParams {
  std::int64_t count = 200;
};
/// Sites denser around the given points.
struct VoronoiFocusParams {
  std::vector<Vec2> points;
  std::int64_t count = 200;
  double radius = 1.0;
  double share = 0.7;
};
/// Jittered grid points joined to their cardinal neighbours.
struct QuadGridParams {
  double cell = 0.3;
  double jitter = 0.7;
};

/// The generators, by the `type` a scene names them with (see pattern_type).
using PatternParams = std::variant<VoronoiGridParams, VoronoiSitesParams, VoronoiRandomParams,
                                   VoronoiFocusParams, QuadGridParams, SpiderwebParams>;

/// Scene name of a generator: "voronoi-grid", "voronoi-sites", "voronoi-random", "voronoi-focus",
/// "quad-grid", "spiderweb"; in the order of PatternParams.
inline constexpr std::string_view kPatternTypes[] = {
    "voronoi-grid", "voronoi-sites", "voronoi-random", "voronoi-focus", "quad-grid", "spiderweb"};

/// Unit quaternion.
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
  friend bool operator==(const Quaternion&, const Quaternion&) = default;
};

/// Turns about the x, then the y, then the z axis (fixed axes), each in degrees; exact at multiples
/// of 90°, the same bits on every machine.
Quaternion rotation_from_degrees(Vec3 degrees);
/// The vector turned by a unit quaternion.
Vec3 rotate(const Quaternion& rotation, Vec3 vector);

/// A wall as a scene describes it. It lies in its local XY plane, thickness along z centred on z =
/// 0. SI units.
struct Wall {
  std::string name = "wall";
  Region region{rectangle({6, 3}), {}};
  double thickness = 0.2;
  std::string material = "concrete-c30";
  PatternParams pattern = VoronoiGridParams{};
  /// Cells whose area is below min_cell² are merged into the neighbour with the longest common
  /// edge; m. Below 0: a tenth of the generator's cell size.
  double min_cell = -1;
  std::vector<std::string> anchors;  ///< sides held by the world: bottom, left, right, top
  Vec3 position;
  Quaternion rotation;
  /// A file that `sunder fracture` wrote, instead of outline and pattern; empty: none.
  std::string asset;
};

/// The same wall in the same place with its local origin at the lower left of its outline's
/// bounding box: what is far from a polygon's origin keeps its digits in float32 files.
Wall with_local_origin(Wall wall);

template <>
std::span<const Field<VoronoiGridParams>> fields();
template <>
std::span<const Field<VoronoiSitesParams>> fields();
template <>
std::span<const Field<VoronoiRandomParams>> fields();
template <>
std::span<const Field<VoronoiFocusParams>> fields();
template <>
std::span<const Field<QuadGridParams>> fields();
template <>
std::span<const Field<SpiderwebParams>> fields();
/// The plain keys of a wall (name, thickness, material, min_cell, anchors, asset).
template <>
std::span<const Field<Wall>> fields();

}  // namespace sunder
