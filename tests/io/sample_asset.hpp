// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fracture/asset.hpp"
#include "fracture/bonds.hpp"
#include "fracture/chunk_mesh.hpp"
#include "meshing/random.hpp"
#include "meshing/tri_mesh.hpp"

namespace sunder {

/// A wall of columns × rows cells of about 0.5 m whose inner corners are moved by up to 0.1 m,
/// fractured by hand, so that what is written does not depend on a generator.
inline WallAsset sample_wall(const std::string& name, std::uint32_t columns, std::uint32_t rows,
                             std::uint64_t seed = 1) {
  WallAsset asset;
  asset.wall.name = name;
  asset.wall.region = {rectangle({0.5 * columns, 0.5 * rows}), {}};
  asset.wall.anchors = {"bottom"};
  asset.region =
      make_lattice_region(asset.wall.region, make_lattice({}, {0.5 * columns, 0.5 * rows}), name);
  Pattern& p = asset.pattern;
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const std::uint32_t id = j * (columns + 1) + i;
      const bool fixed_x = i == 0 || i == columns, fixed_y = j == 0 || j == rows;
      const double dx = fixed_x ? 0 : 0.2 * random_unit(seed, id, 0) - 0.1;
      const double dy = fixed_y ? 0 : 0.2 * random_unit(seed, id, 1) - 0.1;
      p.vertices.push_back({0.5 * i + dx, 0.5 * j + dy});
    }
  }
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t low = j * (columns + 1) + i, high = low + columns + 1;
      const std::uint32_t cell = j * columns + i;
      p.corners.insert(p.corners.end(), {low, low + 1, high + 1, high});
      p.across.push_back(j == 0 ? Across::border(0) : Across::cell(cell - columns));
      p.across.push_back(i + 1 == columns ? Across::border(1) : Across::cell(cell + 1));
      p.across.push_back(j + 1 == rows ? Across::border(2) : Across::cell(cell + columns));
      p.across.push_back(i == 0 ? Across::border(3) : Across::cell(cell - 1));
      p.cell_begin.push_back(static_cast<std::uint32_t>(p.corners.size()));
    }
  }
  p.all_convex = true;
  for (std::uint32_t c = 0; c < p.cell_count(); ++c) {
    asset.chunks.push_back(mass_properties(chunk_mesh(asset, c).mesh));
  }
  asset.bonds = find_bonds(p, asset.wall.thickness, std::vector<std::uint8_t>{1, 0, 0, 0});
  asset.volume_expected = 0.25 * columns * rows * asset.wall.thickness;
  return asset;
}

/// A folder of its own for a test's files, removed at the end.
class TestFolder {
 public:
  TestFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "sunder_test_XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }
  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
      result.push_back(entry.path().filename().string());
    }
    std::sort(result.begin(), result.end());
    return result;
  }

 private:
  std::filesystem::path path_;
};

inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void put_content(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

}  // namespace sunder
