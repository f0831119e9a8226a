// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fracture/asset.hpp"
#include "fracture/solid_asset.hpp"
#include "meshing/field.hpp"

namespace sunder {

/// Convex hulls that stand for chunks in collisions.
struct HullParams {
  std::string nodes = "none";      ///< names for an engine: none, ucx (Unreal), convcol (Godot)
  double error = 0.02;             ///< see HullSet::Error
  std::int64_t max_hulls = 16;     ///< per chunk
  std::int64_t max_vertices = 64;  ///< per hull
  bool physics = false;            ///< rigid bodies in glTF (KHR_physics_rigid_bodies)
  bool is_wanted() const { return nodes != "none" || physics; }
};
template <>
std::span<const Field<HullParams>> fields();

/// Hulls of all chunks of a wall or solid, in its frame: closed and convex, decided exactly on the
/// float32 that stand here (no vertex is above a triangle's plane). Chunk c has the hulls
/// hull_begin[c] …, none only if float32 leaves it no volume; hull h has the vertices
/// vertex_begin[h] … and the indices index_begin[h] …, relative to its first vertex.
struct HullSet {
  /// What the hulls of a chunk have too much.
  struct Error {
    double volume = 0;    ///< sum of the hulls' volumes by the chunk's, less 1
    double distance = 0;  ///< no point of a hull or of the chunk is farther from the other than
                          ///< this, by the diagonal of the chunk's bounding box: an upper bound
  };
  std::vector<float> positions;  ///< 3 per vertex, m
  std::vector<std::uint16_t> indices;
  std::vector<std::uint32_t> vertex_begin{0}, index_begin{0};  ///< per hull
  std::vector<std::uint32_t> hull_begin{0};                    ///< per chunk
  std::vector<Error> errors;                                   ///< per chunk
  std::uint32_t hull_count() const { return static_cast<std::uint32_t>(vertex_begin.size()) - 1; }
};

/// A chunk keeps one hull where both errors are within params.error. Else it is cut by planes
/// through its reflex edges until they are, and hulls are joined again while they stay so; a chunk
/// for which max_hulls or max_vertices are too few has larger errors. The same chunks give the same
/// hulls on any number of threads.
HullSet wall_hulls(const WallAsset& asset, const HullParams& params, int threads = 1);
HullSet solid_hulls(const SolidAsset& asset, const HullParams& params, int threads = 1);

}  // namespace sunder
