// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices without hashing: the smallest cell that meets at a vertex owns it and writes it into the
// other cells, which it finds through the edges they share.
#include <algorithm>

#include "fracture/voronoi_detail.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = ~0u;
constexpr std::size_t kLargestFan = 1u << 22;
constexpr int kWholeCell = -1;

// The cells around a vertex, each with its corner there; on the border also the sides at both ends.
struct Fan {
  struct Slot {
    std::uint32_t cell, corner;
  };
  std::vector<Slot> slots;
  std::int32_t entry = 0, exit = 0;  // ~side, or 0 inside the wall
};

// Finds and places the vertices that the cells of one band own.
class Band {
 public:
  Band(const Sites& sites, const Stars& stars, Pattern& pattern)
      : sites_(sites), stars_(stars), pattern_(pattern) {}

  void share(std::uint32_t begin, std::uint32_t end) {
    vertices.reserve(2 * static_cast<std::size_t>(end - begin) + 8);
    // Blocks, so that finding the owned corners (unpredictable) and sharing them (long) are two
    // loops.
    constexpr std::uint32_t kBlock = 64;
    for (std::uint32_t cell = begin; cell < end; cell += kBlock)
      share_block(cell, std::min(end, cell + kBlock));
  }

  RawVector<Vec2> vertices;
  std::vector<std::uint32_t> wrong;
  std::uint64_t merged = 0, written = 0, box_corners = 0, border_edges = 0;

 private:
  std::uint32_t begin_of(std::uint32_t cell) const { return pattern_.cell_begin[cell]; }
  std::uint32_t next(std::uint32_t cell, std::uint32_t corner) const {
    return corner + 1 == pattern_.cell_begin[cell + 1] ? begin_of(cell) : corner + 1;
  }
  std::uint32_t before(std::uint32_t cell, std::uint32_t corner) const {
    return (corner == begin_of(cell) ? pattern_.cell_begin[cell + 1] : corner) - 1;
  }

