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
#include "io/hull_view.hpp"

namespace sunder {

/// A material as files have it.
struct ViewMaterial {
  std::string name;
  std::array<double, 3> colour{1, 1, 1};  ///< linear
  double alpha = 1, metallic = 0, roughness = 1;
  std::string image = {};  ///< path of the picture that multiplies the colour; empty: none
  std::string uri = {};    ///< of that picture as a file refers to it, with '/'
  friend bool operator==(const ViewMaterial&, const ViewMaterial&) = default;
};
/// Of a wall's old and broken faces: "<material>_outer", "<material>_inner".
ViewMaterial outer_material(const std::string& material);
ViewMaterial inner_material(const std::string& material);

/// The faces of a chunk that have one material.
struct ViewPart {
  std::uint32_t material = 0;  ///< of the view's
  std::uint32_t list = 0;      ///< of the view's
};

/// What a format's writer needs to know of a wall or solid; the arrays belong to someone else: a
/// MeshedAsset, or what was gathered from an aiScene. The mesh arrays are those of RenderMeshes or
/// SolidMeshes.
struct WallView {
  std::string name;
  std::string first_chunk;  ///< name of chunk 0; the others count up from it
  std::string material;
  Vec3 position;
  Quaternion rotation;
  bool is_solid = false;
  Vec3 origin = {};      ///< of a solid: SolidAsset::origin
  double thickness = 0;  ///< of a wall
  double density = 0, volume_expected = 0;
  std::span<const float> positions = {}, normals = {}, uvs = {};
  std::span<const float> colours = {};  ///< 4 per vertex, linear; empty: none
  std::span<const std::uint32_t> vertex_begin = {}, indices = {};
  std::vector<IndexList> lists = {};
  std::vector<ViewMaterial> materials = {};
  std::vector<std::uint32_t> part_begin{0};  ///< chunk c has parts part_begin[c] …
  std::vector<ViewPart> parts = {};
  std::span<const MassProperties> chunks;  ///< at density 1, wall frame
  std::span<const Bond> bonds;
  HullView hulls = {};

  std::uint32_t chunk_count() const { return static_cast<std::uint32_t>(part_begin.size()) - 1; }
  std::span<const ViewPart> parts_of(std::uint32_t chunk) const {
    return {parts.data() + part_begin[chunk], part_begin[chunk + 1] - part_begin[chunk]};
  }
  std::uint32_t vertex_count(std::uint32_t chunk) const {
    return vertex_begin[chunk + 1] - vertex_begin[chunk];
  }
};

/// View of a wall and its meshes; both must outlive it.
WallView view_of(const WallAsset& wall, const RenderMeshes& meshes);
/// Gives a view the mesh arrays, materials and parts of a wall's chunks.
void show_meshes(const RenderMeshes& meshes, WallView& view);

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

/// Index lists without repeats, over all walls, in order of first use (part by part, chunk by
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
/// The same of a channel 0 … 1, to no fixed number of decimals; and back.
double linear_channel(double srgb);
double srgb_channel(double linear);

}  // namespace sunder
