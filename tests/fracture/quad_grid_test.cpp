// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/quad_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "meshing/random.hpp"

namespace sunder {
namespace {

constexpr double kJitters[] = {0, 0.3, 0.66, 0.9, 1};

GridShape shape(int columns, int rows, int width, int height, Vec2 origin = {},
                Vec2 step = {0x1p-20, 0x1p-20}) {
  return {{origin, step, std::int64_t{columns} * width, std::int64_t{rows} * height},
          columns,
          rows,
          width,
          height};
}

std::int64_t twice_area(const QuadGrid& quads, std::uint32_t cell) {
  const Pattern& p = quads.pattern;
  const LatticePoint base = quads.points[p.corners[p.cell_begin[cell]]];
  std::int64_t sum = 0;
  for (std::uint32_t k = p.cell_begin[cell] + 2; k < p.cell_begin[cell + 1]; ++k)
    sum += cross(quads.points[p.corners[k - 1]] - base, quads.points[p.corners[k]] - base);
  return sum;
}

// Exactly convex on the lattice; straight corners allowed.
bool is_convex(const QuadGrid& quads, std::uint32_t cell) {
  const Pattern& p = quads.pattern;
  const std::uint32_t begin = p.cell_begin[cell], size = p.cell_begin[cell + 1] - begin;
  for (std::uint32_t k = 0; k < size; ++k)
    if (orientation(quads.points[p.corners[begin + k]],
                    quads.points[p.corners[begin + (k + 1) % size]],
                    quads.points[p.corners[begin + (k + 2) % size]]) < 0)
      return false;
  return true;
}

void expect_partition(const QuadGrid& quads, const GridShape& grid) {
  const Pattern& p = quads.pattern;
  EXPECT_EQ(check(p), PatternDefects{});
  std::int64_t sum = 0;
  for (std::uint32_t c = 0; c < p.cell_count(); ++c) {
    EXPECT_GT(twice_area(quads, c), 0) << "cell " << c;
    EXPECT_TRUE(is_convex(quads, c)) << "cell " << c;
    sum += twice_area(quads, c);
  }
  EXPECT_EQ(sum, 2 * grid.lattice.width * grid.lattice.height);
  EXPECT_EQ(p.cell_count(),
            static_cast<std::uint32_t>(grid.columns * grid.rows) + quads.quads_split);
  EXPECT_TRUE(std::is_sorted(p.origin.begin(), p.origin.end()));
}

TEST(JitteredPoints, StayInTheirHalfOpenBoxesAndOnTheBorder) {
  const GridShape grid = shape(5, 4, 7, 10);
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const QuadPoints points = jittered_points(grid, 1, seed);
    ASSERT_EQ(points.points.size(), 30u);
    for (int j = 0; j <= 4; ++j)
      for (int i = 0; i <= 5; ++i) {
        const LatticePoint p = points.points[static_cast<std::size_t>(j * 6 + i)];
        const std::int64_t dx = p.x - 7 * i, dy = p.y - 10 * j;
        EXPECT_TRUE(dx == 0 || (i != 0 && i != 5));
        EXPECT_TRUE(dy == 0 || (j != 0 && j != 4));
        EXPECT_TRUE(dx >= -3 && dx <= 3 && dy >= -5 && dy <= 4) << dx << " " << dy;
      }
  }
}

TEST(JitteredPoints, FillTheirBoxesEvenly) {
  const GridShape grid = shape(2, 2, 8, 8);
  int count[8][8] = {};
  for (std::uint64_t seed = 0; seed < 64000; ++seed) {
    const LatticePoint p = jittered_points(grid, 1, seed).points[4];
    ++count[p.y - 4][p.x - 4];
  }
  double chi_squared = 0;
  for (const auto& row : count)
    for (const int n : row) chi_squared += (n - 1000) * (n - 1000) / 1000.0;
  EXPECT_LT(chi_squared, 63 + 5 * 11.2);  // mean 63, standard deviation sqrt(126)
}

TEST(JitteredPoints, DependOnSeedAndIndexOnly) {
  const auto small = jittered_points(shape(6, 3, 100, 100), 0.7, 9);
  const auto tall = jittered_points(shape(6, 5, 100, 100), 0.7, 9);
  for (std::size_t k = 0; k < 3 * 7; ++k) EXPECT_EQ(small.points[k], tall.points[k]);
  EXPECT_NE(small.points, jittered_points(shape(6, 3, 100, 100), 0.7, 10).points);
}

TEST(QuadGrid, WithoutJitterIsAPlainGrid) {
  const GridShape grid = shape(4, 3, 1 << 18, 1 << 19, {-1, 2}, {0x1p-20, 0x1p-20});
  const QuadGrid quads = quad_grid(jittered_points(grid, 0, 1));
  expect_partition(quads, grid);
  const Pattern& p = quads.pattern;
  ASSERT_EQ(p.cell_count(), 12u);
  EXPECT_EQ(quads.quads_split, 0u);
  EXPECT_TRUE(p.all_convex);
  for (std::uint32_t c = 0; c < 12; ++c) EXPECT_EQ(cell_area(p, c), 0.25 * 0.5);
  // The middle cell of the lower row: border below, neighbours right, above, left.
  EXPECT_EQ(p.across[4], Across::border(0));
  EXPECT_EQ(p.across[5], Across::cell(2));
  EXPECT_EQ(p.across[6], Across::cell(5));
  EXPECT_EQ(p.across[7], Across::cell(0));
  EXPECT_EQ(p.across[4 * 11 + 1], Across::border(1));
  EXPECT_EQ(p.across[4 * 11 + 2], Across::border(2));
  EXPECT_EQ(p.across[3], Across::border(3));
}

TEST(QuadGrid, TilesTheWallExactlyForAllSeedsAndJitters) {
  std::uint32_t split = 0;
  for (const double jitter : kJitters)
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed) + " jitter " + std::to_string(jitter));
      const GridShape grid = shape(7, 5, 1 << 20, (1 << 20) - 3, {1.5, -7}, {0x1p-21, 0x1p-21});
      const QuadGrid quads = quad_grid(jittered_points(grid, jitter, seed));
      expect_partition(quads, grid);
      const double area = static_cast<double>(grid.lattice.width * grid.lattice.height) * 0x1p-42;
      EXPECT_NEAR(total_area(quads.pattern), area, 1e-13 * area);
      split += quads.quads_split;
      if (::testing::Test::HasFailure()) return;
    }
  EXPECT_GT(split, 0u);
}

