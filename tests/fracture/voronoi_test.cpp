// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/voronoi.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "meshing/trig.hpp"

namespace sunder {
namespace {

constexpr double kJitters[] = {0, 0.3, 0.66, 0.9, 1};

std::int32_t code_of(Across across) {
  return across.is_border() ? ~static_cast<std::int32_t>(across.border())
                            : static_cast<std::int32_t>(across.cell());
}

std::vector<std::int32_t> neighbours(const Pattern& pattern, std::uint32_t cell) {
  std::vector<std::int32_t> result;
  for (std::uint32_t k = pattern.cell_begin[cell]; k < pattern.cell_begin[cell + 1]; ++k)
    result.push_back(code_of(pattern.across[k]));
  return result;
}

std::vector<std::int32_t> turned(std::vector<std::int32_t> cycle) {
  std::ranges::rotate(cycle, std::ranges::min_element(cycle));
  return cycle;
}

std::uint32_t cells_unlike_the_definition(const Sites& sites, const Pattern& pattern) {
  std::uint32_t count = 0;
  for (std::uint32_t cell = 0; cell < sites.points.size(); ++cell)
    count += turned(neighbours(pattern, cell)) != turned(exact_cell(sites, cell));
  return count;
}

double box_area(const Lattice& lattice) {
  return lattice.step.x * static_cast<double>(lattice.width) * lattice.step.y *
         static_cast<double>(lattice.height);
}

bool same_bytes(const Pattern& p, const Pattern& q) {
  const auto equal = [](const auto& a, const auto& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
  };
  return equal(p.vertices, q.vertices) && equal(p.cell_begin, q.cell_begin) &&
         equal(p.corners, q.corners) && equal(p.across, q.across) && p.all_convex == q.all_convex;
}

void expect_sound(const Sites& sites, const Pattern& pattern, const std::string& what) {
  EXPECT_EQ(check(pattern), PatternDefects{}) << what;
  EXPECT_NEAR(total_area(pattern) / box_area(sites.lattice), 1, 1e-13) << what;
  EXPECT_TRUE(pattern.all_convex);
  std::uint32_t not_convex = 0;
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell)
    not_convex += !is_strictly_convex(pattern, cell);
  EXPECT_EQ(not_convex, 0u) << what;
}

// Moves every site onto a lattice of `parts` places a cell side: many cocircular sites.
void coarsen(Sites& sites, std::int32_t parts) {
  const std::int32_t unit = sites.cell_width / parts;
  for (Site& p : sites.points) p = {p.x / unit * unit, p.y / unit * unit};
}

Lattice box(std::int64_t width, std::int64_t height) {
  Lattice lattice;
  lattice.width = width, lattice.height = height;
  return lattice;
}

Sites free_sites(const Lattice& lattice, std::vector<Site> points) {
  Sites sites;
  sites.lattice = lattice;
  sites.points = std::move(points);
  return sites;
}

TEST(Voronoi, OneSiteOwnsTheWall) {
  const Sites sites = free_sites(box(8, 4), {{3, 1}});
  const Pattern pattern = voronoi(sites);
  EXPECT_EQ(neighbours(pattern, 0), (std::vector<std::int32_t>{~3, ~0, ~1, ~2}));
  EXPECT_EQ(pattern.vertices.size(), 4u);
  EXPECT_EQ(total_area(pattern), 32);
}

TEST(Voronoi, TwoSitesShareTheWallAlongTheirBisector) {
  const Pattern pattern = voronoi(free_sites(box(8, 4), {{1, 2}, {5, 2}}));
  EXPECT_EQ(cell_area(pattern, 0), 12);
  EXPECT_EQ(cell_area(pattern, 1), 20);
  EXPECT_EQ(pattern.vertices.size(), 6u);
}

TEST(Voronoi, ABisectorThroughABoxCornerMakesOneVertexThere) {
  const Pattern pattern = voronoi(free_sites(box(4, 4), {{1, 3}, {3, 1}}));
  EXPECT_EQ(pattern.vertices.size(), 4u);
  EXPECT_EQ(pattern.corners.size(), 6u);
  EXPECT_EQ(check(pattern), PatternDefects{});
}

TEST(Voronoi, CellsOfARegularGridMeetInFours) {
  const Sites sites = jittered_sites(make_grid({}, {30, 20}, 1), 0, 1);
  VoronoiStats stats;
  const Pattern pattern = voronoi(sites, {}, &stats);
  EXPECT_EQ(pattern.vertices.size(), 31u * 21u);
  EXPECT_EQ(pattern.corners.size(), 4u * 600u);
  EXPECT_EQ(stats.merged_vertices, 29u * 19u);
  EXPECT_EQ(stats.exact, 0u);
  for (std::uint32_t cell = 0; cell < 600; ++cell) EXPECT_NEAR(cell_area(pattern, cell), 1, 1e-13);
}

TEST(Voronoi, SitesOnACircleMeetInOneVertex) {
  // Pythagorean points on the circle of radius 65.
  std::vector<Site> points;
  for (const auto& [x, y] : {std::pair{63, 16}, {60, 25}, {56, 33}, {52, 39}})
    for (const int sx : {-1, 1})
      for (const int sy : {-1, 1}) {
        points.push_back({100 + sx * x, 100 + sy * y});
        points.push_back({100 + sx * y, 100 + sy * x});
      }
  const Sites sites = free_sites(box(200, 200), points);
  VoronoiStats stats;
  const Pattern pattern = voronoi(sites, {}, &stats);
  EXPECT_EQ(stats.merged_vertices, 5u);  // the centre, and two cells at each box corner
  EXPECT_EQ(cells_unlike_the_definition(sites, pattern), 0u);
  expect_sound(sites, pattern, "circle");
}

// The smallest wall on which a search two cells wide fails: the outer cells must not overlap.
TEST(Voronoi, NeighboursThreeCellsAwayAreFound) {
  const std::int32_t unit = 1 << 20;
  Sites sites = free_sites(box(4 * unit, unit), {});
  for (const auto& [x, y] : {std::pair{9, 1}, {11, 9}, {29, 9}, {31, 1}})
    sites.points.push_back({x * unit / 10, y * unit / 10});
  sites.columns = 4, sites.rows = 1, sites.cell_width = sites.cell_height = unit;
  const Pattern pattern = voronoi(sites);
  EXPECT_EQ(std::ranges::count(neighbours(pattern, 0), 3), 1);
  EXPECT_EQ(cells_unlike_the_definition(sites, pattern), 0u);
  expect_sound(sites, pattern, "4 x 1");
}

// The same four sites in the middle of a large wall, where the fast kernels work.
TEST(Voronoi, NeighboursThreeCellsAwayAreFoundInside) {
  const GridShape grid = make_grid({}, {12, 12}, 1);
  for (const bool upright : {false, true}) {
    Sites sites = jittered_sites(grid, 0, 1);
    const auto place = [&](int i, int j, int x, int y) {
      if (upright) std::swap(i, j), std::swap(x, y);
      sites.points[static_cast<std::size_t>(j * 12 + i)] = {(i << 20) + (x << 20) / 100,
                                                            (j << 20) + (y << 20) / 100};
    };
    // Empty circle around (6, 5.5).
    place(4, 5, 99, 50), place(5, 5, 2, 99), place(6, 5, 98, 99), place(7, 5, 1, 50);
    place(5, 4, 1, 1), place(6, 4, 99, 1), place(5, 6, 1, 99), place(6, 6, 99, 99);
    const Pattern pattern = voronoi(sites);
    EXPECT_EQ(cells_unlike_the_definition(sites, pattern), 0u);
    expect_sound(sites, pattern, "inside");
  }
}

TEST(Voronoi, GriddedCellsAreTheDefinitionAtEveryJitter) {
  for (const double jitter : kJitters)
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      const Sites sites = jittered_sites(make_grid({}, {17, 13}, 1), jitter, seed);
      const std::string what = "jitter " + std::to_string(jitter) + " seed " + std::to_string(seed);
      const Pattern pattern = voronoi(sites);
      EXPECT_EQ(cells_unlike_the_definition(sites, pattern), 0u) << what;
      expect_sound(sites, pattern, what);
    }
}

