// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/front_kernels.hpp"

#include "sim/front_kernels_wide.hpp"

namespace sunder {

const FrontKernels& front_kernels_portable() {
  static constexpr FrontKernels kernels = Wide<2>::kernels();
  return kernels;
}

const FrontKernels& front_kernels() {
  if (const FrontKernels* kernels = front_kernels_avx512()) return *kernels;
  if (const FrontKernels* kernels = front_kernels_avx2()) return *kernels;
  return front_kernels_portable();
}

}  // namespace sunder
