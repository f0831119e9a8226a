// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fracture/bonds.hpp"
#include "fracture/pattern.hpp"
#include "fracture/wall.hpp"
#include "meshing/progress.hpp"
#include "meshing/region.hpp"
#include "meshing/tri_mesh.hpp"

namespace sunder {

/// What happened while a wall was fractured.
struct FractureStats {
  std::uint64_t cells_exact = 0;      ///< Voronoi cells computed in exact arithmetic
  std::uint64_t cells_certified = 0;  ///< … that a fast kernel proposed and the certificate passed
  std::uint64_t cells_cut = 0;        ///< cells that outline or openings cut
  std::uint64_t cells_outside = 0;    ///< cells dropped whole: outside, or inside an opening
  std::uint64_t slivers_merged = 0;
  std::uint64_t sites_repeated = 0;  ///< given sites dropped because another has their place
  std::uint64_t quads_split = 0;     ///< quads that were not convex
};

/// A pre-fractured wall: cell c of the pattern, extruded, is chunk c.
struct WallAsset {
  Wall wall;                           ///< with its local origin (with_local_origin)
  double density = 2400;               ///< kg/m³
  LatticeRegion region;                ///< outline and openings; `across` borders are its edges
  Pattern pattern;                     ///< cells after cutting and merging
  std::vector<MassProperties> chunks;  ///< at density 1, wall frame
  std::vector<Bond> bonds;
  double volume_expected = 0;  ///< region's area × thickness, m³
  FractureStats stats;
  /// "<wall>_chunk_0000": as many digits as the last chunk needs, four at least.
  std::string chunk_name(std::uint32_t chunk) const;
};

/// Everything a scene's walls became.
struct Asset {
  std::vector<WallAsset> walls;
};

struct FractureParams {
  std::uint64_t seed = 1;
  int threads = 1;
  Progress progress = {};
};

/// A wall's pattern and the region it fills.
struct WallPattern {
  LatticeRegion region;
  Pattern pattern;
};
/// The wall's pattern: sites or points, cells, cut by outline and openings, slivers merged.
/// In the wall's local frame: origin at the lower left of the outline's bounding box. Throws
/// Error{geometry} as make_lattice_region and the generators do.
WallPattern make_pattern(const Wall& wall, const FractureParams& params,
                         FractureStats* stats = nullptr);

/// Fractures a wall: pattern, mass properties and bonds. Chunk meshes are made when asked for
/// (chunk_mesh, render_meshes). The wall's pattern depends on (seed, name of the wall) only.
WallAsset fracture_wall(const Wall& wall, double density, const FractureParams& params);

}  // namespace sunder
