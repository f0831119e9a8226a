// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/spiderweb.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

LatticeRegion on_lattice(const Region& region) {
  const Box box = bounding_box(region.outline);
  return make_lattice_region(region, make_lattice(box.low, box.high - box.low), "test");
}

Region plain_wall() {
  return {rectangle({6, 3}), {}};
}

// A door on the floor, a window, and a gable: edges on the outline's, free ones and slanted ones.
Region house_wall() {
  return {{{0, 0}, {7, 0}, {7, 2.5}, {3.4, 4.1}, {0, 2.5}},
          {rectangle({0.9, 2.1}, {1, 0}),
           rectangle({1.2, 1.1}, {4, 1}),
           {{3.4, 2.9}, {3.1, 3.3}, {3.4, 3.6}, {3.8, 3.2}}}};
}

// Parameters that leave the rest of the wall in a few large cells.
SpiderwebParams only_damage(std::int64_t points, double low, double high) {
  return {.impacts = {{2.5, 1.5}},
          .min_points = points,
          .max_points = points,
          .min_radius = low,
          .max_radius = high,
          .rings = 0,
          .rest_cell = 50};
}

void expect_partition(const Pattern& pattern, const Region& region) {
  EXPECT_EQ(check(pattern), PatternDefects{});
  EXPECT_NEAR(total_area(pattern), area(region), 1e-13 * area(region));
}

std::uint32_t vertex_at(const Pattern& pattern, Vec2 place) {
  for (std::uint32_t v = 0; v < pattern.vertices.size(); ++v)
    if (length(pattern.vertices[v] - place) < 1e-7) return v;
  ADD_FAILURE() << "no vertex at " << place.x << " " << place.y;
  return 0;
}

std::vector<std::uint32_t> corners_of(const Pattern& pattern, std::uint32_t cell) {
  return {pattern.corners.begin() + pattern.cell_begin[cell],
          pattern.corners.begin() + pattern.cell_begin[cell + 1]};
}

// The cells around an interior vertex in counter-clockwise order, each with the vertex after it.
struct Fan {
  std::vector<std::uint32_t> cells, ends;
};
Fan fan_at(const Pattern& pattern, std::uint32_t vertex) {
  Fan all, fan;
  std::vector<std::uint32_t> before;
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell) {
    const auto corners = corners_of(pattern, cell);
    const auto at = std::find(corners.begin(), corners.end(), vertex) - corners.begin();
    if (at == static_cast<std::ptrdiff_t>(corners.size())) continue;
    const auto k = static_cast<std::size_t>(at), n = corners.size();
    all.cells.push_back(cell);
    all.ends.push_back(corners[(k + 1) % n]);
    before.push_back(corners[(k + n - 1) % n]);
  }
  for (std::size_t i = 0, found = 0; i < all.cells.size(); ++i) {
    fan.cells.push_back(all.cells[found]);
    fan.ends.push_back(all.ends[found]);
    found = static_cast<std::size_t>(std::find(all.ends.begin(), all.ends.end(), before[found]) -
                                     all.ends.begin());
    if (found == all.cells.size()) return {};  // open: the vertex lies on the border
  }
  return fan;
}

// Direction in [0, 1) turns, from `start` on.
double turns(Vec2 d, double start) {
  const double t = std::atan2(d.y, d.x) / (2 * std::numbers::pi) - start;
  return t - std::floor(t);
}

// Area of the convex hull by definition: what lies left of every edge that has all points left of
// it.
double hull_area(const std::vector<Vec2>& points) {
  double sum = 0;
  for (const Vec2 a : points)
    for (const Vec2 b : points)
      if (!(a == b) &&
          std::ranges::all_of(points, [&](Vec2 c) { return orientation(a, b, c) >= 0; }))
        sum += cross(a - points[0], b - points[0]) / 2;
  return sum;
}

