// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "meshing/triangle_tree.hpp"

namespace sunder {

/// A value at the lattice point (i, j, k), in voxels.
struct VoxelValue {
  std::array<std::int32_t, 3> at{};
  float value = 0;
};

/// Distances around a surface on a lattice of step `voxel` (m) through `origin` (m), ascending by
/// lattice point, in voxels: below 0 inside, above 0 outside, never 0. All points nearer to the
/// surface than kBand voxels are there, so that cells that the surface passes are whole.
struct LevelSet {
  double voxel = 0;
  Vec3 origin;
  std::vector<VoxelValue> values;
  static constexpr float kBand = 3;
  Vec3 place(const std::array<std::int32_t, 3>& at) const {
    return origin + voxel * Vec3{double(at[0]), double(at[1]), double(at[2])};
  }
};

/// Most lattice points of a level set: about 2 GB while it is worked on.
inline constexpr double kMostVoxels = 2e7;

/// Level set of what a closed surface winds around at least once, whatever crosses or covers what;
/// the surface may be any set of triangles whose edges cancel (OpenVDB's distances; signs by
/// winding numbers). The same bytes on any number of threads; 0: all there are.
/// Throws Error{geometry} if it would take more than kMostVoxels.
LevelSet level_set(const TriMesh& closed, double voxel, int threads = 0);

/// Takes what lies where `distance` (m, the shape's signed distance) is below 0 out of the solid.
/// `box` holds the shape.
void take_away(LevelSet& set, const Box3& box, const std::function<double(Vec3)>& distance);

/// The surface where a level set is 0: OpenVDB's dual contouring, quads cut along the shorter
/// diagonal. As a rule it is sound; where cells are ambiguous it may meet itself.
TriMesh smooth_surface(const LevelSet& set, int threads = 0);

/// The surface where the level set is 0 and linear in each of the six tetrahedra of a cell: sound
/// whatever the values are, with about three times the triangles.
TriMesh sound_surface(const LevelSet& set);

}  // namespace sunder
