// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/self_crossing.hpp"

#include <gtest/gtest.h>

#include "meshing/random.hpp"
#include "meshing/surface_predicates.hpp"

namespace sunder {
namespace {

using Triangle = std::array<Vec3, 3>;

TEST(SelfCrossing, DepthIsTheShortestWayOut) {
  const Triangle flat{Vec3{-1, -1, 0}, Vec3{1, -1, 0}, Vec3{0, 2, 0}};
  for (const double z : {-0.3, -0.01, 0.0, 0.01}) {
    const Triangle dipping{Vec3{0, 0, z}, Vec3{0.1, 0, 1}, Vec3{-0.1, 0, 1}};
    EXPECT_NEAR(crossing_depth(flat, dipping), -z, 1e-15) << z;
    EXPECT_NEAR(crossing_depth(dipping, flat), -z, 1e-15) << z;
  }
}

TEST(SelfCrossing, NeighboursAndTrianglesInOnePlaneHaveNone) {
  const Triangle a{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  EXPECT_LE(crossing_depth(a, {Vec3{1, 0, 0}, Vec3{0, 0, 0}, Vec3{0.2, 0.3, 1}}), 0);
  EXPECT_LE(crossing_depth(a, {Vec3{0, 0, 0}, Vec3{-1, 0, 1}, Vec3{0, -1, 1}}), 0);
  EXPECT_LE(crossing_depth(a, {Vec3{0.1, 0.1, 0}, Vec3{2, 0, 0}, Vec3{0, 2, 0}}), 0);
}

// With the exact predicate for an oracle: no depth, no common point, but for rounding.
TEST(SelfCrossing, DepthIsAboveZeroExactlyWhereTrianglesMeet) {
  int met = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    std::vector<Vec3> points;
    for (std::uint64_t k = 0; k < 6; ++k)
      points.push_back(
          {random_unit(5, i, 3 * k), random_unit(5, i, 3 * k + 1), random_unit(5, i, 3 * k + 2)});
    const bool meets = meet_apart(points, {0, 1, 2}, {3, 4, 5});
    const double depth =
        crossing_depth({points[0], points[1], points[2]}, {points[3], points[4], points[5]});
    met += meets;
    EXPECT_EQ(meets, depth > 0) << "draw " << i << ", depth " << depth;
  }
  EXPECT_GT(met, 100);
}

TEST(SelfCrossing, ASpikeThroughTheOtherSideIsFoundDownToItsDepth) {
  TriMesh mesh;  // a tetrahedron with its top pushed below its base by 0.1
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, -0.1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  EXPECT_FALSE(crosses_itself(mesh, 0));  // inside out, but not crossed
  mesh.vertices.insert(mesh.vertices.end(), {{0.2, 0.2, 0.5}, {0.3, 0.2, 0.5}, {0.2, 0.2, -0.1}});
  mesh.triangles.push_back({4, 5, 6});
  EXPECT_TRUE(crosses_itself(mesh, 0.001));
  EXPECT_FALSE(crosses_itself(mesh, 0.2));
}

}  // namespace
}  // namespace sunder
