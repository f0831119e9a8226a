// SPDX-License-Identifier: GPL-3.0-or-later
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "io/export_files.hpp"
#include "io/import.hpp"
#include "io/reader_process.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

// --- files the readers may open
// -------------------------------------------------------------------

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::input, what);
}

class InputStream : public Assimp::IOStream {
 public:
  explicit InputStream(std::string content) : content_(std::move(content)) {}
  std::size_t Read(void* out, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t items = std::min(count, (content_.size() - at_) / size);
    std::memcpy(out, content_.data() + at_, items * size);
    at_ += items * size;
    return items;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t from = origin == aiOrigin_CUR   ? at_
                             : origin == aiOrigin_END ? content_.size()
                                                      : 0;
    if (offset > content_.size() - from) return aiReturn_FAILURE;
    at_ = from + offset;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return content_.size(); }
  void Flush() override {}

 private:
  std::string content_;
  std::size_t at_ = 0;
};

// Only regular files inside the asset's folder, wherever links and ".." lead; never a scheme, never
// a device.
class FolderFiles : public Assimp::IOSystem {
 public:
  FolderFiles(const std::filesystem::path& file, std::uint64_t limit)
      : folder_(std::filesystem::canonical(file).parent_path()),
        given_(file.parent_path()),
        limit_(limit) {}
  bool Exists(const char* path) const override { return locate(path).has_value(); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* path, const char* mode) override {
    const auto found = locate(path);
    if (!found || std::strchr(mode, 'w') != nullptr) return nullptr;
    std::optional<std::string> content = read(*found);
    return content ? new InputStream(std::move(*content)) : nullptr;
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::optional<std::filesystem::path> locate(const std::string& name) const {
    if (auto found = confined(name)) return found;
    return name.find('%') == std::string::npos ? std::nullopt : confined(percent_decoded(name));
  }

  std::optional<std::filesystem::path> confined(const std::filesystem::path& name) const {
    std::error_code error;
    std::filesystem::path found = std::filesystem::canonical(name, error);
    if (error) found = std::filesystem::canonical(given_ / name, error);
    if (error || !std::filesystem::is_regular_file(found, error)) return std::nullopt;
    const auto [end, ignored] =
        std::mismatch(folder_.begin(), folder_.end(), found.begin(), found.end());
    if (end != folder_.end()) return std::nullopt;
    return found;
  }

  static std::string percent_decoded(const std::string& name) {
    const auto digit = [](char c) {
      return c >= '0' && c <= '9'                 ? c - '0'
             : (c | 32) >= 'a' && (c | 32) <= 'f' ? (c | 32) - 87
                                                  : -1;
    };
    std::string text;
    for (std::size_t i = 0; i < name.size(); ++i) {
      const bool code = name[i] == '%' && i + 2 < name.size() && digit(name[i + 1]) >= 0 &&
                        digit(name[i + 2]) >= 0;
      text += code ? static_cast<char>(16 * digit(name[i + 1]) + digit(name[i + 2])) : name[i];
      if (code) i += 2;
    }
    return text;
  }

  std::optional<std::string> read(const std::filesystem::path& path) const {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) return std::nullopt;
    struct stat info = {};
    std::optional<std::string> content;
    if (::fstat(file, &info) == 0 && S_ISREG(info.st_mode) &&
        static_cast<std::uint64_t>(info.st_size) <= limit_) {
      content.emplace(static_cast<std::size_t>(info.st_size), '\0');
      std::size_t at = 0;
      while (at < content->size()) {
        const ssize_t count = ::read(file, content->data() + at, content->size() - at);
        if (count <= 0) break;
        at += static_cast<std::size_t>(count);
      }
      content->resize(at);
    }
    ::close(file);
    return content;
  }

  std::filesystem::path folder_, given_;
  std::uint64_t limit_;
};

// --- aiScene → ImportedAsset
// ----------------------------------------------------------------------

