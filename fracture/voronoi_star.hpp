// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace sunder {

/// Proposing the cells of gridded sites, as the portable and the AVX2 kernel share it.
///
/// A star word holds a cell's neighbours as up to eight bytes, counter-clockwise from the lowest: a
/// neighbour i columns and j rows away is the byte 16 (j + 8) + i + 8, so bytes order like sites
/// and differences of bytes are differences of places. Bytes behind the last neighbour are 0. A
/// word that is 0 says nothing (too many neighbours, or a search that failed).
///
/// Every function here is `static` or takes a type of the including file: what the AVX2 file
/// compiles must never be what the linker keeps for processors without AVX2.
using StarWord = std::uint64_t;
using StarCode = std::uint32_t;  ///< one byte of a star word
constexpr StarCode kHere = 0x88;

/// The grid's sites with mirror images of its border cells around it: they make the box's sides
/// ordinary bisectors for the search. Entry (j + kPadLow) * stride + i + kPadLow is grid cell (i,
/// j).
constexpr std::int32_t kPadLow = 3, kPadHigh = 5;
constexpr std::int32_t kSmallestGrid = 6;  ///< fewest columns and rows
struct PaddedGrid {
  const std::int32_t* x = nullptr;
  const std::int32_t* y = nullptr;
  std::int32_t stride = 0, columns = 0, rows = 0;
  /// Squared diameter of an empty circle that may reach sites which are no candidates: two cells.
  float far = 0;
};

/// A star of nine to sixteen neighbours: the first eight and the others, as found (not turned).
struct LongStar {
  StarWord low, high;
  std::uint32_t cell;
};
constexpr int kLongest = 16;
/// Stands in the scratch rows for a star word that is too long.
constexpr StarWord kLong = StarWord{0xFF} << 56;

/// What a kernel remembers between rows: the star words of the last rows, mirrored columns included
/// (two in work, and neighbours reach three rows down), and what stands behind kLong. All words 0
/// at first; kScratchRows * stride each, and kMargin words on both sides, which codes of
/// contradicting stars may reach.
constexpr std::int32_t kScratchRows = 8, kMargin = 8;
struct KernelScratch {
  StarWord* words;
  LongStar* longs;
};

/// Proposes rows row and row + 1 (only `row` if it is the last) into words (rows × columns of the
/// whole grid) and those that do not fit into `longs` (room for both rows). Rows come in order.
/// Returns how many do not fit; a cell with more than sixteen neighbours gets the word 0.
std::int32_t propose_portable(const PaddedGrid& grid, std::int32_t row, std::int32_t row_end,
                              StarWord* words, KernelScratch scratch, LongStar* longs);
/// The same, eight candidates at a time; only if has_avx2().
std::int32_t propose_avx2(const PaddedGrid& grid, std::int32_t row, std::int32_t row_end,
                          StarWord* words, KernelScratch scratch, LongStar* longs);

/// Writes the cells of [begin, end) whose star word does not hold for certain to `doubtful` (room
/// for all) and returns how many. For certain means exactly: every corner turns left, every edge is
/// longer than kBriefEdge as a determinant (see voronoi_exact.cpp); lists are always doubtful.
/// Neighbours lie less than 2^22 lattice units apart per axis. `xy`: the sites. Only if has_avx2().
constexpr double kBriefEdge = 0x1p62;
std::uint32_t doubtful_cells_avx2(const StarWord* words, const std::int32_t* xy,
                                  std::int32_t columns, std::uint32_t begin, std::uint32_t end,
                                  std::uint32_t* doubtful);

[[maybe_unused]] static inline std::int32_t columns_away(StarCode code) {
  return static_cast<std::int32_t>(code & 15u) - 8;
}
[[maybe_unused]] static inline std::int32_t rows_away(StarCode code) {
  return static_cast<std::int32_t>(code >> 4) - 8;
}
[[maybe_unused]] static inline StarCode reverse(StarCode code) {
  return (0x110u - code) & 0xFFu;
}
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
  const int size = star_size(word);
  return star_code(word, k - 1 + (static_cast<int>(k == 0) * size));
}
/// The code after place k, around the star.
[[maybe_unused]] static inline StarCode star_after(StarWord word, int k) {
  return star_code(word, k + 1 == star_size(word) ? 0 : k + 1);
}
/// Place of the smallest code.
[[maybe_unused]] static inline int star_first(StarWord word, int size) {
  int best = 0;
  for (int k = 1; k < size; ++k)
    if (star_code(word, k) < star_code(word, best)) best = k;
  return best;
}
/// A bit in byte k for every corner k whose cells on both sides come later.
[[maybe_unused]] static inline StarWord owned_corners(StarWord word, int size) {
  const StarWord low = 0x7F7F7F7F7F7F7F7Fu, high = 0x8080808080808080u;
  const StarWord later = word & ((word & low) + 0x7777777777777777u) & high;  // bytes above kHere
  return later & (later << 8 | later >> (8 * (size - 1)));
}
/// The word turned so that place k comes first.
[[maybe_unused]] static inline StarWord star_turned(StarWord word, int size, int k) {
  if (k == 0) return word;
  const StarWord turned = word >> (8 * k) | word << (8 * (size - k));
  return size == 8 ? turned : turned & ((StarWord{1} << (8 * size)) - 1);
}