TEST(Spiderweb, TilesTheRegionForManySeeds) {
  const Region region = house_wall();
  const LatticeRegion lattice = on_lattice(region);
  const SpiderwebParams params{.impacts = {{3.0, 1.2}, {3.3, 1.5}, {6.5, 2.2}}, .radial = 5};
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Pattern pattern = spiderweb(lattice, params, seed);
    expect_partition(pattern, region);
    EXPECT_TRUE(pattern.hole_begin.empty());
  }
}

TEST(Spiderweb, BorderEdgesAddUpToTheRegionsBoundary) {
  const Region region = house_wall();
  const LatticeRegion lattice = on_lattice(region);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Pattern p = spiderweb(lattice, {.impacts = {{0, 1}, {5, 0.9}}, .radial = 4}, seed);
    std::vector<double> sum(lattice.edge_count());
    for (std::uint32_t c = 0; c < p.cell_count(); ++c)
      for (std::uint32_t k = p.cell_begin[c]; k < p.cell_begin[c + 1]; ++k) {
        const std::uint32_t next = LoopRange{p.cell_begin[c], p.cell_begin[c + 1]}.next(k);
        if (p.across[k].is_border())
          sum[p.across[k].border()] +=
              length(p.vertices[p.corners[next]] - p.vertices[p.corners[k]]);
      }
    for (std::uint32_t e = 0; e < sum.size(); ++e) {
      double expected = length(lattice.places[lattice.next(e)] - lattice.places[e]);
      if (e == 0) expected -= 0.9;  // the door's width
      if (lattice.places[e].y == 0 && lattice.places[lattice.next(e)].y == 0 && e != 0)
        expected = 0;
      EXPECT_NEAR(sum[e], expected, 1e-12) << "edge " << e << " seed " << seed;
    }
  }
}

TEST(Spiderweb, SectorsHaveTheClosedFormArea) {
  const Region region = plain_wall();
  const LatticeRegion lattice = on_lattice(region);
  for (const std::int64_t n : {5, 6, 9, 14})
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      SCOPED_TRACE("points " + std::to_string(n) + " seed " + std::to_string(seed));
      const Pattern p = spiderweb(lattice, only_damage(n, 0.3, 0.5), seed);
      const Vec2 impact = p.vertices[vertex_at(p, {2.5, 1.5})];
      const Fan fan = fan_at(p, vertex_at(p, {2.5, 1.5}));
      ASSERT_EQ(fan.cells.size(), static_cast<std::size_t>(n));
      // Corner i lies in the i-th n-th of a turn, a gap too narrow may move it by a twentieth.
      std::vector<double> slots;
      double expected_sum = 0, sum = 0;
      for (std::size_t i = 0; i < fan.ends.size(); ++i) {
        const Vec2 a = p.vertices[fan.ends[i]] - impact;
        const Vec2 b = p.vertices[fan.ends[(i + 1) % fan.ends.size()]] - impact;
        EXPECT_GE(length(a), 0.3 - 1e-8);
        EXPECT_LE(length(a), 0.5 + 1e-8);
        const double angle = (turns(b, 0) - turns(a, 0)) * 2 * std::numbers::pi;
        const double expected = 0.5 * length(a) * length(b) * std::sin(angle);
        EXPECT_NEAR(cell_area(p, fan.cells[i]), expected, 1e-14);
        expected_sum += expected;
        sum += cell_area(p, fan.cells[i]);
        slots.push_back(turns(a, -0.5 / static_cast<double>(n)) * static_cast<double>(n));
      }
      EXPECT_NEAR(sum, expected_sum, 1e-13);
      std::sort(slots.begin(), slots.end());
      for (std::size_t i = 0; i < slots.size(); ++i) {
        EXPECT_GE(slots[i], static_cast<double>(i) - 1e-6);
        EXPECT_LE(slots[i], static_cast<double>(i) + 1.05 + 1e-6);
      }
    }
}

