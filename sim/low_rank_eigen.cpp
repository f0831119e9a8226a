// SPDX-License-Identifier: GPL-3.0-or-later
// W. W. Hager, "Updating the inverse of a matrix", SIAM Review 31 (1989) 221-239 (Woodbury). By the
// inertia of [A U; Uᵀ -D] the sum is positive definite just where D + ZᵀZ has as many positive
// eigenvalues as D: with the added columns first, the Schur complement of the taken is negative.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/low_rank.hpp"

namespace sunder {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kRankShare = 1e-14;   // of a change, scaled to a unit diagonal: nothing below it
constexpr std::size_t kMostNodes = 8;  // of changes that are decomposed together
constexpr double kSafePivot = 1e-5;    // what stays of a direction's stiffness: else refactor

/// One column of U: its numbers at the nodes of its patch, and whether it is added or taken.
struct Root {
  std::vector<double> at;
  double sign;
};

/// Changes that are decomposed together, the nodes that they are of, and their columns.
struct Patch {
  std::vector<const BlockChange*> changes;
  std::vector<std::uint32_t> nodes;
  std::vector<Root> roots = {};
};

std::vector<double> scale_of(const Matrix& delta) {
  const auto size = static_cast<std::size_t>(delta.rows());
  std::vector<double> scale(size, 0.0);
  const double most = delta.cwiseAbs().maxCoeff();
  if (most == 0) return scale;
  for (std::size_t i = 0; i < size; ++i) {
    const auto r = static_cast<Eigen::Index>(i);
    const double row = delta.row(r).cwiseAbs().maxCoeff();
    scale[i] = std::sqrt(std::max(std::abs(delta(r, r)), row * (row / most)));
  }
  return scale;
}

/// Columns whose squares, with their signs, sum up to the change: by its eigenvectors after scaling
/// to a unit diagonal, so that stiff and soft freedoms keep the same digits.
std::vector<Root> roots_of(const Matrix& delta) {
  std::vector<Root> roots;
  const auto size = static_cast<std::size_t>(delta.rows());
  const std::vector<double> scale = scale_of(delta);
  Matrix scaled = delta;
  for (Eigen::Index i = 0; i < delta.rows(); ++i) {
    for (Eigen::Index j = 0; j < delta.cols(); ++j) {
      const double by = scale[static_cast<std::size_t>(i)] * scale[static_cast<std::size_t>(j)];
      scaled(i, j) = by > 0 ? delta(i, j) / by : 0;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(scaled);
  const auto& values = solver.eigenvalues();
  const double most = values.cwiseAbs().maxCoeff();
  for (Eigen::Index k = 0; k < delta.rows(); ++k) {
    if (!(std::abs(values[k]) > kRankShare * most)) continue;
    Root root{std::vector<double>(size), values[k] > 0 ? 1.0 : -1.0};
    for (std::size_t i = 0; i < size; ++i)
      root.at[i] = scale[i] * solver.eigenvectors()(static_cast<Eigen::Index>(i), k) *
                   std::sqrt(std::abs(values[k]));
    roots.push_back(std::move(root));
  }
  return roots;
}

/// The sum of its changes, by its nodes.
Matrix sum_of(const Patch& patch) {
  const auto size = static_cast<Eigen::Index>(6 * patch.nodes.size());
  Matrix sum = Matrix::Zero(size, size);
  for (const BlockChange* change : patch.changes) {
    const auto first = [&](std::uint32_t node) {
      return 6 * (std::ranges::find(patch.nodes, node) - patch.nodes.begin());
    };
    const std::array<Eigen::Index, 2> start{first(change->a), first(change->b)};
    const int count = change->a == change->b ? 6 : 12;
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j)
        sum(start[i / 6] + i % 6, start[j / 6] + j % 6) += change->delta(i, j);
  }
  return sum;
}

/// The fronts from some nodes to the root, and the columns of Z that are not zero there.
struct Path {
  std::vector<std::uint32_t> fronts;   // ascending
  std::vector<std::size_t> low, high;  // per front, columns; multiples of 8
  std::vector<std::size_t> start;      // per front, its first row
  std::size_t rows = 0;
};

/// Z of one call of add(): rows of the fronts on its path.
struct Batch {
  Path path;
  std::size_t columns = 0;  // used; rows are `stride` numbers, zeros beyond
  std::size_t stride = 0;
  std::size_t first = 0;  // its first column among all
  std::vector<double> z;
};

std::size_t to_eight(std::size_t count) {
  return (count + 7) / 8 * 8;
}

/// z[row of front] of the part of a batch, from its first column there.
const double* part_of(const Batch& batch, std::size_t i) {
  return batch.z.data() + batch.path.start[i] * batch.stride + batch.path.low[i];
}

}  // namespace

struct LowRank::Impl {
  const FrontTree& tree;
  std::vector<Batch> batches;
  std::vector<double> sign;  // per column
  Matrix gram;               // ZᵀZ
  std::vector<int> added, taken;
  Eigen::LLT<Matrix> added_factor;  // of I + Z₊ᵀZ₊
  Matrix coupling;                  // Z₊ᵀZ₋
  Eigen::LLT<Matrix> taken_factor;  // of the Schur complement, negated
  mutable Vector sum;

