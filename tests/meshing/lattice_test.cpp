// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/lattice.hpp"

#include <gtest/gtest.h>

#include "meshing/error.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

LatticePoint random_point(std::uint64_t seed, std::uint64_t draw, std::int64_t limit) {
  const auto bits = [&](std::uint64_t d) {
    return static_cast<std::int64_t>(random_bits(seed, d) % static_cast<std::uint64_t>(2 * limit)) -
           limit;
  };
  return {bits(2 * draw), bits(2 * draw + 1)};
}

TEST(Lattice, BisectorSeparatesByDistance) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const LatticePoint d = random_point(seed, 0, kMaxExtent / 2);
    const LatticePoint p = random_point(seed, 1, kMaxExtent / 2);
    const auto squared = [](LatticePoint q) {
      return static_cast<Int128>(q.x) * q.x + static_cast<Int128>(q.y) * q.y;
    };
    const Int128 nearer = squared(p) - squared(p - d);  // > 0: nearer to d than to the base
    EXPECT_EQ(side_of(bisector(d), p), (nearer > 0) - (nearer < 0)) << "seed " << seed;
  }
}

TEST(Lattice, ALineHasItsLeftSideInside) {
  const LatticeLine line = line_through({0, 0}, {10, 0});
  EXPECT_EQ(side_of(line, LatticePoint{3, 1}), -1);
  EXPECT_EQ(side_of(line, LatticePoint{3, 0}), 0);
  EXPECT_EQ(side_of(line, LatticePoint{3, -1}), 1);
}

TEST(Lattice, CrossingsLieOnBothLinesAtTheLargestExtent) {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const LatticeLine p = bisector(random_point(seed, 0, kMaxExtent));
    const LatticeLine q =
        line_through(random_point(seed, 1, kMaxExtent / 2), random_point(seed, 2, kMaxExtent / 2));
    if (static_cast<Int128>(p.a) * q.b == static_cast<Int128>(q.a) * p.b) continue;
    const LatticeCrossing crossing = intersection(p, q);
    EXPECT_GT(crossing.w, 0);
    EXPECT_EQ(side_of(p, crossing), 0) << "seed " << seed;
    EXPECT_EQ(side_of(q, crossing), 0) << "seed " << seed;
  }
}

TEST(Lattice, PointsReturnFromMetres) {
  const Lattice lattice = make_lattice({1e5, -3}, {6.1, 3});
  EXPECT_EQ(lattice.width, kMaxExtent);
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    LatticePoint p = random_point(seed, 0, lattice.height / 2);
    p = {std::abs(p.x), std::abs(p.y)};
    const LatticePoint back = lattice.nearest(lattice.to_metres(p));
    EXPECT_LE(std::abs(back.x - p.x), 3) << "at 1e5 m a double resolves three lattice steps";
    EXPECT_EQ(back.y, p.y);
  }
}

TEST(Lattice, AnEmptyBoxIsRefused) {
  EXPECT_THROW(make_lattice({0, 0}, {0, 1}), Error);
  EXPECT_THROW(make_lattice({0, 0}, {1, -1}), Error);
  EXPECT_THROW(make_lattice({0, 0}, {1, std::numeric_limits<double>::infinity()}), Error);
}

}  // namespace
}  // namespace sunder
