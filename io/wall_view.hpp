// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fracture/asset.hpp"
#include "fracture/bonds.hpp"
#include "fracture/chunk_mesh.hpp"

namespace sunder {

/// What a format's writer needs to know of a wall; the arrays belong to someone else: a
/// MeshedAsset, or what was gathered from an aiScene. The mesh arrays are those of RenderMeshes.
struct WallView {
  std::string name;
  std::string first_chunk;  ///< name of chunk 0; the others count up from it
  std::string material;
  Vec3 position;
  Quaternion rotation;
  double thickness = 0, density = 0, volume_expected = 0;
  std::span<const float> positions, normals, uvs;
  std::span<const std::uint32_t> vertex_begin, indices;
  std::span<const IndexList> lists;
  std::span<const std::uint32_t> outer, inner;
  std::span<const MassProperties> chunks;  ///< at density 1, wall frame
  std::span<const Bond> bonds;

  std::uint32_t chunk_count() const { return static_cast<std::uint32_t>(outer.size()); }
  std::uint32_t vertex_count(std::uint32_t chunk) const {
    return vertex_begin[chunk + 1] - vertex_begin[chunk];
  }
};

/// View of a wall and its meshes; both must outlive it.
WallView view_of(const WallAsset& wall, const RenderMeshes& meshes);

/// Throws Error{output} that names the wall, chunk and value at fault, unless the walls can be
/// written: array sizes agree, indices in range, every number finite, normals of length 1, names
/// unique, not empty, at most 56 bytes of A-Z a-z 0-9 _ -.
void validate(std::span<const WallView> walls);
/// 1 to 56 characters of A-Z a-z 0-9 _ -: what every program keeps as a node's name.
bool is_portable(std::string_view name);

/// Counts the names of a wall's chunks up: "wall_chunk_0000", "wall_chunk_0001", …
class ChunkNames {
 public:
  explicit ChunkNames(const std::string& first) : name_(first) {}
  std::string_view operator*() const { return name_; }
  void operator++();

 private:
  std::string name_;
};

/// Index lists without repeats, over all walls, in order of first use (outer before inner, chunk by
/// chunk): what a file holds, whatever order the meshes were made in.
struct UniqueLists {
  struct List {
    std::span<const std::uint32_t> indices;
    std::uint32_t largest = 0;  ///< largest index
  };
  std::vector<List> lists;
  std::vector<std::vector<std::uint32_t>> of_wall;  ///< per wall: its list → one of `lists`
};
UniqueLists unique_lists(std::span<const WallView> walls);

/// How a material looks, sRGB 0 … 255: its weathered outside and its freshly broken inside.
struct MaterialLook {
  std::array<std::uint8_t, 3> outer{}, inner{};
  double outer_roughness = 0.9, inner_roughness = 1, metallic = 0;
};
/// Known materials by the word in their name, others a muted colour of their name's own.
MaterialLook look_of(std::string_view material);
/// One sRGB channel as the linear value that glTF wants, to four decimals.
double linear(std::uint8_t channel);

}  // namespace sunder
