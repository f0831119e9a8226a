// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/gltf_animation.hpp"
#include "io/gltf_parts.hpp"
#include "io/wall_view.hpp"

namespace sunder {

/// 65535 in 16 bits means "restart the strip", so it is not an index.
constexpr std::uint32_t kLargestShortIndex = 65534;
constexpr std::uint32_t kUnused = UINT32_MAX;

/// The binary is a few large blocks, each one bufferView: what vertices and triangles of all walls
/// spheres and parts consist of, the bonds, the animation's keys, and how far joints are used.
enum class GltfBlock {
  positions,
  normals,
  uvs,
  colours,
  indices,
  bonds,
  times,
  translations,
  rotations,
  weights,
  utilisations
};
constexpr std::size_t kGltfBlocks = 11;

/// A picture that materials refer to.
struct GltfImage {
  std::string image;             ///< path of the file
  std::string uri;               ///< as the document refers to it, if not embedded
  std::vector<std::byte> bytes;  ///< embedded
  std::string mime;
  std::uint64_t begin = 0;  ///< in the binary
};

/// Everything about a glTF file that is known before its first byte is written. Bytes of the
/// blocks follow each other in the order of GltfBlock; within each: walls, spheres, parts, hulls.
struct GltfLayout {
  struct Block {
    std::uint64_t begin = 0, size = 0;
    std::uint32_t view = kUnused;  ///< bufferView; kUnused: the block is empty
  };
  UniqueLists lists;
  std::vector<std::uint64_t> list_begin;    // bytes into the index block
  std::vector<std::uint64_t> first_vertex;  // per wall
  std::vector<std::uint64_t> bonds_begin;   // per wall, bytes into the bond block
  std::vector<std::uint64_t> first_colour;  // per wall: vertices into the colour block
  std::vector<ViewMaterial> materials;
  std::vector<std::vector<std::uint32_t>> materials_of;  // per wall: its material → one of these
  std::vector<GltfImage> images;                         // distinct ones of materials
  std::uint64_t mesh_count = 0, coloured_count = 0;      // of chunks
  std::array<Block, kGltfBlocks> blocks;
  std::uint64_t binary_size = 0;

  // Of a recording.
  const Recording* recording = nullptr;
  std::optional<std::uint32_t> step;  // the one moment that the file shows; without: animated
  GltfAnimation animation;
  std::vector<double> radii;           // distinct ones of spheres, a mesh each
  std::vector<std::uint32_t> mesh_of;  // per projectile: into radii
  std::uint32_t sphere_material = kUnused;
  std::uint64_t first_sphere_vertex = 0;
  std::uint64_t sphere_list_begin = 0;  // bytes into the index block
  GltfParts parts;
  std::uint64_t first_part_position = 0, first_part_normal = 0, first_part_uv = 0;  // vertices
  std::uint64_t part_list_begin = 0;  // bytes into the index block

  // Of hulls, which a file with a recording does not have.
  std::uint64_t first_hull_vertex = 0, hull_list_begin = 0;

  const Block& operator[](GltfBlock block) const { return blocks[static_cast<std::size_t>(block)]; }
  /// Times at the start of their block, which all bodies share; then those of lights.
  std::uint64_t common_times() const { return animation.empty() ? 0 : animation.steps.size(); }
};

/// `step`, of the recording: the file shows that moment instead of the motion. `embeds`: images go
/// into the binary. Throws Error{output} for an image that cannot be read.
GltfLayout lay_out_gltf(std::span<const WallView> walls, const Recording* recording,
                        std::optional<std::uint32_t> step, bool embeds);

/// The sphere of radius 1 that stands for projectiles: rings of latitude about the y axis.
struct SphereMesh {
  std::vector<Vec3> vertices;  ///< on the unit sphere: normals too
  std::vector<std::uint16_t> indices;
};
constexpr std::uint32_t kSphereRings = 16, kSphereSectors = 32;
constexpr std::uint32_t kSphereVertices = (kSphereRings - 1) * kSphereSectors + 2;
constexpr std::uint32_t kSphereIndices = 6 * (kSphereRings - 1) * kSphereSectors;
SphereMesh sphere_mesh();

}  // namespace sunder