TEST(Voronoi, NearlyCocircularSitesAreDecidedExactly) {
  for (const double jitter : {1e-6, 1e-5, 1e-4, 1e-3}) {
    const Sites sites = jittered_sites(make_grid({}, {15, 15}, 1), jitter, 3);
    const Pattern pattern = voronoi(sites);
    EXPECT_EQ(cells_unlike_the_definition(sites, pattern), 0u) << jitter;
    EXPECT_EQ(check(pattern), PatternDefects{}) << jitter;
  }
}

// An edge may be shorter than what separates two doubles: it goes, and the pattern stays sound.
TEST(Voronoi, EdgesWithoutLengthInCoordinatesAreDropped) {
  std::uint32_t dropped = 0;
  for (const double jitter : {3e-6, 5e-6})
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const Sites sites = jittered_sites(make_grid({}, {16, 16}, 1), jitter, seed);
      const Pattern pattern = voronoi(sites);
      EXPECT_EQ(check(pattern), PatternDefects{}) << jitter << " seed " << seed;
      EXPECT_NEAR(total_area(pattern) / 256, 1, 1e-13);
      dropped += cells_unlike_the_definition(sites, pattern);
    }
  EXPECT_GT(dropped, 0u);
}

TEST(Voronoi, SitesOnACoarseLatticeMeetInManyTies) {
  for (const std::int32_t parts : {2, 4, 16})
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      Sites sites = jittered_sites(make_grid({}, {14, 14}, 1), 1, seed);
      coarsen(sites, parts);
      VoronoiStats stats;
      const Pattern pattern = voronoi(sites, {}, &stats);
      const std::string what = "parts " + std::to_string(parts) + " seed " + std::to_string(seed);
      EXPECT_EQ(cells_unlike_the_definition(sites, pattern), 0u) << what;
      expect_sound(sites, pattern, what);
      EXPECT_GE(stats.merged_vertices, parts < 16 ? 1u : 0u) << what;
    }
}

