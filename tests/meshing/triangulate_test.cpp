// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/triangulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "meshing/random.hpp"
#include "meshing/trig.hpp"

namespace sunder {
namespace {

using Parts = std::vector<std::vector<std::uint32_t>>;

double twice_area(std::span<const Vec2> points, const std::vector<std::uint32_t>& loop) {
  double sum = 0;
  const Vec2 base = points[loop[0]];
  for (std::size_t k = 2; k < loop.size(); ++k)
    sum += cross(points[loop[k - 1]] - base, points[loop[k]] - base);
  return sum;
}

double twice_area(std::span<const Vec2> points, const Parts& loops) {
  double sum = 0;
  for (const auto& loop : loops) sum += twice_area(points, loop);
  return sum;
}

Parts as_parts(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  Parts parts;
  for (const auto& t : triangles) parts.emplace_back(t.begin(), t.end());
  return parts;
}

// Every loop edge once in its direction, every other edge once in each: the parts tile the polygon
// as a surface, whatever the coordinates are.
void expect_tiles(const Parts& parts, const IndexLoops& loops) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
  for (const auto& part : parts)
    for (std::size_t k = 0; k < part.size(); ++k) ++count[{part[k], part[(k + 1) % part.size()]}];
  for (const auto& [edge, times] : count) EXPECT_EQ(times, 1) << edge.first << " " << edge.second;
  for (const auto& loop : loops)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const std::pair edge{loop[k], loop[(k + 1) % loop.size()]};
      EXPECT_EQ(count[edge], 1) << edge.first << " " << edge.second;
      EXPECT_EQ(count.erase({edge.second, edge.first}), 0u);
      count.erase(edge);
    }
  for (const auto& [edge, times] : count)
    EXPECT_TRUE(count.contains({edge.second, edge.first})) << edge.first << " " << edge.second;
}

void expect_positive(std::span<const Vec2> points, const Parts& triangles) {
  for (const auto& t : triangles)
    EXPECT_GT(orientation(points[t[0]], points[t[1]], points[t[2]]), 0)
        << t[0] << " " << t[1] << " " << t[2];
}

void expect_convex(std::span<const Vec2> points, const Parts& parts) {
  for (const auto& part : parts)
    for (std::size_t k = 0; k < part.size(); ++k)
      EXPECT_GE(orientation(points[part[k]], points[part[(k + 1) % part.size()]],
                            points[part[(k + 2) % part.size()]]),
                0);
}

// A star-shaped polygon of `count` corners around `centre`, counter-clockwise.
std::vector<Vec2> random_star(std::uint32_t count, std::uint64_t seed, double radius, Vec2 centre) {
  std::vector<Vec2> points;
  for (std::uint32_t k = 0; k < count; ++k) {
    const double turns = (k + random_unit(seed, k, 0)) / count;
    const double r = radius * (0.2 + 0.8 * random_unit(seed, k, 1));
    points.push_back(centre + r * unit_at_turns(turns));
  }
  return points;
}

std::vector<std::uint32_t> indices(std::uint32_t begin, std::uint32_t end, bool reversed = false) {
  std::vector<std::uint32_t> loop(end - begin);
  std::iota(loop.begin(), loop.end(), begin);
  if (reversed) std::reverse(loop.begin(), loop.end());
  return loop;
}

TEST(Orientation, IsExactWhereDoublesCancel) {
  // The determinant of each row but the first vanishes when it is evaluated in doubles.
  const Vec2 a{0, 0}, b{1, 1};
  EXPECT_EQ(orientation(a, b, {0x1p-60, 0x1p-60}), 0);
  EXPECT_EQ(orientation(a, b, {0x1p-60, 0x1.0000000000001p-60}), 1);
  EXPECT_EQ(orientation(a, b, {0x1.0000000000001p-60, 0x1p-60}), -1);
  EXPECT_EQ(orientation({0x1p53, 0x1p53}, {-0x1p53, -0x1p53}, {0.5, 0.5}), 0);
  EXPECT_EQ(orientation({0x1p53, 0x1p53}, {-0x1p53, -0x1p53}, {0.5, 0.25}), 1);
}