  Double2 relative(Site a, std::uint32_t other) const {
    const Site b = sites_.points[other];
    return Double2{static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y)};
  }

  void add(std::uint32_t corner) {
    pattern_.corners[corner] = static_cast<std::uint32_t>(vertices.size());
    ++written;
  }

  void share_block(std::uint32_t begin, std::uint32_t end) {
    owned_.clear();
    for (std::uint32_t cell = begin; cell < end; ++cell) {
      const StarWord word = stars_.words[cell];
      if (stars_.is_list(cell)) {
        owned_.push_back({cell, kWholeCell});
        continue;
      }
      for (StarWord set = owned_corners(word, star_size(word)); set != 0; set &= set - 1)
        owned_.push_back({cell, __builtin_ctzll(set) / 8});
    }
    for (const Owned& owned : owned_) {
      if (owned.place == kWholeCell)
        share_any(owned.cell);
      else if (!share_triple(owned.cell, owned.place))
        share_slowly(owned.cell, begin_of(owned.cell) + static_cast<std::uint32_t>(owned.place));
    }
  }

  std::uint32_t neighbour(std::uint32_t cell, StarCode code) const {
    return cell + static_cast<std::uint32_t>(stars_.offset[code]);
  }

  // The usual corner: three cells with nothing but cells around them. False if it is not.
  bool share_triple(std::uint32_t cell, int place) {
    const StarWord word = stars_.words[cell];
    const StarCode a = star_before(word, place), b = star_code(word, place);
    const std::uint32_t cell_a = neighbour(cell, a), cell_b = neighbour(cell, b);
    const StarWord word_a = stars_.words[cell_a], word_b = stars_.words[cell_b];
    const int in_a = star_find(word_a, reverse(a)), in_b = star_find(word_b, seen_from(b, a));
    if (stars_.is_list(cell_a) || stars_.is_list(cell_b) || in_a == 8 || in_b == 8) return false;
    if (star_before(word_a, in_a) != seen_from(a, b) || star_before(word_b, in_b) != reverse(b))
      return false;
    add(begin_of(cell) + static_cast<std::uint32_t>(place));
    add(begin_of(cell_a) + static_cast<std::uint32_t>(in_a));
    add(begin_of(cell_b) + static_cast<std::uint32_t>(in_b));
    const Site site = sites_.points[cell];
    const Vec2 centre = circle_centre(relative(site, cell_a), relative(site, cell_b));
    vertices.push_back(sites_.lattice.to_metres(Vec2{site.x + centre.x, site.y + centre.y}));
    return true;
  }

  void share_any(std::uint32_t cell) {
    for (std::uint32_t corner = begin_of(cell); corner < pattern_.cell_begin[cell + 1]; ++corner) {
      border_edges += pattern_.across[corner].is_border();
      const Across a = pattern_.across[before(cell, corner)], b = pattern_.across[corner];
      if ((a.is_border() || a.cell() > cell) && (b.is_border() || b.cell() > cell))
        share_slowly(cell, corner);
    }
  }

  void share_slowly(std::uint32_t cell, std::uint32_t corner) {
    if (!collect(cell, corner)) return reject();
    const auto smaller = [](const Fan::Slot& p, const Fan::Slot& q) { return p.cell < q.cell; };
    std::ranges::sort(fan_.slots, smaller);
    if (fan_.slots[0].cell != cell) return;
    std::int32_t generators[3];
    if (!find_generators(generators)) return reject();
    for (const Fan::Slot& slot : fan_.slots) add(slot.corner);
    vertices.push_back(place_of(sites_, generators));
  }

  // Every cell at the fan may be at fault.
  void reject() {
    for (const Fan::Slot& slot : fan_.slots) wrong.push_back(slot.cell);
  }

  // The corner of `cell` where its edge to `other` starts, kNone if there is no such edge.
  std::uint32_t find(std::uint32_t cell, std::uint32_t other) const {
    const auto first = pattern_.across.begin() + begin_of(cell);
    const auto last = pattern_.across.begin() + pattern_.cell_begin[cell + 1];
    const auto place = std::find(first, last, Across::cell(other));
    return place == last ? kNone : static_cast<std::uint32_t>(place - pattern_.across.begin());
  }

  // Walks once around a vertex; on the border from end to end. False when the walk does not close.
  bool collect(std::uint32_t cell, std::uint32_t corner) {
    fan_.slots.assign(1, {cell, corner});
    fan_.entry = fan_.exit = 0;
    Across way = pattern_.across[before(cell, corner)];
    for (std::uint32_t at = cell; !way.is_border();) {
      const std::uint32_t found = find(way.cell(), at);
      if (way.cell() == cell && found == corner) return true;
      fan_.slots.push_back({way.cell(), found});
      if (found == kNone || fan_.slots.size() > kLargestFan) return false;
      at = way.cell();
      way = pattern_.across[before(at, found)];
    }
    fan_.entry = ~static_cast<std::int32_t>(way.border());
    way = pattern_.across[corner];
    for (std::uint32_t at = cell; !way.is_border();) {
      const std::uint32_t edge = find(way.cell(), at);
      fan_.slots.push_back({way.cell(), edge});
      if (edge == kNone || fan_.slots.size() > kLargestFan) return false;
      at = way.cell();
      fan_.slots.back().corner = next(at, edge);
      way = pattern_.across[fan_.slots.back().corner];
    }
    fan_.exit = ~static_cast<std::int32_t>(way.border());
    return true;
  }

  // What defines the fan's vertex; false unless all of its cells meet there exactly.
  bool find_generators(std::int32_t (&generators)[3]) {
    const bool inside = fan_.entry == 0, box_corner = !inside && fan_.entry != fan_.exit;
    const std::size_t needed = inside ? 3 : box_corner ? 1 : 2;
    if (fan_.slots.size() < needed) return false;
    if (box_corner && ((~fan_.entry + 1) & 3) != ~fan_.exit) return false;
    for (std::size_t k = 0; k < needed; ++k)
      generators[k] = static_cast<std::int32_t>(fan_.slots[k].cell);
    if (!inside) generators[2] = fan_.exit;
    if (box_corner) generators[1] = fan_.entry;
    for (std::size_t k = 1; k < fan_.slots.size(); ++k)
      if (fan_.slots[k].cell == fan_.slots[k - 1].cell ||
          (k >= needed && !meets(sites_, generators, fan_.slots[k].cell)))
        return false;
    merged += fan_.slots.size() > needed;
    box_corners += box_corner;
    return true;
  }

  struct Owned {
    std::uint32_t cell;
    int place;
  };

  const Sites& sites_;
  const Stars& stars_;
  Pattern& pattern_;
  std::vector<Owned> owned_;
  Fan fan_;
};

Across across_of(std::int32_t neighbour) {
  return neighbour < 0 ? Across::border(static_cast<std::uint32_t>(~neighbour))
                       : Across::cell(static_cast<std::uint32_t>(neighbour));
}

// Always eight neighbours while there is room (the next cell writes over them): how many there are
// cannot be predicted.
void write_star(const Stars& stars, std::uint32_t cell, Across* out, const Across* limit) {
  std::int32_t buffer[8];
  const StarWord word = stars.words[cell];
  if (stars.is_list(cell) || limit - out < 8) {
    for (const std::int32_t neighbour : stars.star(cell, buffer)) *out++ = across_of(neighbour);
    return;
  }
  for (int k = 0; k < 8; ++k)
    out[k] = Across::cell(cell + static_cast<std::uint32_t>(stars.offset[star_code(word, k)]));
}

