// SPDX-License-Identifier: GPL-3.0-or-later
// I. S. Duff, J. K. Reid, "The multifrontal solution of indefinite sparse symmetric linear
// equations", ACM Trans. Math. Softw. 9 (1983) 302-325; J. W. H. Liu, "The multifrontal method for
// sparse matrix solution: theory and practice", SIAM Review 34 (1992) 82-109.
#include "sim/front_factor.hpp"

#include <algorithm>

namespace sunder {
namespace {

/// A pivot of no more than this share of what its entry on the diagonal has been is rounding: a
/// mechanism. The tip of a mast of a hundred inclined members of slenderness 100 keeps 3e-10.
constexpr double kPivotShare = 1e-10;

std::size_t packed_size(std::size_t rows) {
  return rows * (rows + 1) / 2;
}

/// Of a factor of `columns` of `rows`, multiplications and additions.
double flops_of(double columns, double rows) {
  const double below = rows - columns;
  return columns * columns * columns / 3 + columns * columns * below + columns * below * below;
}

}  // namespace

FrontFactor::FrontFactor(const FrontTree& tree, const FrontKernels& kernels, double most_kept)
    : tree_(tree), kernels_(kernels), rests_(tree.fronts.size()) {
  std::size_t panels = 0, most_rows = 0, most_columns = 0;
  double kept = 0;
  for (const Front& front : tree.fronts) {
    const std::size_t rows = 6 * front.rows(), columns = 6 * front.count;
    panel_start_.push_back(panels);
    panels += rows * columns;
    most_rows = std::max(most_rows, rows);
    most_columns = std::max(most_columns, columns);
    kept += 8.0 * static_cast<double>(packed_size(rows - columns));
    front_flops_.push_back(flops_of(static_cast<double>(columns), static_cast<double>(rows)));
    flops_ += front_flops_.back();
  }
  keeps_rests_ = kept <= most_kept;
  panels_ = std::make_unique_for_overwrite<double[]>(panels);
  scratch_.resize(factor_scratch(most_rows));
  floor_.resize(most_columns);
  local_.resize(most_rows);
  stale_.assign(tree.fronts.size(), 0);
  touch_all();
}

void FrontFactor::touch_all() {
  std::fill(stale_.begin(), stale_.end(), char{1});
  stale_count_ = stale_.size();
  stale_flops_ = flops_;
}

void FrontFactor::touch(std::uint32_t place) {
  if (!keeps_rests_) return touch_all();
  for (std::uint32_t f = tree_.front_of[place]; f != Front::kNone && !stale_[f];
       f = tree_.fronts[f].parent) {
    stale_[f] = 1;
    ++stale_count_;
    stale_flops_ += front_flops_[f];
  }
}

void FrontFactor::assemble(std::uint32_t f, const BlockMatrix& matrix) {
  const Front& front = tree_.fronts[f];
  const std::size_t rows = 6 * front.rows(), columns = 6 * front.count;
  double* panel = panels_.get() + panel_start_[f];
  std::fill_n(panel, rows * columns, 0.0);
  for (std::uint32_t c = 0; c < front.count; ++c) {
    const std::uint32_t place = front.first + c;
    const auto put = [&](std::size_t row, const Matrix6& block) {
      double* to = panel + 6 * c * rows + 6 * row;
      for (std::size_t i = 0; i < 36; ++i) to[i % 6 * rows + i / 6] = block[i];
    };
    put(c, matrix.diagonal(place));
    for (std::size_t i = 0; i < 6; ++i) floor_[6 * c + i] = kPivotShare * matrix.peak(place)[i];
    auto below = front.below.begin();
    const auto places = matrix.rows(place);
    for (std::size_t e = 0; e < places.size(); ++e) {
      if (places[e] < front.first + front.count) {
        put(places[e] - front.first, matrix.blocks(place)[e]);
      } else {
        below = std::lower_bound(below, front.below.end(), places[e]);
        put(front.count + static_cast<std::size_t>(below - front.below.begin()),
            matrix.blocks(place)[e]);
      }
    }
  }
}

void FrontFactor::add_child(std::uint32_t f, std::uint32_t c) {
  const Front& front = tree_.fronts[f];
  const std::vector<std::uint32_t>& to_row = tree_.fronts[c].row_in_parent;
  const std::size_t rows = 6 * front.rows(), columns = 6 * front.count, below = rows - columns;
  const std::size_t nodes = to_row.size();
  std::vector<std::size_t> run_end(nodes, nodes);  // nodes that stay neighbours in the parent
  for (std::size_t i = nodes - 1; i-- > 0;)
    run_end[i] = to_row[i + 1] == to_row[i] + 1 ? run_end[i + 1] : i + 1;
  const double* from = rests_[c].get();
  double* const panel = panels_.get() + panel_start_[f];
  for (std::size_t column = 0; column < 6 * nodes; ++column) {
    const std::size_t to_column = 6 * to_row[column / 6] + column % 6;
    double* base;  // of the parent's column: where its row to_column is
    if (to_column < columns) {
      base = panel + to_column * rows + to_column;
    } else {
      const std::size_t j = to_column - columns;
      base = rests_[f].get() + j * below - j * (j + 1) / 2 + j;
    }
    for (std::size_t row = column; row < 6 * nodes;) {
      const std::size_t end = 6 * run_end[row / 6];
      double* to = base + (6 * to_row[row / 6] + row % 6 - to_column);
      for (; row < end; ++row) *to++ += *from++;
    }
  }
}

std::uint32_t FrontFactor::factor_front(std::uint32_t f, const BlockMatrix& matrix) {
  const Front& front = tree_.fronts[f];
  const std::size_t rows = 6 * front.rows(), columns = 6 * front.count;
  const std::size_t rest = packed_size(rows - columns);
  assemble(f, matrix);
  if (!rests_[f]) rests_[f] = std::make_unique_for_overwrite<double[]>(rest);
  std::fill_n(rests_[f].get(), rest, 0.0);
  for (std::uint32_t child : front.children) {
    add_child(f, child);
    if (!keeps_rests_) rests_[child].reset();
  }
  const std::size_t good = kernels_.factor(panels_.get() + panel_start_[f], rows, columns,
                                           floor_.data(), rests_[f].get(), scratch_.data());
  return good == columns ? Front::kNone : front.first + static_cast<std::uint32_t>(good / 6);
}

std::uint32_t FrontFactor::refactor(const BlockMatrix& matrix, const Progress& progress) {
  constexpr double kTold = 1e-3;
  if (!keeps_rests_ && is_stale()) touch_all();  // a refactor that stopped kept nothing
  const double all = stale_flops_;
  double told = 0;
  for (std::uint32_t f = 0; f < stale_.size(); ++f) {
    if (!stale_[f]) continue;
    const std::uint32_t bad = factor_front(f, matrix);
    if (bad != Front::kNone) return bad;
    stale_[f] = 0;
    --stale_count_;
    stale_flops_ -= front_flops_[f];
    const double share = 1 - stale_flops_ / all;
    if (!progress || share < told + kTold || !is_stale()) continue;
    told = share;
    progress(share);
  }
  stale_flops_ = 0;
  if (progress) progress(1);
  return Front::kNone;
}

void FrontFactor::forward_front(std::uint32_t f, std::span<double> x) const {
  const Front& front = tree_.fronts[f];
  const std::size_t columns = 6 * front.count;
  double* mine = local_.data();
  std::copy_n(&x[6 * front.first], columns, mine);
  std::fill_n(mine + columns, 6 * front.below.size(), 0.0);
  kernels_.forward(panel(f), 6 * front.rows(), columns, mine);
  std::copy_n(mine, columns, &x[6 * front.first]);
  mine += columns;
  for (std::uint32_t place : front.below)
    for (std::size_t i = 0; i < 6; ++i) x[6 * place + i] += *mine++;
}

void FrontFactor::forward(std::span<double> x) const {
  for (std::uint32_t f = 0; f < tree_.fronts.size(); ++f) forward_front(f, x);
}

void FrontFactor::forward(std::span<double> x, std::span<const std::uint32_t> fronts) const {
  for (std::uint32_t f : fronts) forward_front(f, x);
}

void FrontFactor::backward(std::span<double> x) const {
  for (std::size_t f = tree_.fronts.size(); f-- > 0;) {
    const Front& front = tree_.fronts[f];
    double* mine = std::copy_n(&x[6 * front.first], 6 * front.count, local_.data());
    for (std::uint32_t place : front.below) mine = std::copy_n(&x[6 * place], 6, mine);
    kernels_.backward(panel(static_cast<std::uint32_t>(f)), 6 * front.rows(), 6 * front.count,
                      local_.data());
    std::copy_n(local_.data(), 6 * front.count, &x[6 * front.first]);
  }
}

}  // namespace sunder
