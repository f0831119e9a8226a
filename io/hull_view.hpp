// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "fracture/hulls.hpp"

namespace sunder {

/// Whose rules the nodes of hulls follow; none: they are in no scene, for colliders only.
enum class HullNodes : std::uint8_t { none, ucx, convcol };
HullNodes hull_nodes(std::string_view name);

/// Hulls of a wall or solid as a file has them; the set must outlive it.
struct HullView {
  const HullSet* set = nullptr;  ///< none: no hulls
  HullNodes nodes = HullNodes::none;
  bool physics = false;  ///< chunks are rigid bodies
  double friction = 0.6, restitution = 0.1;

  std::uint32_t count() const { return set ? set->hull_count() : 0; }
  std::uint32_t begin(std::uint32_t chunk) const { return set ? set->hull_begin[chunk] : 0; }
  std::uint32_t count(std::uint32_t chunk) const {
    return set ? set->hull_begin[chunk + 1] - set->hull_begin[chunk] : 0;
  }
};

/// UCX_<chunk>_00 (Unreal: convex collision of the mesh of that name), <chunk>_00-convcolonly
/// (Godot: a convex collision shape in place of the mesh) or <chunk>_hull_00.
std::string hull_name(HullNodes nodes, std::string_view chunk, std::uint32_t index);
/// Whether a node's name is one of the first two, whose mesh is not a chunk.
bool is_hull_name(std::string_view name);

}  // namespace sunder
