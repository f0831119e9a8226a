// SPDX-License-Identifier: GPL-3.0-or-later
// The topology against CGAL's Delaunay triangulation with exact predicates and constructions.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "fracture/voronoi.hpp"

namespace sunder {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Base = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using Triangulation =
    CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Base>>;
using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

// Whether the dual of an edge has a length inside the box.
bool has_length(const Triangulation& triangulation, Triangulation::Edge edge,
                const Kernel::Iso_rectangle_2& box) {
  const CGAL::Object dual = triangulation.dual(edge);
  const auto clipped_has_length = [&](const auto& line) {
    if (line.is_degenerate()) return false;
    const auto clipped = CGAL::intersection(box, line);
    return clipped && boost::get<Kernel::Segment_2>(&*clipped) != nullptr;
  };
  if (const auto* segment = CGAL::object_cast<Kernel::Segment_2>(&dual))
    return clipped_has_length(*segment);
  if (const auto* ray = CGAL::object_cast<Kernel::Ray_2>(&dual)) return clipped_has_length(*ray);
  if (const auto* line = CGAL::object_cast<Kernel::Line_2>(&dual)) return clipped_has_length(*line);
  return false;
}

Pairs exact_neighbours(const Sites& sites) {
  std::vector<std::pair<Kernel::Point_2, std::uint32_t>> points;
  for (std::uint32_t k = 0; k < sites.points.size(); ++k)
    points.push_back({Kernel::Point_2(sites.points[k].x, sites.points[k].y), k});
  const Triangulation triangulation(points.begin(), points.end());
  const Kernel::Iso_rectangle_2 box(0, 0, static_cast<double>(sites.lattice.width),
                                    static_cast<double>(sites.lattice.height));
  Pairs pairs;
  for (auto edge = triangulation.finite_edges_begin(); edge != triangulation.finite_edges_end();
       ++edge) {
    if (!has_length(triangulation, *edge, box)) continue;
    const std::uint32_t a = edge->first->vertex(triangulation.ccw(edge->second))->info();
    const std::uint32_t b = edge->first->vertex(triangulation.cw(edge->second))->info();
    pairs.insert({std::min(a, b), std::max(a, b)});
  }
  return pairs;
}

Pairs our_neighbours(const Pattern& pattern) {
  Pairs pairs;
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell)
    for (std::uint32_t k = pattern.cell_begin[cell]; k < pattern.cell_begin[cell + 1]; ++k)
      if (!pattern.across[k].is_border())
        pairs.insert(
            {std::min(cell, pattern.across[k].cell()), std::max(cell, pattern.across[k].cell())});
  return pairs;
}

void expect_same_neighbours(const Sites& sites, const std::string& what) {
  const Pairs expected = exact_neighbours(sites);
  EXPECT_GE(expected.size() + 1, sites.points.size()) << what;  // the cells hang together
  EXPECT_EQ(our_neighbours(voronoi(sites)), expected) << what;
}

TEST(VoronoiAgainstCgal, GriddedCellsHaveTheExactNeighbours) {
  for (const double jitter : {0.0, 0.3, 0.66, 0.9, 1.0})
    for (std::uint64_t seed = 0; seed < 3; ++seed)
      expect_same_neighbours(jittered_sites(make_grid({}, {60, 45}, 1), jitter, seed),
                             "jitter " + std::to_string(jitter) + " seed " + std::to_string(seed));
}

TEST(VoronoiAgainstCgal, SitesOnAQuarterCellLatticeHaveTheExactNeighbours) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Sites sites = jittered_sites(make_grid({}, {40, 40}, 1), 1, seed);
    const std::int32_t unit = sites.cell_width / 4;
    for (Site& p : sites.points) p = {p.x / unit * unit, p.y / unit * unit};
    expect_same_neighbours(sites, "seed " + std::to_string(seed));
  }
}

TEST(VoronoiAgainstCgal, RandomAndFocusedSitesHaveTheExactNeighbours) {
  const Lattice lattice = make_lattice({}, {3, 2});
  const Vec2 foci[] = {{1, 1}, {2.5, 0}};
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    expect_same_neighbours(random_sites(lattice, 2000, seed), "random " + std::to_string(seed));
    expect_same_neighbours(
        focused_sites(lattice, foci, {.count = 2000, .radius = 0.5, .share = 0.9}, seed),
        "focused " + std::to_string(seed));
  }
}

TEST(VoronoiAgainstCgal, CocircularSitesHaveTheExactNeighbours) {
  Lattice crowded;
  crowded.width = 25, crowded.height = 19;
  for (std::uint64_t seed = 0; seed < 5; ++seed)
    expect_same_neighbours(random_sites(crowded, 200, seed), "seed " + std::to_string(seed));
}

TEST(VoronoiAgainstCgal, ThinWallsAndLongCellsHaveTheExactNeighbours) {
  for (const Vec2 size : {Vec2{1, 80}, Vec2{80, 1.4}, Vec2{80, 0.3}, Vec2{2, 50}})
    expect_same_neighbours(jittered_sites(make_grid({}, size, 1), 1, 3), std::to_string(size.x));
  Sites sites;
  sites.lattice.width = 30 * 1000, sites.lattice.height = 12 * 10000;
  sites = random_sites(sites.lattice, 360, 8);
  std::ranges::sort(sites.points, {}, [](Site p) { return std::pair(p.y / 10000, p.x / 1000); });
  expect_same_neighbours(sites, "long cells");
}

}  // namespace
}  // namespace sunder