// Leaves the one reader that the suffix names; assimp would else let any of its fifty try.
void keep_only(Assimp::Importer& importer, const std::string& suffix) {
  std::string word = suffix + " ";
  word.front() = ' ';
  std::vector<Assimp::BaseImporter*> others;
  for (std::size_t i = 0; i < importer.GetImporterCount(); ++i) {
    const aiImporterDesc* description = importer.GetImporterInfo(i);
    std::string words = description->mFileExtensions;
    words.insert(0, 1, ' ').push_back(' ');
    const bool named = words.find(word) != std::string::npos;
    const bool first_gltf = std::strcmp(description->mName, "glTF Importer") == 0;
    if (!named || first_gltf) others.push_back(importer.GetImporter(i));
  }
  // Unregistered readers are not freed; this process ends with the file.
  for (Assimp::BaseImporter* other : others) importer.UnregisterLoader(other);
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

  std::size_t wall_named(const std::string& name) {
    const auto [found, added] = by_name_.emplace(name, asset_.walls.size());
    if (added) asset_.walls.push_back({name, "", {}, std::numeric_limits<double>::quiet_NaN(), 0});
    return found->second;
  }

  std::size_t wall_marked(const aiNode& node, const aiMetadata* extras) {
    ImportedWall wall{node.mName.C_Str(), "", {}, std::numeric_limits<double>::quiet_NaN(), 0};
    wall.volume_expected = number(extras, "volume_expected").value_or(wall.volume_expected);
    const double bonds = number(group(extras, "bonds"), "count").value_or(0);
    wall.bonds = bonds >= 0 && bonds < 1e15 ? static_cast<std::uint64_t>(bonds) : 0;
    asset_.walls.push_back(std::move(wall));
    return asset_.walls.size() - 1;
  }

  // What stands before "_chunk_"; a mesh that no one named so belongs to the file.
  std::string wall_of(const std::string& chunk) const {
    const std::size_t at = chunk.rfind("_chunk_");
    return at == std::string::npos ? file_name_ : chunk.substr(0, at);
  }

  void visit(const aiNode& node, std::optional<std::size_t> wall) {
    const aiMetadata* extras = group(node.mMetaData, "sunder");
    if (number(extras, "sunder")) wall = wall_marked(node, extras);
    if (number(extras, "radius")) return;  // a projectile of a recording
    if (node.mNumMeshes > 0) {
      ImportedChunk chunk{node.mName.C_Str(), {}, {}, {}};
      std::string material;
      for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        if (node.mMeshes[i] >= scene_.mNumMeshes) refuse("a node names a mesh that does not exist");
        const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[i]];
        material = material_of(mesh);
        append(mesh, material.ends_with("_inner"), chunk);
      }
      const std::size_t home = wall ? *wall : wall_named(wall_of(chunk.name));
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
  keep_only(importer, suffix);
  importer.SetIOHandler(new FolderFiles(path, limits.file_size));  // owns it
  const aiScene* scene = importer.ReadFile(path.string(), aiProcess_Triangulate);
  if (scene == nullptr) refuse(importer.GetErrorString());
  ImportedAsset asset = Flattener(*scene, path.stem().string()).run();
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
  const std::string name = path.string();
  constexpr std::string_view kSuffixes[] = {".glb", ".gltf", ".obj", ".stl", ".ply"};
  if (std::ranges::find(kSuffixes, suffix) == std::end(kSuffixes)) {
    throw Error(ErrorCode::usage,
                name + ": suffix \"" + suffix + "\" is not one of .glb .gltf .obj .stl .ply");
  }
  struct stat info = {};
  if (::stat(path.c_str(), &info) != 0) refuse(name + ": " + std::strerror(errno));
  if (!S_ISREG(info.st_mode)) refuse(name + ": is not a regular file");
  if (static_cast<std::uint64_t>(info.st_size) > limits.file_size) {
    refuse(name + ": has " + std::to_string(info.st_size) + " bytes, at most " +
           std::to_string(limits.file_size) + " are read");
  }
  // A sound file takes a tenth of this; one that lies about its size would use up the whole limit.
  const double megabytes = static_cast<double>(info.st_size) * 0x1p-20;
  limits.seconds = std::min(limits.seconds, 5 + 0.5 * megabytes);
  return run_reader(name, limits, [&] { return read_with_assimp(path, suffix, limits); });
}

}  // namespace sunder
