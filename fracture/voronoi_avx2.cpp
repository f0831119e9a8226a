// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/voronoi.hpp"
#include "fracture/voronoi_star.hpp"

#if defined(__AVX2__)
#include <immintrin.h>

namespace sunder {
namespace {

constexpr float kNever = 1e30f;

// The candidates in two registers of eight and one of four.
class Pivot {
 public:
  explicit Pivot(const PaddedSite& site) : site_(site) {
    gather(site.grid->x + site.index, x_, x_last_);
    gather(site.grid->y + site.index, y_, y_last_);
    for (int v = 0; v < 2; ++v)
      square_[v] = _mm256_add_ps(_mm256_mul_ps(x_[v], x_[v]), _mm256_mul_ps(y_[v], y_[v]));
    square_last_ = _mm_add_ps(_mm_mul_ps(x_last_, x_last_), _mm_mul_ps(y_last_, y_last_));
  }

  StarCode next(StarCode from) const {
    const float fx = static_cast<float>(relative_x(site_, from));
    const float fy = static_cast<float>(relative_y(site_, from));
    const __m256 x = _mm256_set1_ps(fx), y = _mm256_set1_ps(fy);
    const __m256 a = cotangent(x, y, 0), b = cotangent(x, y, 1);
    const __m128 c = cotangent_last(_mm256_castps256_ps128(x), _mm256_castps256_ps128(y));
    const __m256 ab = _mm256_min_ps(a, b);
    __m128 low = _mm_min_ps(_mm256_castps256_ps128(ab), _mm256_extractf128_ps(ab, 1));
    low = _mm_min_ps(low, c);
    low = _mm_min_ps(low, _mm_movehl_ps(low, low));
    low = _mm_min_ss(low, _mm_movehdup_ps(low));
    const float least = _mm_cvtss_f32(low);
    if (!(least < kNever)) return 0;
    const float limit = least + static_cast<float>(kTie) * (1 + (least < 0 ? -least : least));
    const __m256 limits = _mm256_set1_ps(limit);
    const auto near_a = static_cast<unsigned>(
        _mm256_movemask_ps(_mm256_cmp_ps(a, limits, _CMP_LE_OQ)));
    const auto near_b = static_cast<unsigned>(
        _mm256_movemask_ps(_mm256_cmp_ps(b, limits, _CMP_LE_OQ)));
    const auto near_c = static_cast<unsigned>(
        _mm_movemask_ps(_mm_cmple_ps(c, _mm256_castps256_ps128(limits))));
    return leftmost(site_, near_a | near_b << 8 | near_c << 16);
  }

  static int first(StarWord word, int size) {
    // Absent codes become the largest.
    const StarWord absent = size == 8 ? 0 : ~StarWord{0} << (8 * size);
    const __m128i codes =
        _mm_cvtepu8_epi16(_mm_cvtsi64_si128(static_cast<long long>(word | absent)));
    return _mm_extract_epi16(_mm_minpos_epu16(codes), 1);
  }

 private:
  static __m128i load(const std::int32_t* from) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
  }

  void gather(const std::int32_t* here, __m256* out, __m128& last) {
    const std::int64_t stride = site_.grid->stride;
    const __m256i origin = _mm256_set1_epi32(*here);
    const auto keep = [&](__m128i low, __m128i high) {
      return _mm256_cvtepi32_ps(_mm256_sub_epi32(_mm256_set_m128i(high, low), origin));
    };
    out[0] = keep(load(here - stride - 2), load(here - 1));
    out[1] = keep(load(here + stride - 2), load(here + 2 * stride - 2));
    const __m128i places =
        _mm_set_epi32(here[2 + 2 * stride], here[2 + stride], here[2 - stride], here[-2]);
    last = _mm_cvtepi32_ps(_mm_sub_epi32(places, _mm256_castsi256_si128(origin)));
  }

  __m256 cotangent(__m256 x, __m256 y, int v) const {
    const __m256 left = _mm256_sub_ps(_mm256_mul_ps(x, y_[v]), _mm256_mul_ps(y, x_[v]));
    const __m256 along = _mm256_add_ps(_mm256_mul_ps(x, x_[v]), _mm256_mul_ps(y, y_[v]));
    const __m256 value = _mm256_div_ps(_mm256_sub_ps(square_[v], along), left);
    const __m256 is_left = _mm256_cmp_ps(left, _mm256_setzero_ps(), _CMP_GT_OQ);
    return _mm256_blendv_ps(_mm256_set1_ps(kNever), value, is_left);
  }

  __m128 cotangent_last(__m128 x, __m128 y) const {
    const __m128 left = _mm_sub_ps(_mm_mul_ps(x, y_last_), _mm_mul_ps(y, x_last_));
    const __m128 along = _mm_add_ps(_mm_mul_ps(x, x_last_), _mm_mul_ps(y, y_last_));
    const __m128 value = _mm_div_ps(_mm_sub_ps(square_last_, along), left);
    const __m128 is_left = _mm_cmpgt_ps(left, _mm_setzero_ps());
    return _mm_blendv_ps(_mm_set1_ps(kNever), value, is_left);
  }

  PaddedSite site_;
  __m256 x_[2], y_[2], square_[2];
  __m128 x_last_, y_last_, square_last_;
};

}  // namespace

bool has_avx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2"); }

void propose_avx2(const PaddedGrid& grid, std::int32_t row_begin, std::int32_t row_end,
                  StarWord* words, StarWord* scratch) {
  propose_rows<Pivot>(grid, row_begin, row_end, words, scratch);
}

}  // namespace sunder

#else

namespace sunder {

bool has_avx2() { return false; }

void propose_avx2(const PaddedGrid& grid, std::int32_t row_begin, std::int32_t row_end,
                  StarWord* words, StarWord* scratch) {
  propose_portable(grid, row_begin, row_end, words, scratch);
}

}  // namespace sunder

#endif
