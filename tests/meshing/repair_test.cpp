// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/repair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "meshing/sample_solids.hpp"
#include "meshing/triangle_tree.hpp"

namespace {

using namespace sunder;

Repair repaired(const TriMesh& mesh, const RepairParams& params = {}) {
  const Repair r = repair(flat_surface(mesh), params);
  EXPECT_TRUE(r.after.is_solid()) << r.after.text();
  EXPECT_TRUE(diagnose(r.surface).is_solid());
  EXPECT_EQ(r.surface.corners.size(), 3 * r.surface.mesh.triangles.size());
  EXPECT_EQ(r.surface.material.size(), r.surface.mesh.triangles.size());
  return r;
}

TEST(Repair, ASoundSolidStaysAsItIs) {
  TriMesh mesh = sphere_mesh(1, 8);
  append(mesh, turned_over(sphere_mesh(0.5, 4)));
  const Repair r = repaired(mesh);
  EXPECT_TRUE(r.steps.empty());
  EXPECT_EQ(r.surface.mesh.vertices, mesh.vertices);
  EXPECT_EQ(r.surface.mesh.triangles, mesh.triangles);
  EXPECT_LT(r.hausdorff, 1e-15);
  EXPECT_EQ(r.voxel, 0);
  EXPECT_NEAR(r.volume_before, r.volume_after, 1e-14);
}

TEST(Repair, FlippedFacesAreTurnedWithTheirNormals) {
  TriMesh mesh = sphere_mesh(1, 6);
  for (const std::size_t t : {5u, 6u, 100u}) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  const Repair r = repaired(mesh);
  EXPECT_EQ(r.steps, std::vector<std::string>{"3 flipped faces turned over"});
  EXPECT_EQ(r.surface.mesh.triangles, sphere_mesh(1, 6).triangles);
  const Vec3 n = face_normal(r.surface.mesh, 6);
  EXPECT_EQ(r.surface.corners[18].normal[0], static_cast<float>(n.x));
}

TEST(Repair, InsideOutShellsAreTurned) {
  TriMesh mesh = turned_over(unit_cube());
  append(mesh, box_mesh({.2, .2, .2}, {.8, .8, .8}));
  const Repair r = repaired(mesh);
  EXPECT_NEAR(r.volume_after, 1 - 0.216, 1e-14);
  EXPECT_NEAR(r.volume_before, -1 + 0.216, 1e-14);
  ASSERT_FALSE(r.steps.empty());
  EXPECT_EQ(r.steps[0].substr(0, 31), "2 inside-out shells turned over") << r.steps[0];
}

TEST(Repair, DuplicatesFlatFacesAndBadNumbersGo) {
  TriMesh mesh = unit_cube();
  mesh.triangles.push_back(mesh.triangles[2]);
  mesh.triangles.push_back({0, 0, 1});
  mesh.vertices.push_back({std::numeric_limits<double>::infinity(), 0, 0});
  mesh.triangles.push_back({0, 1, 8});
  const Repair r = repaired(mesh);
  EXPECT_EQ(r.steps, (std::vector<std::string>{"1 face with bad numbers dropped",
                                               "1 face with two equal corners dropped",
                                               "1 duplicate face dropped"}));
  EXPECT_EQ(r.surface.mesh.vertices, unit_cube().vertices);
  EXPECT_EQ(r.surface.mesh.triangles, unit_cube().triangles);
}

TEST(Repair, AFaceWithoutAreaIsTakenOutAndItsNeighbourCut) {
  TriMesh mesh = unit_cube();
  mesh.vertices.push_back({0, 0.5, 0.5});
  const auto t = mesh.triangles[8];  // 0 4 6, with 0 6 2 beside it
  mesh.triangles[8] = {t[0], t[1], 8};
  mesh.triangles.push_back({t[1], t[2], 8});
  mesh.triangles.push_back({t[0], 8, t[2]});
  const Repair r = repaired(mesh);
  EXPECT_EQ(r.steps,
            std::vector<std::string>{"1 face without area taken out, neighbours cut to fit"});
  EXPECT_EQ(r.surface.mesh.triangles.size(), 14u);
  EXPECT_NEAR(r.volume_after, 1, 1e-15);
  EXPECT_LT(r.hausdorff, 1e-15);
}

// Every face with corners of its own, equal or moved by rounding to float about a far place.
TriMesh torn(const TriMesh& mesh, double noise) {
  TriMesh soup;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) {
      const std::uint64_t at = soup.vertices.size();
      const auto jitter = [&](std::uint64_t k) { return noise * (2 * random_unit(9, at, k) - 1); };
      soup.vertices.push_back(mesh.vertices[v] + Vec3{jitter(0), jitter(1), jitter(2)});
      if (at % 3 == 2)
        soup.triangles.push_back({static_cast<std::uint32_t>(at - 2),
                                  static_cast<std::uint32_t>(at - 1),
                                  static_cast<std::uint32_t>(at)});
    }
  return soup;
}

