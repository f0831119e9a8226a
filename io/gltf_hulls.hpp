// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "io/gltf_layout.hpp"
#include "io/gltf_text.hpp"

namespace sunder {

/// Writes hulls and rigid bodies (KHR_physics_rigid_bodies) into a glTF document: a node, a mesh
/// and two accessors per hull, then a node per collider of a chunk with several hulls.
class GltfHulls {
 public:
  struct First {
    std::uint64_t node = 0, mesh = 0, accessor = 0;  ///< of hull 0
  };
  GltfHulls(std::span<const WallView> walls, const GltfLayout& layout, First first, GltfText& out);

  /// `"extensionsUsed":…,"extensions":…,` of the document.
  void write_extensions();
  /// Adds a wall's hulls to its children.
  void add_to_wall(std::size_t w, bool& first);
  /// A chunk's `,"children":…,"extensions":…`.
  void write_in_chunk(std::size_t w, std::uint32_t chunk);
  void write_nodes();
  void write_meshes();
  void write_accessors(bool& first);

 private:
  bool has_physics() const;
  void write_motion(const WallView& wall, std::uint32_t chunk);
  void write_collider(std::size_t w, std::uint64_t hull);
  template <class Visit>
  void for_each_hull(const Visit& visit) const;

  std::span<const WallView> walls_;
  const GltfLayout& layout_;
  First first_;
  std::vector<std::uint64_t> wall_hull_;              // number of each wall's first hull
  std::vector<std::vector<std::uint64_t>> collider_;  // per wall and chunk: its first collider node
  GltfText& out_;
};

}  // namespace sunder
