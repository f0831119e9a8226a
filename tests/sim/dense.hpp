// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace sunder {

using Column = std::vector<long double>;

/// Square matrix, row by row, in extended precision: a test sees the library's error, not its own.
struct Dense {
  explicit Dense(std::size_t rows) : size(rows), at(rows * rows) {}
  long double& operator()(std::size_t row, std::size_t column) { return at[size * row + column]; }
  long double operator()(std::size_t row, std::size_t column) const {
    return at[size * row + column];
  }
  std::size_t size;
  std::vector<long double> at;
};

/// Gaussian elimination with row pivots.
inline Column solved(Dense m, Column x) {
  for (std::size_t i = 0; i < m.size; ++i) {
    std::size_t pivot = i;
    for (std::size_t r = i + 1; r < m.size; ++r) {
      if (std::abs(m(r, i)) > std::abs(m(pivot, i))) pivot = r;
    }
    for (std::size_t c = 0; c < m.size; ++c) std::swap(m(i, c), m(pivot, c));
    std::swap(x[i], x[pivot]);
    for (std::size_t r = i + 1; r < m.size; ++r) {
      const long double factor = m(r, i) / m(i, i);
      for (std::size_t c = i; c < m.size; ++c) m(r, c) -= factor * m(i, c);
      x[r] -= factor * x[i];
    }
  }
  for (std::size_t i = m.size; i-- > 0;) {
    for (std::size_t c = i + 1; c < m.size; ++c) x[i] -= m(i, c) * x[c];
    x[i] /= m(i, i);
  }
  return x;
}

/// Eliminates the last rows of a symmetric system down to `kept`; what is left of both is the
/// condensed one.
inline void condense(Dense& m, Column& rhs, std::size_t kept) {
  for (std::size_t i = m.size; i-- > kept;) {
    for (std::size_t r = 0; r < i; ++r) {
      const long double factor = m(r, i) / m(i, i);
      for (std::size_t c = 0; c <= i; ++c) m(r, c) -= factor * m(i, c);
      rhs[r] -= factor * rhs[i];
    }
  }
}

/// Number of negative eigenvalues of a symmetric matrix: signs of its pivots (Sylvester).
inline int negative_eigenvalues(Dense m) {
  int count = 0;
  for (std::size_t i = 0; i < m.size; ++i) {
    if (m(i, i) < 0) ++count;
    for (std::size_t r = i + 1; r < m.size; ++r) {
      const long double factor = m(r, i) / m(i, i);
      if (factor == 0) continue;
      for (std::size_t c = i; c < m.size; ++c) m(r, c) -= factor * m(i, c);
    }
  }
  return count;
}

/// The `number`-th (from 1) value at which k − value × m is singular; below `bound`, k positive.
inline double eigenvalue(const Dense& k, const Dense& m, int number, double bound) {
  long double low = 0, high = bound;
  for (int step = 0; step < 60; ++step) {
    const long double middle = (low + high) / 2;
    Dense shifted = k;
    for (std::size_t i = 0; i < k.at.size(); ++i) shifted.at[i] -= middle * m.at[i];
    (negative_eigenvalues(shifted) >= number ? high : low) = middle;
  }
  return static_cast<double>(low);
}

}  // namespace sunder
