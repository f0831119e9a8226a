// SPDX-License-Identifier: GPL-3.0-or-later
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "io/export_files.hpp"
#include "io/hull_view.hpp"
#include "io/import.hpp"
#include "io/imported_asset.hpp"
#include "io/scene_file.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::input, what);
}

const aiMetadata* group(const aiMetadata* data, const char* key) {
  for (unsigned i = 0; data != nullptr && i < data->mNumProperties; ++i) {
    if (data->mValues[i].mType == AI_AIMETADATA && data->mKeys[i] == aiString(key)) {
      return static_cast<const aiMetadata*>(data->mValues[i].mData);
    }
  }
  return nullptr;
}

// A number, whatever type the reader chose for it.
std::optional<double> number(const aiMetadata* data, const char* key) {
  for (unsigned i = 0; data != nullptr && i < data->mNumProperties; ++i) {
    if (!(data->mKeys[i] == aiString(key))) continue;
    const aiMetadataEntry& entry = data->mValues[i];
    switch (entry.mType) {
      case AI_INT32: return *static_cast<const std::int32_t*>(entry.mData);
      case AI_UINT64: return static_cast<double>(*static_cast<const std::uint64_t*>(entry.mData));
      case AI_FLOAT: return static_cast<double>(*static_cast<const float*>(entry.mData));
      case AI_DOUBLE: return *static_cast<const double*>(entry.mData);
      default: return std::nullopt;
    }
  }
  return std::nullopt;
}

bool is_text(const aiMetadata* data, const char* key, const char* text) {
  for (unsigned i = 0; data != nullptr && i < data->mNumProperties; ++i) {
    if (data->mKeys[i] == aiString(key) && data->mValues[i].mType == AI_AISTRING)
      return *static_cast<const aiString*>(data->mValues[i].mData) == aiString(text);
  }
  return false;
}

// Appends a mesh; the two halves of a chunk that share their vertices in the file share them here.
void append(const aiMesh& mesh, bool inner, ImportedChunk& chunk) {
  const auto* values = reinterpret_cast<const float*>(mesh.mVertices);
  const std::size_t count = 3 * std::size_t{mesh.mNumVertices};
  const bool shared = chunk.positions.size() == count && count > 0 &&
                      std::memcmp(chunk.positions.data(), values, count * sizeof(float)) == 0;
  const std::size_t base = shared ? 0 : chunk.positions.size() / 3;
  if (!shared) chunk.positions.insert(chunk.positions.end(), values, values + count);
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices < 3) continue;  // points and lines bound no volume
    if (face.mNumIndices > 3) refuse("a face has more than three corners");
    for (unsigned k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices) refuse("an index is out of range");
      chunk.triangles.push_back(static_cast<std::uint32_t>(base + face.mIndices[k]));
    }
    chunk.inner.push_back(inner);
  }
}

class Flattener {
 public:
  Flattener(const aiScene& scene, std::string file_name)
      : scene_(scene), file_name_(std::move(file_name)) {}

  ImportedAsset run() {
    if (scene_.mRootNode != nullptr) visit(*scene_.mRootNode, std::nullopt);
    return std::move(asset_);
  }

 private:
  std::string material_of(const aiMesh& mesh) const {
    if (mesh.mMaterialIndex >= scene_.mNumMaterials) return "";
    return scene_.mMaterials[mesh.mMaterialIndex]->GetName().C_Str();
  }

  static ImportedWall unmarked(std::string name) {
    ImportedWall wall;
    wall.name = std::move(name);
    wall.volume_expected = std::numeric_limits<double>::quiet_NaN();
    return wall;
  }

  std::size_t wall_named(const std::string& name) {
    const auto [found, added] = by_name_.emplace(name, asset_.walls.size());
    if (added) asset_.walls.push_back(unmarked(name));
    return found->second;
  }

  std::size_t wall_marked(const aiNode& node, const aiMetadata* extras) {
    ImportedWall wall = unmarked(node.mName.C_Str());
    if (number(extras, "thickness")) wall.kind = SoupWall::Kind::wall;
    if (is_text(extras, "kind", "solid")) wall.kind = SoupWall::Kind::solid;
    wall.volume_expected = number(extras, "volume_expected").value_or(wall.volume_expected);
    const double bonds = number(group(extras, "bonds"), "count").value_or(0);
    wall.bonds = bonds >= 0 && bonds < 1e15 ? static_cast<std::uint64_t>(bonds) : 0;
    asset_.walls.push_back(std::move(wall));
    return asset_.walls.size() - 1;
  }

