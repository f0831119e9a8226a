// SPDX-License-Identifier: GPL-3.0-or-later
// Block products as in K. Goto, R. van de Geijn, "Anatomy of high-performance matrix
// multiplication", ACM Trans. Math. Softw. 34 (2008) 12. Included once by each file that gives a
// set; all is in its own anonymous namespace, so that no function built for a wider processor can
// stand in for another. Each sum runs in the same order whatever the width: multiply, then add,
// column after column; eight partial sums in dot products.
#pragma once

#include <math.h>
#include <string.h>

#include "sim/front_kernels.hpp"

namespace sunder {
namespace {

template <int kWidth>
struct Wide {
  typedef double Vector __attribute__((vector_size(8 * kWidth)));
  static constexpr int kParts = 8 / kWidth;
  /// Vectors of rows in a tile: what the registers hold beside six columns.
  static constexpr int kTall = kWidth == 8 ? 3 : 2;

  static Vector load(const double* from) {
    Vector v;
    memcpy(&v, from, sizeof v);
    return v;
  }
  static void store(double* to, Vector v) { memcpy(to, &v, sizeof v); }

  /// out (6 columns of kStrip) = Σ a(:, l) b(:, l)ᵀ for kTall vectors of rows.
  template <int kTallHere>
  static inline __attribute__((always_inline)) void tile(std::size_t depth, const double* a,
                                                         std::size_t stride_a, const double* b,
                                                         std::size_t stride_b, double* out) {
    Vector sum[6][kTallHere] = {};
    for (std::size_t l = 0; l < depth; ++l, a += stride_a, b += stride_b) {
      Vector rows[kTallHere];
      for (int i = 0; i < kTallHere; ++i) rows[i] = load(a + i * kWidth);
#pragma GCC unroll 6
      for (int j = 0; j < 6; ++j) {
#pragma GCC unroll 3
        for (int i = 0; i < kTallHere; ++i) sum[j][i] += rows[i] * b[j];
      }
    }
#pragma GCC unroll 6
    for (int j = 0; j < 6; ++j) {
#pragma GCC unroll 3
      for (int i = 0; i < kTallHere; ++i)
        store(out + static_cast<std::size_t>(j) * kStrip + i * kWidth, sum[j][i]);
    }
  }

  /// out = a bᵀ for `height` rows (a multiple of 8, at most kStrip) and 6 columns.
  static void product(std::size_t depth, const double* a, std::size_t stride_a, const double* b,
                      std::size_t stride_b, std::size_t height, double* out) {
    constexpr std::size_t kRows = static_cast<std::size_t>(kTall * kWidth);
    std::size_t i = 0;
    for (; i + kRows <= height; i += kRows)
      tile<kTall>(depth, a + i, stride_a, b, stride_b, out + i);
    for (; i < height; i += kWidth) tile<1>(depth, a + i, stride_a, b, stride_b, out + i);
  }

  // ---- factor ---------------------------------------------------------------------------------

  /// Copies rows [first, rows) of the columns into strips: kStrip numbers per column, zeros beyond.
  static void pack(const double* panel, std::size_t rows, std::size_t first, std::size_t columns,
                   double* strips) {
    for (std::size_t i = first; i < rows; i += kStrip) {
      const std::size_t height = rows - i < kStrip ? rows - i : kStrip;
      for (std::size_t l = 0; l < columns; ++l, strips += kStrip) {
        const double* from = panel + l * rows + i;
        if (height == kStrip) {
          for (std::size_t v = 0; v < kStrip; v += kWidth) store(strips + v, load(from + v));
        } else {
          for (std::size_t v = 0; v < kStrip; ++v) strips[v] = v < height ? from[v] : 0;
        }
      }
    }
  }

  /// Subtracts a tile from a column-major block of which column j starts at to(j); rows from `row`
  /// on, not above the diagonal, `height` of them.
  template <class To>
  static inline __attribute__((always_inline)) void subtract(const double* out, std::size_t row,
                                                             std::size_t height, std::size_t column,
                                                             To to) {
    for (std::size_t j = 0; j < 6; ++j) {
      double* at = to(column + j) + row;
      const double* from = out + j * kStrip;
      if (height == kStrip && column + j <= row) {
        for (std::size_t v = 0; v < kStrip; v += kWidth)
          store(at + v, load(at + v) - load(from + v));
        continue;
      }
      for (std::size_t v = column + j > row ? column + j - row : 0; v < height; ++v)
        at[v] -= from[v];
    }
  }

