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

  /// Whether both have blocks between the same nodes at the same places.
  bool has_places_of(const BlockMatrix& other) const {
    return place_of_ == other.place_of_ && start_ == other.start_ && rows_ == other.rows_;
  }
  void add(const BlockChange& change);
  /// result = A x; six numbers per node, in the order of the nodes.
  void multiply(std::span<const double> x, std::span<double> result) const;

  const Matrix6& diagonal(std::uint32_t place) const { return diagonal_[place]; }
  /// The largest that each of a place's six entries on the diagonal has been: what is left of it by
  /// rounding after all was taken away again is no stiffness.
  const std::array<double, 6>& peak(std::uint32_t place) const { return peak_[place]; }
  /// Places below the diagonal in the column of `place`, ascending, and their blocks.
  std::span<const std::uint32_t> rows(std::uint32_t place) const {
    return {rows_.data() + start_[place], start_[place + 1] - start_[place]};
  }
  std::span<const Matrix6> blocks(std::uint32_t place) const {
    return {blocks_.data() + start_[place], start_[place + 1] - start_[place]};
  }

 private:
  void add_on_diagonal(const Matrix12& delta, int first, std::uint32_t place);

  std::vector<std::uint32_t> place_of_, node_at_;
  std::vector<Matrix6> diagonal_, blocks_;
  std::vector<std::array<double, 6>> peak_;
  std::vector<std::size_t> start_;
  std::vector<std::uint32_t> rows_;
};

}  // namespace sunder
