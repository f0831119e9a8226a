// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "fracture/chunk_mesh.hpp"
#include "fracture/solid_asset.hpp"

namespace sunder {

/// A chunk as files hold it: float32 positions, with repeats, and triangles over them.
struct SoupChunk {
  std::vector<float> positions;          ///< 3 per vertex, m
  std::vector<std::uint32_t> triangles;  ///< 3 per triangle, counter-clockwise from outside
  std::vector<std::uint8_t> inner;       ///< per triangle: 1 on a crack; empty: not known
};

/// A wall to be measured; chunks are fetched one at a time.
struct SoupWall {
  std::uint32_t chunk_count = 0;
  std::function<SoupChunk(std::uint32_t)> chunk;
  /// False when the whole wall is one soup without chunk borders (STL, PLY).
  bool has_chunks = true;
  /// A wall's chunks run through its thickness and are compared by their front faces; those of a
  /// solid lie anywhere. Not known: a wall if its faces are such.
  enum class Kind : std::uint8_t { unknown, wall, solid } kind = Kind::unknown;
  std::uint64_t bonds = 0;
  double volume_expected = std::numeric_limits<double>::quiet_NaN();  ///< m³; NaN: not known
};

/// What an asset is, measured from the float32 meshes that users get. Points are equal when their
/// bits are. Volumes in m³.
struct Soundness {
  std::uint64_t chunks = 0, triangles = 0, bonds = 0;
  double volume = 0;
  double volume_expected = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t open_chunks = 0;         ///< some directed edge has no reverse
  std::uint64_t nonmanifold_chunks = 0;  ///< some directed edge occurs twice
  std::uint64_t inverted_chunks = 0;     ///< closed, but the volume is not above 0
  /// Of a solid: chunks that cross themselves by more than the rounding of float32
  /// (float_rounding), or one of whose shells faces the wrong way.
  std::uint64_t self_crossing_chunks = 0;
  /// Solids whose outer faces, joined, do.
  std::uint64_t crossing_surfaces = 0;
  std::uint64_t unmatched_faces = 0;  ///< crack triangles without exactly one reverse elsewhere
  /// Chunks of a wall whose front faces overlap, decided exactly; of a solid, chunks that have an
  /// outer triangle with the same corners (see docs/formats.md for what that proves).
  std::uint64_t overlapping_pairs = 0;
  /// Chunks of a wall whose front is thinner than 1:50; of a solid, those with less than a
  /// thousandth of the volume of the cube over their bounding box's diagonal.
  std::uint64_t slivers = 0;
  double min_chunk_volume = std::numeric_limits<double>::infinity();
  std::uint64_t hash = 0;  ///< of all chunks' triangles, bit for bit

  /// Relative; NaN when the expected volume is not known.
  double volume_error() const;
  /// No fault, and the volume right to 1e-6 where it is known.
  bool is_sound() const;
};

/// Measures walls, O(triangles log triangles). `progress` as elsewhere, may be empty.
Soundness measure(const std::vector<SoupWall>& walls, const Progress& progress = {});

/// A wall's render meshes as a soup; both must outlive it.
SoupWall soup_of(const WallAsset& asset, const RenderMeshes& meshes);
/// The same of a solid.
SoupWall soup_of(const SolidAsset& asset, const SolidMeshes& meshes);

}  // namespace sunder