  /// Subtracts (strips)(strips)ᵀ: rows and columns both counted from the strips' first row.
  template <class To>
  static void subtract_product(const double* strips, std::size_t rows, std::size_t columns,
                               std::size_t depth, To to) {
    alignas(64) double out[6 * kStrip];
    for (std::size_t first = 0; first < columns; first += kBroad) {
      const std::size_t last = columns - first < kBroad ? columns : first + kBroad;
      for (std::size_t i = first; i < rows; i += kStrip) {
        const double* a = strips + i * depth;
        const std::size_t height = rows - i < kStrip ? rows - i : kStrip;
        for (std::size_t j = first; j < last && j < i + height; j += 6) {
          const double* b = strips + j / kStrip * kStrip * depth + j % kStrip;
          product(depth, a, kStrip, b, kStrip, (height + 7) / 8 * 8, out);
          subtract(out, i, height, j, to);
        }
      }
    }
  }

  /// Six columns at the diagonal. Returns the first with a bad pivot, or 6.
  static std::size_t factor_node(double* panel, std::size_t rows, std::size_t column,
                                 const double* floor) {
    double* diagonal = panel + column * rows + column;
    double inverse[6];
    for (std::size_t j = 0; j < 6; ++j) {
      double* c = diagonal + j * rows;
      for (std::size_t k = 0; k < j; ++k)
        for (std::size_t i = j; i < 6; ++i) c[i] -= diagonal[k * rows + i] * diagonal[k * rows + j];
      if (!(c[j] > floor[column + j])) return j;
      c[j] = sqrt(c[j]);
      inverse[j] = 1 / c[j];
      for (std::size_t i = j + 1; i < 6; ++i) c[i] *= inverse[j];
    }
    const std::size_t below = rows - column - 6;
    std::size_t i = 0;
    for (; i + kWidth <= below; i += kWidth) {
      Vector x[6];
      for (std::size_t j = 0; j < 6; ++j) {
        x[j] = load(diagonal + j * rows + 6 + i);
        for (std::size_t k = 0; k < j; ++k) x[j] -= x[k] * diagonal[k * rows + j];
        x[j] *= inverse[j];
        store(diagonal + j * rows + 6 + i, x[j]);
      }
    }
    for (; i < below; ++i) {
      for (std::size_t j = 0; j < 6; ++j) {
        double& x = diagonal[j * rows + 6 + i];
        for (std::size_t k = 0; k < j; ++k)
          x -= diagonal[k * rows + 6 + i] * diagonal[k * rows + j];
        x *= inverse[j];
      }
    }
    return 6;
  }

  /// L of columns [first, last) whose earlier columns have been subtracted: halves in turn.
  static std::size_t factor_columns(double* panel, std::size_t rows, std::size_t first,
                                    std::size_t last, const double* floor, double* scratch) {
    if (last - first == 6) {
      const std::size_t good = factor_node(panel, rows, first, floor);
      return good == 6 ? last : first + good;
    }
    const std::size_t middle = first + (last - first) / 12 * 6;
    const std::size_t good = factor_columns(panel, rows, first, middle, floor, scratch);
    if (good < middle) return good;
    for (std::size_t l = first; l < middle; l += kDeep) {
      const std::size_t depth = middle - l < kDeep ? middle - l : kDeep;
      pack(panel + l * rows, rows, middle, depth, scratch);
      subtract_product(scratch, rows - middle, last - middle, depth,
                       [&](std::size_t j) { return panel + (middle + j) * rows + middle; });
    }
    return factor_columns(panel, rows, middle, last, floor, scratch);
  }

  static std::size_t factor(double* panel, std::size_t rows, std::size_t columns,
                            const double* floor, double* rest, double* scratch) {
    const std::size_t good = factor_columns(panel, rows, 0, columns, floor, scratch);
    if (good < columns) return good;
    const std::size_t below = rows - columns;
    for (std::size_t l = 0; l < columns; l += kDeep) {
      const std::size_t depth = columns - l < kDeep ? columns - l : kDeep;
      pack(panel + l * rows, rows, columns, depth, scratch);
      // Column j of the packed triangle begins at its diagonal: here at where row 0 would be.
      subtract_product(scratch, below, below, depth,
                       [&](std::size_t j) { return rest + j * below - j * (j + 1) / 2; });
    }
    return columns;
  }

  // ---- solve ----------------------------------------------------------------------------------

