// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "fracture/asset.hpp"
#include "fracture/chunk_mesh.hpp"
#include "fracture/hulls.hpp"
#include "fracture/solid_asset.hpp"
#include "io/png.hpp"
#include "sim/material.hpp"

namespace sunder {

/// Suffixes export_asset writes: .glb .gltf .obj .stl .ply .svg .png .html
bool is_export_suffix(const std::string& suffix);

/// An asset with the render meshes of its walls, made once for any number of files; and solids
/// with theirs.
struct MeshedAsset {
  const Asset& asset;
  std::vector<RenderMeshes> meshes;  ///< one per wall
  std::span<const SolidAsset> solids = {};
  std::vector<SolidMeshes> solid_meshes = {};
  std::vector<HullSet> hulls = {};  ///< of the walls, then of the solids; empty: none
  HullParams hull_params = {};
  std::vector<Material> hull_materials = {};  ///< as the hulls; friction and restitution only
  int picture_width = kPictureWidth;          ///< of a .png, pixels
};
MeshedAsset mesh_asset(const Asset& asset, int threads = 1,
                       std::span<const SolidAsset> solids = {});
/// Makes the hulls that the params want, for .glb, .gltf and .obj by export_asset. `materials` has
/// those of all walls and solids. Throws Error{input} for a material that is not there.
void add_hulls(MeshedAsset& asset, const HullParams& params, const std::vector<Material>& materials,
               int threads = 1);

/// Writes the asset in the format of the path's suffix; whole or not at all (a .gltf with its .bin,
/// an .obj with its .mtl). GLB, glTF and OBJ are written straight from the meshes by the writers
/// that are also registered with assimp (export_through_assimp), byte for byte the same; STL and
/// PLY by assimp; SVG and the page (see page.hpp) by ourselves; PNG is the same picture (png_of).
/// A solid's textures stand inside a .glb; a .gltf or .mtl refers to the files by their path from
/// its folder. Throws Error{usage} for another suffix, Error{output} on failure. Same asset, same
/// bytes.
void export_asset(const MeshedAsset& asset, const std::filesystem::path& path);

/// The same file by way of an aiScene and Assimp::Exporter, for every format but .svg and .png; of
/// solids, .stl and .ply only.
void export_through_assimp(const MeshedAsset& asset, const std::filesystem::path& path);

}  // namespace sunder
