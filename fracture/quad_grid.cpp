// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/quad_grid.hpp"

#include <algorithm>
#include <span>
#include <array>
#include <cassert>
#include <cmath>

#include "meshing/random.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

// Corners of quad (i, j) counter-clockwise from its lower left one; edge e runs from corner e to
// corner e + 1, so edges are 0 bottom, 1 right, 2 top, 3 left, like the border's.
struct QuadFrame {
  std::uint32_t columns, rows;

  std::uint32_t quad_count() const { return columns * rows; }
  std::array<std::uint32_t, 4> corners(std::uint32_t i, std::uint32_t j) const {
    const std::uint32_t low = j * (columns + 1) + i, high = low + columns + 1;
    return {low, low + 1, high + 1, high};
  }
};

QuadFrame frame_of(const GridShape& grid) {
  return {static_cast<std::uint32_t>(grid.columns), static_cast<std::uint32_t>(grid.rows)};
}

constexpr std::uint8_t kWhole = 4;  // instead of the corner a quad is cut at

// The reflex corner of a quad, kWhole if it has none. A quad of half-open boxes is simple, so there
// is at most one. `strict` is cleared by a corner that is not strictly convex, on the lattice or on
// the rounded coordinates: two nearby decisions that users of `all_convex` need both.
std::uint8_t reflex_corner(const std::array<LatticePoint, 4>& p, const std::array<Vec2, 4>& metres,
                           bool& strict) {
  std::uint8_t reflex = kWhole;
  for (std::uint8_t k = 0; k < 4; ++k) {
    const unsigned after = (k + 1) & 3, before = (k + 3) & 3;
    const std::int64_t turn = orientation(p[before], p[k], p[after]);
    if (turn < 0) reflex = k;
    const Vec2 in = metres[k] - metres[before], out = metres[after] - metres[k];
    const double left = in.x * out.y, right = in.y * out.x;
    // Filter: differences and products are rounded once each, 2^-50 covers them all.
    const bool surely_left = left - right > 0x1p-50 * (std::abs(left) + std::abs(right));
    if (turn == 0 ||
        (turn > 0 && !surely_left && orientation(metres[before], metres[k], metres[after]) <= 0))
      strict = false;
  }
  return reflex;
}

// Where each quad is cut and the first of its cells.
struct Cuts {
  std::vector<std::uint8_t> reflex;
  std::vector<std::uint32_t> first_cell;
  bool strict = true;

  // The cell of `quad` that has the quad's edge: a cut quad's first cell has the two edges that
  // follow the reflex corner, the second the other two.
  std::uint32_t cell_at(std::uint32_t quad, unsigned edge) const {
    const unsigned cut = reflex[quad];
    return first_cell[quad] + (cut != kWhole && ((edge - cut) & 3) >= 2 ? 1 : 0);
  }
};

Cuts find_cuts(const QuadFrame& frame, const std::vector<LatticePoint>& points,
               std::span<const Vec2> vertices) {
  Cuts cuts;
  cuts.reflex.resize(frame.quad_count());
  cuts.first_cell.resize(frame.quad_count() + 1);
  std::uint32_t cell = 0, quad = 0;
  for (std::uint32_t j = 0; j < frame.rows; ++j) {
    for (std::uint32_t i = 0; i < frame.columns; ++i, ++quad) {
      const auto c = frame.corners(i, j);
      cuts.reflex[quad] = reflex_corner(
          {points[c[0]], points[c[1]], points[c[2]], points[c[3]]},
          {vertices[c[0]], vertices[c[1]], vertices[c[2]], vertices[c[3]]}, cuts.strict);
      cuts.first_cell[quad] = cell;
      cell += cuts.reflex[quad] == kWhole ? 1 : 2;
    }
  }
  cuts.first_cell[quad] = cell;
  return cuts;
}

