// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>

#include "meshing/error.hpp"
#include "sim/block_factor.hpp"
#include "sim/block_matrix.hpp"
#include "sim/front_factor.hpp"
#include "sim/front_tree.hpp"
#include "sim/low_rank.hpp"

namespace sunder {
namespace {

/// Time per operation of a correction against that of a refactor, as both count them; measured on
/// buildings of 3 x 3 x 12 to 10 x 10 x 30 places.
constexpr double kLowRankCost = 0.6;
/// Forward solves that start from the one before, until rounding is wiped out by a whole one.
constexpr int kMostReuses = 32;

}  // namespace

struct BlockFactor::Impl {
  FrontTree tree;
  BlockMatrix matrix;
  FrontFactor factor;
  LowRank low_rank;
  FactorCounts counts;
  mutable std::vector<double> work;
  mutable std::vector<double> last_b, forwarded;  // L⁻¹ last_b, in the order of elimination
  mutable int reuses = kMostReuses;               // of `forwarded`
  bool is_current = false;  // the factor, with the correction, is that of the matrix

  Impl(FrontTree ordered, std::span<const std::pair<std::uint32_t, std::uint32_t>> edges)
      : tree(std::move(ordered)),
        matrix(tree.place_of, edges),
        factor(tree),
        low_rank(tree),
        work(6 * tree.node_at.size()),
        last_b(work.size()) {
    counts.flops = factor.flops();
    for (const Front& front : tree.fronts) {
      const std::uint64_t columns = 6 * front.count, rows = 6 * front.rows();
      counts.nonzeros += columns * rows - columns * (columns - 1) / 2;
    }
  }

  void add(const BlockChange& change) {
    matrix.add(change);
    factor.touch(tree.place_of[change.a]);
    factor.touch(tree.place_of[change.b]);
  }

  std::uint32_t refactor(const Progress& progress) {
    is_current = false;
    low_rank.clear();
    reuses = kMostReuses;
    ++(factor.stale_flops() < factor.flops() ? counts.partial : counts.full);
    const std::uint32_t place = factor.refactor(matrix, progress);
    is_current = place == Front::kNone;
    return is_current ? kNoNode : tree.node_at[place];
  }

  /// work = b - last_b. Fronts that a forward solve of that must visit; all, if that is no gain.
  std::vector<std::uint32_t> take_difference(std::span<const double> b) const {
    std::vector<char> is_visited(tree.fronts.size(), 0);
    bool is_finite = true;
    for (std::uint32_t i = 0; i < tree.node_at.size(); ++i) {
      const std::size_t from = 6 * std::size_t{tree.node_at[i]};
      bool differs = false;
      for (std::size_t k = 0; k < 6; ++k) {
        const double d = work[6 * i + k] = b[from + k] - last_b[from + k];
        differs |= d != 0;
        is_finite &= std::isfinite(d);
      }
      if (!differs) continue;
      for (std::uint32_t f = tree.front_of[i]; f != Front::kNone && !is_visited[f];
           f = tree.fronts[f].parent)
        is_visited[f] = 1;
    }
    if (!is_finite) is_visited.assign(is_visited.size(), 1);
    std::vector<std::uint32_t> fronts;
    for (std::uint32_t f = 0; f < is_visited.size(); ++f)
      if (is_visited[f]) fronts.push_back(f);
    return fronts;
  }

  void take(std::span<const double> b) const {
    for (std::size_t i = 0; i < tree.node_at.size(); ++i)
      std::copy_n(&b[6 * tree.node_at[i]], 6, &work[6 * i]);
  }

  /// work = L⁻¹ b: from the last b, where that differs at few nodes only.
  void forward(std::span<const double> b) const {
    if (reuses < kMostReuses) {
      const std::vector<std::uint32_t> fronts = take_difference(b);
      if (2 * fronts.size() < tree.fronts.size()) {
        factor.forward(work, fronts);
        for (std::size_t i = 0; i < work.size(); ++i) work[i] += forwarded[i];
        reuses += fronts.empty() ? 0 : 1;
        return keep(b);
      }
    }
    take(b);
    factor.forward(work);
    reuses = 0;
    keep(b);
  }