  explicit Impl(const FrontTree& of) : tree(of) {}

  std::uint32_t first_place(const BlockChange& change) const {
    return std::min(tree.place_of[change.a], tree.place_of[change.b]);
  }

  Patch alone(const BlockChange& change) const {
    Patch patch{{&change}, {change.a}};
    if (change.b != change.a) patch.nodes.push_back(change.b);
    return patch;
  }

  /// Changes in the order of their first front, so that a front's columns lie side by side.
  std::vector<Patch> sorted(std::span<const BlockChange> changes) const {
    std::vector<Patch> patches;
    for (const BlockChange& change : changes) patches.push_back(alone(change));
    std::ranges::stable_sort(
        patches, {}, [&](const Patch& patch) { return first_place(*patch.changes.front()); });
    return patches;
  }

  /// Puts those together that are of the same nodes and have more columns than a matrix of those:
  /// of n nodes, 6 n. The others keep their order.
  std::vector<Patch> merged(std::vector<Patch> patches) const {
    std::vector<Patch> groups;
    std::vector<std::size_t> group_of, columns;
    for (const Patch& patch : patches) {
      std::vector<std::uint32_t> all;
      const auto takes = [&](const Patch& group) {
        all = group.nodes;
        for (const std::uint32_t node : patch.nodes)
          if (std::ranges::find(all, node) == all.end()) all.push_back(node);
        return all.size() < group.nodes.size() + patch.nodes.size() && all.size() <= kMostNodes;
      };
      const auto group = std::ranges::find_if(groups, takes);
      group_of.push_back(static_cast<std::size_t>(group - groups.begin()));
      if (group == groups.end()) {
        groups.push_back({patch.changes, patch.nodes});
        columns.push_back(patch.roots.size());
      } else {
        group->nodes = all;
        group->changes.push_back(patch.changes.front());
        columns[group_of.back()] += patch.roots.size();
      }
    }
    std::vector<Patch> result;
    for (std::size_t i = 0; i < patches.size(); ++i) {
      Patch& group = groups[group_of[i]];
      if (columns[group_of[i]] <= 6 * group.nodes.size()) {
        result.push_back(std::move(patches[i]));
      } else if (group.changes.front() == patches[i].changes.front()) {
        group.roots = roots_of(sum_of(group));
        result.push_back(group);
      }
    }
    return result;
  }

  /// `column`: per patch its first column, and at the end their count.
  Path path_of(const std::vector<Patch>& patches, const std::vector<std::size_t>& column) const {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> seen;  // front, patch
    std::vector<std::uint32_t> last(tree.fronts.size(), Front::kNone);
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
      for (const std::uint32_t node : patches[i].nodes) {
        for (std::uint32_t f = tree.front_of[tree.place_of[node]];
             f != Front::kNone && last[f] != i; f = tree.fronts[f].parent) {
          last[f] = i;
          seen.emplace_back(f, i);
        }
      }
    }
    std::sort(seen.begin(), seen.end());
    Path path;
    for (const auto& [f, i] : seen) {
      if (path.fronts.empty() || path.fronts.back() != f) {
        path.fronts.push_back(f);
        path.low.push_back(column[i] / 8 * 8);
        path.high.push_back(0);
        path.start.push_back(path.rows);
        path.rows += 6 * tree.fronts[f].count;
      }
      path.high.back() = to_eight(column[i + 1]);
    }
    return path;
  }

