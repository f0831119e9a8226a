// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/hulls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "fracture/convex_hull.hpp"
#include "meshing/random.hpp"
#include "meshing/tri_mesh.hpp"
#include "meshing/triangle_tree.hpp"
#include "solid_shapes.hpp"

namespace sunder {
namespace {

using test::as_surface;

TriMesh hull_mesh(const HullSet& set, std::uint32_t hull) {
  TriMesh mesh;
  for (std::size_t v = set.vertex_begin[hull]; v < set.vertex_begin[hull + 1]; ++v)
    mesh.vertices.push_back(
        {set.positions[3 * v], set.positions[3 * v + 1], set.positions[3 * v + 2]});
  for (std::size_t i = set.index_begin[hull]; i < set.index_begin[hull + 1]; i += 3)
    mesh.triangles.push_back({set.indices[i], set.indices[i + 1], set.indices[i + 2]});
  return mesh;
}

// The float32 are whole numbers of 2^-24 of the largest's power of two, so their determinants are
// whole numbers below 2^80.
bool is_convex(const TriMesh& mesh, double reach) {
  int exponent = 0;
  std::frexp(reach, &exponent);
  const double scale = std::ldexp(1.0, 24 - exponent);
  const auto whole = [&](Vec3 p) {
    const std::array<double, 3> scaled{scale * p.x, scale * p.y, scale * p.z};
    for (const double x : scaled) EXPECT_EQ(x, std::floor(x));
    return std::array<Int128, 3>{Int128(scaled[0]), Int128(scaled[1]), Int128(scaled[2])};
  };
  for (const auto& t : mesh.triangles) {
    const auto a = whole(mesh.vertices[t[0]]);
    const auto from_a = [&](std::uint32_t v) {
      auto p = whole(mesh.vertices[v]);
      for (std::size_t k = 0; k < 3; ++k) p[k] -= a[k];
      return p;
    };
    const auto u = from_a(t[1]), v = from_a(t[2]);
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
      const auto p = from_a(i);
      if (p[0] * (u[1] * v[2] - u[2] * v[1]) + p[1] * (u[2] * v[0] - u[0] * v[2]) +
              p[2] * (u[0] * v[1] - u[1] * v[0]) >
          0)
        return false;
    }
  }
  return true;
}

double reach_of(const SolidAsset& asset) {
  double reach = 0;
  for (const Vec3 p : asset.partition.vertices)
    reach = std::max({reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return reach;
}

TriMesh chunk_of(const SolidAsset& asset, std::uint32_t chunk) {
  TriMesh mesh;
  mesh.vertices = asset.partition.vertices;
  for (auto t = asset.partition.chunk_begin[chunk]; t < asset.partition.chunk_begin[chunk + 1]; ++t)
    mesh.triangles.push_back(asset.partition.triangles[t].corners);
  return mesh;
}

void expect_sound(const HullSet& set, double reach, const HullParams& params) {
  ASSERT_EQ(set.errors.size() + 1, set.hull_begin.size());
  for (std::uint32_t h = 0; h < set.hull_count(); ++h) {
    const TriMesh mesh = hull_mesh(set, h);
    EXPECT_EQ(check(mesh), MeshDefects{}) << "hull " << h;
    EXPECT_TRUE(is_convex(mesh, reach)) << "hull " << h;
    EXPECT_LE(mesh.vertices.size(), static_cast<std::size_t>(params.max_vertices));
  }
  for (std::size_t c = 0; c < set.errors.size(); ++c)
    EXPECT_LE(set.hull_begin[c + 1] - set.hull_begin[c],
              static_cast<std::uint32_t>(params.max_hulls));
}

// Every corner of a chunk is in one of its hulls, no point of a hull is farther out than is said.
void expect_errors_hold(const SolidAsset& asset, const HullSet& set) {
  for (std::uint32_t c = 0; c < set.errors.size(); ++c) {
    const TriMesh chunk = chunk_of(asset, c);
    const TriangleTree tree(chunk);
    const double size = diagonal(box_of(chunk)), error = set.errors[c].distance + 1e-6;
    std::vector<TriMesh> hulls;
    double volume = 0;
    for (std::uint32_t h = set.hull_begin[c]; h < set.hull_begin[c + 1]; ++h) {
      hulls.push_back(hull_mesh(set, h));
      volume += mass_properties(hulls.back()).volume;
      std::uint64_t draw = 0;
      const auto uniform = [&] { return random_unit(7, h, draw++); };
      for (const auto& t : hulls.back().triangles)
        for (int k = 0; k < 9; ++k) {
          const double u = uniform(), v = uniform() * (1 - u);
          const auto& p = hulls.back().vertices;
          const Vec3 at = u * p[t[0]] + v * p[t[1]] + (1 - u - v) * p[t[2]];
          const double distance = tree.nearest(at).distance;
          if (distance > error * size) {
            EXPECT_GT(tree.winding_number(at), 0.5) << "chunk " << c;
          }
        }
    }
    EXPECT_NEAR(volume / asset.chunks[c].volume - 1, set.errors[c].volume, 1e-4) << "chunk " << c;
    std::vector<std::unique_ptr<TriangleTree>> trees;
    for (const TriMesh& hull : hulls) trees.push_back(std::make_unique<TriangleTree>(hull));
    for (const auto& t : chunk.triangles) {
      double least = size;
      for (const auto& hull_tree : trees) {
        const Vec3 p = chunk.vertices[t[0]];
        least = std::min(least,
                         hull_tree->winding_number(p) > 0.5 ? 0 : hull_tree->nearest(p).distance);
      }
      EXPECT_LE(least, error * size) << "chunk " << c;
    }
  }
}

SolidAsset broken(TriMesh mesh, std::int64_t count) {
  SolidVoronoiParams pattern;
  pattern.count = count;
  SolidModel model;
  model.pattern = pattern;
  return fracture_solid(model, as_surface(std::move(mesh)), 2400, {});
}

std::vector<HullPoint> random_points(std::uint64_t seed, std::size_t count, double reach) {
  std::vector<HullPoint> points;
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto x = [&](std::uint64_t k) {
      return static_cast<std::int32_t>(reach * (2 * random_unit(seed, i, k) - 1));
    };
    points.push_back({x(0), x(1), x(2)});
  }
  return points;
}

// Every point is on or below every facet; facets close; a vertex of its own for every corner.
void expect_hull_of(const ConvexHull& hull, const std::vector<HullPoint>& points) {
  ASSERT_FALSE(hull.triangles.empty());
  EXPECT_TRUE(hull.missed.empty());
  TriMesh mesh;
  for (const HullPoint p : hull.vertices)
    mesh.vertices.push_back({double(p.x), double(p.y), double(p.z)});
  mesh.triangles = hull.triangles;
  EXPECT_EQ(check(mesh), MeshDefects{});
  EXPECT_NEAR(hull.volume() / mass_properties(mesh).volume, 1, 1e-12);
  for (const auto& t : hull.triangles) {
    const HullPlane plane =
        plane_through(hull.vertices[t[0]], hull.vertices[t[1]], hull.vertices[t[2]]);
    for (const HullPoint p : points) EXPECT_LE(plane.side(p), 0);
  }
}

TEST(ConvexHull, HasEveryPointOnOrBelowItsFacetsExactly) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    // From a few places of a tiny lattice, where most points are in planes of others, to its reach.
    const double reach = seed % 3 == 0 ? 3 : seed % 3 == 1 ? 40 : kHullReach;
    const std::vector<HullPoint> points = random_points(seed, 5 + 3 * seed, reach);
    const ConvexHull hull = convex_hull(points, points.size());
    if (hull.triangles.empty()) continue;
    SCOPED_TRACE("seed " + std::to_string(seed));
    expect_hull_of(hull, points);
  }
}

