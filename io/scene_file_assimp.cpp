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
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "io/export_files.hpp"
#include "io/scene_file.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr std::string_view kSuffixes[] = {".glb", ".gltf", ".obj", ".stl", ".ply"};

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::input, what);
}

// The regular file of that name inside the folder, wherever links and ".." lead.
std::optional<std::filesystem::path> confined(const std::filesystem::path& folder,
                                              const std::filesystem::path& given,
                                              const std::filesystem::path& name) {
  std::error_code error;
  std::filesystem::path found = std::filesystem::canonical(name, error);
  if (error) found = std::filesystem::canonical(given / name, error);
  if (error || !std::filesystem::is_regular_file(found, error)) return std::nullopt;
  const auto [end, ignored] =
      std::mismatch(folder.begin(), folder.end(), found.begin(), found.end());
  if (end != folder.end()) return std::nullopt;
  return found;
}

std::string percent_decoded(const std::string& name) {
  const auto digit = [](char c) {
    return c >= '0' && c <= '9' ? c - '0' : (c | 32) >= 'a' && (c | 32) <= 'f' ? (c | 32) - 87 : -1;
  };
  std::string text;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool code =
        name[i] == '%' && i + 2 < name.size() && digit(name[i + 1]) >= 0 && digit(name[i + 2]) >= 0;
    text += code ? static_cast<char>(16 * digit(name[i + 1]) + digit(name[i + 2])) : name[i];
    if (code) i += 2;
  }
  return text;
}

std::optional<std::filesystem::path> file_beside(const std::filesystem::path& folder,
                                                 const std::filesystem::path& given,
                                                 const std::string& name) {
  if (auto found = confined(folder, given, name)) return found;
  if (name.find('%') == std::string::npos) return std::nullopt;
  return confined(folder, given, percent_decoded(name));
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
    return file_beside(folder_, given_, name);
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

}  // namespace

bool is_import_suffix(const std::string& suffix) {
  return std::ranges::find(kSuffixes, suffix) != std::end(kSuffixes);
}

std::string image_beside(const std::filesystem::path& model, std::string name) {
  std::ranges::replace(name, '\\', '/');
  std::error_code fault;
  const std::filesystem::path folder = std::filesystem::canonical(model, fault).parent_path();
  if (fault || name.empty() || std::filesystem::path(name).is_absolute()) return "";
  const std::filesystem::path given = model.parent_path();
  const auto found = file_beside(folder, given.empty() ? "." : given, name);
  return found ? found->lexically_relative(folder).generic_string() : "";
}

void limit_to_file(const std::filesystem::path& path, ImportLimits& limits) {
  const std::string suffix = suffix_of(path), name = path.string();
  if (!is_import_suffix(suffix)) {
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
}

const aiScene& read_scene_file(Assimp::Importer& importer, const std::filesystem::path& path,
                               const ImportLimits& limits) {
  keep_only(importer, suffix_of(path));
  importer.SetIOHandler(new FolderFiles(path, limits.file_size));  // owns it
  const aiScene* scene = importer.ReadFile(path.string(), aiProcess_Triangulate);
  if (scene == nullptr) refuse(importer.GetErrorString());
  return *scene;
}

}  // namespace sunder