  Batch batch_of(std::span<const BlockChange> changes, const FrontFactor& factor,
                 std::vector<double>& signs) const {
    std::vector<Patch> alone = sorted(changes);
    for (Patch& patch : alone) patch.roots = roots_of(sum_of(patch));
    const std::vector<Patch> patches = merged(std::move(alone));
    std::vector<std::size_t> column{0};
    for (const Patch& patch : patches) column.push_back(column.back() + patch.roots.size());
    Batch batch;
    batch.path = path_of(patches, column);
    batch.columns = column.back();
    batch.stride = to_eight(column.back());
    batch.z.assign(batch.path.rows * batch.stride, 0.0);
    std::vector<std::size_t> row_of(tree.fronts.size());  // front → its first row
    for (std::size_t i = 0; i < batch.path.fronts.size(); ++i)
      row_of[batch.path.fronts[i]] = batch.path.start[i];
    const auto row_at = [&](std::uint32_t place) {
      const std::uint32_t f = tree.front_of[place];
      return row_of[f] + 6 * (place - tree.fronts[f].first);
    };
    for (std::size_t i = 0; i < patches.size(); ++i) {
      for (std::size_t c = column[i]; c < column[i + 1]; ++c) {
        const Root& root = patches[i].roots[c - column[i]];
        signs.push_back(root.sign);
        for (std::size_t n = 0; n < patches[i].nodes.size(); ++n) {
          const std::size_t row = row_at(tree.place_of[patches[i].nodes[n]]);
          for (std::size_t k = 0; k < 6; ++k)
            batch.z[(row + k) * batch.stride + c] = root.at[6 * n + k];
        }
      }
    }
    forward(batch, factor, row_at);
    return batch;
  }

  template <class RowAt>
  void forward(Batch& batch, const FrontFactor& factor, const RowAt& row_at) const {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < batch.path.fronts.size(); ++i) {
      const std::uint32_t f = batch.path.fronts[i];
      const Front& front = tree.fronts[f];
      places.clear();
      for (std::uint32_t place : front.below) places.push_back(row_at(place));
      double* z = batch.z.data() + batch.path.low[i];
      factor.kernels().forward_many(factor.panel(f), 6 * front.rows(), 6 * front.count,
                                    z + batch.path.start[i] * batch.stride, z, places.data(),
                                    batch.stride, batch.path.high[i] - batch.path.low[i]);
    }
  }

  /// Columns of `b` are the last: their products with those of `a`.
  void add_products(const Batch& a, const Batch& b, const FrontKernels& kernels) {
    std::vector<double> products(a.stride * b.stride, 0.0);
    for (std::size_t i = 0, j = 0; i < a.path.fronts.size() && j < b.path.fronts.size();) {
      const std::uint32_t f = a.path.fronts[i], g = b.path.fronts[j];
      if (f == g) {
        kernels.inner(6 * tree.fronts[f].count, part_of(a, i), a.stride,
                      a.path.high[i] - a.path.low[i], part_of(b, j), b.stride,
                      b.path.high[j] - b.path.low[j],
                      products.data() + a.path.low[i] * b.stride + b.path.low[j], b.stride);
      }
      if (f <= g) ++i;
      if (g <= f) ++j;
    }
    for (std::size_t i = 0; i < a.columns; ++i) {
      for (std::size_t j = 0; j < b.columns; ++j) {
        const auto row = static_cast<Eigen::Index>(a.first + i);
        const auto column = static_cast<Eigen::Index>(b.first + j);
        gram(row, column) = gram(column, row) = products[i * b.stride + j];
      }
    }
  }

  bool factor_small() {
    added.clear();
    taken.clear();
    for (std::size_t i = 0; i < sign.size(); ++i)
      (sign[i] > 0 ? added : taken).push_back(static_cast<int>(i));
    if (!added.empty()) {
      Matrix first = gram(added, added);
      first.diagonal().array() += 1;
      added_factor.compute(first);
    }
    if (taken.empty()) return true;
    Matrix rest = -gram(taken, taken);
    rest.diagonal().array() += 1;
    if (!added.empty()) {
      coupling = gram(added, taken);
      rest += coupling.transpose() * added_factor.solve(coupling);
    }
    const Vector before = rest.diagonal();
    taken_factor.compute(rest);
    if (taken_factor.info() != Eigen::Success) return false;
    const auto pivots = taken_factor.matrixLLT().diagonal().array().square();
    return (pivots >= kSafePivot * before.array().max(1.0)).all();
  }

  /// sum = (D + ZᵀZ)⁻¹ sum
  void solve_small() const {
    if (taken.empty()) {
      sum = added_factor.solve(sum).eval();
      return;
    }
    Vector of_added = sum(added), of_taken = -sum(taken);
    if (!added.empty()) of_taken += coupling.transpose() * added_factor.solve(of_added);
    taken_factor.solveInPlace(of_taken);
    sum(taken) = of_taken;
    if (added.empty()) return;
    of_added -= coupling * of_taken;
    added_factor.solveInPlace(of_added);
    sum(added) = of_added;
  }
};

