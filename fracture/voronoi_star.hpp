// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace sunder {

/// Proposing the cells of gridded sites, as the portable and the AVX2 kernel share it.
///
/// A star word holds a cell's neighbours as up to eight bytes, counter-clockwise from the lowest: a
/// neighbour i columns and j rows away is the byte 16 (j + 8) + i + 8, so bytes order like sites and
/// differences of bytes are differences of places. Bytes behind the last neighbour are 0. A word
/// that is 0 says nothing (more than eight neighbours, or a search that failed).
///
/// Every function here is `static` or takes a type of the including file: what the AVX2 file
/// compiles must never be what the linker keeps for processors without AVX2.
using StarWord = std::uint64_t;
using StarCode = std::uint32_t;  ///< one byte of a star word
constexpr StarCode kHere = 0x88;

/// The grid's sites with mirror images of its border cells around it: they make the box's sides
/// ordinary bisectors for the search. Entry (j + kPadLow) * stride + i + kPadLow is grid cell (i, j).
constexpr std::int32_t kPadLow = 3, kPadHigh = 5;
constexpr std::int32_t kSmallestGrid = 6;  ///< fewest columns and rows
struct PaddedGrid {
  const std::int32_t* x = nullptr;
  const std::int32_t* y = nullptr;
  std::int32_t stride = 0, columns = 0, rows = 0;
};

/// Rows of star words a kernel keeps, mirrored columns included: neighbours reach three rows down.
constexpr std::int32_t kScratchRows = 4;

/// Proposes rows [row_begin, row_end) into words (rows × columns of the whole grid). `scratch` is
/// kScratchRows * stride words of 0.
void propose_portable(const PaddedGrid& grid, std::int32_t row_begin, std::int32_t row_end,
                      StarWord* words, StarWord* scratch);
/// The same, eight candidates at a time; only if has_avx2().
void propose_avx2(const PaddedGrid& grid, std::int32_t row_begin, std::int32_t row_end,
                  StarWord* words, StarWord* scratch);

[[maybe_unused]] static inline std::int32_t columns_away(StarCode code) {
  return static_cast<std::int32_t>(code & 15u) - 8;
}
[[maybe_unused]] static inline std::int32_t rows_away(StarCode code) {
  return static_cast<std::int32_t>(code >> 4) - 8;
}
[[maybe_unused]] static inline StarCode reverse(StarCode code) { return (0x110u - code) & 0xFFu; }
/// The neighbour seen from another neighbour of the same site.
[[maybe_unused]] static inline StarCode seen_from(StarCode from, StarCode code) {
  return (code - from + kHere) & 0xFFu;
}
[[maybe_unused]] static inline int star_size(StarWord word) {
  return word == 0 ? 0 : 8 - __builtin_clzll(word) / 8;
}
[[maybe_unused]] static inline StarCode star_code(StarWord word, int k) {
  return static_cast<StarCode>(word >> (8 * k) & 0xFFu);
}
/// Place of a code in a word, 8 if it is not there.
[[maybe_unused]] static inline int star_find(StarWord word, StarCode code) {
  const StarWord zero_byte = word ^ (code * 0x0101010101010101u);
  const StarWord hit = (zero_byte - 0x0101010101010101u) & ~zero_byte & 0x8080808080808080u;
  return hit == 0 ? 8 : __builtin_ctzll(hit) / 8;
}
/// The code before place k, around the star.
[[maybe_unused]] static inline StarCode star_before(StarWord word, int k) {
  return star_code(word, k == 0 ? star_size(word) - 1 : k - 1);
}
/// Place of the smallest code.
[[maybe_unused]] static inline int star_first(StarWord word, int size) {
  int best = 0;
  for (int k = 1; k < size; ++k)
    if (star_code(word, k) < star_code(word, best)) best = k;
  return best;
}
/// The word turned so that place k comes first.
[[maybe_unused]] static inline StarWord star_turned(StarWord word, int size, int k) {
  if (k == 0) return word;
  const StarWord turned = word >> (8 * k) | word << (8 * (size - k));
  return size == 8 ? turned : turned & ((StarWord{1} << (8 * size)) - 1);
}

/// Two candidates for the next neighbour are tied when their cotangents differ by less: then the
/// first one counter-clockwise is taken, and no neighbour of a cocircular set is skipped. Wider than
/// float32 rounding; the certificate corrects a tie that was none.
constexpr double kTie = 4e-6;

/// Site of the grid as the kernels see it: position in the padded arrays.
struct PaddedSite {
  const PaddedGrid* grid;
  std::int64_t index;
};
[[maybe_unused]] static inline std::int64_t index_of(const PaddedSite& site, StarCode code) {
  return site.index + rows_away(code) * std::int64_t{site.grid->stride} + columns_away(code);
}
/// Position of a neighbour relative to the site, lattice units; below 2^23.
[[maybe_unused]] static inline std::int32_t relative_x(const PaddedSite& site, StarCode code) {
  return site.grid->x[index_of(site, code)] - site.grid->x[site.index];
}
[[maybe_unused]] static inline std::int32_t relative_y(const PaddedSite& site, StarCode code) {
  return site.grid->y[index_of(site, code)] - site.grid->y[site.index];
}

