// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/level_set.hpp"

namespace sunder {

/// Of the bounding box's diagonal: what max_error = 0 stands for.
inline constexpr double kErrorShare = 1.0 / 200;
/// Voxel size as a share of the greatest error: a cube's corner strays by a voxel at most
/// (bench_level_set), sharper ones further.
inline constexpr double kVoxelShare = 0.8;

/// A sound surface where the level set is 0: the smooth one, mended where it meets itself in a few
/// places, or the one by tetrahedra. Without shells and bubbles of less than a tenth of a voxel.
TriMesh solid_surface(const LevelSet& set);

}  // namespace sunder