LowRank::LowRank(const FrontTree& tree) : impl_(std::make_unique<Impl>(tree)) {}
LowRank::~LowRank() = default;
bool LowRank::empty() const {
  return impl_->batches.empty();
}

void LowRank::clear() {
  impl_->batches.clear();
  impl_->sign.clear();
}

double LowRank::flops_with(std::span<const BlockChange> changes) const {
  // A removed member has rank 6; what more there may be is cheap to have guessed wrong.
  const std::vector<Patch> list = impl_->sorted(changes);
  std::vector<std::size_t> column(list.size() + 1);
  for (std::size_t i = 0; i < column.size(); ++i) column[i] = 6 * i;
  const Path path = impl_->path_of(list, column);
  double flops = 0;
  for (std::size_t i = 0; i < path.fronts.size(); ++i) {
    const Front& front = impl_->tree.fronts[path.fronts[i]];
    const double width = static_cast<double>(path.high[i] - path.low[i]);
    flops += 72.0 * front.count * front.rows() * width + 6.0 * front.count * width * width;
  }
  const double old = static_cast<double>(impl_->sign.size());
  const double rank = old + 6 * static_cast<double>(list.size());
  for (const Batch& batch : impl_->batches)  // products with the columns that are there, apply()
    flops += static_cast<double>(batch.z.size()) * (2 * (rank - old) + 4);
  return flops + rank * rank * rank / 3;
}

bool LowRank::add(std::span<const BlockChange> changes, const FrontFactor& factor) {
  Batch batch = impl_->batch_of(changes, factor, impl_->sign);
  if (batch.columns == 0) return true;
  batch.first = impl_->sign.size() - batch.columns;
  impl_->batches.push_back(std::move(batch));
  const auto rank = static_cast<Eigen::Index>(impl_->sign.size());
  impl_->gram.conservativeResize(rank, rank);
  for (const Batch& other : impl_->batches)
    impl_->add_products(other, impl_->batches.back(), factor.kernels());
  return impl_->factor_small();
}

void LowRank::apply(std::span<double> y) const {
  if (empty()) return;
  impl_->sum.setZero(static_cast<Eigen::Index>(impl_->sign.size()));
  // Columns beyond a batch's last are zeros: only those before it are summed.
  const auto for_rows = [&](const auto& visit) {
    for (const Batch& batch : impl_->batches) {
      for (std::size_t i = 0; i < batch.path.fronts.size(); ++i) {
        const Front& front = impl_->tree.fronts[batch.path.fronts[i]];
        const std::size_t low = batch.path.low[i];
        const auto width =
            static_cast<Eigen::Index>(std::min(batch.path.high[i], batch.columns) - low);
        using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        visit(Eigen::Map<const Rows, 0, Eigen::OuterStride<>>(
                  part_of(batch, i), 6 * front.count, width,
                  Eigen::OuterStride<>(static_cast<Eigen::Index>(batch.stride))),
              Eigen::Map<Vector>(&y[6 * front.first], 6 * front.count),
              impl_->sum.segment(static_cast<Eigen::Index>(batch.first + low), width));
      }
    }
  };
  for_rows(
      [](const auto& z, const auto& mine, auto sum) { sum.noalias() += z.transpose() * mine; });
  impl_->solve_small();
  for_rows([](const auto& z, auto mine, const auto& sum) { mine.noalias() -= z * sum; });
}

}  // namespace sunder
