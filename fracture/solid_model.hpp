// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "fracture/wall.hpp"
#include "meshing/field.hpp"
#include "meshing/repair.hpp"

namespace sunder {

/// 3D Voronoi cells of sites that are uniform in the solid, or denser around points, or given.
struct SolidVoronoiParams {
  std::int64_t count = 100;
  std::vector<Vec3> points;  ///< that cells are denser around; empty: uniform
  double radius = 0.5;       ///< m, around the points
  double share = 0.7;        ///< of the sites that are drawn around a point
  std::vector<Vec3> sites;   ///< given: no others are drawn
};
/// Parallel slices along each axis, offsets and directions varied; wavy where `amplitude` > 0.
struct SolidSlicesParams {
  Vec3 slices{3, 3, 3};         ///< cuts along x, y, z; whole numbers
  double offset_variation = 0;  ///< of the distance between cuts, 0 … 1
  double angle_variation = 0;   ///< rad, most; degrees in its table
  double amplitude = 0;         ///< m, of waves
  double wavelength = 0.5;      ///< m
};
/// Rays and rings about an axis, as glass or a blow has them.
struct SolidRadialParams {
  Vec3 centre, axis{0, 0, 1};
  std::int64_t rays = 12, rings = 4;
  double radius = 1;         ///< m, of the outermost ring
  double variability = 0.3;  ///< 0 … 1
};
/// Courses of bricks along y, each moved by `offset` of a brick's length against the one below.
struct SolidBrickParams {
  Vec3 brick{0.24, 0.071, 0.115};  ///< m: length (x), height (y), depth (z), without mortar
  double offset = 0.5;             ///< of a brick's length with its mortar
  double mortar = 0;               ///< m, thickness of joints; 0: bricks touch
};
using SolidPatternParams =
    std::variant<SolidVoronoiParams, SolidSlicesParams, SolidRadialParams, SolidBrickParams>;
/// Scene and command-line names, in the order of SolidPatternParams.
inline constexpr std::string_view kSolidPatternTypes[] = {"voronoi", "slices", "radial", "brick"};

/// A mesh that is fractured as a whole.
struct SolidModel {
  std::string name = "solid";
  std::string file;  ///< the model
  std::string material = "concrete-c30";
  SolidPatternParams pattern = SolidVoronoiParams{};
  double roughness = 0;       ///< m, how far inner faces stray from their planes
  double roughness_size = 0;  ///< m, of the bumps; 0: half a chunk's size
  double uv_scale = 1;        ///< inner faces: metres per unit of texture
  double scale = 1;           ///< of the model's coordinates to metres
  bool repair = false;
  double max_error = 0;  ///< m, of repair and craters
  /// Craters, one after the other. With a depth and without a direction (0, 0, 0) a crater goes
  /// against the normal of the face that is nearest to its centre.
  std::vector<CarveParams> craters;
  Vec3 position;
  Quaternion rotation;
};

template <>
std::span<const Field<SolidVoronoiParams>> fields();
template <>
std::span<const Field<SolidSlicesParams>> fields();
template <>
std::span<const Field<SolidRadialParams>> fields();
template <>
std::span<const Field<SolidBrickParams>> fields();
/// Of a crater, without its centre and direction.
template <>
std::span<const Field<CarveParams>> fields();
/// The plain keys of a solid.
template <>
std::span<const Field<SolidModel>> fields();

}  // namespace sunder
