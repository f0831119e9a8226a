// SPDX-License-Identifier: GPL-3.0-or-later
// Propose every cell fast, certify it exactly, repair the few that fail, then share the vertices.
#include "fracture/voronoi.hpp"

#include <algorithm>
#include <cassert>
#include <string>

#include "fracture/voronoi_detail.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

// Of the grid's cells; beyond it too many neighbours lie outside the kernels' window.
constexpr double kLargestAspect = 1.7;

struct Edge {
  std::uint32_t cell;
  std::int32_t neighbour;
};

// What one thread found.
struct Findings {
  std::vector<Edge> ties;
  std::vector<std::uint32_t> wrong;
  std::vector<std::uint32_t> brief;  // cells with an edge so short that its ends may coincide
};

template <class Value>
void append(std::vector<Value>& to, const std::vector<Value>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

bool suits_kernels(const Sites& sites) {
  const double aspect = static_cast<double>(sites.cell_width) / sites.cell_height;
  return sites.columns >= kSmallestGrid && sites.rows >= kSmallestGrid &&
         aspect <= kLargestAspect && aspect >= 1 / kLargestAspect;
}

// Grid position whose mirror image stands at i, and the mirrored coordinate. The image is moved
// outwards by one unit: a site on the box's side does not meet its own image.
struct Mirror {
  std::int64_t index, twice_axis;
  bool mirrored;
};
Mirror mirror(std::int64_t i, std::int64_t count, std::int64_t extent) {
  if (i < 0) return {-1 - i, -1, true};
  if (i >= count) return {2 * count - 1 - i, 2 * extent + 1, true};
  return {i, 0, false};
}

struct PaddedSites {
  std::vector<std::int32_t> x, y;
  PaddedGrid grid;
};

PaddedSites pad(const Sites& sites) {
  PaddedSites padded;
  PaddedGrid& grid = padded.grid;
  grid.columns = sites.columns, grid.rows = sites.rows;
  grid.stride = sites.columns + kPadLow + kPadHigh;
  // Codes of contradicting stars may reach kMargin rows and columns away.
  const std::size_t begin =
      static_cast<std::size_t>(kMargin) * static_cast<std::size_t>(grid.stride);
  const auto rows = static_cast<std::size_t>(grid.rows + kPadLow + kPadHigh + 2 * kMargin);
  padded.x.resize(rows * static_cast<std::size_t>(grid.stride));
  padded.y.resize(rows * static_cast<std::size_t>(grid.stride));
  std::size_t at = begin;
  for (std::int64_t j = -kPadLow; j < grid.rows + kPadHigh; ++j) {
    const Mirror row = mirror(j, grid.rows, sites.lattice.height);
    const Site* source = sites.points.data() + row.index * grid.columns;
    for (std::int64_t i = -kPadLow; i < grid.columns + kPadHigh; ++i, ++at) {
      const Mirror column = mirror(i, grid.columns, sites.lattice.width);
      const Site site = source[column.index];
      padded.x[at] =
          column.mirrored ? static_cast<std::int32_t>(column.twice_axis - site.x) : site.x;
      padded.y[at] = row.mirrored ? static_cast<std::int32_t>(row.twice_axis - site.y) : site.y;
    }
  }
  grid.x = padded.x.data() + begin, grid.y = padded.y.data() + begin;
  const auto side = static_cast<float>(std::min(sites.cell_width, sites.cell_height));
  grid.far = 4 * side * side;
  return padded;
}

// Turns a star's mirrored neighbours into the box's sides: once a side, and none across a box
// corner. Long stars and those that change become lists.
void unfold(Stars& stars, const Sites& sites, const LongStar& codes) {
  const auto j = static_cast<std::int32_t>(codes.cell) / sites.columns;
  const auto i = static_cast<std::int32_t>(codes.cell) % sites.columns;
  std::int32_t star[kLongest];
  std::size_t size = 0;
  bool changes = codes.high != 0;
  for (StarWord rest = codes.low, next = codes.high; rest != 0;) {
    const StarCode code = star_code(rest, 0);
    rest = rest >> 8 | next << 56;
    next >>= 8;
    const std::int32_t x = i + columns_away(code), y = j + rows_away(code);
    const bool beside = x < 0 || x >= sites.columns, above = y < 0 || y >= sites.rows;
    changes |= beside || above;
    if (beside && above) continue;
    const std::int32_t side = beside ? (x < 0 ? 3 : 1) : (y < 0 ? 0 : 2);
    const std::int32_t neighbour = beside || above ? ~side : y * sites.columns + x;
    if (size == 0 || star[size - 1] != neighbour) star[size++] = neighbour;
  }
  if (size > 1 && star[0] == star[size - 1]) --size;
  if (changes) stars.assign(codes.cell, {star, size});
}

void unfold_border(Stars& stars, const Sites& sites) {
  const std::int32_t columns = sites.columns, rows = sites.rows;
  for (std::int32_t j = 0; j < rows; ++j) {
    const bool whole_row = j < kPadLow || j >= rows - kPadLow;
    for (std::int32_t i = 0; i < columns; ++i) {
      if (!whole_row && i == kPadLow) i = columns - kPadLow;
      const auto cell = static_cast<std::uint32_t>(j * columns + i);
      if (!stars.is_list(cell)) unfold(stars, sites, {stars.words[cell], 0, cell});
    }
  }
}

// The kernel over the rows of one band. Returns the stars that do not fit a word.
std::vector<LongStar> propose_band(Stars& stars, const PaddedGrid& grid, bool avx2,
                                   std::int32_t begin, std::int32_t end) {
  const std::size_t size =
      static_cast<std::size_t>(kScratchRows) * static_cast<std::size_t>(grid.stride);
  std::vector<StarWord> words(size + 2 * kMargin);
  RawVector<LongStar> longs(size), found(2 * static_cast<std::size_t>(grid.columns));
  std::vector<LongStar> result;
  for (std::int32_t row = begin; row < end; row += 2) {
    const std::int32_t count = (avx2 ? propose_avx2 : propose_portable)(
        grid, row, end, stars.words.data(), {words.data() + kMargin, longs.data()}, found.data());
    result.insert(result.end(), found.begin(), found.begin() + count);
  }
  return result;
}

void propose_gridded(Stars& stars, const Sites& sites, bool avx2, int threads) {
  const PaddedSites padded = pad(sites);
  std::vector<std::vector<LongStar>> longs(static_cast<std::size_t>(threads));
  in_bands(threads, sites.rows, stars.cell_count(),
           [&](int band, std::int64_t begin, std::int64_t end) {
             longs[static_cast<std::size_t>(band)] =
                 propose_band(stars, padded.grid, avx2, static_cast<std::int32_t>(begin),
                              static_cast<std::int32_t>(end));
           });
  for (const std::vector<LongStar>& band : longs)
    for (const LongStar& star : band) unfold(stars, sites, star);
  unfold_border(stars, sites);
}

// Proposes every cell. Returns those that a kernel left open, and that its other cells may
// therefore not agree with.
std::vector<std::uint32_t> propose(Stars& stars, const Sites& sites, const Buckets& buckets,
                                   bool avx2, int threads) {
  const bool gridded = suits_kernels(sites);
  if (gridded) propose_gridded(stars, sites, avx2, threads);
  std::vector<std::uint32_t> open;
  for (std::uint32_t cell = 0; cell < stars.cell_count(); ++cell) {
    if (stars.words[cell] != 0) continue;
    stars.assign(cell, clip_cell_fast(sites, buckets, cell));
    if (gridded) open.push_back(cell);
  }
  return open;
}

bool lists(const Stars& stars, std::uint32_t cell, std::uint32_t other) {
  std::int32_t buffer[8];
  return std::ranges::count(stars.star(cell, buffer), static_cast<std::int32_t>(other)) == 1;
}

// The cells, and their neighbours, where one lists the other but not the other way round.
std::vector<std::uint32_t> one_sided(const Stars& stars, std::span<const std::uint32_t> cells) {
  std::vector<std::uint32_t> result;
  for (const std::uint32_t cell : cells) {
    std::int32_t buffer[8];
    for (const std::int32_t neighbour : stars.star(cell, buffer)) {
      const auto other = static_cast<std::uint32_t>(neighbour);
      if (neighbour >= 0 && !lists(stars, other, cell)) result.insert(result.end(), {cell, other});
    }
  }
  return result;
}

// The cells of a band that a closer look must decide.
std::vector<std::uint32_t> doubtful_band(const Stars& stars, const Sites& sites, bool avx2,
                                         std::int64_t begin, std::int64_t end) {
  constexpr std::int64_t kBlock = 4096;  // keeps the list of candidates in the cache
  std::uint32_t block[kBlock];
  std::vector<std::uint32_t> doubtful;
  static_assert(sizeof(Site) == 2 * sizeof(std::int32_t));
  const auto* xy = &sites.points.data()->x;
  for (std::int64_t at = begin; at < end; at += kBlock) {
    const auto first = static_cast<std::uint32_t>(at);
    const auto last = static_cast<std::uint32_t>(std::min(end, at + kBlock));
    const std::uint32_t count =
        avx2 ? doubtful_cells_avx2(stars.words.data(), xy, sites.columns, first, last, block)
             : doubtful_cells(sites, stars, first, last, block);
    doubtful.insert(doubtful.end(), block, block + count);
  }
  return doubtful;
}

Findings certify_all(const Stars& stars, const Sites& sites, bool avx2, int threads) {
  std::vector<Findings> found(static_cast<std::size_t>(std::max(1, threads)));
  in_bands(threads, stars.cell_count(), stars.cell_count(),
           [&](int band, std::int64_t begin, std::int64_t end) {
             Findings& mine = found[static_cast<std::size_t>(band)];
             for (const std::uint32_t cell : doubtful_band(stars, sites, avx2, begin, end)) {
               CloseEdges close;
               const Verdict verdict = certify(sites, stars, cell, stars.is_list(cell), close);
               if (verdict == Verdict::good) continue;
               if (verdict == Verdict::wrong)
                 mine.wrong.push_back(cell);
               else if (!close.brief.empty())
                 mine.brief.push_back(cell);
               if (verdict == Verdict::close)
                 for (const std::int32_t neighbour : close.ties)
                   mine.ties.push_back({cell, neighbour});
             }
           });
  for (std::size_t band = 1; band < found.size(); ++band) {
    append(found[0].ties, found[band].ties);
    append(found[0].wrong, found[band].wrong);
    append(found[0].brief, found[band].brief);
  }
  return std::move(found[0]);
}

// Edges of length 0 leave both cells: what remains is one vertex where more than three cells meet.
void drop_ties(Stars& stars, std::span<const Edge> ties) {
  for (const auto [cell, neighbour] : ties) {
    stars.remove(cell, neighbour);
    if (neighbour >= 0)
      stars.remove(static_cast<std::uint32_t>(neighbour), static_cast<std::int32_t>(cell));
  }
}

// Replaces wrong cells by exact ones, then whatever contradicts those, until nothing does.
class Repair {
 public:
  Repair(Stars& stars, const Sites& sites, const Buckets& buckets)
      : stars_(stars), sites_(sites), buckets_(buckets) {}

  void run(std::vector<std::uint32_t> wrong) {
    if (wrong.empty()) return;
    if (exact_.empty()) exact_.assign(stars_.cell_count(), false);
    while (!wrong.empty()) {
      suspects_.clear();
      for (const std::uint32_t cell : wrong) make_exact(cell);
      unlisted_ = one_sided(stars_, wrong);
      std::erase_if(unlisted_, [&](std::uint32_t cell) { return exact_[cell]; });
      std::ranges::sort(suspects_);
      suspects_.erase(std::unique(suspects_.begin(), suspects_.end()), suspects_.end());
      wrong.clear();
      std::ranges::copy_if(suspects_, std::back_inserter(wrong),
                           [&](std::uint32_t cell) { return contradicts(cell); });
      append(wrong, unlisted_);
    }
  }

  bool all_exact(std::span<const std::uint32_t> cells) const {
    return !exact_.empty() &&
           std::ranges::all_of(cells, [&](std::uint32_t cell) { return exact_[cell]; });
  }
  /// The cells that were made exact.
  const std::vector<std::uint32_t>& exact_cells() const { return exact_cells_; }

 private:
  void suspect_neighbours(std::uint32_t cell) {
    std::int32_t buffer[8];
    for (const std::int32_t neighbour : stars_.star(cell, buffer))
      if (neighbour >= 0) suspects_.push_back(static_cast<std::uint32_t>(neighbour));
  }

  void make_exact(std::uint32_t cell) {
    if (exact_[cell]) return;
    suspect_neighbours(cell);
    stars_.assign(cell, clip_cell_exactly(sites_, buckets_, cell));
    exact_[cell] = true;
    exact_cells_.push_back(cell);
    suspect_neighbours(cell);
  }

  // A cell that is not exact yet and does not hold by itself or against its neighbours.
  bool contradicts(std::uint32_t cell) const {
    if (exact_[cell]) return false;
    CloseEdges close;
    if (certify(sites_, stars_, cell, true, close) == Verdict::wrong || !close.ties.empty())
      return true;
    std::int32_t buffer[8];
    const std::span<const std::int32_t> star = stars_.star(cell, buffer);
    for (std::size_t k = 0; k < star.size(); ++k)
      if (!closes(cell, star[k == 0 ? star.size() - 1 : k - 1], star[k])) return true;
    return false;
  }

  // Whether neighbour a, which comes before b around the cell, sees the same corner.
  bool closes(std::uint32_t cell, std::int32_t a, std::int32_t b) const {
    if (a < 0) return true;
    std::int32_t buffer[8];
    const std::span<const std::int32_t> star = stars_.star(static_cast<std::uint32_t>(a), buffer);
    const auto place = std::ranges::find(star, static_cast<std::int32_t>(cell));
    if (place == star.end()) return false;
    const std::int32_t next = place == star.begin() ? star.back() : *(place - 1);
    if (next == b) return true;
    if (next < 0 || next == a) return false;
    const std::int32_t generators[3] = {static_cast<std::int32_t>(cell), a, b};
    return meets(sites_, generators, static_cast<std::uint32_t>(next));
  }

  Stars& stars_;
  const Sites& sites_;
  const Buckets& buckets_;
  std::vector<bool> exact_;
  std::vector<std::uint32_t> exact_cells_;
  std::vector<std::uint32_t> suspects_, unlisted_;
};

}  // namespace

