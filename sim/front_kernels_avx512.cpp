// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/front_kernels.hpp"

#if defined(__AVX512F__)
#include "sim/front_kernels_wide.hpp"

namespace sunder {

const FrontKernels* front_kernels_avx512() {
  static constexpr FrontKernels kernels = Wide<8>::kernels();
  static const bool has = __builtin_cpu_supports("avx512f");
  return has ? &kernels : nullptr;
}

}  // namespace sunder
#else
namespace sunder {
const FrontKernels* front_kernels_avx512() {
  return nullptr;
}
}  // namespace sunder
#endif
