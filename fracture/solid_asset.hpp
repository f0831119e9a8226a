// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fracture/asset.hpp"
#include "fracture/bonds.hpp"
#include "fracture/solid_model.hpp"
#include "meshing/model_surface.hpp"
#include "meshing/raw_vector.hpp"

namespace sunder {

/// A partition of a solid into chunks that share vertices by index: no gap, no overlap. Every chunk
/// is closed: its triangles are parts of the solid's own surface and of faces that two chunks share
/// (both have them with the same corners, in opposite order).
struct SolidPartition {
  struct Triangle {
    std::array<std::uint32_t, 3> corners{};  ///< of `vertices`
    /// Outer: the surface's triangle it is part of. Inner: kInner | face.
    std::uint32_t source = 0;
    bool is_inner() const { return (source & kInner) != 0; }
    std::uint32_t face() const { return source & ~kInner; }
  };
  static constexpr std::uint32_t kInner = 0x80000000u;
  /// What two chunks have in common in one plane; the normal points from a to b.
  struct Face {
    std::uint32_t a = 0, b = 0;
    Vec3 normal;
  };
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> chunk_begin{0};  ///< chunk c: triangles chunk_begin[c] …
  std::vector<Triangle> triangles;
  std::vector<Face> faces;
  std::uint32_t chunk_count() const { return static_cast<std::uint32_t>(chunk_begin.size()) - 1; }
};

/// What happened while a solid was fractured.
struct SolidStats {
  std::uint64_t cells = 0;          ///< of the pattern
  std::uint64_t cells_outside = 0;  ///< that hold nothing of the solid
  std::uint64_t cells_inside = 0;   ///< whole: never cut
  std::uint64_t islands_split = 0;  ///< chunks more than cells: a cell's parts apart
  std::uint64_t slivers_merged = 0;
  std::uint64_t triangles_cut = 0;      ///< of the surface
  std::uint64_t exact_predicates = 0;   ///< that floating point could not decide
  double roughness = 0, amplitude = 0;  ///< m, used: less than asked where more is not one to one
};

/// A pre-fractured solid.
struct SolidAsset {
  SolidModel solid;
  double density = 2400;  ///< kg/m³
  ModelSurface surface;   ///< sound, in metres, local frame
  /// Origin of the local frame, in the model's own coordinates, m. Where a model's middle is more
  /// than twice its extent away from 0 along an axis, float32 would lose what a file is good for:
  /// there it is the middle, and `solid.position` has moved along. 0 along other axes.
  Vec3 origin;
  SolidPartition partition;
  std::vector<MassProperties> chunks;  ///< at density 1, local frame
  std::vector<Bond> bonds;             ///< by (a, b); area of all common faces
  double volume_expected = 0;          ///< of the surface, m³
  SolidStats stats;
  std::string chunk_name(std::uint32_t chunk) const;  ///< as WallAsset's
  bool has_rough_faces() const;  ///< whether inner faces stray from their planes
};

/// Cuts a sound surface into chunks. Throws Error{geometry}, with locations, if it is not a
/// solid's, and for patterns that would make more than kMaxCells. The same input gives the same
/// bytes on any number of threads.
SolidAsset fracture_solid(const SolidModel& solid, ModelSurface surface, double density,
                          const FractureParams& params);

/// Chunk meshes as renderers want them: float32, vertices not shared between faces of different
/// direction or material. Outer faces keep normals, UVs, materials and colours of the surface
/// (linear in each triangle); inner ones are flat (rough ones smooth within a face), UVs in metres
/// × 1/uv_scale in their plane. Positions are the doubles rounded once per shared vertex; where
/// that makes corners of a triangle one, it is dropped, on both sides: vertices of equal bits taken
/// as one, chunks stay closed.
struct SolidMeshes {
  RawVector<float> positions, normals, uvs;  ///< 3, 3, 2 per vertex
  RawVector<float> colours;                  ///< 4 per vertex, linear; empty: the surface has none
  struct Part {
    std::uint32_t material = 0;          ///< of the surface's; kInnerMaterial
    std::uint32_t begin = 0, count = 0;  ///< range of `indices`, relative to the chunk's vertices
  };
  static constexpr std::uint32_t kInnerMaterial = 0xFFFFFFFFu;
  RawVector<std::uint32_t> indices;
  std::vector<std::uint32_t> vertex_begin{0};  ///< per chunk
  std::vector<std::uint32_t> part_begin{0};    ///< chunk c has parts part_begin[c] …, inner last
  std::vector<Part> parts;
};
SolidMeshes solid_meshes(const SolidAsset& asset, int threads = 1);

}  // namespace sunder