TEST(Spiderweb, TheImpactIsAlwaysStrictlyInsideItsPolygon) {
  const LatticeRegion lattice = on_lattice(plain_wall());
  for (const std::int64_t n : {3, 4, 5, 7}) {
    std::uint32_t repaired = 0;
    const std::uint64_t draws = n == 3 ? 2000 : 300;
    for (std::uint64_t seed = 0; seed < draws; ++seed) {
      SpiderwebStats stats;
      const Pattern p = spiderweb(lattice, only_damage(n, 0.2, 0.6), seed, &stats);
      const std::uint32_t impact = vertex_at(p, {2.5, 1.5});
      const Fan fan = fan_at(p, impact);
      ASSERT_EQ(fan.cells.size(), static_cast<std::size_t>(n)) << "seed " << seed;
      for (std::size_t i = 0; i < fan.ends.size(); ++i)
        ASSERT_GT(orientation(p.vertices[impact], p.vertices[fan.ends[i]],
                              p.vertices[fan.ends[(i + 1) % fan.ends.size()]]),
                  0)
            << "seed " << seed;
      repaired += stats.draws_repaired;
    }
    if (n == 3) {
      EXPECT_NEAR(repaired / 2000.0, 3.0 / 8, 5 * 0.0108);  // the unrepaired draw misses in 3/8
    } else {
      EXPECT_EQ(repaired, 0u);
    }
  }
}

TEST(Spiderweb, FilledCornersMakeThePolygonConvex) {
  const LatticeRegion lattice = on_lattice(plain_wall());
  std::uint32_t filled = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    SpiderwebStats stats;
    const Pattern p = spiderweb(lattice, only_damage(10, 0.2, 0.7), seed, &stats);
    const Fan fan = fan_at(p, vertex_at(p, {2.5, 1.5}));
    std::vector<Vec2> corners;
    for (const std::uint32_t v : fan.ends) corners.push_back(p.vertices[v]);
    double sum = 0;
    std::uint32_t fills = 0;
    for (std::uint32_t c = 0; c < p.cell_count(); ++c) {
      const auto loop = corners_of(p, c);
      const bool sector = std::ranges::find(fan.cells, c) != fan.cells.end();
      const bool fill = !sector && std::ranges::all_of(loop, [&](std::uint32_t v) {
        return std::ranges::find(fan.ends, v) != fan.ends.end();
      });
      fills += fill;
      if (sector || fill) sum += cell_area(p, c);
    }
    EXPECT_EQ(fills, stats.corners_filled);
    EXPECT_NEAR(sum, hull_area(corners), 1e-13);
    filled += fills;
  }
  EXPECT_GT(filled, 100u);
}

TEST(Spiderweb, RingsCutEverySector) {
  const LatticeRegion lattice = on_lattice(plain_wall());
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    SpiderwebParams params = only_damage(8, 0.5, 0.5);
    const Pattern plain = spiderweb(lattice, params, seed);
    params.rings = 3;
    const Pattern ringed = spiderweb(lattice, params, seed);
    EXPECT_EQ(ringed.cell_count(), plain.cell_count() + 3 * 8);
    expect_partition(ringed, plain_wall());
    // Corners at radius 0.5 and ring points where the law puts them, wavering by a quarter step.
    const Vec2 impact = ringed.vertices[vertex_at(ringed, {2.5, 1.5})];
    std::vector<double> radii;
    for (const Vec2 v : ringed.vertices)
      if (length(v - impact) < 0.499) radii.push_back(length(v - impact) / 0.5);
    ASSERT_EQ(radii.size(), 1u + 3 * 8);
    std::sort(radii.begin(), radii.end());
    for (std::size_t i = 0; i < 24; ++i) {
      const double f = static_cast<double>(i / 8 + 1) / 4, low = f - 0.0625, high = f + 0.0625;
      EXPECT_GE(radii[i + 1], low * (0.6 + 0.4 * low) - 1e-7);
      EXPECT_LE(radii[i + 1], high * (0.6 + 0.4 * high) + 1e-7);
    }
  }
}

