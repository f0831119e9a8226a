// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/region.hpp"

#include <gtest/gtest.h>

#include "meshing/error.hpp"

namespace sunder {
namespace {

const Lattice kLattice = make_lattice({0, 0}, {6, 3});

TEST(Region, EdgesRunWithTheRegionOnTheirLeftWhateverTheWinding) {
  Loop clockwise = rectangle({6, 3});
  std::reverse(clockwise.begin(), clockwise.end());
  const LatticeRegion region =
      make_lattice_region({clockwise, {rectangle({1, 1}, {1, 1})}}, kLattice, "w");
  for (std::uint32_t l = 0; l < region.loop_count(); ++l) {
    const std::span<const Vec2> loop(region.places.data() + region.loop_begin[l],
                                     region.loop_begin[l + 1] - region.loop_begin[l]);
    EXPECT_GT(area(loop) * (l == 0 ? 1 : -1), 0);
  }
}

TEST(Region, ARectangleIsABoxAndAnythingElseIsNot) {
  EXPECT_TRUE(make_lattice_region({rectangle({6, 3}), {}}, kLattice, "w").is_box());
  EXPECT_FALSE(make_lattice_region({{{0, 0}, {6, 0}, {5, 3}, {0, 3}}, {}}, kLattice, "w").is_box());
  EXPECT_FALSE(make_lattice_region({rectangle({6, 3}), {rectangle({1, 1}, {1, 1})}}, kLattice, "w")
                   .is_box());
}

TEST(Region, PointsAreLocatedExactly) {
  const LatticeRegion region =
      make_lattice_region({rectangle({6, 3}), {rectangle({1.5, 1.5}, {1.5, 0})}}, kLattice, "w");
  const auto at = [&](Vec2 p) { return locate(region, kLattice.nearest(p)); };
  EXPECT_EQ(at({0.5, 0.5}), 1);
  EXPECT_EQ(at({2, 0.5}), -1);
  EXPECT_EQ(at({1.5, 0.5}), 0);
  EXPECT_EQ(at({0, 2}), 0);
  const LatticePoint beside = kLattice.nearest({1.5, 0.5}) - LatticePoint{1, 0};
  EXPECT_EQ(locate(region, beside), 1);
}

TEST(Region, TheAreaOfAPolygonIsItsClosedForm) {
  EXPECT_DOUBLE_EQ(area(Region{rectangle({6, 3}), {rectangle({1, 2}, {1, 0})}}), 16);
  EXPECT_DOUBLE_EQ(area(Loop{{0, 0}, {4, 0}, {0, 3}}), 6);
}

TEST(Region, EveryFaultIsNamedWithItsPlace) {
  const auto message = [](const Region& region) -> std::string {
    try {
      make_lattice_region(region, kLattice, "wall north");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::geometry);
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({{{0, 0}, {6, 3}}, {}}),
            "wall north: the outline has 2 corners, a polygon needs at least 3");
  EXPECT_NE(message({{{0, 0}, {6, 0}, {6, 3}, {6, 3}, {0, 3}}, {}}).find("corners 2 and 3"),
            std::string::npos);
  EXPECT_NE(message({{{0, 0}, {3, 0}, {6, 0}}, {}}).find("meets itself"), std::string::npos);
  EXPECT_NE(message({rectangle({6, 3}), {{{1, 1}, {2, 1}, {2, 2}, {1.5, 1}, {1, 2}}}})
                .find("opening 0 meets itself"),
            std::string::npos);
}

}  // namespace
}  // namespace sunder