Stars::Stars(const Sites& sites) : words(sites.points.size(), 0) {
  for (StarCode code = 0; code < 256; ++code)
    offset[code] = rows_away(code) * sites.columns + columns_away(code);
}

std::span<const std::int32_t> Stars::star(std::uint32_t cell, std::int32_t (&buffer)[8]) const {
  const StarWord word = words[cell];
  if (is_list(cell)) return {pool.data() + (word & 0xFFFFFFFFu), (word >> 32) & 0xFFFFFFu};
  const int count = star_size(word);
  for (int k = 0; k < count; ++k)
    buffer[k] = static_cast<std::int32_t>(cell) + offset[star_code(word, k)];
  return {buffer, static_cast<std::size_t>(count)};
}

void Stars::assign(std::uint32_t cell, std::span<const std::int32_t> star) {
  words[cell] = StarWord{0xFF} << 56 | StarWord{star.size()} << 32 | StarWord{pool.size()};
  const auto first = std::ranges::min_element(star);
  pool.insert(pool.end(), first, star.end());
  pool.insert(pool.end(), star.begin(), first);
}

void Stars::remove(std::uint32_t cell, std::int32_t neighbour) {
  std::int32_t buffer[8];
  const std::span<const std::int32_t> now = star(cell, buffer);
  const auto place = std::ranges::find(now, neighbour);
  if (place == now.end()) return;
  const auto k = place - now.begin();
  if (!is_list(cell)) {
    const StarWord below = (StarWord{1} << (8 * k)) - 1;
    const StarWord shorter = (words[cell] & below) | ((words[cell] >> 8) & ~below);
    const int size = star_size(shorter);
    words[cell] = star_turned(shorter, size, star_first(shorter, size));
    return;
  }
  Star shorter(now.begin(), now.end());
  shorter.erase(shorter.begin() + k);
  assign(cell, shorter);
}

Pattern voronoi(const Sites& sites, VoronoiParams params, VoronoiStats* stats) {
  assert(!sites.points.empty());
  const bool avx2 = params.kernel != VoronoiKernel::portable && has_avx2();
  const int threads = std::max(1, params.threads);
  const Buckets buckets(sites);
  Stars stars(sites);
  const std::vector<std::uint32_t> open = propose(stars, sites, buckets, avx2, threads);
  Findings found = certify_all(stars, sites, avx2 && suits_kernels(sites), threads);
  drop_ties(stars, found.ties);
  append(found.wrong, one_sided(stars, open));
  Repair repair(stars, sites, buckets);
  repair.run(std::move(found.wrong));
  Shared shared = share_vertices(sites, stars, threads);
  while (!shared.wrong.empty()) {
    // Exact cells of distinct sites agree.
    if (repair.all_exact(shared.wrong))
      throw Error(ErrorCode::geometry, "a Voronoi pattern needs distinct sites; near site " +
                                           std::to_string(shared.wrong[0]) + " two coincide");
    repair.run(std::move(shared.wrong));
    shared = share_vertices(sites, stars, threads);
  }
  append(found.brief, repair.exact_cells());
  shared.merged += drop_vanished_edges(shared.pattern, found.brief);
  if (stats != nullptr) {
    const std::uint64_t exact = repair.exact_cells().size();
    *stats = {stars.cell_count() - exact, exact, shared.merged, avx2 && suits_kernels(sites)};
  }
  return std::move(shared.pattern);
}

}  // namespace sunder