  // A member, slab or panel of a building's recording stands for itself: at its joints it may
  // overlap others. A chunk's wall is what stands before "_chunk_"; a mesh that no one named so
  // belongs to the file.
  std::size_t home_of(const aiNode& node, const aiMetadata* extras) {
    const std::string name = node.mName.C_Str();
    const std::size_t at = name.rfind("_chunk_");
    if (at != std::string::npos) return wall_named(name.substr(0, at));
    if (!number(extras, "mass")) return wall_named(file_name_);
    const std::size_t part = wall_named(name);
    asset_.walls[part].kind = SoupWall::Kind::solid;
    return part;
  }

  void visit(const aiNode& node, std::optional<std::size_t> wall) {
    const aiMetadata* extras = group(node.mMetaData, "sunder");
    if (number(extras, "sunder")) wall = wall_marked(node, extras);
    if (number(extras, "radius")) return;  // a projectile of a recording
    if (is_hull_name(node.mName.C_Str())) return;
    if (node.mNumMeshes > 0) {
      ImportedChunk chunk{node.mName.C_Str(), {}, {}, {}};
      std::string material;
      for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        if (node.mMeshes[i] >= scene_.mNumMeshes) refuse("a node names a mesh that does not exist");
        const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[i]];
        material = material_of(mesh);
        append(mesh, material.ends_with("_inner"), chunk);
      }
      const std::size_t home = wall ? *wall : home_of(node, extras);
      // Both materials of a wall are named after one.
      for (const std::string_view end : {"_outer", "_inner"})
        if (material.ends_with(end) && asset_.walls[home].material.empty())
          asset_.walls[home].material = material.substr(0, material.size() - end.size());
      asset_.walls[home].chunks.push_back(std::move(chunk));
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], wall);
  }

  const aiScene& scene_;
  std::string file_name_;
  ImportedAsset asset_;
  std::map<std::string, std::size_t> by_name_;
};

ImportedAsset read_with_assimp(const std::filesystem::path& path, const std::string& suffix,
                               const ImportLimits& limits) {
  Assimp::Importer importer;
  const aiScene& scene = read_scene_file(importer, path, limits);
  ImportedAsset asset = Flattener(scene, path.stem().string()).run();
  const bool empty = std::ranges::all_of(asset.walls, [](const ImportedWall& wall) {
    return std::ranges::all_of(wall.chunks, [](const auto& chunk) { return chunk.inner.empty(); });
  });
  if (empty) refuse("it holds no triangles");
  asset.has_chunks = suffix == ".glb" || suffix == ".gltf" || suffix == ".obj";
  asset.has_materials = asset.has_chunks;
  return asset;
}

}  // namespace

SoupWall soup_of(const ImportedAsset& asset, const ImportedWall& wall) {
  SoupWall soup;
  soup.chunk_count = static_cast<std::uint32_t>(wall.chunks.size());
  soup.has_chunks = asset.has_chunks;
  soup.kind = wall.kind;
  soup.bonds = wall.bonds;
  soup.volume_expected = wall.volume_expected;
  soup.chunk = [&wall, &asset](std::uint32_t c) {
    const ImportedChunk& chunk = wall.chunks[c];
    return SoupChunk{chunk.positions, chunk.triangles,
                     asset.has_materials ? chunk.inner : std::vector<std::uint8_t>{}};
  };
  return soup;
}

ImportedAsset import_asset(const std::filesystem::path& path, ImportLimits limits) {
  const std::string suffix = suffix_of(path);
  limit_to_file(path, limits);
  ImportedAsset asset;
  run_reader(
      path.string(), limits,
      [&] {
        return [read = read_with_assimp(path, suffix, limits)](AnswerWriter& out) {
          send_asset(read, out);
        };
      },
      [&](AnswerReader& in) { asset = receive_asset(in); });
  return asset;
}

}  // namespace sunder