void write_stars(Pattern& pattern, const Stars& stars, int threads) {
  const std::uint32_t count = stars.cell_count();
  pattern.cell_begin.resize(count + 1);
  std::uint32_t corner = 0;
  for (std::uint32_t cell = 0; cell < count; ++cell) {
    pattern.cell_begin[cell] = corner;
    corner += stars.size(cell);
  }
  pattern.cell_begin[count] = corner;
  pattern.corners.resize(corner);
  pattern.across.resize(corner);
  in_bands(threads, count, count, [&](int, std::int64_t begin, std::int64_t end) {
    for (auto cell = static_cast<std::uint32_t>(begin); cell < end; ++cell)
      write_star(stars, cell, pattern.across.data() + pattern.cell_begin[cell],
                 pattern.across.data() + pattern.cell_begin[end]);
  });
}

// Smallest vertex that coincides with each vertex.
class Coincidence {
 public:
  explicit Coincidence(std::size_t count) : parent_(count) {
    for (std::uint32_t v = 0; v < count; ++v) parent_[v] = v;
  }
  std::uint32_t first(std::uint32_t v) const {
    while (parent_[v] != v) v = parent_[v];
    return v;
  }
  void join(std::uint32_t v, std::uint32_t w) {
    v = first(v), w = first(w);
    parent_[std::max(v, w)] = std::min(v, w);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

void rebuild(Pattern& pattern, const Coincidence& coincidence) {
  Pattern whole;
  std::vector<std::uint32_t> number(pattern.vertices.size(), kNone);
  for (std::uint32_t v = 0; v < pattern.vertices.size(); ++v) {
    if (coincidence.first(v) != v) continue;
    number[v] = static_cast<std::uint32_t>(whole.vertices.size());
    whole.vertices.push_back(pattern.vertices[v]);
  }
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell) {
    const LoopRange loop{pattern.cell_begin[cell], pattern.cell_begin[cell + 1]};
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      const std::uint32_t start = coincidence.first(pattern.corners[k]);
      if (start == coincidence.first(pattern.corners[loop.next(k)])) continue;
      whole.corners.push_back(number[start]);
      whole.across.push_back(pattern.across[k]);
    }
    whole.cell_begin.push_back(static_cast<std::uint32_t>(whole.corners.size()));
  }
  pattern = std::move(whole);
}

}  // namespace

std::uint64_t drop_vanished_edges(Pattern& pattern, std::span<const std::uint32_t> cells) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> vanished;
  for (const std::uint32_t cell : cells) {
    const LoopRange loop{pattern.cell_begin[cell], pattern.cell_begin[cell + 1]};
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      const std::uint32_t start = pattern.corners[k], end = pattern.corners[loop.next(k)];
      if (pattern.vertices[start] == pattern.vertices[end])
        vanished.push_back({std::min(start, end), std::max(start, end)});
    }
  }
  std::ranges::sort(vanished);
  vanished.erase(std::unique(vanished.begin(), vanished.end()), vanished.end());
  if (!vanished.empty()) {
    Coincidence coincidence(pattern.vertices.size());
    for (const auto& [start, end] : vanished) coincidence.join(start, end);
    rebuild(pattern, coincidence);
  }
  pattern.all_convex = std::ranges::all_of(
      cells, [&](std::uint32_t cell) { return is_strictly_convex(pattern, cell); });
  return vanished.size();
}

Shared share_vertices(const Sites& sites, const Stars& stars, int threads) {
  Shared shared;
  write_stars(shared.pattern, stars, threads);
  Band band(sites, stars, shared.pattern);
  band.share(0, stars.cell_count());
  const Pattern& pattern = shared.pattern;
  // Euler's formula: with every corner turning left it also says that each cell and each vertex is
  // gone around once (sum of the angles), so the cells tile the box once.
  const std::int64_t corners = static_cast<std::int64_t>(pattern.corners.size());
  const std::int64_t border = static_cast<std::int64_t>(band.border_edges);
  const std::int64_t edges = (corners - border) / 2 + border;
  const bool closes = static_cast<std::int64_t>(band.written) == corners && band.box_corners == 4 &&
                      static_cast<std::int64_t>(band.vertices.size()) - edges +
                              static_cast<std::int64_t>(stars.cell_count()) ==
                          1;
  shared.wrong = std::move(band.wrong);
  shared.merged = band.merged;
  if (!closes && shared.wrong.empty())
    for (std::uint32_t cell = 0; cell < stars.cell_count(); ++cell) shared.wrong.push_back(cell);
  shared.pattern.vertices = std::move(band.vertices);
  return shared;
}

}  // namespace sunder
