// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/block_matrix.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace sunder {
namespace {

/// block += the 6 × 6 of `delta` whose first row and column are these.
void add_part(const Matrix12& delta, int row, int column, Matrix6& block) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      block[static_cast<std::size_t>(6 * i + j)] += delta(row + i, column + j);
}

}  // namespace

BlockMatrix::BlockMatrix(const std::vector<std::uint32_t>& place_of,
                         std::span<const std::pair<std::uint32_t, std::uint32_t>> edges)
    : place_of_(place_of),
      diagonal_(place_of.size(), Matrix6{}),
      peak_(place_of.size()),
      start_(place_of.size() + 1, 0) {
  node_at_.resize(place_of.size());
  for (std::uint32_t node = 0; node < place_of.size(); ++node) node_at_[place_of[node]] = node;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> below;  // column, row
  for (const auto& [a, b] : edges) {
    assert(a != b && "an edge joins two nodes");
    below.emplace_back(std::minmax(place_of[a], place_of[b]));
  }
  std::sort(below.begin(), below.end());
  below.erase(std::unique(below.begin(), below.end()), below.end());
  for (const auto& [column, row] : below) {
    ++start_[column + 1];
    rows_.push_back(row);
  }
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  blocks_.assign(rows_.size(), Matrix6{});
}

void BlockMatrix::add(const BlockChange& change) {
  const std::uint32_t a = place_of_[change.a], b = place_of_[change.b];
  add_on_diagonal(change.delta, 0, a);
  if (a == b) return;
  add_on_diagonal(change.delta, 6, b);
  const std::uint32_t column = std::min(a, b), row = std::max(a, b);
  const auto places = rows(column);
  const auto at = std::lower_bound(places.begin(), places.end(), row);
  assert(at != places.end() && *at == row && "a change lies along an edge");
  Matrix6& block = blocks_[start_[column] + static_cast<std::size_t>(at - places.begin())];
  add_part(change.delta, row == a ? 0 : 6, row == a ? 6 : 0, block);
}

void BlockMatrix::add_on_diagonal(const Matrix12& delta, int first, std::uint32_t place) {
  Matrix6& block = diagonal_[place];
  add_part(delta, first, first, block);
  for (std::size_t i = 0; i < 6; ++i) peak_[place][i] = std::max(peak_[place][i], block[7 * i]);
}

void BlockMatrix::multiply(std::span<const double> x, std::span<double> result) const {
  std::fill(result.begin(), result.end(), 0.0);
  for (std::uint32_t j = 0; j < node_at_.size(); ++j) {
    const double* x_j = &x[6 * std::size_t{node_at_[j]}];
    double sum[6] = {};
    for (std::size_t r = 0; r < 6; ++r)
      for (std::size_t c = 0; c < 6; ++c) sum[c] += diagonal_[j][6 * r + c] * x_j[r];
    for (std::size_t e = start_[j]; e < start_[j + 1]; ++e) {
      const Matrix6& block = blocks_[e];
      const double* x_i = &x[6 * std::size_t{node_at_[rows_[e]]}];
      double* y_i = &result[6 * std::size_t{node_at_[rows_[e]]}];
      for (std::size_t r = 0; r < 6; ++r) {
        const double* row = &block[6 * r];
        for (std::size_t c = 0; c < 6; ++c) sum[c] += row[c] * x_i[r];
        const double even = row[0] * x_j[0] + row[2] * x_j[2] + row[4] * x_j[4];
        const double odd = row[1] * x_j[1] + row[3] * x_j[3] + row[5] * x_j[5];
        y_i[r] += even + odd;
      }
    }
    double* y_j = &result[6 * std::size_t{node_at_[j]}];
    for (std::size_t c = 0; c < 6; ++c) y_j[c] += sum[c];
  }
}

}  // namespace sunder