TEST(ConvexHull, OfABoxWithPointsAllOverItsFacesIsTheBox) {
  std::vector<HullPoint> points;
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; j <= 8; ++j)
      for (int k = 0; k <= 8; ++k) points.push_back({3 * i, 5 * j, 7 * k});
  const ConvexHull hull = convex_hull(points, 8);
  expect_hull_of(hull, points);
  EXPECT_EQ(hull.vertices.size(), 8u);
  EXPECT_EQ(hull.volume(), 24.0 * 40 * 56);
}

TEST(ConvexHull, OfPointsInAPlaneIsEmpty) {
  std::vector<HullPoint> points;
  for (int i = 0; i < 9; ++i) points.push_back({i, i * i, 2 * i + 3 * i * i});
  EXPECT_TRUE(convex_hull(points, 64).triangles.empty());
  EXPECT_TRUE(convex_hull(std::vector<HullPoint>(7, HullPoint{1, 2, 3}), 64).triangles.empty());
  EXPECT_TRUE(convex_hull({}, 64).triangles.empty());
}

TEST(ConvexHull, IsTheSameForPointsInAnyOrder) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::vector<HullPoint> points = random_points(seed, 300, seed % 2 ? 6 : 1000);
    ConvexHull one = convex_hull(points, 20);
    std::ranges::reverse(points);
    ConvexHull other = convex_hull(points, 20);
    std::ranges::sort(one.vertices);
    std::ranges::sort(other.vertices);
    EXPECT_EQ(one.vertices, other.vertices) << "seed " << seed;
  }
}

TEST(ConvexHull, WithFewVerticesKeepsTheFarthestAndNamesWhatItMisses) {
  const std::vector<HullPoint> points = random_points(1, 2000, 1e6);
  double before = 0;
  for (const std::size_t most : {4u, 8u, 16u, 32u}) {
    const ConvexHull hull = convex_hull(points, most);
    EXPECT_EQ(hull.vertices.size(), most);
    EXPECT_FALSE(hull.missed.empty());
    EXPECT_GT(hull.volume(), before);
    before = hull.volume();
  }
  EXPECT_GT(before, 0.75 * 8e18);
}

