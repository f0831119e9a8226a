// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "sim/block_factor.hpp"
#include "sim/front_factor.hpp"

namespace sunder {

/// Correction of a factor L Lᵀ = A for A + U D Uᵀ, D = diag(±1), of few columns. Only the rows of
/// the fronts from the changed nodes to the root are touched. Refers to the tree.
class LowRank {
 public:
  explicit LowRank(const FrontTree& tree);
  ~LowRank();

  /// Floating-point operations that add() and an apply() would take with these besides.
  double flops_with(std::span<const BlockChange> changes) const;
  /// False if the changes leave the matrix singular or so nearly that a correction loses more than
  /// five digits; then clear().
  bool add(std::span<const BlockChange> changes, const FrontFactor& factor);
  /// y = (I + Z D Zᵀ)⁻¹ y between the forward and the backward solve, Z = L⁻¹ U.
  void apply(std::span<double> y) const;
  void clear();
  bool empty() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunder
