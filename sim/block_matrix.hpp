// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "sim/block_factor.hpp"

namespace sunder {

/// The symmetric matrix of a BlockFactor: the blocks on and below the diagonal in the order of
/// elimination, which names nodes by their places.
class BlockMatrix {
 public:
  /// `place_of`: node → place. Edges between nodes; they may repeat.
  BlockMatrix(const std::vector<std::uint32_t>& place_of,
              std::span<const std::pair<std::uint32_t, std::uint32_t>> edges);

  void add(const BlockChange& change);
  /// result = A x; six numbers per node, in the order of the nodes.
  void multiply(std::span<const double> x, std::span<double> result) const;

  const Matrix6& diagonal(std::uint32_t place) const { return diagonal_[place]; }
  /// Places below the diagonal in the column of `place`, ascending, and their blocks.
  std::span<const std::uint32_t> rows(std::uint32_t place) const {
    return {rows_.data() + start_[place], start_[place + 1] - start_[place]};
  }
  std::span<const Matrix6> blocks(std::uint32_t place) const {
    return {blocks_.data() + start_[place], start_[place + 1] - start_[place]};
  }

 private:
  std::vector<std::uint32_t> place_of_;
  std::vector<Matrix6> diagonal_, blocks_;
  std::vector<std::size_t> start_;
  std::vector<std::uint32_t> rows_;
};

}  // namespace sunder