TEST(Voronoi, SitesOnTheBoxSidesAreCellsLikeOthers) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Sites sites = jittered_sites(make_grid({}, {9, 9}, 1), 1, seed);
    for (std::int32_t i = 0; i < 9; ++i) {
      sites.points[static_cast<std::size_t>(i)].y = 0;
      sites.points[static_cast<std::size_t>(i * 9)].x = 0;
    }
    const Pattern pattern = voronoi(sites);
    EXPECT_EQ(cells_unlike_the_definition(sites, pattern), 0u) << "seed " << seed;
    expect_sound(sites, pattern, "seed " + std::to_string(seed));
  }
}

TEST(Voronoi, SmallAndThinWallsNeedNoWindow) {
  for (const Vec2 size :
       {Vec2{1, 1}, Vec2{2, 1}, Vec2{2, 2}, Vec2{3, 3}, Vec2{1, 40}, Vec2{60, 1.4}, Vec2{0.01, 30},
        Vec2{30, 2e-4}, Vec2{5, 5}, Vec2{6, 6}, Vec2{6, 5}})
    for (const double jitter : {0.0, 0.7, 1.0}) {
      const Sites sites = jittered_sites(make_grid({}, size, 1), jitter, 9);
      const std::string what = std::to_string(size.x) + " x " + std::to_string(size.y);
      const Pattern pattern = voronoi(sites);
      EXPECT_EQ(cells_unlike_the_definition(sites, pattern), 0u) << what;
      EXPECT_EQ(check(pattern), PatternDefects{}) << what;
    }
}