/// Kernels keep a candidate's code in the lowest byte of its cotangent, so that the least cotangent
/// names it. Candidates that differ by less, relatively, are therefore compared again exactly.
constexpr float kNearTie = 1e-4f;
constexpr float kNever = 1e30f;  ///< the cotangent of a candidate that is not to the left

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

/// Where the third site of an empty circle around a site lies when the second comes later and is
/// not the last of the turn, in the order in which the kernels load them: all places but those more
/// than two cells away, which need a large circle, and few that did not occur in 10^6 cells at full
/// jitter. Relative positions are below 2^23, so float32 holds them exactly.
constexpr int kCandidates = 20;
constexpr std::int32_t kCandidateCode[kCandidates] = {0x86, 0x96, 0x97, 0x98, 0x99, 0x9A, 0x89,
                                                      0x8A, 0xA5, 0xA6, 0xA7, 0xA8, 0xA9, 0xAA,
                                                      0x79, 0x7A, 0x75, 0x76, 0x77, 0x78};
[[maybe_unused]] static inline float near_tie_limit(float least) {
  return least + kNearTie * (1 + (least < 0 ? -least : least));
}

/// How a candidate sees the pair (site, known neighbour): the cotangent along / left of its angle.
struct Sight {
  StarCode code;
  std::int64_t x, y;  ///< relative to the site
  std::int64_t along, left;
};
[[maybe_unused]] static inline Sight sight_of(const PaddedSite& site, StarCode from,
                                              StarCode code) {
  const std::int64_t fx = relative_x(site, from), fy = relative_y(site, from);
  const std::int64_t x = relative_x(site, code), y = relative_y(site, code);
  return {code, x, y, x * (x - fx) + y * (y - fy), fx * y - fy * x};
}
/// Whether a sees the pair under a wider angle than b; of cocircular ones the first
/// counter-clockwise wins, so that none of them is skipped. Both lie left; exact.
[[maybe_unused]] static inline bool wins(const Sight& a, const Sight& b) {
  __extension__ using Wide = __int128;
  const Wide gap = static_cast<Wide>(a.along) * b.left - static_cast<Wide>(b.along) * a.left;
  return gap < 0 || (gap == 0 && a.x * b.y - a.y * b.x > 0);
}

/// Of the candidates in the set (which float32 cannot tell apart), the one that wins.
[[maybe_unused]] static StarCode best_of(const PaddedSite& site, StarCode from, unsigned set) {
  Sight best{};
  for (; set != 0; set &= set - 1) {
    const auto code = static_cast<StarCode>(kCandidateCode[__builtin_ctz(set)]);
    const Sight other = sight_of(site, from, code);
    if (best.code == 0 || wins(other, best)) best = other;
  }
  return best.code;
}

/// The next neighbour counter-clockwise after `from`: the site left of it that sees the pair under
/// the widest angle (the empty circle). Searches the whole window, exactly; 0 if there is none.
template <class Tag>
static StarCode pivot_in_window(const PaddedSite& site, StarCode from, Tag) {
  Sight best{};
  for (StarCode row = 0x50; row <= 0xB0; row += 0x10)
    for (StarCode code = row + 5; code <= row + 11; ++code) {
      const Sight other = sight_of(site, from, code);
      if (other.left > 0 && (best.code == 0 || wins(other, best))) best = other;
    }
  return best.code;
}

/// The winner of the candidates, or a site more than two cells away that wins over it.
template <class Tag>
static StarCode better_afar(const PaddedSite& site, StarCode from, StarCode candidate, Tag) {
  constexpr StarCode afar[] = {0x57, 0x58, 0x59, 0x67, 0x68, 0x69, 0x7B,
                               0x85, 0x8B, 0x95, 0x9B, 0xB7, 0xB8, 0xB9};
  Sight best = sight_of(site, from, candidate);
  for (const StarCode code : afar) {
    const Sight other = sight_of(site, from, code);
    if (other.left > 0 && wins(other, best)) best = other;
  }
  return best.code;
}

