// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/export.hpp"
#include "io/output.hpp"
#include "io/text_writer.hpp"
#include "io/wall_view.hpp"

namespace sunder {

/// An OutputFile as a writer sees it.
class FileSink : public ByteSink {
 public:
  explicit FileSink(OutputFile& file) : file_(file) {}
  void write(std::span<const std::byte> bytes) override { file_.write(bytes); }
  void rewrite_front(std::span<const std::byte> bytes) override {
    file_.seek(0);
    file_.write(bytes);
    file_.seek(file_.size());
  }

 private:
  OutputFile& file_;
};

/// The path's suffix in small letters, ".glb".
std::string suffix_of(const std::filesystem::path& path);
/// The file a .gltf or .obj has beside it: its path with another suffix; empty for other formats.
std::filesystem::path companion_of(const std::filesystem::path& path);
/// Views of all walls and solids of an asset, which must outlive them, for a file at `path`.
std::vector<WallView> views_of(const MeshedAsset& asset, const std::filesystem::path& path);
/// Both files or none: the companion first, so that the file that refers to it never lacks it.
void commit_pair(OutputFile& companion, OutputFile& file);

}  // namespace sunder