std::array<Across, 4> neighbours(const QuadFrame& frame, const Cuts& cuts, std::uint32_t i,
                                 std::uint32_t j) {
  const std::uint32_t quad = j * frame.columns + i;
  return {
      j > 0 ? Across::cell(cuts.cell_at(quad - frame.columns, 2)) : Across::border(0),
      i + 1 < frame.columns ? Across::cell(cuts.cell_at(quad + 1, 3)) : Across::border(1),
      j + 1 < frame.rows ? Across::cell(cuts.cell_at(quad + frame.columns, 0)) : Across::border(2),
      i > 0 ? Across::cell(cuts.cell_at(quad - 1, 1)) : Across::border(3)};
}

// Writes the corners of one quad's cells at `out` and returns the corner after the last.
std::uint32_t put_quad(Pattern& pattern, const std::array<std::uint32_t, 4>& corners,
                       const std::array<Across, 4>& across, std::uint8_t cut, std::uint32_t cell,
                       std::uint32_t out) {
  const auto put = [&](std::uint32_t corner, Across beyond) {
    pattern.corners[out] = corner;
    pattern.across[out++] = beyond;
  };
  if (cut == kWhole) {
    for (unsigned k = 0; k < 4; ++k) put(corners[k], across[k]);
    pattern.cell_begin[cell + 1] = out;
    return out;
  }
  for (unsigned half = 0; half < 2; ++half) {
    const unsigned a = (cut + 2 * half) & 3;
    put(corners[a], across[a]);
    put(corners[(a + 1) & 3], across[(a + 1) & 3]);
    put(corners[(a + 2) & 3], Across::cell(cell + 1 - half));
    pattern.cell_begin[cell + half + 1] = out;
  }
  return out;
}

// Index range of a quad's cells, found in the raster-ordered origins: at most quads_split + 2
// candidates, since every quad before it has one or two cells.
std::pair<std::uint32_t, std::uint32_t> cells_of(const QuadGrid& quads, std::uint32_t quad) {
  const auto& origin = quads.pattern.origin;
  const auto low = origin.begin() + quad;
  const auto high = low + std::min<std::ptrdiff_t>(quads.quads_split + 1, origin.end() - low);
  const auto first = std::lower_bound(low, high, quad);
  auto last = first;
  while (last != origin.end() && *last == quad) ++last;
  return {static_cast<std::uint32_t>(first - origin.begin()),
          static_cast<std::uint32_t>(last - origin.begin())};
}

// Calls `visit(i, j)` for each of the up to four quads that use a grid point.
template <class Visit>
void for_quads_at(const QuadFrame& frame, std::uint32_t point, Visit visit) {
  const std::uint32_t i = point % (frame.columns + 1), j = point / (frame.columns + 1);
  for (std::uint32_t y = j > 0 ? j - 1 : 0; y <= j && y < frame.rows; ++y)
    for (std::uint32_t x = i > 0 ? i - 1 : 0; x <= i && x < frame.columns; ++x) visit(x, y);
}

bool has_intact_quad(const QuadGrid& quads, const QuadFrame& frame, std::uint32_t point,
                     const std::vector<std::uint8_t>& cell_broken) {
  bool intact = false;
  for_quads_at(frame, point, [&](std::uint32_t i, std::uint32_t j) {
    const auto [begin, end] = cells_of(quads, j * frame.columns + i);
    for (std::uint32_t cell = begin; cell < end; ++cell) intact |= !cell_broken[cell];
  });
  return intact;
}

}  // namespace

