// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "meshing/progress.hpp"
#include "sim/block_matrix.hpp"
#include "sim/front_kernels.hpp"
#include "sim/front_tree.hpp"

namespace sunder {

/// Multifrontal Cholesky factor over a tree of fronts. Each front keeps what it contributes to its
/// parent, so that after a change only the fronts from there to the root are done again; if that
/// took more than `most_kept` bytes, it is dropped, and each change does all again. The tree must
/// outlive it.
class FrontFactor {
 public:
  explicit FrontFactor(const FrontTree& tree, const FrontKernels& kernels = front_kernels(),
                       double most_kept = 4e9);

  /// The matrix changed at this place: its front and those above are stale.
  void touch(std::uint32_t place);
  void touch_all();
  bool is_stale() const { return stale_count_ > 0; }
  /// Floating-point operations that refactor() would take, and that all fronts take.
  double stale_flops() const { return stale_flops_; }
  double flops() const { return flops_; }

  /// Brings the stale fronts up to date. Returns the place of the first pivot that is not positive:
  /// then what is left stays stale, as it does if `progress` throws. Else Front::kNone. It is told
  /// the share of the operations, at steps of a thousandth at least.
  std::uint32_t refactor(const BlockMatrix& matrix, const Progress& progress = {});

  // With an up-to-date factor; six numbers per place.
  void forward(std::span<double> x) const;   ///< x = L⁻¹ x
  void backward(std::span<double> x) const;  ///< x = L⁻ᵀ x
  /// forward() where x is zero but in these fronts, which hold those above each; ascending.
  void forward(std::span<double> x, std::span<const std::uint32_t> fronts) const;
  /// Columns of L that a front eliminates: its rows × 6 count.
  const double* panel(std::uint32_t front) const { return panels_.get() + panel_start_[front]; }
  const FrontKernels& kernels() const { return kernels_; }

 private:
  void assemble(std::uint32_t front, const BlockMatrix& matrix);
  void add_child(std::uint32_t front, std::uint32_t child);
  std::uint32_t factor_front(std::uint32_t front, const BlockMatrix& matrix);
  void forward_front(std::uint32_t front, std::span<double> x) const;

  const FrontTree& tree_;
  const FrontKernels& kernels_;
  std::vector<std::size_t> panel_start_;
  std::unique_ptr<double[]> panels_;
  std::vector<std::unique_ptr<double[]>> rests_;  ///< per front, packed lower triangle
  bool keeps_rests_ = true;
  std::vector<char> stale_;
  std::size_t stale_count_ = 0;
  double flops_ = 0, stale_flops_ = 0;
  std::vector<double> front_flops_;
  std::vector<double> scratch_, floor_;
  mutable std::vector<double> local_;  ///< a front's part of a vector
};

}  // namespace sunder