TEST(Hulls, OfConvexCellsAreOneEachAndTheCells) {
  const SolidAsset asset = broken(test::box({5, 0, 0}, {1, 2, 1}), 60);
  const HullSet set = solid_hulls(asset, {});
  expect_sound(set, reach_of(asset), {});
  EXPECT_EQ(set.hull_count(), 60u);
  double volume = 0;
  for (std::uint32_t h = 0; h < set.hull_count(); ++h)
    volume += mass_properties(hull_mesh(set, h)).volume;
  EXPECT_NEAR(volume, 2, 1e-5);
  for (const HullSet::Error& error : set.errors) EXPECT_NEAR(error.volume, 0, 1e-5);
}

TEST(Hulls, OfAnLAreItsTwoBoxes) {
  const SolidAsset asset = broken(test::l_shape(), 1);
  const HullSet set = solid_hulls(asset, {});
  expect_sound(set, 2, {});
  expect_errors_hold(asset, set);
  EXPECT_EQ(set.hull_count(), 2u);
  EXPECT_NEAR(set.errors[0].volume, 0, 1e-6);
  // One is 1/6 too much in volume; its slope is 1/√2 off the corner, by a diagonal of 3.
  HullParams only_one;
  only_one.max_hulls = 1;
  const HullSet one = solid_hulls(asset, only_one);
  EXPECT_EQ(one.hull_count(), 1u);
  EXPECT_NEAR(one.errors[0].volume, 1.0 / 6, 1e-6);
  EXPECT_GE(one.errors[0].distance, 0.5 * std::sqrt(0.5) / 3);
  EXPECT_LE(one.errors[0].distance, 1.1 * std::sqrt(0.5) / 3);
}

HullParams rough() {
  HullParams params;
  params.error = 0.2;
  params.max_hulls = 4;
  params.max_vertices = 16;
  return params;
}

void expect_bounds_hold(TriMesh mesh, const HullParams& params) {
  const SolidAsset asset = broken(std::move(mesh), 12);
  const HullSet set = solid_hulls(asset, params);
  expect_sound(set, reach_of(asset), params);
  expect_errors_hold(asset, set);
}

TEST(Hulls, KeepTheirBoundsOnAGear) {
  expect_bounds_hold(test::gear(), {});
  expect_bounds_hold(test::gear(), rough());
}
TEST(Hulls, KeepTheirBoundsOnATorus) {
  expect_bounds_hold(test::torus(1, 0.3, 16, 10), {});
  expect_bounds_hold(test::torus(1, 0.3, 16, 10), rough());
}
TEST(Hulls, KeepTheirBoundsOnAVase) {
  expect_bounds_hold(test::vase(), rough());
}
TEST(Hulls, KeepTheirBoundsOnACavity) {
  expect_bounds_hold(test::nested_cavity(), rough());
}
TEST(Hulls, KeepTheirBoundsOnTwoShells) {
  expect_bounds_hold(test::two_shells(), {});
  expect_bounds_hold(test::two_shells(), rough());
}

TEST(Hulls, AreWithinTheErrorWhereThereMayBeEnough) {
  const SolidAsset asset = broken(test::torus(1, 0.3, 16, 10), 1);
  for (const double error : {0.5, 0.1, 0.05}) {
    HullParams params;
    params.error = error;
    params.max_hulls = 64;
    const HullSet set = solid_hulls(asset, params);
    EXPECT_LE(set.errors[0].volume, error);
    EXPECT_LE(set.errors[0].distance, error);
    EXPECT_GT(set.hull_count(), 3u);
  }
}

TEST(Hulls, DoNotDependOnThreads) {
  const SolidAsset asset = broken(test::torus(1, 0.3, 16, 10), 20);
  const HullSet one = solid_hulls(asset, {}, 1);
  for (const int threads : {2, 5}) {
    const HullSet other = solid_hulls(asset, {}, threads);
    EXPECT_EQ(one.positions, other.positions);
    EXPECT_EQ(one.indices, other.indices);
    EXPECT_EQ(one.hull_begin, other.hull_begin);
  }
}

TEST(Hulls, OfAWallWithOpeningsFillIt) {
  Wall wall;
  wall.region.outline = rectangle({6, 3});
  wall.region.openings = {rectangle({0.9, 2.1}, {1, 0}), rectangle({1.2, 1}, {3, 1})};
  wall.pattern = VoronoiGridParams{};
  const WallAsset asset = fracture_wall(wall, 2400, {});
  const HullSet set = wall_hulls(asset, {});
  expect_sound(set, 6, {});
  ASSERT_EQ(set.errors.size(), asset.chunks.size());
  EXPECT_GT(set.hull_count(), asset.chunks.size());  // cells around the openings' corners
  double volume = 0;
  for (std::uint32_t h = 0; h < set.hull_count(); ++h)
    volume += mass_properties(hull_mesh(set, h)).volume;
  EXPECT_NEAR(volume / asset.volume_expected, 1, 0.005);
  for (const HullSet::Error& error : set.errors) {
    EXPECT_LE(error.volume, 0.02);
    EXPECT_LE(error.distance, 0.02);
  }
}

}  // namespace
}  // namespace sunder
