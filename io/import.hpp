// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fracture/measure.hpp"

namespace sunder {

/// One chunk as a file holds it: float32 positions with repeats, as triangles.
struct ImportedChunk {
  std::string name;
  std::vector<float> positions;          ///< 3 per vertex, wall frame (node above applied: no)
  std::vector<std::uint32_t> triangles;  ///< 3 per triangle
  std::vector<std::uint8_t> inner;       ///< per triangle: 1 if its material is an inner one
};

/// A wall's chunks and what its extras say; a format without extras leaves NaN.
struct ImportedWall {
  std::string name;
  std::string material;  ///< "" if the format has none
  SoupWall::Kind kind = SoupWall::Kind::unknown;
  std::vector<ImportedChunk> chunks;
  double volume_expected = 0;  ///< m³, NaN: the file does not say
  std::uint64_t bonds = 0;
};

struct ImportedAsset {
  std::vector<ImportedWall> walls;
  /// True when the format keeps chunks apart (glTF, OBJ), false for STL and PLY.
  bool has_chunks = true;
  bool has_materials = true;
};

struct ImportLimits {
  std::uint64_t memory = std::uint64_t{4} << 30;  ///< bytes, address space of the reader
  double seconds = 60;                            ///< processor time of the reader
  std::uint64_t file_size = std::uint64_t{2} << 30;
};

/// Suffixes that are read: .glb .gltf .obj .stl .ply
bool is_import_suffix(const std::string& suffix);

/// A wall of it as a soup; both must outlive it.
SoupWall soup_of(const ImportedAsset& asset, const ImportedWall& wall);

/// Reads a .glb, .gltf, .obj, .stl or .ply that `sunder fracture` wrote. assimp's readers crash on
/// hostile files, so they run in a child process with limits; files outside the asset's folder are
/// not opened. Throws Error{input} with the path and the reason, also when the child dies.
ImportedAsset import_asset(const std::filesystem::path& path, ImportLimits limits = {});

}  // namespace sunder