TEST(Spiderweb, OverlappingImpactsShareOneConvexPolygon) {
  const Region region = plain_wall();
  const LatticeRegion lattice = on_lattice(region);
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    SpiderwebStats near_stats, far_stats;
    SpiderwebParams params{.impacts = {{2.5, 1.5}, {2.9, 1.6}}, .min_radius = 0.35};
    const Pattern near = spiderweb(lattice, params, seed, &near_stats);
    expect_partition(near, region);
    EXPECT_EQ(near_stats.polygons, 1u);
    for (const Vec2 impact : params.impacts)  // both keep all their sectors
      EXPECT_GE(fan_at(near, vertex_at(near, impact)).cells.size(), 7u);
    params.impacts[1] = {4.5, 1.6};
    const Pattern far = spiderweb(lattice, params, seed, &far_stats);
    expect_partition(far, region);
    EXPECT_EQ(far_stats.polygons, 2u);
  }
}

TEST(Spiderweb, CoincidingImpactsCountOnce) {
  const LatticeRegion lattice = on_lattice(plain_wall());
  const SpiderwebParams once{.impacts = {{2, 1}}};
  const SpiderwebParams thrice{.impacts = {{2, 1}, {2, 1}, {2 + 1e-9, 1}}};
  const Pattern a = spiderweb(lattice, once, 4), b = spiderweb(lattice, thrice, 4);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.corners, b.corners);
}

TEST(Spiderweb, ImpactsOnBordersAndCornersWork) {
  const Region region = house_wall();
  const LatticeRegion lattice = on_lattice(region);
  const Vec2 impacts[] = {{0, 0},     {7, 2.5},   {3.4, 4.1}, {0, 1},    {5, 0},
                          {1.9, 1},   {1.9, 2.1}, {1, 0},     {4, 1},    {4.6, 2.1},
                          {1.7, 3.3}, {3.4, 3.6}, {3.8, 3.2}, {1e-9, 1}, {5.5, 1e-6}};
  for (const Vec2 impact : impacts)
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      SCOPED_TRACE("impact " + std::to_string(impact.x) + " " + std::to_string(impact.y) +
                   " seed " + std::to_string(seed));
      expect_partition(spiderweb(lattice, {.impacts = {impact}, .radial = 6}, seed), region);
    }
}

TEST(Spiderweb, RandomImpactsOnAnyWallTileIt) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const double scale = std::ldexp(1.0, static_cast<int>(seed % 13) - 6);
    const Region region{rectangle({4 * scale, 3 * scale}, {-1.7 * scale, 0.3 * scale}),
                        {rectangle({scale, scale}, {-0.2 * scale, 1.1 * scale})}};
    SpiderwebParams params{.impacts = {},
                           .min_points = 3,
                           .min_radius = 0.05 * scale,
                           .max_radius = 0.7 * scale,
                           .rings = static_cast<std::int64_t>(seed % 4),
                           .radial = static_cast<std::int64_t>(seed % 10),
                           .reach = 1.5 * scale,
                           .rest_cell = 0.4 * scale};
    for (std::uint64_t k = 0; k < 1 + seed % 12; ++k) {
      const Vec2 place{(-1.7 + 4 * random_unit(seed, k, 0)) * scale,
                       (0.3 + 3 * random_unit(seed, k, 1)) * scale};
      if (!(place.x > -0.2 * scale && place.x < 0.8 * scale && place.y > 1.1 * scale &&
            place.y < 2.1 * scale))
        params.impacts.push_back(place);
    }
    expect_partition(spiderweb(on_lattice(region), params, seed), region);
  }
}

TEST(Spiderweb, ZonesLargerThanTheWallAndHugeRestCellsWork) {
  const Region region = house_wall();
  for (const double radius : {5.0, 50.0, 5e4})
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      const SpiderwebParams params{.impacts = {{3, 1}, {6, 1}},
                                   .min_radius = radius,
                                   .max_radius = 2 * radius,
                                   .radial = 3,
                                   .rest_cell = 1e6};
      expect_partition(spiderweb(on_lattice(region), params, seed), region);
    }
}

