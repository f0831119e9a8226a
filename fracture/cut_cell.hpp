// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "fracture/cut.hpp"

namespace sunder {

/// Identity of a vertex that arises when cells are cut.
struct NodeKey {
  enum Kind : std::uint32_t { vertex, corner, crossing };
  Kind kind = vertex;
  /// vertex: {pattern vertex}; corner: {boundary corner, the first of those at its place};
  /// crossing: {smaller cell, larger cell, boundary edge}.
  std::array<std::uint32_t, 3> ids{};
  friend auto operator<=>(const NodeKey&, const NodeKey&) = default;
};

/// An edge of a part: from `from` to the next side's; `across` is an old cell or a boundary edge.
struct CutSide {
  NodeKey from;
  Across across;
};

/// A connected part of a cell within the region: outer loop, then holes.
struct CutPart {
  std::vector<std::vector<CutSide>> loops;
};

struct CutCell {
  /// False when no boundary edge separates anything here: `parts` is the whole cell (perhaps with
  /// corners on its edges), and whether it is inside must be told by its neighbours.
  bool decided = false;
  std::vector<CutPart> parts;
  /// Crossings and vertices that lie on a boundary edge, to be placed on it: {key, edge, t in 0…1}.
  struct OnBoundary {
    NodeKey key;
    std::uint32_t edge;
    double t;
  };
  std::vector<OnBoundary> on_boundary;
};

/// What the cell and the boundary edges that touch it make of each other. `across`, `vertices` as
/// in the pattern; `first_at[k]` is the first boundary corner at corner k's place.
CutCell cut_cell(std::uint32_t id, const ExactCell& cell, std::span<const Across> across,
                 std::span<const std::uint32_t> vertices, const LatticeRegion& region,
                 std::span<const std::uint32_t> first_at, std::span<const std::uint32_t> edges);

/// Whether the closed segment meets the closed cell; exact (separating axes).
bool touches(const ExactCell& cell, LatticePoint from, LatticePoint to);

}  // namespace sunder
