// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "fracture/asset.hpp"
#include "meshing/raw_vector.hpp"
#include "meshing/tri_mesh.hpp"

namespace sunder {

/// A face of a chunk, as its user sees it.
enum class FaceKind : std::uint8_t { front, back, border, inner };

/// A chunk as a closed solid in double precision: cell extruded from -thickness/2 to +thickness/2.
/// Vertices: the cell's corners at the back (z < 0), then the same at the front. `kinds[t]` tells
/// what triangle t belongs to. Neighbours triangulate their common face along the same diagonal.
struct ChunkMesh {
  TriMesh mesh;
  std::vector<FaceKind> kinds;
};
ChunkMesh chunk_mesh(const WallAsset& asset, std::uint32_t chunk);

/// Convex polygons (pattern vertex indices, counter-clockwise) whose extrusions tile the chunk, for
/// physics; a convex chunk is its own only part.
std::vector<std::vector<std::uint32_t>> convex_parts(const WallAsset& asset, std::uint32_t chunk);

/// Index list of one part of a chunk; chunks with the same corners share it.
struct IndexList {
  std::uint32_t begin = 0, count = 0;  ///< range of RenderMeshes::indices
};

/// Meshes of all chunks of a wall, as renderers want them: float32, flat normals, texture
/// coordinates, vertices not shared between faces. Chunk c owns vertices vertex_begin[c] …
/// vertex_begin[c+1], first those of its outer faces (front, back, border), then the inner ones;
/// its triangles are outer[c] and inner[c], indices relative to vertex_begin[c].
///
/// Positions are the doubles rounded once per shared vertex, so neighbours' corners are the same
/// bits. An edge whose ends round to the same float is dropped in both cells that share it. Texture
/// coordinates in metres, v up: wall coordinates outside; along the crack and through the thickness
/// inside.
struct RenderMeshes {
  RawVector<float> positions;  ///< 3 per vertex
  RawVector<float> normals;    ///< 3 per vertex, unit
  RawVector<float> uvs;        ///< 2 per vertex
  std::vector<std::uint32_t> vertex_begin{0};
  std::vector<std::uint32_t> indices;
  std::vector<IndexList> lists;      ///< distinct index lists, in order of first use
  std::vector<std::uint32_t> outer;  ///< per chunk: its list in `lists`
  std::vector<std::uint32_t> inner;  ///< the same; kNoList: a chunk without inner faces
  std::uint64_t edges_dropped = 0;

  static constexpr std::uint32_t kNoList = 0xFFFFFFFFu;
  std::uint32_t chunk_count() const { return static_cast<std::uint32_t>(outer.size()); }
};
RenderMeshes render_meshes(const WallAsset& asset, int threads = 1);

}  // namespace sunder
