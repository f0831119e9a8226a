// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "fracture/asset.hpp"

namespace sunder {

/// Mass properties of a chunk at density 1, from its closed mesh; exactly symmetric about z = 0.
MassProperties measured_chunk(const WallAsset& asset, std::uint32_t chunk);

/// Per edge of the region: 1 when it lies on a side of the bounding box that wall.anchors names.
std::vector<std::uint8_t> edges_on_anchored_sides(const Wall& wall, const LatticeRegion& region);

/// What Pattern::all_convex says, O(corners).
bool all_convex(const Pattern& pattern);

}  // namespace sunder
