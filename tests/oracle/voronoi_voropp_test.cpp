// SPDX-License-Identifier: GPL-3.0-or-later
// Areas against voro++, an independent program for Voronoi cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <voro++/voro++.hh>

#include "fracture/voronoi.hpp"

namespace sunder {
namespace {

std::vector<double> voropp_areas(const Sites& sites) {
  const Lattice& lattice = sites.lattice;
  const double width = lattice.step.x * static_cast<double>(lattice.width);
  const double height = lattice.step.y * static_cast<double>(lattice.height);
  const double blocks = std::sqrt(static_cast<double>(sites.points.size()) / (4 * width * height));
  voro::container container(
      0, width, 0, height, -0.5, 0.5, std::max(1, static_cast<int>(width * blocks)),
      std::max(1, static_cast<int>(height * blocks)), 1, false, false, false, 8);
  for (std::size_t k = 0; k < sites.points.size(); ++k)
    container.put(static_cast<int>(k), lattice.step.x * sites.points[k].x,
                  lattice.step.y * sites.points[k].y, 0);
  std::vector<double> areas(sites.points.size(), 0);
  voro::c_loop_all loop(container);
  voro::voronoicell cell;
  if (loop.start()) do {
      if (container.compute_cell(cell, loop))
        areas[static_cast<std::size_t>(loop.pid())] = cell.volume();
    } while (loop.inc());
  return areas;
}

void expect_same_areas(const Sites& sites, const std::string& what) {
  const Pattern pattern = voronoi(sites);
  const std::vector<double> expected = voropp_areas(sites);
  const double mean = total_area(pattern) / static_cast<double>(pattern.cell_count());
  double worst = 0;
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell)
    worst = std::max(worst, std::abs(cell_area(pattern, cell) - expected[cell]) / mean);
  EXPECT_LT(worst, 1e-9) << what;  // voro++'s own tolerance is about 1e-11 of the box
}

TEST(VoronoiAgainstVoropp, GriddedCellsHaveTheSameAreas) {
  for (const double jitter : {0.3, 0.66, 0.9, 1.0})
    for (std::uint64_t seed = 0; seed < 3; ++seed)
      expect_same_areas(jittered_sites(make_grid({}, {45, 40}, 1), jitter, seed),
                        "jitter " + std::to_string(jitter) + " seed " + std::to_string(seed));
}

TEST(VoronoiAgainstVoropp, RandomCellsHaveTheSameAreas) {
  for (std::uint64_t seed = 0; seed < 3; ++seed)
    expect_same_areas(random_sites(make_lattice({}, {40, 30}), 1500, seed),
                      "seed " + std::to_string(seed));
}

}  // namespace
}  // namespace sunder