TEST(QuadGrid, TinyCellsAreNeverInvertedNorCollapsed) {
  // Cells of a few lattice steps: ties, straight corners and reflex corners are common.
  std::uint32_t not_strict = 0;
  for (const int width : {1, 2, 3, 4})
    for (const int height : {1, 2, 5})
      for (std::uint64_t seed = 0; seed < 50; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const GridShape grid = shape(6, 6, width, height);
        const QuadGrid quads = quad_grid(jittered_points(grid, 1, seed));
        expect_partition(quads, grid);
        bool strict = true;
        for (std::uint32_t c = 0; c < quads.pattern.cell_count(); ++c)
          strict &= is_strictly_convex(quads.pattern, c);
        EXPECT_EQ(quads.pattern.all_convex, strict);
        not_strict += !strict;
      }
  EXPECT_GT(not_strict, 100u);
}

TEST(QuadGrid, CutsAReflexQuadAtItsReflexCorner) {
  for (std::uint32_t reflex = 0; reflex < 4; ++reflex) {
    const GridShape grid = shape(3, 3, 10, 10);
    QuadPoints points = jittered_points(grid, 0, 0);
    // The middle quad has points 5, 6, 10, 9. One of them moves towards the quad's centre and its
    // neighbours away from the opposite corner.
    const std::uint32_t ring[] = {5, 6, 10, 9};
    const LatticePoint out[] = {{-4, -4}, {4, -4}, {4, 4}, {-4, 4}};
    auto& p = points.points;
    p[ring[reflex]] = p[ring[reflex]] - out[reflex];
    for (const unsigned side : {(reflex + 1) & 3, (reflex + 3) & 3}) {
      const LatticePoint o = out[side], r = out[reflex];
      p[ring[side]] = p[ring[side]] + LatticePoint{o.x == r.x ? o.x : 0, o.y == r.y ? o.y : 0};
    }
    const QuadGrid quads = quad_grid(points);
    expect_partition(quads, grid);
    ASSERT_EQ(quads.quads_split, 1u);
    const Pattern& pattern = quads.pattern;
    EXPECT_EQ(pattern.origin[4], 4u);
    EXPECT_EQ(pattern.origin[5], 4u);
    for (const std::uint32_t cell : {4u, 5u}) {
      ASSERT_EQ(pattern.cell_begin[cell + 1] - pattern.cell_begin[cell], 3u);
      const auto* corners = pattern.corners.data() + pattern.cell_begin[cell];
      EXPECT_EQ(std::count(corners, corners + 3, ring[reflex]), 1);
      EXPECT_EQ(std::count(corners, corners + 3, ring[(reflex + 2) & 3]), 1);
    }
  }
}

TEST(QuadGrid, FlipsWithItsPoints) {
  const GridShape grid = shape(8, 6, 101, 97);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const QuadPoints points = jittered_points(grid, 1, seed);
    QuadPoints flipped = points;
    for (std::size_t j = 0; j <= 6; ++j)
      for (std::size_t i = 0; i <= 8; ++i) {
        const LatticePoint p = points.points[j * 9 + i];
        flipped.points[j * 9 + 8 - i] = {grid.lattice.width - p.x, p.y};
      }
    const QuadGrid a = quad_grid(points), b = quad_grid(flipped);
    EXPECT_EQ(a.quads_split, b.quads_split) << "seed " << seed;
    expect_partition(b, grid);
  }
}