QuadPoints jittered_points(const GridShape& grid, double jitter, std::uint64_t seed) {
  assert(jitter >= 0 && jitter <= 1);
  const QuadFrame frame = frame_of(grid);
  // A box of `reach` lattice points per axis around the node; at full jitter the boxes tile the
  // lattice, so that neighbouring ones never share a point.
  const auto reach = [&](std::int64_t cell) {
    return std::max<std::int64_t>(1, std::llround(jitter * static_cast<double>(cell)));
  };
  const std::int64_t reach_x = reach(grid.cell_width), reach_y = reach(grid.cell_height);
  QuadPoints result{grid, {}};
  result.points.reserve(std::size_t{frame.columns + 1} * (frame.rows + 1));
  std::uint32_t k = 0;
  for (std::uint32_t j = 0; j <= frame.rows; ++j) {
    for (std::uint32_t i = 0; i <= frame.columns; ++i, ++k) {
      const std::uint64_t bits = random_bits(seed, k);
      LatticePoint p{std::int64_t{i} * grid.cell_width, std::int64_t{j} * grid.cell_height};
      if (i != 0 && i != frame.columns)
        p.x += static_cast<std::int64_t>((bits >> 32) * reach_x >> 32) - reach_x / 2;
      if (j != 0 && j != frame.rows)
        p.y += static_cast<std::int64_t>((bits & 0xFFFFFFFFu) * reach_y >> 32) - reach_y / 2;
      result.points.push_back(p);
    }
  }
  return result;
}

QuadGrid quad_grid(const QuadPoints& points) {
  const QuadFrame frame = frame_of(points.grid);
  assert(points.points.size() == std::size_t{frame.columns + 1} * (frame.rows + 1));
  QuadGrid result;
  result.points = points.points;
  Pattern& pattern = result.pattern;
  pattern.vertices.reserve(points.points.size());
  for (const LatticePoint p : points.points)
    pattern.vertices.push_back(points.grid.lattice.to_metres(p));
  const Cuts cuts = find_cuts(frame, points.points, pattern.vertices);
  const std::uint32_t cells = cuts.first_cell.back();
  result.quads_split = cells - frame.quad_count();
  pattern.all_convex = cuts.strict;
  // A whole quad has 4 corners, a cut one 6.
  const std::size_t corners = 4 * std::size_t{frame.quad_count()} + 2 * result.quads_split;
  pattern.corners.resize(corners);
  pattern.across.resize(corners);
  pattern.cell_begin.resize(std::size_t{cells} + 1);
  pattern.origin.resize(cells);
  std::uint32_t out = 0, quad = 0;
  for (std::uint32_t j = 0; j < frame.rows; ++j) {
    for (std::uint32_t i = 0; i < frame.columns; ++i, ++quad) {
      out = put_quad(pattern, frame.corners(i, j), neighbours(frame, cuts, i, j), cuts.reflex[quad],
                     cuts.first_cell[quad], out);
      for (std::uint32_t c = cuts.first_cell[quad]; c < cuts.first_cell[quad + 1]; ++c)
        pattern.origin[c] = quad;
    }
  }
  return result;
}

PointBreak break_points(const QuadGrid& quads, const GridShape& grid,
                        const std::vector<std::uint32_t>& points,
                        std::vector<std::uint8_t>& point_broken,
                        std::vector<std::uint8_t>& cell_broken) {
  assert(point_broken.size() == quads.points.size());
  assert(cell_broken.size() == quads.pattern.cell_count());
  const QuadFrame frame = frame_of(grid);
  PointBreak result;
  std::vector<std::uint32_t> near;
  for (const std::uint32_t point : points) {
    if (point_broken[point]) continue;
    point_broken[point] = 1;
    for_quads_at(frame, point, [&](std::uint32_t i, std::uint32_t j) {
      const auto [begin, end] = cells_of(quads, j * frame.columns + i);
      for (std::uint32_t cell = begin; cell < end; ++cell) {
        if (cell_broken[cell]) continue;
        cell_broken[cell] = 1;
        result.cells.push_back(cell);
      }
      for (const std::uint32_t corner : frame.corners(i, j)) near.push_back(corner);
    });
  }
  for (const std::uint32_t point : near) {
    if (point_broken[point] || has_intact_quad(quads, frame, point, cell_broken)) continue;
    point_broken[point] = 1;
    result.leftovers.push_back(point);
  }
  std::sort(result.cells.begin(), result.cells.end());
  std::sort(result.leftovers.begin(), result.leftovers.end());
  return result;
}

}  // namespace sunder
