// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fracture/pattern.hpp"
#include "meshing/vec.hpp"

namespace sunder {

/// The other end of an anchor: the world.
constexpr std::uint32_t kWorld = 0xFFFFFFFFu;

/// Interface of two chunks, or of a chunk and the world (an anchor: b = kWorld).
/// Area in m²; centroid in m, wall frame; normal points from a to b, |normal| = 1, z = 0.
struct Bond {
  std::uint32_t a = 0, b = 0;
  double area = 0;
  Vec3 centroid;
  Vec3 normal;
};

/// The support graph: one bond per pair of neighbouring cells (all edges they share together; area
/// is the edges' length × thickness, the normal that of their vector sum), then one anchor per cell
/// and boundary edge with `anchored[edge]` set. Sorted by (a, b), a < b; anchors last. From shared
/// edges, no tolerance. O(corners).
std::vector<Bond> find_bonds(const Pattern& pattern, double thickness,
                             std::span<const std::uint8_t> anchored);

}  // namespace sunder