/// The nearest site of the window: surely a neighbour.
template <class Tag>
static StarCode nearest_in_window(const PaddedSite& site, Tag) {
  StarCode best = 0;
  std::int64_t least = 0;
  for (StarCode row = 0x50; row <= 0xB0; row += 0x10)
    for (StarCode code = row + 5; code <= row + 11; ++code) {
      const std::int64_t x = relative_x(site, code), y = relative_y(site, code);
      if (code == kHere || (best != 0 && x * x + y * y >= least)) continue;
      best = code, least = x * x + y * y;
    }
  return best;
}

/// One turn around a site. The triangle to the left of a known edge is read from the star of a
/// neighbour that came before (so stars agree by construction); only a triangle whose other two
/// sites come later is searched, among the later sites: two searches a site. Where the turn ends is
/// read from the star of its first neighbour.
/// Pivot(site) prepares the search around a site, next(code) is the search, first(word, size) the
/// place of the smallest code.
template <class Pivot>
struct Turn {
  PaddedSite site;
  Pivot pivot;
  const StarWord* const* row;    ///< row[d]: stars of the row d below, at column 0
  const LongStar* const* longs;  ///< the same for long stars
  std::int32_t column;
  StarCode first;
  StarCode last;  ///< the neighbour before the first, 0 if that is not known yet
  StarCode code;  ///< 0: given up
  StarWord word = 0, high = 0;
  int size = 0;
};

/// The star's code before or after (`way` -1, 1) a site that it may list; 0 if it does not.
[[maybe_unused]] static StarCode beside_in_long(const LongStar& star, StarCode code, int way) {
  const int size = 8 + star_size(star.high);
  for (int k = 0; k < size; ++k) {
    const auto at = [&](int n) {
      return n < 8 ? star_code(star.low, n) : star_code(star.high, n - 8);
    };
    if (at(k) == code) return at((k + way + size) % size);
  }
  return 0;
}

/// The neighbour clockwise of one that came before, by its star; 0 if that star does not list the
/// site.
[[maybe_unused]] static inline StarCode clockwise_of(const StarWord* const* row,
                                                     const LongStar* const* longs,
                                                     std::int32_t column, StarCode code) {
  const std::int32_t down = -rows_away(code), at = column + columns_away(code);
  const StarWord other = row[down][at];
  const int place = star_find(other, reverse(code));
  StarCode after = 0;
  if (place < 8)
    after = star_after(other, place);
  else if (other == kLong)
    after = beside_in_long(longs[down][at], reverse(code), 1);
  return after == 0 ? 0 : (after + code - kHere) & 0xFFu;
}

template <class Pivot>
static inline Turn<Pivot> start_turn(const PaddedGrid& grid, const StarWord* const* row,
                                     const LongStar* const* longs, std::int32_t j, std::int32_t i) {
  const PaddedSite site{&grid, (j + kPadLow) * std::int64_t{grid.stride} + i + kPadLow};
  // Clockwise, so that the first comes right after the later neighbours.
  StarCode first = 0, last = 0;
  constexpr StarCode earlier[] = {kHere - 1, kHere - 2, kHere - 17, kHere - 16, kHere - 15};
  for (const StarCode code : earlier) {
    last = clockwise_of(row, longs, i, code);
    if (last == 0) continue;
    first = code;
    break;
  }
  if (first == 0) {
    first = nearest_in_window(site, Pivot::tag());
  } else if (last < kHere) {
    const StarCode before = clockwise_of(row, longs, i, last);
    if (before != 0) first = last, last = before;
  }
  return {site, Pivot(site), row, longs, i, first, last, first};
}

/// The next neighbour after one that came before and whose star word does not list the site.
template <class Pivot>
static StarCode after_unlisted(const Turn<Pivot>& turn, StarCode code) {
  const std::int32_t down = -rows_away(code), at = turn.column + columns_away(code);
  const StarWord other = turn.row[down][at];
  if (other == 0) return pivot_in_window(turn.site, code, Pivot::tag());
  // A star that was found without this site contradicts it.
  if (other != kLong) return 0;
  const StarCode before = beside_in_long(turn.longs[down][at], reverse(code), -1);
  return before == 0 ? 0 : (before + code - kHere) & 0xFFu;
}

