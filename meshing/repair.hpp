// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "meshing/surface_defects.hpp"

namespace sunder {

struct RepairParams {
  /// How far the repaired surface may be from the given one where it must be made anew by a level
  /// set, m; 0: a 200th of the bounding box's diagonal. Sets the voxel size.
  double max_error = 0;
  bool level_set = true;  ///< make it anew when orientation and holes are not enough
};

/// What was done to make a surface a solid's. Volumes in m³ (of an open surface: what its triangles
/// and their fans to the centroid enclose), distance in m.
struct Repair {
  ModelSurface surface;
  std::vector<std::string> steps;  ///< "12 duplicate faces dropped", "3 holes filled", …
  SurfaceDiagnosis before, after;
  double volume_before = 0, volume_after = 0;
  /// Of both surfaces, symmetric, m: the farthest of points half of max_error apart on each from
  /// the other (see farthest in triangle_tree.hpp). Holes filled and inner walls dropped count; of
  /// what encloses the same volume before and after it is at most max_error.
  double hausdorff = 0;
  double voxel = 0;  ///< of the level set; 0: none was needed
};

/// Equal vertices, duplicates, cracks, orientation, holes and a few crossing faces first; a level
/// set (mesh to volume to mesh) only when that is not enough, which makes the whole surface anew.
/// Triangles that stay keep what they carry; new ones take their plane's normal and what the
/// nearest of the given surface carries. A sound surface comes back as it is. Throws
/// Error{geometry} if no solid came of it (what is left and why), or if a level set would take more
/// than kMostVoxels (level_set.hpp). The same input gives the same bytes.
Repair repair(const ModelSurface& surface, const RepairParams& params = {});

/// A crater: what of the solid lies in the shape is taken away. The whole surface is made anew by a
/// level set: edges elsewhere are rounded by up to a voxel.
struct CarveParams {
  Vec3 centre;
  double radius = 0.2;   ///< m
  double depth = 0;      ///< m along the inward normal `into`: a spherical cap that is `radius`
                         ///< wide at `centre`; 0: a ball of `radius`
  Vec3 into{0, 0, -1};   ///< unit
  double roughness = 0;  ///< m, most, of the bumps of the crater's face, a quarter radius wide
  double max_error = 0;  ///< as RepairParams
  std::uint64_t seed = 1;
};
/// Throws Error{geometry} if the surface is no solid's, nothing of it is left, or a number is not
/// possible.
ModelSurface carve(const ModelSurface& surface, const CarveParams& params);

}  // namespace sunder
