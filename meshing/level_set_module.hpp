// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/level_set.hpp"

namespace sunder {

/// What OpenVDB does for level sets. Loading OpenVDB takes ten times as long as the rest of the
/// program, so it is linked to a module of its own that is loaded when first asked for.
struct LevelSetModule {
  /// Unsigned distances, in voxels, of lattice points near a surface in lattice coordinates; in no
  /// order.
  std::vector<VoxelValue> (*distances)(const TriMesh& on_lattice, float band, int threads);
  /// Vertices (lattice coordinates) and quads of the surface where the values are 0.
  struct Quads {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 4>> quads;
  };
  Quads (*quads)(const std::vector<VoxelValue>& values, float band, int threads);
};
const LevelSetModule& level_set_module();

}  // namespace sunder