TEST(Voronoi, CellsTenTimesAsLongAsWideNeedNoWindow) {
  for (const auto& [width, height] :
       {std::pair{1000, 10000}, {10000, 1000}, {1000, 1500}, {1700, 1000}}) {
    Sites sites = free_sites(box(20 * width, 12 * height), {});
    sites.columns = 20, sites.rows = 12, sites.cell_width = width, sites.cell_height = height;
    for (std::uint64_t k = 0; k < 240; ++k)
      sites.points.push_back(
          {static_cast<std::int32_t>((static_cast<double>(k % 20) + random_unit(1, k, 0)) * width),
           static_cast<std::int32_t>((static_cast<double>(k / 20) + random_unit(1, k, 1)) *
                                     height)});
    const Pattern pattern = voronoi(sites);
    EXPECT_EQ(cells_unlike_the_definition(sites, pattern), 0u) << width << " x " << height;
    expect_sound(sites, pattern, "long cells");
  }
}

TEST(Voronoi, FreeSitesAreTheDefinition) {
  const Lattice lattice = make_lattice({}, {2, 1});
  for (std::uint64_t seed = 0; seed < 6; ++seed)
    for (const std::uint32_t count : {1u, 2u, 3u, 7u, 40u, 250u}) {
      const Sites sites = random_sites(lattice, count, seed);
      const std::string what = "count " + std::to_string(count) + " seed " + std::to_string(seed);
      const Pattern pattern = voronoi(sites);
      EXPECT_EQ(cells_unlike_the_definition(sites, pattern), 0u) << what;
      expect_sound(sites, pattern, what);
    }
}

TEST(Voronoi, CrowdedSitesOnAFewLatticePointsAreTheDefinition) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const Sites sites = random_sites(box(17, 11), 80, seed);
    const Pattern pattern = voronoi(sites);
    EXPECT_EQ(cells_unlike_the_definition(sites, pattern), 0u) << "seed " << seed;
    expect_sound(sites, pattern, "seed " + std::to_string(seed));
  }
}

TEST(Voronoi, ClusteredSitesAreTheDefinition) {
  const Lattice lattice = make_lattice({}, {10, 10});
  const Vec2 foci[] = {{2, 3}, {9.9, 9.9}};
  for (const double radius : {3.0, 0.01, 1e-5}) {
    const Sites sites =
        focused_sites(lattice, foci, {.count = 300, .radius = radius, .share = 0.95}, 5);
    const Pattern pattern = voronoi(sites);
    EXPECT_EQ(cells_unlike_the_definition(sites, pattern), 0u) << radius;
    EXPECT_EQ(check(pattern), PatternDefects{}) << radius;
  }
}

TEST(Voronoi, KernelsAndThreadsGiveTheSameBytes) {
  for (const double jitter : kJitters)
    for (const std::int32_t parts : {0, 4}) {
      Sites sites = jittered_sites(make_grid({}, {90, 91}, 1), jitter, 21);
      if (parts > 0) coarsen(sites, parts);
      const Pattern reference = voronoi(sites, {.kernel = VoronoiKernel::portable});
      for (const int threads : {1, 2, 3, 7})
        for (const VoronoiKernel kernel : {VoronoiKernel::portable, VoronoiKernel::automatic})
          EXPECT_TRUE(same_bytes(reference, voronoi(sites, {kernel, threads})))
              << "jitter " << jitter << " threads " << threads;
    }
  const Sites sites = random_sites(make_lattice({}, {3, 2}), 6000, 4);
  EXPECT_TRUE(same_bytes(voronoi(sites), voronoi(sites, {.threads = 5})));
}

TEST(Voronoi, CoincidingSitesAreRefused) {
  for (const bool gridded : {false, true}) {
    Sites sites = jittered_sites(make_grid({}, {8, 8}, 1), 1, 1);
    if (!gridded) sites.columns = sites.rows = 0;
    sites.points[27] = sites.points[28] = {4 << 20, 3 << 20 | 1 << 19};
    EXPECT_THROW(voronoi(sites), Error) << gridded;
  }
}