/// Goes to the next neighbour. False when the turn is over.
template <class Pivot>
[[gnu::always_inline]] static inline bool advance(Turn<Pivot>& turn) {
  const StarCode code = turn.code;
  if (code == turn.last) {
    turn.code = turn.first;
    return false;
  }
  if (code > kHere) {
    turn.code =
        turn.last != 0 ? turn.pivot.next(code) : pivot_in_window(turn.site, code, Pivot::tag());
  } else {
    const StarWord other = turn.row[-rows_away(code)][turn.column + columns_away(code)];
    const int place = star_find(other, reverse(code));
    turn.code =
        place < 8 ? (star_before(other, place) + code - kHere) & 0xFFu : after_unlisted(turn, code);
  }
  return turn.code != turn.first && turn.code != 0;
}

/// Notes a neighbour and goes to the next. False when the turn is over, or the word full.
template <class Pivot>
[[gnu::always_inline]] static inline bool step(Turn<Pivot>& turn) {
  turn.word |= StarWord{turn.code} << (8 * turn.size++);
  return advance(turn) && turn.size < 8;
}

/// The ninth and later neighbours.
template <class Pivot>
[[gnu::noinline]] static void go_on(Turn<Pivot>& turn) {
  bool more = true;
  while (more && turn.size < kLongest) {
    turn.high |= StarWord{turn.code} << (8 * (turn.size++ - 8));
    more = advance(turn);
  }
  if (more) turn.code = 0;
}

/// Where the stars of two rows go.
struct StarRows {
  StarWord* words;  ///< row 0, column 0 of the grid
  LongStar* longs;
  std::int32_t long_count, columns;
};

template <class Pivot>
static inline void keep_star(Turn<Pivot>& turn, std::int32_t y, StarWord* row, LongStar* long_row,
                             StarRows& out) {
  if (turn.size == 8 && turn.code != turn.first && turn.code != 0) go_on(turn);
  const std::int64_t cell = y * std::int64_t{out.columns} + turn.column;
  const bool closed = turn.code == turn.first && turn.size >= 3;
  if (closed && turn.size > 8) {
    const LongStar star = {turn.word, turn.high, static_cast<std::uint32_t>(cell)};
    row[turn.column] = kLong;
    long_row[turn.column] = star;
    out.longs[out.long_count++] = star;
    return;
  }
  const StarWord word =
      closed ? star_turned(turn.word, turn.size, Pivot::first(turn.word, turn.size)) : 0;
  row[turn.column] = word;
  out.words[cell] = word;
}

/// Two rows, the upper one kSkew columns behind, so that the processor has two chains of dependent
/// steps to work on and the upper row still finds all earlier stars.
template <class Pivot>
static std::int32_t propose_rows(const PaddedGrid& grid, std::int32_t j, std::int32_t row_end,
                                 StarWord* words, KernelScratch scratch, LongStar* long_stars) {
  constexpr std::int32_t kSkew = 4;
  const bool pair = j + 1 < row_end;
  constexpr int kReach = 10;  // whatever a code says
  StarWord* row[kReach];      // from the upper one down
  LongStar* longs[kReach];
  for (int d = 0; d < kReach; ++d) {
    const std::int64_t at =
        ((j + 1 - d) & (kScratchRows - 1)) * std::int64_t{grid.stride} + kPadLow;
    row[d] = scratch.words + at, longs[d] = scratch.longs + at;
  }
  // The oldest rows are used again: nothing may be found there before it is written.
  for (std::int32_t i = 0; i < grid.columns; ++i) row[0][i] = row[1][i] = 0;
  StarRows out{words, long_stars, 0, grid.columns};
  const auto low_turn = [&](std::int32_t i) {
    return start_turn<Pivot>(grid, row + 1, longs + 1, j, i);
  };
  const auto high_turn = [&](std::int32_t i) {
    return start_turn<Pivot>(grid, row, longs, j + 1, i - kSkew);
  };
  for (std::int32_t i = 0; i < grid.columns + kSkew; ++i) {
    const bool lower = i < grid.columns, upper = pair && i >= kSkew;
    if (lower && upper) {
      Turn<Pivot> a = low_turn(i), b = high_turn(i);
      bool more_a, more_b;
      do {
        more_a = step(a);
        more_b = step(b);
      } while (more_a && more_b);
      while (more_a) more_a = step(a);
      while (more_b) more_b = step(b);
      keep_star(a, j, row[1], longs[1], out);
      keep_star(b, j + 1, row[0], longs[0], out);
    } else if (lower || upper) {
      Turn<Pivot> a = lower ? low_turn(i) : high_turn(i);
      while (step(a)) {
      }
      keep_star(a, lower ? j : j + 1, row[lower], longs[lower], out);
    }
  }
  return out.long_count;
}

}  // namespace sunder