  static void forward(const double* panel, std::size_t rows, std::size_t columns, double* x) {
    for (std::size_t c = 0; c < columns; c += 6) {
      const double* l = panel + c * rows + c;
      double* y = x + c;
      for (std::size_t j = 0; j < 6; ++j) {
        y[j] /= l[j * rows + j];
        for (std::size_t i = j + 1; i < 6; ++i) y[i] -= l[j * rows + i] * y[j];
      }
      const std::size_t left = rows - c;
      std::size_t i = 6;
      for (; i + kWidth <= left; i += kWidth) {
        Vector sum = load(y + i);
        for (std::size_t j = 0; j < 6; ++j) sum -= load(l + j * rows + i) * y[j];
        store(y + i, sum);
      }
      for (; i < left; ++i)
        for (std::size_t j = 0; j < 6; ++j) y[i] -= l[j * rows + i] * y[j];
    }
  }

  static void backward(const double* panel, std::size_t rows, std::size_t columns, double* x) {
    for (std::size_t c = columns; c > 0;) {
      c -= 6;
      const double* l = panel + c * rows + c;
      double* y = x + c;
      Vector sum[6][kParts] = {};
      const std::size_t left = rows - c;
      std::size_t i = 6;
      for (; i + 8 <= left; i += 8) {
        for (int p = 0; p < kParts; ++p) {
          const Vector z = load(y + i + p * kWidth);
#pragma GCC unroll 6
          for (std::size_t j = 0; j < 6; ++j) sum[j][p] += load(l + j * rows + i + p * kWidth) * z;
        }
      }
      for (std::size_t j = 6; j-- > 0;) {
        double parts[8], total = y[j];
        memcpy(parts, sum[j], sizeof parts);
        for (double part : parts) total -= part;
        for (std::size_t k = i; k < left; ++k) total -= l[j * rows + k] * y[k];
        for (std::size_t k = j + 1; k < 6; ++k) total -= l[j * rows + k] * y[k];
        y[j] = total / l[j * rows + j];
      }
    }
  }

  /// Columns [first, last) of L for kWidth vectors: their own rows of x.
  static void forward_triangle(const double* panel, std::size_t rows, std::size_t first,
                               std::size_t last, double* x, std::size_t stride) {
    for (std::size_t i = first; i < last; ++i) {
      Vector sum = load(x + i * stride);
      for (std::size_t k = first; k < i; ++k) sum -= load(x + k * stride) * panel[k * rows + i];
      store(x + i * stride, sum / panel[i * rows + i]);
    }
  }

  static void forward_many(const double* panel, std::size_t rows, std::size_t columns, double* x,
                           double* others, const std::size_t* places, std::size_t stride,
                           std::size_t width) {
    alignas(64) double out[6 * kStrip];
    for (std::size_t first = 0; first < columns; first += kStrip) {
      const std::size_t last = first + kStrip < columns ? first + kStrip : columns;
      for (std::size_t v = 0; v < width; v += kWidth)
        forward_triangle(panel, rows, first, last, x + v, stride);
      for (std::size_t row = last; row < rows; row += 6) {
        double* to =
            row < columns ? x + row * stride : others + places[(row - columns) / 6] * stride;
        for (std::size_t v = 0; v < width; v += kStrip) {
          const std::size_t height = width - v < kStrip ? width - v : kStrip;
          product(last - first, x + first * stride + v, stride, panel + first * rows + row, rows,
                  height, out);
          for (std::size_t j = 0; j < 6; ++j)
            for (std::size_t i = 0; i < height; i += kWidth)
              store(to + j * stride + v + i,
                    load(to + j * stride + v + i) - load(out + j * kStrip + i));
        }
      }
    }
  }

  static void inner(std::size_t rows, const double* a, std::size_t stride_a, std::size_t width_a,
                    const double* b, std::size_t stride_b, std::size_t width_b, double* result,
                    std::size_t result_stride) {
    alignas(64) double out[6 * kStrip];
    for (std::size_t i = 0; i < width_a; i += kStrip) {
      const std::size_t height = width_a - i < kStrip ? width_a - i : kStrip;
      for (std::size_t j = 0; j < width_b; j += 6) {
        // The last columns may be fewer than six: then they overlap those before.
        const std::size_t from = j + 6 <= width_b ? j : width_b - 6;
        product(rows, a + i, stride_a, b + from, stride_b, height, out);
        for (std::size_t r = 0; r < height; ++r)
          for (std::size_t c = j; c < from + 6; ++c)
            result[(i + r) * result_stride + c] += out[(c - from) * kStrip + r];
      }
    }
  }

  static constexpr FrontKernels kernels() {
    return {factor, forward, backward, forward_many, inner};
  }
};

}  // namespace
}  // namespace sunder