  void keep(std::span<const double> b) const {
    std::copy(b.begin(), b.end(), last_b.begin());
    forwarded = work;
  }
};

BlockFactor::BlockFactor(std::uint32_t nodes,
                         std::span<const std::pair<std::uint32_t, std::uint32_t>> edges)
    : impl_(std::make_unique<Impl>(front_tree(nodes, edges), edges)) {}
BlockFactor::BlockFactor(std::uint32_t nodes,
                         std::span<const std::pair<std::uint32_t, std::uint32_t>> edges,
                         const BlockFactor& like) {
  const FrontTree& tree = like.impl_->tree;
  if (tree.node_at.size() == nodes) {
    impl_ = std::make_unique<Impl>(tree, edges);
    if (impl_->matrix.has_places_of(like.impl_->matrix)) return;
  }
  throw Error(ErrorCode::input, "block factor: the order of " +
                                    std::to_string(tree.node_at.size()) +
                                    " nodes is that of another graph, not of these " +
                                    std::to_string(nodes) + "; give a factor of the same one");
}
BlockFactor::~BlockFactor() = default;
BlockFactor::BlockFactor(BlockFactor&&) noexcept = default;

void BlockFactor::add(const BlockChange& change) {
  impl_->add(change);
  impl_->is_current = false;
}

std::uint32_t BlockFactor::factor(const Progress& progress) {
  impl_->factor.touch_all();
  return impl_->refactor(progress);
}

std::uint32_t BlockFactor::change(std::span<const BlockChange> changes) {
  if (changes.empty() && impl_->is_current) return kNoNode;
  for (const BlockChange& change : changes) impl_->add(change);
  if (impl_->is_current &&
      kLowRankCost * impl_->low_rank.flops_with(changes) < impl_->factor.stale_flops() &&
      impl_->low_rank.add(changes, impl_->factor)) {
    ++impl_->counts.low_rank;
    return kNoNode;
  }
  return impl_->refactor({});
}

void BlockFactor::solve(std::span<const double> b, std::span<double> x) const {
  assert(impl_->is_current && "the factor stands for the matrix");
  ++impl_->counts.solves;
  std::vector<double>& work = impl_->work;
  const std::vector<std::uint32_t>& node_at = impl_->tree.node_at;
  impl_->forward(b);
  impl_->low_rank.apply(work);
  impl_->factor.backward(work);
  for (std::size_t i = 0; i < node_at.size(); ++i) std::copy_n(&work[6 * i], 6, &x[6 * node_at[i]]);
}

void BlockFactor::correct(std::span<const double> rest, std::span<double> x) const {
  assert(impl_->is_current && "the factor stands for the matrix");
  std::vector<double>& work = impl_->work;
  const std::vector<std::uint32_t>& node_at = impl_->tree.node_at;
  impl_->take(rest);
  impl_->factor.forward(work);
  impl_->low_rank.apply(work);
  impl_->factor.backward(work);
  for (std::size_t i = 0; i < node_at.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k) x[6 * node_at[i] + k] += work[6 * i + k];
}

void BlockFactor::multiply(std::span<const double> x, std::span<double> result) const {
  impl_->matrix.multiply(x, result);
}

double BlockFactor::rounding_of(std::span<const double> x) const {
  double largest = 0;
  for (std::uint32_t i = 0; i < impl_->tree.node_at.size(); ++i) {
    const Matrix6& own = impl_->matrix.diagonal(i);
    const std::size_t from = 6 * std::size_t{impl_->tree.node_at[i]};
    for (std::size_t k = 0; k < 6; ++k)
      largest = std::max(largest, own[7 * k] * std::fabs(x[from + k]));
  }
  return std::numeric_limits<double>::epsilon() * largest;
}

FactorCounts BlockFactor::counts() const {
  return impl_->counts;
}

}  // namespace sunder
