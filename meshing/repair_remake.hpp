// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/level_set.hpp"

namespace sunder {

/// Of the bounding box's diagonal: what max_error = 0 stands for.
inline constexpr double kErrorShare = 1.0 / 200;
/// Voxel size as a share of the greatest error: a corner of a cube strays by 0.8 voxels at most.
inline constexpr double kVoxelShare = 1.0;

/// A sound surface where the level set is 0: the smooth one, or where that meets itself the one by
/// tetrahedra.
TriMesh solid_surface(const LevelSet& set);

}  // namespace sunder
