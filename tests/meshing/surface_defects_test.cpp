// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/surface_defects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "meshing/random.hpp"
#include "meshing/sample_solids.hpp"
#include "meshing/surface_predicates.hpp"

namespace {

using namespace sunder;
using Kind = SurfaceDefect::Kind;
using Counts = std::array<std::uint64_t, kSurfaceDefectKinds>;

Counts only(std::initializer_list<std::pair<Kind, std::uint64_t>> list) {
  Counts counts{};
  for (const auto& [kind, count] : list) counts[static_cast<std::size_t>(kind)] = count;
  return counts;
}

Counts counts_of(const TriMesh& mesh) {
  return diagnose(mesh).counts;
}

TriMesh cube_and(const TriMesh& other) {
  TriMesh mesh = unit_cube();
  append(mesh, other);
  return mesh;
}

TEST(SurfaceDefects, SoundSolidsHaveNone) {
  for (const TriMesh& mesh :
       {unit_cube(), sphere_mesh(1, 7), torus_mesh(2, 0.5, 24, 12),
        cube_and(box_mesh({2, 0, 0}, {3, 1, 1})),                        // two apart
        cube_and(turned_over(box_mesh({.2, .2, .2}, {.8, .8, .8})))}) {  // a cavity
    EXPECT_TRUE(diagnose(mesh).is_solid()) << diagnose(mesh).text();
    EXPECT_EQ(diagnose(mesh).text(), "");
  }
}

TEST(SurfaceDefects, ABodyInACavityIsSound) {
  TriMesh mesh = cube_and(turned_over(box_mesh({.1, .1, .1}, {.9, .9, .9})));
  append(mesh, box_mesh({.3, .3, .3}, {.7, .7, .7}));
  EXPECT_TRUE(diagnose(mesh).is_solid());
  mesh.triangles.erase(mesh.triangles.begin() + 12, mesh.triangles.begin() + 24);
  EXPECT_EQ(counts_of(mesh), only({{Kind::inside_out, 1}}));  // without the cavity about it
}

TEST(SurfaceDefects, AMissingFaceLeavesOpenEdges) {
  TriMesh mesh = unit_cube();
  mesh.triangles.pop_back();
  const auto diagnosis = diagnose(mesh);
  EXPECT_EQ(diagnosis.counts, only({{Kind::open_edge, 3}}));
  ASSERT_EQ(diagnosis.defects.size(), 3u);
  EXPECT_EQ(diagnosis.defects[0].place, (Vec3{1, 0.5, 1}));
}

TEST(SurfaceDefects, AFaceTooManyIsANonManifoldEdge) {
  TriMesh mesh = unit_cube();
  mesh.vertices.push_back({0.5, -1, -1});
  mesh.triangles.push_back({0, 1, 8});
  EXPECT_EQ(counts_of(mesh), only({{Kind::nonmanifold_edge, 1}, {Kind::open_edge, 2}}));
}

TEST(SurfaceDefects, PartsThatMeetInAPointAreANonManifoldVertex) {
  TriMesh mesh = cube_and(box_mesh({1, 1, 1}, {2, 2, 2}));
  for (auto& t : mesh.triangles)
    for (auto& v : t)
      if (v == 8) v = 7;
  const auto diagnosis = diagnose(mesh);
  EXPECT_EQ(diagnosis.counts, only({{Kind::nonmanifold_vertex, 1}}));
  EXPECT_EQ(diagnosis.defects[0].place, (Vec3{1, 1, 1}));
  EXPECT_LT(diagnosis.defects[0].a, 12u);
  EXPECT_GE(diagnosis.defects[0].b, 12u);
}

TEST(SurfaceDefects, PartsThatTouchWithoutSharingTheCornerMeet) {
  EXPECT_GT(counts_of(cube_and(box_mesh({1, 1, 1}, {2, 2, 2})))[4], 0u);
  // A common face, in opposite order: coplanar overlaps.
  EXPECT_GT(counts_of(cube_and(box_mesh({1, 0, 0}, {2, 1, 1})))[4], 0u);
  // An edge on a face.
  EXPECT_GT(counts_of(cube_and(box_mesh({.25, .25, 1}, {.75, .75, 2})))[4], 0u);
  // One step of rounding apart: sound.
  EXPECT_EQ(counts_of(cube_and(box_mesh({std::nextafter(1.0, 2.0), 0, 0}, {2, 1, 1}))), Counts{});
}

TEST(SurfaceDefects, TurnedFacesAreFlipped) {
  TriMesh mesh = sphere_mesh(1, 4);
  for (const std::size_t t : {3u, 4u, 77u}) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  const auto diagnosis = diagnose(mesh);
  EXPECT_EQ(diagnosis.counts, only({{Kind::flipped_face, 3}}));
  EXPECT_EQ(diagnosis.defects[2].a, 77u);
}

TEST(SurfaceDefects, AMoebiusBandHasAnEdgeThatNoTurningMakesRight) {
  TriMesh mesh;
  const int n = 8;
  for (int i = 0; i < n; ++i) {
    const double u = 2 * std::numbers::pi * i / n, w = u / 2;
    for (const double side : {-0.3, 0.3})
      mesh.vertices.push_back({(1 + side * std::cos(w)) * std::cos(u),
                               (1 + side * std::cos(w)) * std::sin(u), side * std::sin(w)});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1, last = i + 1 == n;
    const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({c, d, b});
  }
  EXPECT_EQ(counts_of(mesh), only({{Kind::open_edge, 2 * n}, {Kind::flipped_face, 1}}));
}

TEST(SurfaceDefects, CrossingBodiesMeet) {
  const auto diagnosis = diagnose(cube_and(box_mesh({.5, .5, .5}, {1.5, 1.5, 1.5})), 1000);
  const auto& c = diagnosis.counts;
  EXPECT_GT(c[4], 0u);
  EXPECT_EQ(c[4], std::accumulate(c.begin(), c.end(), std::uint64_t{0}));  // nothing else
  for (const SurfaceDefect& d : diagnosis.defects) {
    EXPECT_LT(d.a, 12u);
    EXPECT_GE(d.b, 12u);
  }
}

TEST(SurfaceDefects, NeighboursThatFoldOverEachOtherMeet) {
  // A flat kite folded along its middle: both halves on the same side.
  TriMesh mesh{{{0, 0, 0}, {1, 0, 0}, {.5, 1, 0}, {.5, .5, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  EXPECT_EQ(counts_of(mesh)[4], 1u);
  mesh.vertices[3].y = -0.5;
  EXPECT_EQ(counts_of(mesh)[4], 0u);
}

TEST(SurfaceDefects, DuplicatesAndFlatFacesAreTold) {
  TriMesh mesh = unit_cube();
  mesh.triangles.push_back(mesh.triangles[5]);
  mesh.triangles.push_back({mesh.triangles[5][1], mesh.triangles[5][0], mesh.triangles[5][2]});
  auto diagnosis = diagnose(mesh);
  EXPECT_EQ(diagnosis.counts, only({{Kind::duplicate_face, 2}}));
  EXPECT_EQ(diagnosis.defects[1].a, 13u);
  EXPECT_EQ(diagnosis.defects[1].b, 5u);

  mesh = unit_cube();
  mesh.triangles.push_back({0, 0, 1});
  EXPECT_EQ(counts_of(mesh), only({{Kind::degenerate_face, 1}}));
  // An edge cut on one side only and closed by a face without area: both halves touch the whole.
  mesh = unit_cube();
  mesh.vertices.push_back({0, 0.5, 0.5});
  const auto t = mesh.triangles[8];  // 0 4 6, with 0 6 2 beside it
  mesh.triangles[8] = {t[0], t[1], 8};
  mesh.triangles.push_back({t[1], t[2], 8});
  mesh.triangles.push_back({t[0], 8, t[2]});
  EXPECT_EQ(counts_of(mesh), only({{Kind::degenerate_face, 1}, {Kind::self_intersection, 2}}));
}

TEST(SurfaceDefects, ShellsThatFaceTheWrongWayAreInsideOut) {
  EXPECT_EQ(counts_of(turned_over(unit_cube())), only({{Kind::inside_out, 1}}));
  const TriMesh inner = box_mesh({.2, .2, .2}, {.8, .8, .8});
  const auto diagnosis = diagnose(cube_and(inner));
  EXPECT_EQ(diagnosis.counts, only({{Kind::inside_out, 1}}));
  EXPECT_EQ(diagnosis.defects[0].a, 12u);
  TriMesh both = turned_over(cube_and(inner));
  EXPECT_EQ(counts_of(both), only({{Kind::inside_out, 1}}));  // the outer one alone
}

TEST(SurfaceDefects, BadNumbersAreToldOnce) {
  TriMesh mesh = cube_and(box_mesh({2, 0, 0}, {3, 1, 1}));
  mesh.vertices.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  mesh.triangles.push_back({0, 1, 16});
  mesh.triangles.push_back({0, 1, 17});
  EXPECT_EQ(counts_of(mesh), only({{Kind::bad_number, 2}}));
}

TEST(SurfaceDefects, TextTellsKindsPlacesAndNumbers) {
  TriMesh mesh = unit_cube();
  mesh.triangles.pop_back();
  mesh.triangles.push_back(mesh.triangles[0]);
  EXPECT_EQ(diagnose(mesh).text(),
            "3 open edges, first near (1, 0.5, 1) m at triangle 2; 1 duplicate face, near "
            "(0.333333, 0.666667, 0) m at triangle 11");
  EXPECT_EQ(diagnose(mesh, 1).defects.size(), 2u);
  EXPECT_EQ(diagnose(mesh, 1).counts, diagnose(mesh).counts);
}

// A broken surface: a sphere with faces missing, doubled and turned, and a box through it.
TriMesh broken(std::uint64_t seed) {
  TriMesh mesh = sphere_mesh(1, 5);
  append(mesh, box_mesh({-.2, -.3, .1}, {.4, .2, 2}));
  std::vector<std::array<std::uint32_t, 3>> kept;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double draw = random_unit(seed, t);
    if (draw < 0.03) continue;
    kept.push_back(mesh.triangles[t]);
    if (draw < 0.06) kept.push_back(mesh.triangles[t]);
    if (draw > 0.97) std::swap(kept.back()[0], kept.back()[2]);
  }
  mesh.triangles = kept;
  return mesh;
}

TEST(SurfaceDefects, CountsStayWhenTheSurfaceIsTurnedMirroredScaledOrRenumbered) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TriMesh mesh = broken(seed);
    const Counts counts = counts_of(mesh);
    TriMesh other = mesh;
    for (Vec3& p : other.vertices) p = {p.y, p.z, p.x};  // a third of a turn: exact
    EXPECT_EQ(counts_of(other), counts) << "seed " << seed;
    for (Vec3& p : other.vertices) p = {-4 * p.x, 4 * p.y, 4 * p.z};
    EXPECT_EQ(counts_of(turned_over(other)), counts) << "seed " << seed;

    other = mesh;
    std::vector<std::uint32_t> order(mesh.vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return random_bits(seed, a, 1) < random_bits(seed, b, 1);
    });
    for (std::uint32_t v = 0; v < order.size(); ++v) other.vertices[order[v]] = mesh.vertices[v];
    for (auto& t : other.triangles) t = {order[t[1]], order[t[2]], order[t[0]]};
    std::reverse(other.triangles.begin(), other.triangles.end());
    EXPECT_EQ(counts_of(other), counts) << "seed " << seed;
  }
}

