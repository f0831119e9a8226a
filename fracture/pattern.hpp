// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "meshing/raw_vector.hpp"
#include "meshing/vec.hpp"

namespace sunder {

/// What lies across an edge of a cell: another cell, or an edge of the region's boundary.
class Across {
 public:
  constexpr Across() = default;
  static constexpr Across cell(std::uint32_t id) { return Across(static_cast<std::int32_t>(id)); }
  static constexpr Across border(std::uint32_t edge) {
    return Across(~static_cast<std::int32_t>(edge));
  }
  constexpr bool is_border() const { return code_ < 0; }
  /// The neighbouring cell; only if !is_border().
  constexpr std::uint32_t cell() const { return static_cast<std::uint32_t>(code_); }
  /// The boundary edge (see LatticeRegion; on a plain box 0 bottom, 1 right, 2 top, 3 left); only
  /// if is_border().
  constexpr std::uint32_t border() const { return static_cast<std::uint32_t>(~code_); }
  friend constexpr bool operator==(Across, Across) = default;

 private:
  explicit constexpr Across(std::int32_t code) : code_(code) {}
  std::int32_t code_ = -1;
};

/// All cells of a wall: a partition of its region into polygons that share vertices by index.
///
/// Cell c has corners cell_begin[c] … cell_begin[c+1]: its outer loop, counter-clockwise, then its
/// hole loops, clockwise; `hole_begin` (sorted, usually empty) holds the corners where a hole loop
/// starts. Corner k stands at vertices[corners[k]]; the edge from it to the next corner of its loop
/// separates the cell from across[k]. Every interior edge occurs in exactly two cells, with the
/// same two vertices in opposite order.
struct Pattern {
  RawVector<Vec2> vertices;  ///< metres, wall frame
  RawVector<std::uint32_t> cell_begin{0};
  RawVector<std::uint32_t> corners;
  RawVector<Across> across;
  std::vector<std::uint32_t> hole_begin;
  /// Site or grid cell that cell c came from; empty: c itself. An opening that cuts a cell into
  /// several gives several cells with one origin.
  std::vector<std::uint32_t> origin;
  /// True when every cell is a strictly convex polygon.
  bool all_convex = false;

  std::uint32_t cell_count() const { return static_cast<std::uint32_t>(cell_begin.size()) - 1; }
  std::uint32_t origin_of(std::uint32_t cell) const { return origin.empty() ? cell : origin[cell]; }
};

/// Half-open range of corners that forms one loop.
struct LoopRange {
  std::uint32_t begin = 0, end = 0;
  std::uint32_t size() const { return end - begin; }
  /// The corner after k in the loop.
  std::uint32_t next(std::uint32_t k) const { return k + 1 == end ? begin : k + 1; }
};

/// The loops of a cell, the outer one first. O(1) when the pattern has no holes.
std::vector<LoopRange> loops_of(const Pattern& pattern, std::uint32_t cell);
/// The loop a corner of `cell` belongs to.
LoopRange loop_with(const Pattern& pattern, std::uint32_t cell, std::uint32_t corner);
/// Area of a cell less its holes, m².
double cell_area(const Pattern& pattern, std::uint32_t cell);
/// Area of all cells, m², summed with compensation.
double total_area(const Pattern& pattern);
/// True when the cell has one loop and turns strictly left at every corner, decided exactly on the
/// vertices' coordinates.
bool is_strictly_convex(const Pattern& pattern, std::uint32_t cell);

/// What is wrong with a pattern; all zero for a valid one.
struct PatternDefects {
  std::uint64_t unpaired_edges = 0;     ///< interior edges without their exact reverse in `across`
  std::uint64_t repeated_vertices = 0;  ///< edges with equal ends (index or coordinates)
  std::uint64_t inverted_cells = 0;     ///< area not above 0
  std::uint64_t bad_indices = 0;        ///< a vertex, cell or loop that does not exist
  friend bool operator==(const PatternDefects&, const PatternDefects&) = default;
};
/// Checks every invariant above except disjointness, which follows from them and the area.
/// O(corners).
PatternDefects check(const Pattern& pattern);

}  // namespace sunder