/// Where the third site of an empty circle around a site lies when the second comes later: row by
/// row as the kernels load them. Another place is right for 4 in 10^5 circles at full jitter.
/// Relative positions are below 2^23, so float32 holds them exactly.
constexpr int kCandidates = 20;
constexpr StarCode kCandidateCode[kCandidates] = {0x76, 0x77, 0x78, 0x79, 0x87, 0x88, 0x89,
                                                  0x8A, 0x96, 0x97, 0x98, 0x99, 0xA6, 0xA7,
                                                  0xA8, 0xA9, 0x86, 0x7A, 0x9A, 0xAA};

/// Of the candidates in the set, the first one counter-clockwise. All within half a turn.
[[maybe_unused]] static inline StarCode leftmost(const PaddedSite& site, unsigned set) {
  StarCode best = kCandidateCode[__builtin_ctz(set)];
  for (set &= set - 1; set != 0; set &= set - 1) {
    const StarCode code = kCandidateCode[__builtin_ctz(set)];
    if (std::int64_t{relative_x(site, code)} * relative_y(site, best) -
            std::int64_t{relative_y(site, code)} * relative_x(site, best) >
        0)
      best = code;
  }
  return best;
}

/// The next neighbour counter-clockwise after `from`: the site left of it that sees the pair under
/// the widest angle (the empty circle). Searches the whole window; 0 if there is none.
template <class Tag>
static StarCode pivot_in_window(const PaddedSite& site, StarCode from, Tag) {
  const double fx = relative_x(site, from), fy = relative_y(site, from);
  StarCode best = 0;
  double least = 0, best_x = 0, best_y = 0;
  for (StarCode row = 0x50; row <= 0xB0; row += 0x10)
    for (StarCode code = row + 5; code <= row + 11; ++code) {
      const double x = relative_x(site, code), y = relative_y(site, code);
      const double left = fx * y - fy * x;
      if (!(left > 0)) continue;
      const double cotangent = (x * (x - fx) + y * (y - fy)) / left;
      const double slack = kTie * (1 + (least < 0 ? -least : least));
      const bool wins = best == 0 || cotangent < least - slack ||
                        (cotangent <= least + slack && x * best_y - y * best_x > 0);
      if (!wins) continue;
      best = code, best_x = x, best_y = y, least = cotangent;
    }
  return best;
}

/// The nearest site of the window: surely a neighbour.
template <class Tag>
static StarCode nearest_in_window(const PaddedSite& site, Tag) {
  StarCode best = 0;
  double least = 0;
  for (StarCode row = 0x50; row <= 0xB0; row += 0x10)
    for (StarCode code = row + 5; code <= row + 11; ++code) {
      const double x = relative_x(site, code), y = relative_y(site, code);
      if (code == kHere || (best != 0 && x * x + y * y >= least)) continue;
      best = code, least = x * x + y * y;
    }
  return best;
}

/// Turns once around each site. The triangle to the left of a known edge is read from the star of a
/// neighbour that came before (so stars agree by construction); only a triangle whose other two
/// sites come later is searched, among the later sites: two searches a site.
/// Pivot(site) prepares the search around a site, next(code) is the search, first(word, size) the
/// place of the smallest code.
template <class Pivot>
static void propose_rows(const PaddedGrid& grid, std::int32_t row_begin, std::int32_t row_end,
                         StarWord* words, StarWord* scratch) {
  struct Tag {};
  for (std::int32_t j = row_begin; j < row_end; ++j) {
    StarWord* row[kScratchRows];  // row[d]: star words of the row d below
    for (int d = 0; d < kScratchRows; ++d)
      row[d] = scratch + ((j - d) & (kScratchRows - 1)) * std::int64_t{grid.stride} + kPadLow;
    // The oldest row's words are reused: nothing may be found there before it is written.
    for (std::int32_t i = 0; i < grid.columns; ++i) row[0][i] = 0;
    for (std::int32_t i = 0; i < grid.columns; ++i) {
      const PaddedSite site{&grid, (j + kPadLow) * std::int64_t{grid.stride} + i + kPadLow};
      const Pivot pivot(site);
      StarCode first;
      if (star_find(row[0][i - 1], kHere + 1) < 8) first = kHere - 1;
      else if (star_find(row[1][i], kHere + 16) < 8) first = kHere - 16;
      else if (star_find(row[1][i + 1], kHere + 15) < 8) first = kHere - 15;
      else first = nearest_in_window(site, Tag{});
      StarWord word = 0;
      int size = 0;
      StarCode code = first;
      do {
        word |= StarWord{code} << (8 * size++);
        if (code > kHere) {
          code = pivot.next(code);
          continue;
        }
        const StarWord other = row[-rows_away(code)][i + columns_away(code)];
        const int place = star_find(other, reverse(code));
        code = place < 8 ? (star_before(other, place) + code - kHere) & 0xFFu
                         : pivot_in_window(site, code, Tag{});
      } while (code != first && code != 0 && size < 8);
      word = code == first ? star_turned(word, size, Pivot::first(word, size)) : 0;
      row[0][i] = word;
      words[j * std::int64_t{grid.columns} + i] = word;
    }
  }
}

}  // namespace sunder
