// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/front_kernels.hpp"

#if defined(__AVX2__)
#include "sim/front_kernels_wide.hpp"

namespace sunder {

const FrontKernels* front_kernels_avx2() {
  static constexpr FrontKernels kernels = Wide<4>::kernels();
  static const bool has = __builtin_cpu_supports("avx2");
  return has ? &kernels : nullptr;
}

}  // namespace sunder
#else
namespace sunder {
const FrontKernels* front_kernels_avx2() {
  return nullptr;
}
}  // namespace sunder
#endif
