// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "fracture/pattern.hpp"
#include "fracture/sites.hpp"
#include "fracture/voronoi_star.hpp"

namespace sunder {

/// A cell's neighbours in counter-clockwise order, the smallest first: a site, or ~side of the box
/// (0 bottom, 1 right, 2 top, 3 left). The same numbers as in Pattern::across.
using Star = std::vector<std::int32_t>;

/// The stars of all cells while they are being decided: a star word each, or a list in the pool.
class Stars {
 public:
  explicit Stars(const Sites& sites);

  std::uint32_t cell_count() const { return static_cast<std::uint32_t>(words.size()); }
  bool is_list(std::uint32_t cell) const { return words[cell] >> 56 == 0xFF; }
  /// The star as numbers; `buffer` holds it if it was a word.
  std::span<const std::int32_t> star(std::uint32_t cell, std::int32_t (&buffer)[8]) const;
  std::uint32_t size(std::uint32_t cell) const {
    return is_list(cell) ? static_cast<std::uint32_t>(words[cell] >> 32 & 0xFFFFFFu)
                         : static_cast<std::uint32_t>(star_size(words[cell]));
  }
  /// Replaces a star by a list, turned so that the smallest comes first.
  void assign(std::uint32_t cell, std::span<const std::int32_t> star);
  /// Removes one neighbour of a cell, if it is there.
  void remove(std::uint32_t cell, std::int32_t neighbour);

  std::array<std::int32_t, 256> offset{};  ///< from a cell to its neighbour, by code
  std::vector<StarWord> words;  ///< 0: not known yet; top byte 0xFF: a list, begin and size follow
  std::vector<std::int32_t> pool;
};

/// Sites by place: grid cells of gridded sites, else square buckets of about one site and a half.
class Buckets {
 public:
  explicit Buckets(const Sites& sites);

  std::int32_t columns = 1, rows = 1;
  std::int64_t width = 1, height = 1;  ///< of a bucket, lattice units
  template <class Visit>
  void visit(std::int64_t bucket, Visit visit_site) const {
    if (begin_.empty()) return visit_site(static_cast<std::uint32_t>(bucket));
    for (std::uint32_t k = begin_[bucket]; k < begin_[bucket + 1]; ++k) visit_site(order_[k]);
  }

 private:
  std::vector<std::uint32_t> begin_, order_;
};

/// A cell by clipping the box with the bisectors of ever farther sites, until no site can matter.
/// In double precision it is right but for near ties; the exact one is the definition.
Star clip_cell_fast(const Sites& sites, const Buckets& buckets, std::uint32_t cell);
Star clip_cell_exactly(const Sites& sites, const Buckets& buckets, std::uint32_t cell);

/// What the certificate says of one star, decided exactly: `wrong` if a corner does not turn left
/// or an edge has a negative length; `close` if edges have length 0, or next to it: their
/// neighbours are in `ties` and `brief`. Only edges to later sites (and the box) are measured
/// unless `all_edges`.
enum class Verdict { good, close, wrong };
struct CloseEdges {
  Star ties, brief;
};
Verdict certify(const Sites& sites, const Stars& stars, std::uint32_t cell, bool all_edges,
                CloseEdges& close);

/// doubtful_cells_avx2 without AVX2, in integers.
std::uint32_t doubtful_cells(const Sites& sites, const Stars& stars, std::uint32_t begin,
                             std::uint32_t end, std::uint32_t* doubtful);

/// Stars as a pattern: vertices found once, by the smallest cell that meets there, and shared.
/// Where a vertex does not close the stars contradict each other: then `wrong` gets the cells
/// around it and the pattern is unfinished. `merged` counts vertices where more cells meet than
/// there must.
struct Shared {
  Pattern pattern;
  std::vector<std::uint32_t> wrong;
  std::uint64_t merged = 0;
};
Shared share_vertices(const Sites& sites, const Stars& stars, int threads);

/// Makes one vertex of both ends of each edge of these cells that has no length in coordinates.
/// Returns how many edges vanished.
std::uint64_t drop_vanished_edges(Pattern& pattern, std::span<const std::uint32_t> cells);

/// True when a site is exactly as far from the point where the generators meet as the generators
/// are: three sites, two sites and a side, or a site and two sides (~side).
bool meets(const Sites& sites, const std::int32_t (&generators)[3], std::uint32_t site);

/// Where three generators meet, in metres: the sites ascending and distinct, then sides (~side).
/// One pure function of the three.
Vec2 place_of(const Sites& sites, const std::int32_t (&generators)[3]);

/// A pair of doubles the compiler keeps in one register.
using Double2 = double __attribute__((vector_size(16)));

/// The centre of the circle through the origin and two sites relative to it, |x|, |y| < 2^25, to
/// the last digits even when the three nearly line up. Either order gives the same bits.
inline Vec2 circle_centre(Double2 p, Double2 q) {
  const Double2 pp = p * p, qq = q * q;
  const double squares[2] = {pp[0] + pp[1], qq[0] + qq[1]};
  // The nearer one first, without a branch: which it is cannot be predicted.
  const auto swap = Double2{squares[1], squares[1]} < Double2{squares[0], squares[0]};
  const Double2 near = swap ? q : p, far = swap ? p : q;
  const double square = std::min(squares[0], squares[1]);
  const double gap = std::max(squares[0], squares[1]) - square;
  const double scale = 1 / (2 * (near[0] * far[1] - near[1] * far[0]));
  const Double2 along = (square * (far - near) - gap * near) * scale;
  return {along[1], -along[0]};
}

/// Calls work(band, begin, end) for bands of 0 … count, each on its own thread; with fewer cells a
/// thread costs more than it brings.
constexpr std::int64_t kCellsForThread = 1024;
template <class Work>
void in_bands(int threads, std::int64_t count, std::int64_t cells, Work work) {
  const std::int64_t bands =
      std::clamp<std::int64_t>(std::min<std::int64_t>(threads, cells / kCellsForThread), 1,
                               std::max<std::int64_t>(1, count));
  std::vector<std::thread> others;
  for (std::int64_t band = 1; band < bands; ++band)
    others.emplace_back(work, static_cast<int>(band), count * band / bands,
                        count * (band + 1) / bands);
  work(0, std::int64_t{0}, count / bands);
  for (std::thread& other : others) other.join();
}

}  // namespace sunder
