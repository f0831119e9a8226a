// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/sites.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "meshing/error.hpp"

namespace sunder {
namespace {

std::string message_of(const auto& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

bool all_distinct(const Sites& sites) {
  return std::set<Site>(sites.points.begin(), sites.points.end()).size() == sites.points.size();
}

bool all_in_box(const Sites& sites) {
  return std::ranges::all_of(sites.points, [&](Site p) {
    return p.x >= 0 && p.y >= 0 && p.x <= sites.lattice.width && p.y <= sites.lattice.height;
  });
}

TEST(Grid, TilesTheWallWithNearlySquareCells) {
  for (const double scale : {1e-3, 1.0, 7.3, 1e4})
    for (const Vec2 shape : {Vec2{6, 3}, Vec2{1, 1}, Vec2{0.31, 17}, Vec2{100, 0.02}}) {
      const Vec2 size = scale * shape;
      const GridShape grid = make_grid({1e6, -3}, size, 0.3 * scale);
      EXPECT_EQ(grid.columns, std::max(1.0, std::round(size.x / (0.3 * scale))));
      EXPECT_EQ(grid.rows, std::max(1.0, std::round(size.y / (0.3 * scale))));
      EXPECT_EQ(grid.lattice.width, std::int64_t{grid.columns} * grid.cell_width);
      EXPECT_EQ(grid.lattice.height, std::int64_t{grid.rows} * grid.cell_height);
      EXPECT_LE(std::max(grid.lattice.width, grid.lattice.height), kMaxExtent);
      EXPECT_EQ(std::max(grid.cell_width, grid.cell_height) &
                    (std::max(grid.cell_width, grid.cell_height) - 1),
                0);
      EXPECT_NEAR(grid.lattice.step.x * static_cast<double>(grid.lattice.width) / size.x, 1, 1e-15);
      EXPECT_NEAR(grid.lattice.step.y * static_cast<double>(grid.lattice.height) / size.y, 1,
                  1e-15);
    }
}

TEST(Grid, UsesTheFinestLatticeThatFits) {
  EXPECT_EQ(make_grid({}, {10, 10}, 0.1).cell_width, 1 << 20);
  EXPECT_EQ(make_grid({}, {1, 1}, 1.0 / 1024).cell_width, 1 << 20);
  EXPECT_EQ(make_grid({}, {1, 1}, 1.0 / 1025).cell_width, 1 << 19);
  EXPECT_EQ(make_grid({}, {1, 1}, 1.0 / 4096).columns, 4096);
}

TEST(Grid, SaysTheSmallestCellThatFits) {
  const std::string message = message_of([] { make_grid({}, {1, 1}, 1e-5); });
  EXPECT_NE(message.find("1e-05"), std::string::npos) << message;
  const std::string words = "the smallest cell that fits is ";
  const auto place = message.find(words);
  ASSERT_NE(place, std::string::npos) << message;
  const double fits = std::stod(message.substr(place + words.size()));
  EXPECT_NEAR(fits, 1.0 / 4096, 1e-6);
  EXPECT_THROW(make_grid({}, {1, 1}, 0), Error);
  EXPECT_THROW(make_grid({}, {1, 1}, NAN), Error);
  EXPECT_THROW(make_grid({}, {1, 1}, 1e-300), Error);
  EXPECT_THROW(make_grid({}, {0, 1}, 1), Error);
  EXPECT_THROW(make_grid({}, {INFINITY, 1}, 1), Error);
}

TEST(JitteredSites, StayInTheirCellAndItsJitteredPart) {
  const GridShape grid = make_grid({}, {3, 2}, 0.1);
  for (const double jitter : {0.0, 0.3, 0.66, 1.0}) {
    const Sites sites = jittered_sites(grid, jitter, 5);
    ASSERT_EQ(sites.points.size(), 600u);
    double widest = 0;
    for (std::size_t k = 0; k < sites.points.size(); ++k) {
      const double x = (sites.points[k].x + 0.5) / grid.cell_width - static_cast<double>(k % 30);
      const double y = (sites.points[k].y + 0.5) / grid.cell_height - static_cast<double>(k / 30);
      widest = std::max({widest, std::abs(x - 0.5), std::abs(y - 0.5)});
      EXPECT_EQ(sites.points[k].x / grid.cell_width, static_cast<int>(k % 30));
      EXPECT_EQ(sites.points[k].y / grid.cell_height, static_cast<int>(k / 30));
    }
    EXPECT_LE(widest, jitter / 2 + 2e-6);
    EXPECT_GE(widest, jitter / 2 * 0.99);
  }
  EXPECT_THROW(jittered_sites(grid, 1.01, 5), Error);
  EXPECT_THROW(jittered_sites(grid, NAN, 5), Error);
}

TEST(JitteredSites, AreUniformInTheirCell) {
  const GridShape grid = make_grid({}, {200, 200}, 1);
  const Sites sites = jittered_sites(grid, 1, 17);
  double sum_x = 0, sum_xx = 0, sum_xy = 0;
  for (std::size_t k = 0; k < sites.points.size(); ++k) {
    const double x = static_cast<double>(sites.points[k].x) / grid.cell_width -
                     static_cast<double>(k % 200) - 0.5;
    const double y = static_cast<double>(sites.points[k].y) / grid.cell_height -
                     static_cast<double>(k / 200) - 0.5;
    sum_x += x, sum_xx += x * x, sum_xy += x * y;
  }
  const double count = 40000;
  EXPECT_NEAR(sum_x / count, 0, 5 * std::sqrt(1 / 12.0 / count));
  EXPECT_NEAR(sum_xx / count, 1 / 12.0, 5 * std::sqrt(1 / 180.0 / count));
  EXPECT_NEAR(sum_xy / count, 0, 5 / 12.0 / std::sqrt(count));
}

TEST(JitteredSites, DependOnSeedAndIndexOnly) {
  const Sites small = jittered_sites(make_grid({}, {1, 1}, 0.1), 1, 3);
  const Sites tall = jittered_sites(make_grid({}, {1, 2}, 0.1), 1, 3);
  EXPECT_TRUE(std::equal(small.points.begin(), small.points.end(), tall.points.begin()));
  EXPECT_NE(small.points, jittered_sites(make_grid({}, {1, 1}, 0.1), 1, 4).points);
}

TEST(RandomSites, AreDistinctEvenWhenTheLatticeIsCrowded) {
  Lattice lattice;
  lattice.width = 9, lattice.height = 9;
  const Sites sites = random_sites(lattice, 50, 1);
  EXPECT_EQ(sites.points.size(), 50u);
  EXPECT_TRUE(all_distinct(sites));
  EXPECT_TRUE(all_in_box(sites));
  EXPECT_THROW(random_sites(lattice, 51, 1), Error);
  EXPECT_THROW(random_sites(lattice, 0, 1), Error);
}

TEST(RandomSites, FillTheBoxEvenly) {
  const Sites sites = random_sites(make_lattice({-5, 2}, {4, 1}), 40000, 11);
  std::vector<int> count(16, 0);
  for (const Site p : sites.points)
    ++count[static_cast<std::size_t>(std::min<std::int64_t>(p.x * 4LL / sites.lattice.width, 3) *
                                         4 +
                                     std::min<std::int64_t>(p.y * 4LL / sites.lattice.height, 3))];
  for (const int c : count) EXPECT_NEAR(c, 2500, 5 * std::sqrt(2500));
}

TEST(GivenSites, DropAndCountRepeatsAndKeepTheOrder) {
  const Lattice lattice = make_lattice({10, 20}, {2, 1});
  const std::vector<Vec2> metres{{11, 20.5}, {10, 20}, {11, 20.5}, {12, 21}, {10, 20 + 1e-12}};
  const Sites sites = given_sites(lattice, metres);
  EXPECT_EQ(sites.duplicates_dropped, 2u);
  ASSERT_EQ(sites.points.size(), 3u);
  EXPECT_EQ(sites.points[0], (Site{1 << 29, 1 << 28}));
  EXPECT_EQ(sites.points[1], (Site{0, 0}));
  EXPECT_EQ(sites.points[2], (Site{1 << 30, 1 << 29}));
}

TEST(GivenSites, OutsideTheBoxAreRefusedByNumberAndPlace) {
  const Lattice lattice = make_lattice({}, {2, 1});
  const std::string message = message_of([&] {
    given_sites(lattice, std::vector<Vec2>{{1, 0.5}, {2.5, 0.5}});
  });
  EXPECT_NE(message.find("site 1 at (2.5, 0.5)"), std::string::npos) << message;
  EXPECT_THROW(given_sites(lattice, std::vector<Vec2>{{NAN, 0}}), Error);
  EXPECT_THROW(given_sites(lattice, {}), Error);
}

TEST(FocusedSites, LieDenserAroundTheFocus) {
  const Lattice lattice = make_lattice({}, {10, 10});
  const Vec2 focus{5, 5};
  const Sites sites =
      focused_sites(lattice, {&focus, 1}, {.count = 20000, .radius = 2, .share = 0.7}, 8);
  EXPECT_TRUE(all_distinct(sites));
  EXPECT_TRUE(all_in_box(sites));
  int near = 0, half = 0;
  for (const Site p : sites.points) {
    const double distance = length(lattice.to_metres(LatticePoint{p.x, p.y}) - focus);
    near += distance < 2, half += distance < 1;
  }
  // share + (1 - share) * area ratio; uniform in the distance within.
  EXPECT_NEAR(near, 20000 * (0.7 + 0.3 * 0.125664), 5 * std::sqrt(20000 * 0.2));
  EXPECT_NEAR(half, 20000 * (0.35 + 0.3 * 0.031416), 5 * std::sqrt(20000 * 0.23));
}

TEST(FocusedSites, EndEvenWhenTheFocusIsFarOutside) {
  const Lattice lattice = make_lattice({}, {1, 1});
  const Vec2 focus{50, 50};
  const Sites sites =
      focused_sites(lattice, {&focus, 1}, {.count = 20, .radius = 1, .share = 1}, 8);
  EXPECT_EQ(sites.points.size(), 20u);
  EXPECT_THROW(focused_sites(lattice, {}, {}, 1), Error);
  EXPECT_THROW(focused_sites(lattice, {&focus, 1}, {.share = 2}, 1), Error);
  EXPECT_THROW(focused_sites(lattice, {&focus, 1}, {.radius = 0}, 1), Error);
}

}  // namespace
}  // namespace sunder
