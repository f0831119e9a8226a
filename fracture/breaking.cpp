// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/breaking.hpp"

#include <algorithm>
#include <cassert>
#include <set>

#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

// Corner of `cell` whose edge runs from → to with `other` across it.
std::uint32_t find_corner(const Pattern& pattern, std::uint32_t cell, std::uint32_t other,
                          std::uint32_t from, std::uint32_t to) {
  const std::uint32_t begin = pattern.cell_begin[cell], end = pattern.cell_begin[cell + 1];
  for (std::uint32_t k = begin; k < end; ++k) {
    if (pattern.across[k] != Across::cell(other) || pattern.corners[k] != from) continue;
    const std::uint32_t l = pattern.hole_begin.empty() ? (k + 1 == end ? begin : k + 1)
                                                       : loop_with(pattern, cell, k).next(k);
    if (pattern.corners[l] == to) return k;
  }
  assert(false && "interior edges are paired");
  return begin;
}

template <class Visit>
void for_each_corner(const Pattern& pattern, std::uint32_t cell, Visit visit) {
  if (pattern.hole_begin.empty()) {
    const LoopRange loop{pattern.cell_begin[cell], pattern.cell_begin[cell + 1]};
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) visit(k, loop.next(k));
    return;
  }
  for (const LoopRange loop : loops_of(pattern, cell))
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) visit(k, loop.next(k));
}

double distance_squared(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = from_segment(p, a, b);
  return dot(d, d);
}

}  // namespace

BreakableWall::BreakableWall(const Pattern& pattern)
    : pattern_(pattern), intact_(pattern.cell_count(), 1), shown_(pattern.corners.size(), 0) {}

BreakableWall::Change BreakableWall::break_cells(std::span<const std::uint32_t> cells) {
  Change change;
  for (const std::uint32_t cell : cells)
    if (intact_[cell]) {
      intact_[cell] = 0;
      change.broken.push_back(cell);
    }
  std::ranges::sort(change.broken);
  change.cells_touched = change.broken.size();
  for (const std::uint32_t cell : change.broken)
    for_each_corner(pattern_, cell, [&](std::uint32_t k, std::uint32_t next) {
      if (shown_[k]) {
        shown_[k] = 0;
        change.hidden.push_back(k);
      }
      const Across across = pattern_.across[k];
      if (across.is_border() || !intact_[across.cell()]) return;
      const std::uint32_t reverse =
          find_corner(pattern_, across.cell(), cell, pattern_.corners[next], pattern_.corners[k]);
      shown_[reverse] = 1;
      change.shown.push_back(reverse);
      ++change.cells_touched;
    });
  std::ranges::sort(change.shown);
  std::ranges::sort(change.hidden);
  return change;
}

std::vector<std::uint8_t> shown_faces(const Pattern& pattern,
                                      std::span<const std::uint8_t> intact) {
  std::vector<std::uint8_t> shown(pattern.corners.size(), 0);
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell)
    for (std::uint32_t k = pattern.cell_begin[cell]; k < pattern.cell_begin[cell + 1]; ++k) {
      const Across across = pattern.across[k];
      shown[k] = intact[cell] && !across.is_border() && !intact[across.cell()];
    }
  return shown;
}

bool contains(const Pattern& pattern, std::uint32_t cell, Vec2 point) {
  bool inside = false, on_edge = false;
  for_each_corner(pattern, cell, [&](std::uint32_t k, std::uint32_t next) {
    const Vec2 a = pattern.vertices[pattern.corners[k]];
    const Vec2 b = pattern.vertices[pattern.corners[next]];
    if (std::min(a.y, b.y) > point.y || std::max(a.y, b.y) < point.y) return;
    const int turn = orientation(a, b, point);
    on_edge |= turn == 0 && std::min(a.x, b.x) <= point.x && point.x <= std::max(a.x, b.x);
    if ((a.y > point.y) != (b.y > point.y)) inside ^= (turn > 0) == (b.y > a.y);
  });
  return inside || on_edge;
}

std::uint32_t cell_at(const Pattern& pattern, Vec2 point) {
  std::uint32_t cell = 0;
  while (cell < pattern.cell_count() && !contains(pattern, cell, point)) ++cell;
  return cell;
}

std::vector<std::uint32_t> cells_near(const Pattern& pattern, std::uint32_t start, Vec2 centre,
                                      double radius) {
  std::vector<std::uint32_t> found{start};
  std::set<std::uint32_t> seen{start};
  for (std::size_t i = 0; i < found.size(); ++i)
    for_each_corner(pattern, found[i], [&](std::uint32_t k, std::uint32_t next) {
      const Across across = pattern.across[k];
      if (across.is_border() || seen.contains(across.cell())) return;
      if (distance_squared(centre, pattern.vertices[pattern.corners[k]],
                           pattern.vertices[pattern.corners[next]]) <= radius * radius) {
        seen.insert(across.cell());
        found.push_back(across.cell());
      }
    });
  std::ranges::sort(found);
  return found;
}

}  // namespace sunder
