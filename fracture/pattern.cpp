// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/pattern.hpp"

#include <algorithm>

#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

std::span<const std::uint32_t> holes_of(const Pattern& pattern, std::uint32_t cell) {
  if (pattern.hole_begin.empty()) return {};
  const auto first = std::lower_bound(pattern.hole_begin.begin(), pattern.hole_begin.end(),
                                      pattern.cell_begin[cell]);
  const auto last = std::lower_bound(first, pattern.hole_begin.end(), pattern.cell_begin[cell + 1]);
  return {first, last};
}

double loop_area(const Pattern& pattern, LoopRange loop) {
  const Vec2 base = pattern.vertices[pattern.corners[loop.begin]];
  double sum = 0;
  for (std::uint32_t k = loop.begin + 2; k < loop.end; ++k)
    sum += cross(pattern.vertices[pattern.corners[k - 1]] - base,
                 pattern.vertices[pattern.corners[k]] - base);
  return sum / 2;
}

bool indices_are_valid(const Pattern& pattern) {
  const auto& begin = pattern.cell_begin;
  if (begin.empty() || begin.front() != 0 || begin.back() != pattern.corners.size() ||
      pattern.across.size() != pattern.corners.size() ||
      !std::is_sorted(begin.begin(), begin.end()))
    return false;
  if (!pattern.origin.empty() && pattern.origin.size() != pattern.cell_count()) return false;
  const auto vertex_exists = [&](std::uint32_t v) { return v < pattern.vertices.size(); };
  const auto cell_exists = [&](Across a) {
    return a.is_border() || a.cell() < pattern.cell_count();
  };
  return std::ranges::all_of(pattern.corners, vertex_exists) &&
         std::ranges::all_of(pattern.across, cell_exists) &&
         std::is_sorted(pattern.hole_begin.begin(), pattern.hole_begin.end());
}

// Whether `neighbour` has the edge to → from with `cell` across it.
bool has_reverse(const Pattern& pattern, std::uint32_t neighbour, std::uint32_t cell,
                 std::uint32_t from, std::uint32_t to) {
  for (const LoopRange loop : loops_of(pattern, neighbour))
    for (std::uint32_t k = loop.begin; k < loop.end; ++k)
      if (pattern.corners[k] == to && pattern.across[k] == Across::cell(cell) &&
          pattern.corners[loop.next(k)] == from)
        return true;
  return false;
}

}  // namespace

std::vector<LoopRange> loops_of(const Pattern& pattern, std::uint32_t cell) {
  std::vector<LoopRange> loops;
  std::uint32_t begin = pattern.cell_begin[cell];
  for (const std::uint32_t hole : holes_of(pattern, cell)) {
    loops.push_back({begin, hole});
    begin = hole;
  }
  loops.push_back({begin, pattern.cell_begin[cell + 1]});
  return loops;
}

LoopRange loop_with(const Pattern& pattern, std::uint32_t cell, std::uint32_t corner) {
  LoopRange loop{pattern.cell_begin[cell], pattern.cell_begin[cell + 1]};
  for (const std::uint32_t hole : holes_of(pattern, cell)) {
    if (hole > corner) return {loop.begin, hole};
    loop.begin = hole;
  }
  return loop;
}

double cell_area(const Pattern& pattern, std::uint32_t cell) {
  if (pattern.hole_begin.empty())
    return loop_area(pattern, {pattern.cell_begin[cell], pattern.cell_begin[cell + 1]});
  double sum = 0;
  for (const LoopRange loop : loops_of(pattern, cell)) sum += loop_area(pattern, loop);
  return sum;
}

double total_area(const Pattern& pattern) {
  double sum = 0, carry = 0;  // Neumaier's compensated sum
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell) {
    const double term = cell_area(pattern, cell), next = sum + term;
    carry += std::abs(sum) >= std::abs(term) ? (sum - next) + term : (term - next) + sum;
    sum = next;
  }
  return sum + carry;
}

bool is_strictly_convex(const Pattern& pattern, std::uint32_t cell) {
  if (!holes_of(pattern, cell).empty()) return false;
  const LoopRange loop{pattern.cell_begin[cell], pattern.cell_begin[cell + 1]};
  int descents = 0;  // edges that turn from leftward to rightward: one per winding
  for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
    const std::uint32_t l = loop.next(k), m = loop.next(l);
    const Vec2 a = pattern.vertices[pattern.corners[k]], b = pattern.vertices[pattern.corners[l]],
               c = pattern.vertices[pattern.corners[m]];
    if (orientation(a, b, c) <= 0) return false;
    const bool left = b.x < a.x || (b.x == a.x && b.y < a.y);
    const bool then_left = c.x < b.x || (c.x == b.x && c.y < b.y);
    descents += left && !then_left;
  }
  return descents == 1;
}

PatternDefects check(const Pattern& pattern) {
  PatternDefects defects;
  if (!indices_are_valid(pattern)) {
    defects.bad_indices = 1;
    return defects;
  }
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell) {
    defects.inverted_cells += !(cell_area(pattern, cell) > 0);
    for (const LoopRange loop : loops_of(pattern, cell))
      for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
        const std::uint32_t from = pattern.corners[k], to = pattern.corners[loop.next(k)];
        defects.repeated_vertices += from == to || pattern.vertices[from] == pattern.vertices[to];
        const Across across = pattern.across[k];
        if (!across.is_border())
          defects.unpaired_edges += !has_reverse(pattern, across.cell(), cell, from, to);
      }
  }
  return defects;
}

}  // namespace sunder
