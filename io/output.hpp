// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace sunder {

/// A file that appears whole or not at all: written under a temporary name in the same folder,
/// then fsync, rename, fsync of the folder. Destroyed without commit(), it leaves nothing.
/// Every failure throws Error{output} that names the path and the reason.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Moves the write position, as assimp's writers want; only backwards or to the end.
  void seek(std::uint64_t position);
  std::uint64_t position() const { return position_; }
  std::uint64_t size() const { return size_; }
  const std::filesystem::path& path() const { return path_; }
  /// Everything written so far is on the disk, still under the temporary name.
  void flush();
  /// flush(), then the file gets its name. Nothing can be written after.
  void commit();

 private:
  [[noreturn]] void fail(const std::string& what, int error) const;
  void create();
  void start_writeback();

  std::filesystem::path path_, temporary_;
  int descriptor_ = -1;
  int slot_ = -1;  ///< in the table remove_temporaries() walks
  std::uint64_t position_ = 0, size_ = 0, started_ = 0;
};

/// Writes one whole file.
void write_file(const std::filesystem::path& path, std::string_view content);

/// Removes the temporary files of every OutputFile still open; safe in a signal handler.
void remove_temporaries() noexcept;

}  // namespace sunder
