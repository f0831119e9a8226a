// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

namespace sunder {

/// Dense work on one front. Its panel holds the columns of the eliminated unknowns: `rows` ×
/// `columns`, column by column, of which the lower trapezoid counts. Rows and columns are multiples
/// of 6. Every set gives the same bits: it differs in the width of its vectors only.
struct FrontKernels {
  /// L of the panel in place; subtracts what it contributes from `rest`, the lower triangle of the
  /// rows below, packed column by column. Returns `columns`, or the first whose pivot is not above
  /// its `floor`. `scratch`: factor_scratch(rows) numbers.
  std::size_t (*factor)(double* panel, std::size_t rows, std::size_t columns, const double* floor,
                        double* rest, double* scratch);
  /// x = L⁻¹ x for the first `columns` of its `rows` numbers; subtracts from the others.
  void (*forward)(const double* panel, std::size_t rows, std::size_t columns, double* x);
  /// The first `columns` of x = L⁻ᵀ (x - what the others contribute).
  void (*backward)(const double* panel, std::size_t rows, std::size_t columns, double* x);
  /// forward() for `width` vectors at once (a multiple of 8): row i of the eliminated at
  /// x + i stride, node n of the others (6 rows) at others + places[n] stride.
  void (*forward_many)(const double* panel, std::size_t rows, std::size_t columns, double* x,
                       double* others, const std::size_t* places, std::size_t stride,
                       std::size_t width);
  /// result (row-major, `result_stride`) += aᵀ b: a has `width_a` numbers per row, b `width_b`,
  /// both multiples of 8.
  void (*inner)(std::size_t rows, const double* a, std::size_t stride_a, std::size_t width_a,
                const double* b, std::size_t stride_b, std::size_t width_b, double* result,
                std::size_t result_stride);
};

constexpr std::size_t kStrip = 24;  ///< rows that the product of two blocks takes at once
constexpr std::size_t kDeep = 192;  ///< columns that it sums up before it subtracts
/// Columns of the result that it works on at once, a multiple of kStrip: what the second cache and
/// the processor's table of pages hold.
constexpr std::size_t kBroad = 192;
constexpr std::size_t factor_scratch(std::size_t rows) {
  return (rows + 2 * kStrip) * kDeep;
}

/// The fastest set for this processor.
const FrontKernels& front_kernels();

const FrontKernels& front_kernels_portable();
/// Null where the compiler or the processor has no such instructions.
const FrontKernels* front_kernels_avx2();
const FrontKernels* front_kernels_avx512();

}  // namespace sunder
