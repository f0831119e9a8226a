// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <numbers>

#include "meshing/error.hpp"
#include "meshing/repair.hpp"
#include "meshing/sample_solids.hpp"
#include "meshing/triangle_tree.hpp"

namespace {

using namespace sunder;
using std::numbers::pi;

double volume(const ModelSurface& surface) {
  return mass_properties(surface.mesh).volume;
}

TEST(Carve, ABallTakesASphericalCapOutOfABox) {
  const ModelSurface box = flat_surface(box_mesh({0, 0, 0}, {2, 2, 1}));
  const double r = 0.4, below = 0.15;  // the ball's centre is above the face by r - h
  const double h = r - below, cap = pi * h * h * (3 * r - h) / 3;
  double last = 0;
  for (const double error : {0.05, 0.025}) {
    const ModelSurface made =
        carve(box, {.centre = {1, 1, 1 + below}, .radius = r, .max_error = error});
    EXPECT_TRUE(diagnose(made).is_solid()) << diagnose(made).text();
    // Edges are chamfered by less than a voxel: their length times its square, and the cap's rim.
    const double edges = 4 * (2 + 2 + 1) + 2 * pi * r;
    EXPECT_NEAR(volume(made), 4 - cap, edges * error * error / 2);
    last = std::abs(volume(made) - (4 - cap));
  }
  EXPECT_LT(last, 0.008);
}

TEST(Carve, TheCratersFaceIsOnTheBall) {
  const ModelSurface box = flat_surface(box_mesh({0, 0, 0}, {2, 2, 1}));
  const Vec3 centre{1, 1, 1.1};
  const double error = 0.02;
  const ModelSurface made = carve(box, {.centre = centre, .radius = 0.4, .max_error = error});
  const TriangleTree tree(made.mesh);
  double most = 0;  // along rays from the ball's centre downwards
  for (int i = 0; i < 200; ++i) {
    const double u = 0.9 * pi / 180 * i * 7, tilt = 0.6 + 0.3 * (i % 10) / 10;
    const Vec3 on{centre.x + 0.4 * std::sqrt(1 - tilt * tilt) * std::cos(u),
                  centre.y + 0.4 * std::sqrt(1 - tilt * tilt) * std::sin(u), centre.z - 0.4 * tilt};
    most = std::max(most, tree.nearest(on).distance);
  }
  EXPECT_LT(most, error / 4);
}

TEST(Carve, AShallowCraterIsAsWideAndDeepAsAsked) {
  const ModelSurface box = flat_surface(box_mesh({0, 0, 0}, {2, 2, 1}));
  const double r = 0.5, d = 0.2, cap = pi * d * (3 * r * r + d * d) / 6;
  const ModelSurface made = carve(
      box, {.centre = {1, 1, 1}, .radius = r, .depth = d, .into = {0, 0, -1}, .max_error = 0.025});
  EXPECT_TRUE(diagnose(made).is_solid());
  EXPECT_NEAR(volume(made), 4 - cap, 0.006);
  const TriangleTree tree(made.mesh);
  EXPECT_LT(tree.nearest({1, 1, 0.8}).distance, 0.005);
}

TEST(Carve, RoughnessStaysWithinItsSizeAndFollowsTheSeed) {
  const ModelSurface box = flat_surface(box_mesh({0, 0, 0}, {1, 1, 1}));
  CarveParams params{.centre = {.5, .5, 1}, .radius = 0.3, .max_error = 0.035};
  const ModelSurface smooth = carve(box, params);
  params.roughness = 0.05;
  const ModelSurface rough = carve(box, params);
  EXPECT_TRUE(diagnose(rough).is_solid()) << diagnose(rough).text();
  const double distance = farthest(rough.mesh, TriangleTree(smooth.mesh), 0.01);
  EXPECT_GT(distance, 0.01);
  EXPECT_LT(distance, 0.05 + 0.035);
  EXPECT_EQ(rough.mesh.vertices, carve(box, params).mesh.vertices);
  params.seed = 2;
  EXPECT_NE(rough.mesh.vertices, carve(box, params).mesh.vertices);
}

TEST(Carve, BadInputIsRefused) {
  ModelSurface box = flat_surface(unit_cube());
  const CarveParams good{.centre = {.5, .5, 1}, .radius = 0.2};
  EXPECT_THROW(carve(box, {.centre = {.5, .5, 1}, .radius = 0}), Error);
  EXPECT_THROW(carve(box, {.centre = {.5, .5, 1}, .radius = 0.2, .into = {0, 0, -2}}), Error);
  EXPECT_THROW(carve(box, {.centre = {.5, .5, .5}, .radius = 2}), Error);  // nothing is left
  box.mesh.triangles.pop_back();
  EXPECT_THROW(carve(box, good), Error);
}

}  // namespace