TEST(Repair, FacesWithCornersOfTheirOwnAreJoined) {
  const TriMesh sphere = sphere_mesh(1, 10);
  const Repair equal = repaired(torn(sphere, 0));
  EXPECT_EQ(equal.surface.mesh.vertices.size(), sphere.vertices.size());
  EXPECT_EQ(equal.steps, std::vector<std::string>{"1998 vertices joined with an equal one"});
  EXPECT_LT(equal.hausdorff, 1e-15);

  const Repair cracks = repaired(torn(sphere, 1e-7));
  EXPECT_EQ(cracks.surface.mesh.vertices.size(), sphere.vertices.size());
  EXPECT_EQ(cracks.voxel, 0);
  EXPECT_LT(cracks.hausdorff, 4e-7);
  ASSERT_EQ(cracks.steps.size(), 1u);
  EXPECT_NE(cracks.steps[0].find("vertices of open edges moved by up to"), std::string::npos);
  EXPECT_NE(cracks.steps[0].find("(nothing further apart than 3.46e-06 m is joined)"),
            std::string::npos)
      << cracks.steps[0];
}

TEST(Repair, SmallHolesAreFilledAndTheRestStays) {
  TriMesh mesh = sphere_mesh(1, 10);
  mesh.triangles.erase(mesh.triangles.begin() + 400, mesh.triangles.begin() + 420);
  mesh.triangles.erase(mesh.triangles.begin() + 11);
  const Repair r = repaired(mesh);
  EXPECT_EQ(r.voxel, 0);
  ASSERT_EQ(r.steps.size(), 1u);
  EXPECT_NE(r.steps[0].find("holes of"), std::string::npos) << r.steps[0];
  EXPECT_TRUE(
      std::equal(mesh.triangles.begin(), mesh.triangles.end(), r.surface.mesh.triangles.begin()));
  EXPECT_NEAR(r.volume_after, mass_properties(sphere_mesh(1, 10)).volume, 0.02);
}

TEST(Repair, AHoleInACubeIsFilledFlat) {
  TriMesh mesh = unit_cube();
  mesh.triangles.resize(10);  // the side x = 1 is open
  const Repair r = repaired(mesh);
  EXPECT_NEAR(r.volume_after, 1, 1e-15);
  EXPECT_EQ(r.steps, std::vector<std::string>{"1 hole of 4 edges filled"});
  EXPECT_EQ(r.surface.corners[30].normal, (std::array<float, 3>{1, 0, 0}));
}

TEST(Repair, PartsThatMeetInAPointAreDrawnApart) {
  TriMesh mesh = unit_cube();
  append(mesh, box_mesh({1, 1, 1}, {2, 2, 2}));
  for (auto& t : mesh.triangles)
    for (auto& v : t)
      if (v == 8) v = 7;
  const Repair r = repaired(mesh);
  EXPECT_EQ(r.voxel, 0);
  EXPECT_NEAR(r.volume_after, 2, 1e-4);
  EXPECT_LT(r.hausdorff, 1e-4);
  EXPECT_NE(r.steps.at(0).find("1 vertex where parts met in a point"), std::string::npos);
}

// Two faces apart from the rest: the hole about them is filled with the same two, turned round.
TEST(Repair, ShellsThatEncloseNothingAreDropped) {
  TriMesh mesh = unit_cube();
  append(mesh, box_mesh({2, 0, 0}, {3, 1, 1}));
  mesh.triangles.resize(14);
  const Repair r = repaired(mesh);
  EXPECT_NEAR(r.volume_after, 1, 1e-15);
  EXPECT_EQ(r.surface.mesh.triangles.size(), 12u);
  EXPECT_EQ(r.steps, (std::vector<std::string>{"1 hole of 4 edges filled",
                                               "1 shell enclosing nothing dropped"}));
}

TEST(Repair, CrossingBodiesBecomeOneWithinTheError) {
  TriMesh mesh = unit_cube();
  append(mesh, box_mesh({.51, .52, .53}, {1.5, 1.5, 1.5}));
  const double error = 0.03;
  const Repair r = repaired(mesh, {.max_error = error});
  EXPECT_GT(r.voxel, 0);
  EXPECT_NEAR(r.volume_after, 1 + .99 * .98 * .97 - .49 * .48 * .47, 0.01);
  EXPECT_LT(farthest(r.surface.mesh, TriangleTree(mesh), error / 4), error);
  EXPECT_THROW(repair(flat_surface(mesh), {.level_set = false}), Error);
}

