// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace sunder {

/// Nodes that are eliminated together: neighbours in the order whose columns of the factor look
/// alike. Nodes are named by their place in the order.
struct Front {
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  std::uint32_t first = 0, count = 0;  ///< places eliminated: first … first + count - 1
  std::vector<std::uint32_t> below;    ///< places after them that their columns reach, ascending
  std::uint32_t parent = kNone;        ///< front that eliminates below[0]; comes later
  /// Per `below`: its row among the parent's (eliminated, then below).
  std::vector<std::uint32_t> row_in_parent;
  std::vector<std::uint32_t> children;  ///< ascending

  std::uint32_t rows() const { return count + static_cast<std::uint32_t>(below.size()); }
};

/// Elimination tree of a graph by fronts, in an order in which each comes after its children.
struct FrontTree {
  std::vector<std::uint32_t> node_at;   ///< place → node
  std::vector<std::uint32_t> place_of;  ///< node → place
  std::vector<Front> fronts;
  std::vector<std::uint32_t> front_of;  ///< place → front that eliminates it
};

/// Nested dissection, elimination tree, symbolic factor, fronts. Edges may repeat; a != b.
FrontTree front_tree(std::uint32_t nodes,
                     std::span<const std::pair<std::uint32_t, std::uint32_t>> edges);

}  // namespace sunder