// The definition of the point mode: a quad is broken when one of its points is, and an intact point
// without an intact quad is a leftover.
struct Reference {
  std::vector<std::uint8_t> point_broken, cell_broken;
};
Reference recompute(const QuadGrid& quads, const std::vector<std::uint8_t>& destroyed) {
  const Pattern& p = quads.pattern;
  std::vector<std::uint8_t> quad_broken(p.origin.back() + 1);
  for (std::uint32_t c = 0; c < p.cell_count(); ++c)
    for (std::uint32_t k = p.cell_begin[c]; k < p.cell_begin[c + 1]; ++k)
      quad_broken[p.origin[c]] |= destroyed[p.corners[k]];
  Reference result{std::vector<std::uint8_t>(destroyed.size(), 1), {}};
  for (std::uint32_t c = 0; c < p.cell_count(); ++c) {
    result.cell_broken.push_back(quad_broken[p.origin[c]]);
    for (std::uint32_t k = p.cell_begin[c]; k < p.cell_begin[c + 1]; ++k)
      if (!quad_broken[p.origin[c]]) result.point_broken[p.corners[k]] = 0;
  }
  return result;
}

TEST(BreakPoints, EqualsAFullRecomputationOverRandomBreaks) {
  std::size_t leftovers = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const GridShape grid = shape(9, 7, 64, 64);
    const QuadGrid quads = quad_grid(jittered_points(grid, 1, seed));
    std::vector<std::uint8_t> point_broken(quads.points.size()),
        cell_broken(quads.pattern.cell_count()), destroyed(quads.points.size());
    for (std::uint64_t hit = 0; hit < 12; ++hit) {
      std::vector<std::uint32_t> points;
      for (std::uint64_t k = 0; k < 3; ++k)
        points.push_back(
            static_cast<std::uint32_t>(random_bits(seed, hit, k) % quads.points.size()));
      for (const std::uint32_t point : points) destroyed[point] = 1;
      const auto cells_before = cell_broken;
      const PointBreak change = break_points(quads, grid, points, point_broken, cell_broken);
      const Reference expected = recompute(quads, destroyed);
      ASSERT_EQ(cell_broken, expected.cell_broken);
      // A destroyed point has no intact quad either, so the flags agree everywhere.
      ASSERT_EQ(point_broken, expected.point_broken);
      std::vector<std::uint32_t> newly;
      for (std::uint32_t c = 0; c < cell_broken.size(); ++c)
        if (cell_broken[c] != cells_before[c]) newly.push_back(c);
      EXPECT_EQ(change.cells, newly);
      EXPECT_TRUE(std::is_sorted(change.leftovers.begin(), change.leftovers.end()));
      leftovers += change.leftovers.size();
    }
  }
  EXPECT_GT(leftovers, 0u);
}

TEST(BreakPoints, RemovesThePointBetweenTwoDestroyedOnes) {
  const GridShape grid = shape(4, 4, 16, 16);
  const QuadGrid quads = quad_grid(jittered_points(grid, 0, 1));
  std::vector<std::uint8_t> point_broken(25), cell_broken(16);
  // Points 11 and 13 are the left and right neighbours of point 12: all four quads around it go.
  const PointBreak first = break_points(quads, grid, {11}, point_broken, cell_broken);
  EXPECT_EQ(first.cells, (std::vector<std::uint32_t>{4, 5, 8, 9}));
  EXPECT_EQ(first.leftovers, std::vector<std::uint32_t>{10});  // on the border, beside point 11
  const PointBreak second = break_points(quads, grid, {13}, point_broken, cell_broken);
  EXPECT_EQ(second.cells, (std::vector<std::uint32_t>{6, 7, 10, 11}));
  EXPECT_EQ(second.leftovers, (std::vector<std::uint32_t>{12, 14}));
  EXPECT_EQ(point_broken[12], 1);
}

TEST(BreakPoints, DestroyingAPointTwiceChangesNothing) {
  const GridShape grid = shape(4, 4, 16, 16);
  const QuadGrid quads = quad_grid(jittered_points(grid, 0.9, 3));
  std::vector<std::uint8_t> point_broken(25), cell_broken(quads.pattern.cell_count());
  break_points(quads, grid, {12, 12}, point_broken, cell_broken);
  const PointBreak again = break_points(quads, grid, {12}, point_broken, cell_broken);
  EXPECT_TRUE(again.cells.empty());
  EXPECT_TRUE(again.leftovers.empty());
}

}  // namespace
}  // namespace sunder
