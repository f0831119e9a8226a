// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstring>

#include "fracture/voronoi_star.hpp"

namespace sunder {
namespace {

// Four lanes that every processor of the last twenty years has; the compiler maps them.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

constexpr int kVectors = kCandidates / 4;

Int4 load(const std::int32_t* from) {
  Int4 result;
  std::memcpy(&result, from, sizeof result);
  return result;
}

Float4 lower(Float4 a, Float4 b) {
  return a < b ? a : b;
}

class Pivot {
 public:
  struct Tag {};
  static Tag tag() { return {}; }

  explicit Pivot(const PaddedSite& site) : site_(site) {
    gather(site.grid->x + site.index, x_);
    gather(site.grid->y + site.index, y_);
    for (int v = 0; v < kVectors; ++v) square_[v] = x_[v] * x_[v] + y_[v] * y_[v];
  }

  StarCode next(StarCode from) const {
    const float fx = static_cast<float>(relative_x(site_, from));
    const float fy = static_cast<float>(relative_y(site_, from));
    Float4 cotangent[kVectors];
    for (int v = 0; v < kVectors; ++v) {
      const Float4 left = fx * y_[v] - fy * x_[v];
      const Float4 value = (square_[v] - (fx * x_[v] + fy * y_[v])) / left;
      Int4 code;
      std::memcpy(&code, kCandidateCode + 4 * v, sizeof code);
      const Float4 named = (Float4)(((Int4)value & ~0xFF) | code);
      cotangent[v] = left > 0 ? named : Float4{kNever, kNever, kNever, kNever};
    }
    const Float4 low = lower(
        lower(lower(cotangent[0], cotangent[1]), lower(cotangent[2], cotangent[3])), cotangent[4]);
    const float a = low[0] < low[1] ? low[0] : low[1], b = low[2] < low[3] ? low[2] : low[3];
    const float least = a < b ? a : b;
    if (!(least < kNever)) return 0;
    const float limit = near_tie_limit(least);
    Int4 near{};
    for (int v = 0; v < kVectors; ++v)
      near |= (cotangent[v] <= limit) & (Int4{1, 2, 4, 8} << (4 * v));
    const auto set = static_cast<unsigned>(near[0] | near[1] | near[2] | near[3]);
    std::uint32_t bits;
    std::memcpy(&bits, &least, sizeof bits);
    StarCode code = bits & 0xFFu;
    if ((set & (set - 1)) != 0) code = best_of(site_, from, set);
    const bool far = (fx * fx + fy * fy) * (1 + least * least) >= site_.grid->far;
    return far ? better_afar(site_, from, code, Tag{}) : code;
  }

  static int first(StarWord word, int size) { return star_first(word, size); }

 private:
  void gather(const std::int32_t* here, Float4* out) {
    const std::int64_t stride = site_.grid->stride;
    const Int4 origin{*here, *here, *here, *here};
    const auto keep = [&](int v, Int4 places) {
      out[v] = __builtin_convertvector(places - origin, Float4);
    };
    const auto halves = [&](const std::int32_t* low, const std::int32_t* high) {
      return __builtin_shuffle(load(low), load(high - 2), Int4{0, 1, 6, 7});
    };
    keep(0, __builtin_shuffle(load(here - 2), load(here + stride - 3), Int4{0, 5, 6, 7}));
    keep(1, halves(here + stride + 1, here + 1));
    keep(2, load(here + 2 * stride - 3));
    keep(3, halves(here + 2 * stride + 1, here - stride + 1));
    keep(4, load(here - stride - 3));
  }

  PaddedSite site_;
  Float4 x_[kVectors], y_[kVectors], square_[kVectors];
};

}  // namespace

std::int32_t propose_portable(const PaddedGrid& grid, std::int32_t row, std::int32_t row_end,
                              StarWord* words, KernelScratch scratch, LongStar* longs) {
  return propose_rows<Pivot>(grid, row, row_end, words, scratch, longs);
}

}  // namespace sunder