TEST(Repair, WhatALevelSetMakesOfASoundSurfaceIsWithinTheError) {
  // A box beside a crossing pair: all of it is made anew, its corners and edges are sharp.
  for (const double error : {0.08, 0.04}) {
    TriMesh mesh = sphere_mesh(0.5, 12);
    append(mesh, sphere_mesh(0.5, 12, {1e-3, 0, 0}));
    TriMesh box = box_mesh({1.01, .03, -.37}, {2.03, .98, .57});
    for (Vec3& p : box.vertices) p = {p.x, 0.8 * p.y - 0.6 * p.z, 0.6 * p.y + 0.8 * p.z};
    append(mesh, box);
    const Repair r = repaired(mesh, {.max_error = error});
    EXPECT_LE(r.hausdorff, error);
    EXPECT_GT(r.voxel, 0);
  }
}

TEST(Repair, WhatASurfaceCarriesIsCarriedOver) {
  TriMesh mesh = unit_cube();
  append(mesh, box_mesh({.5, .5, .5}, {1.5, 1.5, 1.5}));
  ModelSurface surface = flat_surface(mesh);
  surface.materials.resize(2);
  surface.has_colours = surface.has_uvs = true;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    surface.material[t] = t < 12 ? 0 : 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.vertices[mesh.triangles[t][k]];
      Corner& c = surface.corners[3 * t + k];
      c.uv = {static_cast<float>(p.x + p.z), static_cast<float>(p.y - p.z)};
      c.colour = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), 1};
    }
  }
  const double error = 0.05;
  const Repair r = repair(surface, {.max_error = error});
  std::array<int, 2> count{};
  for (std::size_t t = 0; t < r.surface.mesh.triangles.size(); ++t) {
    const auto place = [&](std::size_t k) {
      return r.surface.mesh.vertices[r.surface.mesh.triangles[t][k]];
    };
    ++count[r.surface.material[t]];
    const Vec3 middle = (1.0 / 3) * (place(0) + place(1) + place(2));
    if (middle.x < 0.4) {
      EXPECT_EQ(r.surface.material[t], 0u);
    }
    if (middle.x > 1.1) {
      EXPECT_EQ(r.surface.material[t], 1u);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = place(k);
      const Corner& c = r.surface.corners[3 * t + k];
      EXPECT_NEAR(c.uv[0], p.x + p.z, 2 * error);
      EXPECT_NEAR(c.colour[1], p.y, error);
    }
  }
  EXPECT_GT(count[0], 1000);
  EXPECT_GT(count[1], 1000);
}

// Whatever is done to a sphere and a box, a solid comes of it.
TEST(Repair, RandomDamageIsRepaired) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    TriMesh mesh = sphere_mesh(1, 6);
    if (seed % 2 == 0) append(mesh, box_mesh({-.2, -.3, .1}, {.4, .2, 2}));
    std::vector<std::array<std::uint32_t, 3>> kept;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const double draw = random_unit(seed, t);
      if (draw < 0.02) continue;
      kept.push_back(mesh.triangles[t]);
      if (draw < 0.04) kept.push_back(mesh.triangles[t]);
      if (draw > 0.98) std::swap(kept.back()[0], kept.back()[2]);
    }
    mesh.triangles = kept;
    if (seed % 3 == 0) mesh = torn(mesh, 1e-7);
    const Repair r = repaired(mesh, {.max_error = 0.08});
    EXPECT_NEAR(r.volume_after, seed % 2 == 0 ? 4.45 : 4.1, 0.35) << "seed " << seed;
    const Repair again = repair(flat_surface(mesh), {.max_error = 0.08});
    EXPECT_EQ(r.surface.mesh.vertices, again.surface.mesh.vertices);
    EXPECT_EQ(r.surface.mesh.triangles, again.surface.mesh.triangles);
  }
}

TEST(Repair, WhatEnclosesNothingIsRefused) {
  const auto message = [](const TriMesh& mesh, const RepairParams& params = {}) -> std::string {
    try {
      repair(flat_surface(mesh), params);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::geometry);
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message({}).find("no face is left"), std::string::npos);
  EXPECT_NE(message({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {.max_error = 0.05})
                .find("cannot be made"),
            std::string::npos);
  TriMesh crossing = unit_cube();
  append(crossing, box_mesh({.5, .5, .5}, {2, 2, 2}));
  EXPECT_NE(message(crossing, {.max_error = 1e-4}).find("voxels of"), std::string::npos);
}

}  // namespace