TEST(SurfaceDefects, CrossingsAreThoseOfAllPairs) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    TriMesh mesh;  // triangles at random on a coarse lattice: much touches, overlaps and is shared
    for (std::uint64_t v = 0; v < 40; ++v)
      mesh.vertices.push_back({double(random_bits(seed, v, 0) % 7),
                               double(random_bits(seed, v, 1) % 7),
                               double(random_bits(seed, v, 2) % 3)});
    for (std::uint64_t t = 0; t < 60; ++t) {
      const auto v = [&](std::uint64_t k) {
        return static_cast<std::uint32_t>(random_bits(seed, t, 10 + k) % 40);
      };
      mesh.triangles.push_back({v(0), v(1), v(2)});
    }
    const auto diagnosis = diagnose(mesh, 1u << 20);
    std::vector<bool> skip(60);
    for (const SurfaceDefect& d : diagnosis.defects)
      if (d.kind == Kind::degenerate_face || d.kind == Kind::duplicate_face) skip[d.a] = true;
    std::uint64_t expected = 0;
    for (std::uint32_t a = 0; a < 60; ++a)
      for (std::uint32_t b = a + 1; b < 60; ++b)
        expected +=
            !skip[a] && !skip[b] && meet_apart(mesh.vertices, mesh.triangles[a], mesh.triangles[b]);
    EXPECT_EQ(diagnosis.counts[4], expected) << "seed " << seed;
  }
}

TEST(SurfaceDefects, RaysThroughEdgesAndCornersPassOnce) {
  const TriMesh cube = unit_cube();
  const auto passes = [&](Vec3 p) {
    int sum = 0;
    for (const auto& t : cube.triangles)
      sum += crossing(p, cube.vertices[t[0]], cube.vertices[t[1]], cube.vertices[t[2]]);
    return sum;
  };
  EXPECT_EQ(passes({0.5, 0.5, 0.5}), 1);
  EXPECT_EQ(passes({0.5, 0.3, 0.3}), 1);  // through the diagonal of a face
  EXPECT_EQ(passes({-1, 0.5, 0.5}), 0);
  EXPECT_EQ(passes({-1, 1, 1}), 0);  // along the border
  EXPECT_EQ(passes({-1, 0, 0}), 0);
  EXPECT_EQ(passes({2, 0.5, 0.5}), 0);
}

}  // namespace
