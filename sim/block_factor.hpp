// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "meshing/progress.hpp"
#include "sim/beam_element.hpp"

namespace sunder {

/// Symmetric 6 × 6 block of a node, row by row.
using Matrix6 = std::array<double, 36>;

/// A change of the matrix between two nodes (or at one: b == a, then only the first 6 × 6 of the
/// matrix count).
struct BlockChange {
  std::uint32_t a = 0, b = 0;
  Matrix12 delta;
};

/// What the factor has done, for reports and tests.
struct FactorCounts {
  std::uint64_t full = 0, partial = 0, low_rank = 0, solves = 0;
  std::uint64_t nonzeros = 0;  ///< of L
  double flops = 0;            ///< of a full factor
};

/// Cholesky factor of a sparse symmetric positive definite matrix of 6 × 6 blocks, one per node.
/// Multifrontal on dense kernels of its own, nested dissection of the node graph (METIS). After a
/// change the state is exact (to rounding) again: few changes by a low-rank correction that visits
/// only their paths in the elimination tree (Woodbury; the factor stays), many by refactoring only
/// the fronts on those paths; all of them where keeping what that needs would take more than 4 GB.
/// The same calls give the same bits on any x86-64 processor. Not thread-safe.
class BlockFactor {
 public:
  /// Edges may repeat; a != b. O(edges log edges) and METIS.
  BlockFactor(std::uint32_t nodes, std::span<const std::pair<std::uint32_t, std::uint32_t>> edges);
  /// Takes the order from a factor of the same graph: the same bits, without METIS and the C
  /// library's rand(). Reads only what never changes there, so other threads may use `like`. Throws
  /// Error{input} if the graph is another one.
  BlockFactor(std::uint32_t nodes, std::span<const std::pair<std::uint32_t, std::uint32_t>> edges,
              const BlockFactor& like);
  ~BlockFactor();
  BlockFactor(BlockFactor&&) noexcept;

  /// Adds to the matrix; only along the edges given. Needs factor() afterwards.
  void add(const BlockChange& change);
  /// Node of the first pivot that is not positive: a mechanism; kNoNode: factored.
  static constexpr std::uint32_t kNoNode = 0xFFFFFFFFu;
  /// `progress` may throw: then another factor() is needed.
  std::uint32_t factor(const Progress& progress = {});
  /// Adds to the matrix and brings the factor up to date. kNoNode, or where it became singular:
  /// then the matrix holds the change and factor() or a further change must repair it before a
  /// solve.
  std::uint32_t change(std::span<const BlockChange> changes);
  /// x = A⁻¹ b; six numbers per node. Takes half the time where b is that of the last solve but at
  /// few nodes; then the last digits depend on the solves before.
  void solve(std::span<const double> b, std::span<double> x) const;
  /// x += A⁻¹ rest: refines a solution. No later solve starts from this one.
  void correct(std::span<const double> rest, std::span<double> x) const;
  /// A x with the matrix as it is now: for residuals.
  void multiply(std::span<const double> x, std::span<double> result) const;
  /// What rounding of x alone makes of A x: the precision times the largest diagonal entry by its
  /// x.
  double rounding_of(std::span<const double> x) const;
  FactorCounts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunder
