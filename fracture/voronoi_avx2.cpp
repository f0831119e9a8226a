// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/voronoi.hpp"
#include "fracture/voronoi_star.hpp"

#if defined(__AVX2__)
#include <immintrin.h>

namespace sunder {
namespace {

// The candidates in two registers of eight and one of four.
class Pivot {
 public:
  struct Tag {};
  static Tag tag() { return {}; }

  explicit Pivot(const PaddedSite& site) : site_(site) {
    gather(site.grid->x + site.index, x_, last_x_);
    gather(site.grid->y + site.index, y_, last_y_);
    for (int v = 0; v < 2; ++v)
      square_[v] = _mm256_add_ps(_mm256_mul_ps(x_[v], x_[v]), _mm256_mul_ps(y_[v], y_[v]));
    last_square_ = _mm_add_ps(_mm_mul_ps(last_x_, last_x_), _mm_mul_ps(last_y_, last_y_));
  }

  StarCode next(StarCode from) const {
    const float fx = static_cast<float>(relative_x(site_, from));
    const float fy = static_cast<float>(relative_y(site_, from));
    const __m256 x = _mm256_set1_ps(fx), y = _mm256_set1_ps(fy);
    const __m256 a = cotangent(x, y, 0), b = cotangent(x, y, 1);
    const __m128 c = last_cotangent(_mm256_castps256_ps128(x), _mm256_castps256_ps128(y));
    const __m256 ab = _mm256_min_ps(a, b);
    __m128 low = _mm_min_ps(_mm256_castps256_ps128(ab), _mm256_extractf128_ps(ab, 1));
    low = _mm_min_ps(low, c);
    low = _mm_min_ps(low, _mm_movehl_ps(low, low));
    low = _mm_min_ss(low, _mm_movehdup_ps(low));
    const float least = _mm_cvtss_f32(low);
    if (!(least < kNever)) return 0;
    const __m256 limits = _mm256_set1_ps(near_tie_limit(least));
    const auto last = static_cast<unsigned>(
        _mm_movemask_ps(_mm_cmp_ps(c, _mm256_castps256_ps128(limits), _CMP_LE_OQ)));
    const unsigned near = within(a, limits) | within(b, limits) << 8 | last << 16;
    StarCode code = static_cast<StarCode>(_mm_cvtsi128_si32(_mm_castps_si128(low))) & 0xFFu;
    if ((near & (near - 1)) != 0) code = best_of(site_, from, near);
    const bool far = (fx * fx + fy * fy) * (1 + least * least) >= site_.grid->far;
    return far ? better_afar(site_, from, code, Tag{}) : code;
  }

  static int first(StarWord word, int size) {
    // Absent codes become the largest.
    const StarWord absent = size == 8 ? 0 : ~StarWord{0} << (8 * size);
    const __m128i codes =
        _mm_cvtepu8_epi16(_mm_cvtsi64_si128(static_cast<long long>(word | absent)));
    return _mm_extract_epi16(_mm_minpos_epu16(codes), 1);
  }

 private:
  static unsigned within(__m256 values, __m256 limits) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(values, limits, _CMP_LE_OQ)));
  }
  static __m256i load(const std::int32_t* from) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
  }

  void gather(const std::int32_t* here, __m256 (&out)[2], __m128& last) {
    const std::int64_t stride = site_.grid->stride;
    const __m256i origin = _mm256_set1_epi32(*here);
    const auto keep = [&](__m256i places) {
      return _mm256_cvtepi32_ps(_mm256_sub_epi32(places, origin));
    };
    const __m256i above = _mm256_blend_epi32(load(here + stride - 3), load(here - 5), 0xC0);
    out[0] = keep(_mm256_blend_epi32(above, load(here - 2), 0x01));
    out[1] = keep(_mm256_blend_epi32(load(here + 2 * stride - 3), load(here - stride - 5), 0xC0));
    const __m128i below = _mm_loadu_si128(reinterpret_cast<const __m128i*>(here - stride - 3));
    last = _mm_cvtepi32_ps(_mm_sub_epi32(below, _mm256_castsi256_si128(origin)));
  }

  __m256 cotangent(__m256 x, __m256 y, int v) const {
    const __m256 left = _mm256_sub_ps(_mm256_mul_ps(x, y_[v]), _mm256_mul_ps(y, x_[v]));
    const __m256 along = _mm256_add_ps(_mm256_mul_ps(x, x_[v]), _mm256_mul_ps(y, y_[v]));
    const __m256 value = _mm256_div_ps(_mm256_sub_ps(square_[v], along), left);
    const __m256 is_left = _mm256_cmp_ps(left, _mm256_setzero_ps(), _CMP_GT_OQ);
    const __m256i code =
        _mm256_loadu_si256(reinterpret_cast<const __m256i*>(kCandidateCode + 8 * v));
    const __m256 named =
        _mm256_or_ps(_mm256_and_ps(value, _mm256_castsi256_ps(_mm256_set1_epi32(~0xFF))),
                     _mm256_castsi256_ps(code));
    return _mm256_blendv_ps(_mm256_set1_ps(kNever), named, is_left);
  }

  __m128 last_cotangent(__m128 x, __m128 y) const {
    const __m128 left = _mm_sub_ps(_mm_mul_ps(x, last_y_), _mm_mul_ps(y, last_x_));
    const __m128 along = _mm_add_ps(_mm_mul_ps(x, last_x_), _mm_mul_ps(y, last_y_));
    const __m128 value = _mm_div_ps(_mm_sub_ps(last_square_, along), left);
    const __m128 is_left = _mm_cmp_ps(left, _mm_setzero_ps(), _CMP_GT_OQ);
    const __m128i code = _mm_loadu_si128(reinterpret_cast<const __m128i*>(kCandidateCode + 16));
    const __m128 named = _mm_or_ps(_mm_and_ps(value, _mm_castsi128_ps(_mm_set1_epi32(~0xFF))),
                                   _mm_castsi128_ps(code));
    return _mm_blendv_ps(_mm_set1_ps(kNever), named, is_left);
  }

  PaddedSite site_;
  __m256 x_[2], y_[2], square_[2];
  __m128 last_x_, last_y_, last_square_;
};

// Lane k of row n: the lane before and after k around n lanes.
struct Turns {
  alignas(32) std::int32_t before[9][8], after[9][8];
};
constexpr Turns make_turns() {
  Turns turns{};
  for (int n = 0; n <= 8; ++n)
    for (int k = 0; k < 8; ++k) {
      turns.before[n][k] = k >= n ? k : k == 0 ? n - 1 : k - 1;
      turns.after[n][k] = k >= n ? k : k + 1 == n ? 0 : k + 1;
    }
  return turns;
}
constexpr Turns kTurns = make_turns();

struct Lines {
  __m256d x, y;  // of four neighbours, relative to the site
};
__m256d turn(const Lines& p, const Lines& q) {
  return _mm256_sub_pd(_mm256_mul_pd(p.x, q.y), _mm256_mul_pd(p.y, q.x));
}
__m256d square(const Lines& p) {
  return _mm256_add_pd(_mm256_mul_pd(p.x, p.x), _mm256_mul_pd(p.y, p.y));
}

// Bits of the four lanes that hold: turns are exact; each of the three products of an edge's
// determinant is below 2^92, so that its error is below 2^43.
unsigned holds(const Lines& before, const Lines& line, const Lines& after) {
  const __m256d entry = turn(before, line), exit = turn(line, after);
  const __m256d length =
      _mm256_add_pd(_mm256_sub_pd(_mm256_mul_pd(square(before), exit),
                                  _mm256_mul_pd(square(line), turn(before, after))),
                    _mm256_mul_pd(square(after), entry));
  const __m256d left = _mm256_cmp_pd(entry, _mm256_setzero_pd(), _CMP_GT_OQ);
  const __m256d is_long = _mm256_cmp_pd(length, _mm256_set1_pd(kBriefEdge + 0x1p43), _CMP_GE_OQ);
  return static_cast<unsigned>(_mm256_movemask_pd(_mm256_and_pd(left, is_long)));
}

Lines low_lines(__m256i x, __m256i y) {
  return {_mm256_cvtepi32_pd(_mm256_castsi256_si128(x)),
          _mm256_cvtepi32_pd(_mm256_castsi256_si128(y))};
}
Lines high_lines(__m256i x, __m256i y) {
  return {_mm256_cvtepi32_pd(_mm256_extracti128_si256(x, 1)),
          _mm256_cvtepi32_pd(_mm256_extracti128_si256(y, 1))};
}

__m256i lanes_of(const std::int32_t (&row)[8]) {
  return _mm256_load_si256(reinterpret_cast<const __m256i*>(row));
}

// The star's cells; lanes behind the last one name the cell itself.
__m256i neighbours(StarWord word, int size, std::uint32_t cell, __m256i columns) {
  const __m256i code = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(word)));
  const __m256i eight = _mm256_set1_epi32(8);
  const __m256i rows = _mm256_sub_epi32(_mm256_srli_epi32(code, 4), eight);
  const __m256i side = _mm256_sub_epi32(_mm256_and_si256(code, _mm256_set1_epi32(15)), eight);
  const __m256i offset = _mm256_add_epi32(_mm256_mullo_epi32(rows, columns), side);
  const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256i there = _mm256_cmpgt_epi32(_mm256_set1_epi32(size), lane);
  return _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(cell)),
                          _mm256_and_si256(offset, there));
}

bool surely_holds(StarWord word, const std::int32_t* xy, std::uint32_t cell, __m256i columns) {
  const int size = star_size(word);
  const __m256i cells = neighbours(word, size, cell, columns);
  const auto* sites = reinterpret_cast<const long long*>(xy);
  const __m256i low = _mm256_i32gather_epi64(sites, _mm256_castsi256_si128(cells), 8);
  const __m256i high = _mm256_i32gather_epi64(sites, _mm256_extracti128_si256(cells, 1), 8);
  const auto part = [&](__m256 mixed, std::int32_t origin) {
    const __m256i sorted = _mm256_permute4x64_epi64(_mm256_castps_si256(mixed), 0xD8);
    return _mm256_sub_epi32(sorted, _mm256_set1_epi32(origin));
  };
  const __m256 a = _mm256_castsi256_ps(low), b = _mm256_castsi256_ps(high);
  const __m256i x = part(_mm256_shuffle_ps(a, b, 0x88), xy[2 * std::size_t{cell}]);
  const __m256i y = part(_mm256_shuffle_ps(a, b, 0xDD), xy[2 * std::size_t{cell} + 1]);
  const __m256i before = lanes_of(kTurns.before[size]), after = lanes_of(kTurns.after[size]);
  const __m256i bx = _mm256_permutevar8x32_epi32(x, before);
  const __m256i by = _mm256_permutevar8x32_epi32(y, before);
  const __m256i ax = _mm256_permutevar8x32_epi32(x, after);
  const __m256i ay = _mm256_permutevar8x32_epi32(y, after);
  const unsigned held = holds(low_lines(bx, by), low_lines(x, y), low_lines(ax, ay)) |
                        holds(high_lines(bx, by), high_lines(x, y), high_lines(ax, ay)) << 4;
  const unsigned all = (1u << size) - 1;
  return (held & all) == all;
}

}  // namespace

std::uint32_t doubtful_cells_avx2(const StarWord* words, const std::int32_t* xy,
                                  std::int32_t columns, std::uint32_t begin, std::uint32_t end,
                                  std::uint32_t* doubtful) {
  const __m256i width = _mm256_set1_epi32(columns);
  std::uint32_t count = 0;
  for (std::uint32_t cell = begin; cell < end; ++cell) {
    const StarWord word = words[cell];
    doubtful[count] = cell;
    if (word >> 56 == 0xFF)
      ++count;
    else
      count += !surely_holds(word, xy, cell, width);
  }
  return count;
}

bool has_avx2() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
         __builtin_cpu_supports("bmi2");
}

std::int32_t propose_avx2(const PaddedGrid& grid, std::int32_t row, std::int32_t row_end,
                          StarWord* words, KernelScratch scratch, LongStar* longs) {
  return propose_rows<Pivot>(grid, row, row_end, words, scratch, longs);
}

}  // namespace sunder

#else

namespace sunder {

bool has_avx2() {
  return false;
}

std::uint32_t doubtful_cells_avx2(const StarWord*, const std::int32_t*, std::int32_t, std::uint32_t,
                                  std::uint32_t, std::uint32_t*) {
  return 0;
}

std::int32_t propose_avx2(const PaddedGrid& grid, std::int32_t row, std::int32_t row_end,
                          StarWord* words, KernelScratch scratch, LongStar* longs) {
  return propose_portable(grid, row, row_end, words, scratch, longs);
}

}  // namespace sunder

#endif
