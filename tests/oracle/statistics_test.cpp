// SPDX-License-Identifier: GPL-3.0-or-later
// Cell statistics against known values: Poisson-Voronoi moments from Brakke, "Statistics of random
// plane Voronoi tessellations"; the jittered grid from 10^6 to 6.75·10^6 cells computed elsewhere.
#include <gtest/gtest.h>

#include <cmath>

#include "fracture/voronoi.hpp"

namespace sunder {
namespace {

struct Statistics {
  double count = 0, mean_area = 0, area_variance = 0, mean_sides = 0, side_variance = 0,
         mean_perimeter = 0;
};

// Over cells whose site is `margin` away from the wall's border, in units of the mean cell.
Statistics measure(const Sites& sites, double margin) {
  const Pattern pattern = voronoi(sites);
  const Vec2 size =
      sites.lattice.to_metres(LatticePoint{sites.lattice.width, sites.lattice.height});
  const double unit = std::sqrt(size.x * size.y / pattern.cell_count());
  double count = 0, area = 0, area2 = 0, sides = 0, sides2 = 0, perimeter = 0;
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell) {
    const Vec2 site =
        sites.lattice.to_metres(LatticePoint{sites.points[cell].x, sites.points[cell].y});
    if (std::min({site.x, site.y, size.x - site.x, size.y - site.y}) < margin * unit) continue;
    const LoopRange loop{pattern.cell_begin[cell], pattern.cell_begin[cell + 1]};
    const double a = cell_area(pattern, cell) / (unit * unit), n = loop.size();
    for (std::uint32_t k = loop.begin; k < loop.end; ++k)
      perimeter += length(pattern.vertices[pattern.corners[k]] -
                          pattern.vertices[pattern.corners[loop.next(k)]]) /
                   unit;
    count += 1, area += a, area2 += a * a, sides += n, sides2 += n * n;
  }
  Statistics s{count, area / count, 0, sides / count, 0, perimeter / count};
  s.area_variance = area2 / count - s.mean_area * s.mean_area;
  s.side_variance = sides2 / count - s.mean_sides * s.mean_sides;
  return s;
}

// 86 400 cells: the variance of a variance is about 2 / count; limits are five standard errors and
// the 0.3 % that the values themselves are known to.
double limit(double value) {
  return value * (5 * std::sqrt(2.5 / 86400) + 0.003);
}

TEST(Statistics, JitteredGridHasTheKnownMoments) {
  struct Row {
    double jitter, area_variance, side_variance, perimeter;
  };
  for (const Row row : {Row{0.25, 0.00452, 0.835, 3.928}, Row{0.5, 0.01629, 0.825, 3.901},
                        Row{0.75, 0.03466, 0.836, 3.924}, Row{0.9, 0.0494, 0.952, 3.958},
                        Row{1, 0.0609, 1.087, 3.983}}) {
    const Statistics s = measure(jittered_sites(make_grid({}, {300, 300}, 1), row.jitter, 77), 3);
    EXPECT_NEAR(s.area_variance, row.area_variance, limit(row.area_variance)) << row.jitter;
    EXPECT_NEAR(s.side_variance, row.side_variance, limit(row.side_variance)) << row.jitter;
    EXPECT_NEAR(s.mean_perimeter, row.perimeter, 0.003) << row.jitter;
    EXPECT_NEAR(s.mean_sides, 6, 0.003) << row.jitter;
    EXPECT_NEAR(s.mean_area, 1, 0.001) << row.jitter;
  }
}

TEST(Statistics, RandomSitesHaveThePoissonVoronoiMoments) {
  const Statistics s = measure(random_sites(make_lattice({}, {300, 300}), 90000, 5), 3);
  EXPECT_NEAR(s.area_variance, 0.280176, 2 * limit(0.280176));  // heavier tail than normal
  EXPECT_NEAR(s.side_variance, 1.7808, limit(1.7808));
  EXPECT_NEAR(s.mean_sides, 6, 0.01);
  EXPECT_NEAR(s.mean_perimeter, 4, 0.01);
}

}  // namespace
}  // namespace sunder