TEST(Spiderweb, WithoutImpactsTheWallIsGatheredIntoCompactCells) {
  const Region region = plain_wall();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Pattern p = spiderweb(on_lattice(region), {.impacts = {}, .rest_cell = 0.4}, seed);
    expect_partition(p, region);
    EXPECT_NEAR(18.0 / p.cell_count(), 0.16, 0.05);
    for (std::uint32_t c = 0; c < p.cell_count(); ++c) {
      EXPECT_GT(cell_area(p, c), 0.3 * 0.16);
      EXPECT_LT(cell_area(p, c), 2 * 0.16);
    }
  }
}

TEST(Spiderweb, SameSeedSameBytesOtherSeedOtherPattern) {
  const LatticeRegion lattice = on_lattice(house_wall());
  const SpiderwebParams params{.impacts = {{3.0, 1.2}, {3.3, 1.5}}, .radial = 7};
  const Pattern a = spiderweb(lattice, params, 1), b = spiderweb(lattice, params, 1);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.corners, b.corners);
  EXPECT_EQ(a.across, b.across);
  EXPECT_EQ(a.cell_begin, b.cell_begin);
  EXPECT_NE(a.vertices, spiderweb(lattice, params, 2).vertices);
}

TEST(Spiderweb, KeepsItsShapeFarFromTheOrigin) {
  const SpiderwebParams near{.impacts = {{3.25, 1.5}}, .radial = 5};
  const SpiderwebParams far{.impacts = {{1e6 + 3.25, 1.5 - 1e6}}, .radial = 5};
  const Region there{rectangle({6, 3}, {1e6, -1e6}), {}};
  const Pattern a = spiderweb(on_lattice(plain_wall()), near, 3);
  const Pattern b = spiderweb(on_lattice(there), far, 3);
  expect_partition(b, there);
  EXPECT_EQ(a.corners, b.corners);
  EXPECT_EQ(a.cell_begin, b.cell_begin);
}

TEST(Spiderweb, AMirroredWallIsTiledToo) {
  Region mirrored = house_wall();
  for (Vec2& p : mirrored.outline) p.x = -p.x;
  for (Loop& opening : mirrored.openings)
    for (Vec2& p : opening) p.x = -p.x;
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    expect_partition(
        spiderweb(on_lattice(mirrored), {.impacts = {{-3, 1.2}, {-3.3, 1.5}}, .radial = 5}, seed),
        mirrored);
}

std::string error_of(const SpiderwebParams& params) {
  try {
    spiderweb(on_lattice(house_wall()), params, 1);
  } catch (const Error& error) {
    return (error.code() == ErrorCode::geometry ? "geometry: " : "input: ") +
           std::string(error.what());
  }
  return "no error";
}

TEST(Spiderweb, ImpactsOutsideTheRegionAreRefusedWithTheirPlace) {
  for (const Vec2 place :
       {Vec2{-0.5, 1}, Vec2{7.25, 1}, Vec2{1.5, 1}, Vec2{1e30, 0}, Vec2{0.5, 4}}) {
    const std::string message = error_of({.impacts = {{3, 1}, place}});
    EXPECT_EQ(message.rfind("geometry: impact (", 0), 0u) << message;
  }
  EXPECT_NE(error_of({.impacts = {{7.25, 1}}}).find("(7.25, 1) m"), std::string::npos);
}

TEST(Spiderweb, ParametersThatCannotBeMetAreRefused) {
  const std::vector<Vec2> at{{3, 1}};
  EXPECT_NE(error_of({.impacts = at, .min_points = 8, .max_points = 7}).find("max_points = 7"),
            std::string::npos);
  EXPECT_NE(error_of({.impacts = at, .min_points = 2}).find("min_points = 2"), std::string::npos);
  EXPECT_NE(error_of({.impacts = at, .min_radius = 1, .max_radius = 0.5}).find("max_radius = 0.5"),
            std::string::npos);
  EXPECT_NE(error_of({.impacts = at, .min_radius = 1e-7}).find("too small"), std::string::npos);
  EXPECT_NE(error_of({.impacts = at, .max_radius = 1e12}).find("far beyond"), std::string::npos);
  EXPECT_NE(error_of({.impacts = at, .rest_cell = 1e-6}).find("too many cells"), std::string::npos);
}

}  // namespace
}  // namespace sunder