TEST(Voronoi, SaysWhichKernelRan) {
  const Sites sites = jittered_sites(make_grid({}, {20, 20}, 1), 1, 1);
  VoronoiStats stats;
  voronoi(sites, {.kernel = VoronoiKernel::portable}, &stats);
  EXPECT_FALSE(stats.vectorised);
  EXPECT_EQ(stats.proposed + stats.exact, 400u);
  voronoi(sites, {.kernel = VoronoiKernel::avx2}, &stats);
  EXPECT_EQ(stats.vectorised, has_avx2());
}

TEST(Voronoi, FewCellsNeedExactArithmetic) {
  const Sites sites = jittered_sites(make_grid({}, {150, 150}, 1), 1, 2);
  VoronoiStats stats;
  voronoi(sites, {}, &stats);
  EXPECT_LT(stats.exact, 50u);
}

TEST(Voronoi, WallsOfAnySizeAndPlaceAreSound) {
  for (const double size : {1e-3, 1e-1, 1.0, 37.7, 1e4})
    for (const Vec2 origin : {Vec2{0, 0}, Vec2{-1e3 * size, 12 * size}})
      for (const double jitter : kJitters) {
        const Sites sites =
            jittered_sites(make_grid(origin, {size, size / 2}, size / 20), jitter, 6);
        const Pattern pattern = voronoi(sites);
        EXPECT_EQ(check(pattern), PatternDefects{}) << size << " at " << origin.x;
        EXPECT_NEAR(total_area(pattern) / (size * size / 2), 1, 1e-11)
            << size << " at " << origin.x;
      }
  const Sites far = jittered_sites(make_grid({1e6, -1e6}, {3, 2}, 0.1), 1, 6);
  EXPECT_EQ(check(voronoi(far)), PatternDefects{});
}

TEST(Voronoi, TheTopologyDoesNotDependOnSizeOrPlace) {
  const Pattern near = voronoi(jittered_sites(make_grid({}, {16, 8}, 1), 1, 6));
  const Pattern far = voronoi(jittered_sites(make_grid({1e6, 3e5}, {16e-3, 8e-3}, 1e-3), 1, 6));
  EXPECT_EQ(near.across, far.across);
  EXPECT_EQ(near.corners, far.corners);
}

TEST(Voronoi, BorderVerticesLieOnTheBorderExactly) {
  const Sites sites = jittered_sites(make_grid({3.1, -7.7}, {6.3, 2.9}, 0.1), 1, 4);
  const Pattern pattern = voronoi(sites);
  const Vec2 low = sites.lattice.origin;
  const Vec2 high =
      sites.lattice.to_metres(LatticePoint{sites.lattice.width, sites.lattice.height});
  std::uint32_t on_border = 0;
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell) {
    const LoopRange loop{pattern.cell_begin[cell], pattern.cell_begin[cell + 1]};
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      if (!pattern.across[k].is_border()) continue;
      ++on_border;
      for (const std::uint32_t corner : {k, loop.next(k)}) {
        const Vec2 v = pattern.vertices[pattern.corners[corner]];
        switch (pattern.across[k].border()) {
          case 0: EXPECT_EQ(v.y, low.y); break;
          case 1: EXPECT_EQ(v.x, high.x); break;
          case 2: EXPECT_EQ(v.y, high.y); break;
          default: EXPECT_EQ(v.x, low.x);
        }
      }
    }
  }
  EXPECT_GT(on_border, 150u);
}