TEST(Triangulate, ASquareIsTwoTriangles) {
  const std::vector<Vec2> points{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const auto parts = as_parts(triangulate(points, {{0, 1, 2, 3}}));
  EXPECT_EQ(parts.size(), 2u);
  expect_tiles(parts, {{0, 1, 2, 3}});
  expect_positive(points, parts);
}

TEST(Triangulate, KeepsStraightCornersAsEdges) {
  const std::vector<Vec2> points{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  const IndexLoops loops{indices(0, 8)};
  const auto parts = as_parts(triangulate(points, loops));
  EXPECT_EQ(parts.size(), 6u);
  expect_tiles(parts, loops);
  expect_positive(points, parts);
  EXPECT_EQ(twice_area(points, parts), 8);
}

TEST(Triangulate, KeepsCornersThatRoundingMadeSlightlyReflex) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::vector<Vec2> points;
    const Vec2 corner[] = {{0.1, 0.7}, {3.3, 0.2}, {2.9, 2.6}, {-0.4, 2.2}};
    for (int side = 0; side < 4; ++side)  // points on slanted sides, rounded to either side of them
      for (int k = 0; k < 5; ++k) {
        const double t =
            (k + 0.9 * random_unit(seed, static_cast<std::uint64_t>(5 * side + k))) / 5;
        points.push_back(corner[side] + (k == 0 ? 0 : t) * (corner[(side + 1) % 4] - corner[side]));
      }
    const IndexLoops loops{indices(0, 20)};
    const auto parts = as_parts(triangulate(points, loops));
    EXPECT_EQ(parts.size(), 18u);
    expect_tiles(parts, loops);
    expect_positive(points, parts);
  }
}

TEST(Triangulate, RandomPolygonsWithHolesAreTiledExactly) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto count = static_cast<std::uint32_t>(3 + seed % 40);
    std::vector<Vec2> points{{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
    IndexLoops loops{indices(0, 4)};
    for (const Vec2 centre : {Vec2{-1, -1}, Vec2{1, -0.9}, Vec2{0.9, 1}}) {
      const auto begin = static_cast<std::uint32_t>(points.size());
      for (const Vec2 p : random_star(count, seed + begin, 0.9, centre)) points.push_back(p);
      loops.push_back(indices(begin, begin + count, true));
    }
    // With three corners a star may miss its centre and run clockwise: the hole must not.
    for (auto& loop : loops)
      if (&loop != &loops[0] && twice_area(points, loop) > 0)
        std::reverse(loop.begin(), loop.end());
    const auto parts = as_parts(triangulate(points, loops));
    EXPECT_EQ(parts.size(), 4 + 3 * count + 2 * 3 - 2);
    expect_tiles(parts, loops);
    expect_positive(points, parts);
    EXPECT_NEAR(twice_area(points, parts), twice_area(points, loops), 1e-13);
  }
}

TEST(Triangulate, AHoleMayTouchTheOutlineAtACorner) {
  const std::vector<Vec2> points{{0, 0}, {2, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 2}, {3, 2}};
  const IndexLoops loops{{0, 1, 2, 3, 4}, {1, 5, 6}};
  const auto parts = as_parts(triangulate(points, loops));
  expect_tiles(parts, loops);
  expect_positive(points, parts);
  EXPECT_EQ(twice_area(points, parts), 2 * (16 - 2.0));
}

TEST(Triangulate, ALoopMayTouchItself) {
  // Two squares that meet at point 2, as one loop.
  const std::vector<Vec2> points{{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {0, 1}};
  const IndexLoops loops{{0, 1, 2, 3, 4, 5, 2, 6}};
  const auto parts = as_parts(triangulate(points, loops));
  EXPECT_EQ(parts.size(), 4u);
  expect_tiles(parts, loops);
  expect_positive(points, parts);
}

TEST(Triangulate, ACornerThatRoundingPutOnAnotherEdgeKeepsTheTopology) {
  // Corner 3 should lie just above edge 0-1 but has been rounded onto it; then below it.
  for (const double y : {0.0, -1e-17}) {
    const std::vector<Vec2> points{{0, 0}, {4, 0}, {4, 1}, {2, y}, {0, 1}};
    const IndexLoops loops{indices(0, 5)};
    const auto parts = as_parts(triangulate(points, loops));
    EXPECT_EQ(parts.size(), 3u);
    expect_tiles(parts, loops);
    EXPECT_NEAR(twice_area(points, parts), 4, 1e-14);
  }
}

TEST(Triangulate, CoincidingAndCrossingHolesKeepTheTopology) {
  // A hole corner on the outline's edge, one beyond it, and two corners at the same place.
  for (const Vec2 corner : {Vec2{2, 0}, Vec2{2, -1e-16}, Vec2{4, 4}}) {
    const std::vector<Vec2> points{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 2}, corner, {3, 2.5}};
    for (const IndexLoops& loops :
         {IndexLoops{{0, 1, 2, 3}, {4, 6, 5}}, IndexLoops{{0, 1, 2, 3}, {6, 5, 4}}}) {
      const auto parts = as_parts(triangulate(points, loops));
      EXPECT_EQ(parts.size(), 7u);
      expect_tiles(parts, loops);
      EXPECT_NEAR(twice_area(points, parts), twice_area(points, loops), 1e-14);
    }
  }
}

