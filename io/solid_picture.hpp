// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "fracture/solid_asset.hpp"
#include "meshing/vec.hpp"

namespace sunder {

/// Pictures of a solid for an SVG, as groups of paths in whole units, y down; both have their lower
/// left corner at the origin.
struct SolidPicture {
  std::string whole;     ///< as it stands
  std::string exploded;  ///< with its chunks pushed apart; empty above kMostDrawnTriangles
  Vec2 whole_size, exploded_size;  ///< units
  double unit = 1;                 ///< m
};
constexpr std::uint64_t kMostDrawnTriangles = 60000;

/// The solid from the front, a little from the right and from above, as it stands in the world: no
/// perspective, farthest triangles first. Same solid, same text.
SolidPicture draw_solid(const SolidAsset& asset);

}  // namespace sunder