TEST(Voronoi, VerticesAreEquallyFarFromTheirSites) {
  const Sites sites = jittered_sites(make_grid({}, {40, 40}, 1), 1, 12);
  const Pattern pattern = voronoi(sites);
  double worst = 0;
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell) {
    const LoopRange loop{pattern.cell_begin[cell], pattern.cell_begin[cell + 1]};
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      if (pattern.across[k].is_border()) continue;
      const Site a = sites.points[cell], b = sites.points[pattern.across[k].cell()];
      const Vec2 p = sites.lattice.to_metres(LatticePoint{a.x, a.y});
      const Vec2 q = sites.lattice.to_metres(LatticePoint{b.x, b.y});
      const Vec2 v = pattern.vertices[pattern.corners[k]];
      worst = std::max(worst, std::abs(length(v - p) - length(v - q)));
    }
  }
  EXPECT_LT(worst, 40 * 4e-16);
}

TEST(Voronoi, AMirroredWallHasTheMirroredTopology) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Sites sites = jittered_sites(make_grid({}, {24, 20}, 1), 1, seed);
    for (Site& p : sites.points) p = {p.x | 1, p.y | 1};  // keeps mirrored sites in their cells
    Sites image = sites;
    for (std::size_t k = 0; k < sites.points.size(); ++k) {
      const std::size_t mirrored = k / 24 * 24 + 23 - k % 24;
      image.points[mirrored] = {static_cast<std::int32_t>(sites.lattice.width) - sites.points[k].x,
                                sites.points[k].y};
    }
    const Pattern pattern = voronoi(sites), other = voronoi(image);
    const auto mirrored = [](std::int32_t code) {
      if (code == ~1 || code == ~3) return code == ~1 ? ~3 : ~1;
      return code < 0 ? code : code / 24 * 24 + 23 - code % 24;
    };
    for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell) {
      std::vector<std::int32_t> expected = neighbours(pattern, cell);
      std::ranges::transform(expected, expected.begin(), mirrored);
      std::ranges::reverse(expected);
      const auto image_cell = static_cast<std::uint32_t>(mirrored(static_cast<std::int32_t>(cell)));
      EXPECT_EQ(turned(expected), turned(neighbours(other, image_cell))) << "seed " << seed;
    }
  }
}

TEST(Voronoi, ARotatedWallHasTheRotatedTopology) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Sites sites = jittered_sites(make_grid({}, {20, 20}, 1), 1, seed);
    Sites image = sites;  // a quarter turn to the left about the box's centre
    for (std::size_t k = 0; k < sites.points.size(); ++k) {
      const Site p = sites.points[k];
      image.points[k % 20 * 20 + 19 - k / 20] = {
          static_cast<std::int32_t>(sites.lattice.height) - 1 - p.y, p.x};
    }
    Sites shifted = sites;  // so that both see the box's sides at the same distance
    shifted.lattice.height -= 1;
    image.lattice.width -= 1;
    const auto rotated = [](std::int32_t code) {
      return code < 0 ? ~((~code + 1) & 3) : code % 20 * 20 + 19 - code / 20;
    };
    const auto as_free = [](Sites s) {
      s.columns = s.rows = 0;
      return s;
    };
    const Pattern pattern = voronoi(as_free(shifted)), other = voronoi(as_free(image));
    for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell) {
      std::vector<std::int32_t> expected = neighbours(pattern, cell);
      std::ranges::transform(expected, expected.begin(), rotated);
      const auto image_cell = static_cast<std::uint32_t>(rotated(static_cast<std::int32_t>(cell)));
      EXPECT_EQ(turned(expected), turned(neighbours(other, image_cell))) << "seed " << seed;
    }
  }
}

TEST(Voronoi, GriddedAndFreeSitesGiveTheSameTopology) {
  for (const double jitter : kJitters) {
    const Sites gridded = jittered_sites(make_grid({}, {50, 40}, 1), jitter, 33);
    Sites free = gridded;
    free.columns = free.rows = 0;
    EXPECT_TRUE(same_bytes(voronoi(gridded), voronoi(free))) << jitter;
  }
}

}  // namespace
}  // namespace sunder