TEST(Triangulate, DependsOnlyOnTheLoopsNotOnWhereTheyStart) {
  const auto points = random_star(30, 5, 1, {});
  auto loop = indices(0, 30);
  const auto reference = triangulate(points, {loop});
  for (int turn = 0; turn < 30; ++turn) {
    std::rotate(loop.begin(), loop.begin() + 1, loop.end());
    EXPECT_EQ(triangulate(points, {loop}), reference);
  }
}

TEST(Triangulate, MeetsTheDelaunayCriterionInsideAConvexPolygon) {
  std::vector<Vec2> points;
  for (int k = 0; k < 12; ++k) {  // no four on a circle
    const Vec2 u = unit_at_turns((k + 0.3 * random_unit(3, static_cast<std::uint64_t>(k))) / 12);
    points.push_back({2 * u.x, u.y});
  }
  for (const auto& t : triangulate(points, {indices(0, 12)}))
    for (std::uint32_t p = 0; p < 12; ++p) {
      const Vec2 a = points[t[0]] - points[p], b = points[t[1]] - points[p],
                 c = points[t[2]] - points[p];
      EXPECT_LT(dot(a, a) * cross(b, c) + dot(b, b) * cross(c, a) + dot(c, c) * cross(a, b), 1e-12);
    }
}

TEST(ConvexParts, AConvexPolygonStaysWhole) {
  std::vector<Vec2> points;
  for (int k = 0; k < 9; ++k) points.push_back(unit_at_turns(k / 9.0));
  const Parts parts = convex_parts(points, {indices(0, 9)});
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0], indices(0, 9));
}

TEST(ConvexParts, StraightCornersDoNotCut) {
  const std::vector<Vec2> points{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {0, 2}};
  EXPECT_EQ(convex_parts(points, {indices(0, 6)}).size(), 1u);
}

TEST(ConvexParts, AnEllIsTwoAndAFrameAtMostEight) {
  const std::vector<Vec2> ell{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  EXPECT_EQ(convex_parts(ell, {indices(0, 6)}).size(), 2u);
  const std::vector<Vec2> frame{{0, 0}, {3, 0}, {3, 3}, {0, 3}, {1, 1}, {1, 2}, {2, 2}, {2, 1}};
  const IndexLoops loops{indices(0, 4), indices(4, 8)};
  const Parts parts = convex_parts(frame, loops);
  EXPECT_LE(parts.size(), 8u);
  EXPECT_GE(parts.size(), 4u);
  expect_tiles(parts, loops);
  expect_convex(frame, parts);
  EXPECT_EQ(twice_area(frame, parts), 16);
}

TEST(ConvexParts, RandomStarsComeOutConvexAndFew) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto count = static_cast<std::uint32_t>(5 + seed % 60);
    const auto points = random_star(count, seed, 2, {7, -3});
    const IndexLoops loops{indices(0, count)};
    const Parts parts = convex_parts(points, loops);
    expect_tiles(parts, loops);
    expect_convex(points, parts);
    EXPECT_NEAR(twice_area(points, parts), twice_area(points, loops), 1e-13);
    // At most four times the optimum, which is at most one part more than reflex corners.
    std::size_t reflex = 0;
    for (std::uint32_t k = 0; k < count; ++k)
      reflex += orientation(points[k], points[(k + 1) % count], points[(k + 2) % count]) < 0;
    EXPECT_LE(parts.size(), 2 * reflex + 1);
  }
}

}  // namespace
}  // namespace sunder
