// SPDX-License-Identifier: GPL-3.0-or-later
// Chunks of solids against CGAL's corefinement with exact constructions: the mesh clipped by one
// bisecting plane after the other.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fracture/solid_shapes.hpp"
#include "fracture/solid_sound.hpp"
#include "meshing/random.hpp"

namespace sunder::test {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

struct Measures {
  double volume = 0, area = 0;
};

Kernel::Point_3 exact(Vec3 p) {
  return {p.x, p.y, p.z};
}

Mesh exact(const TriMesh& mesh) {
  Mesh result;
  std::vector<Mesh::Vertex_index> vertices;
  for (const Vec3 v : mesh.vertices) vertices.push_back(result.add_vertex(exact(v)));
  for (const auto& t : mesh.triangles)
    result.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
  return result;
}

double area_of(Vec3 a, Vec3 b, Vec3 c) {
  return length(cross(b - a, c - a)) / 2;
}

Measures measured(const Mesh& mesh) {
  Measures result;
  if (mesh.number_of_faces() == 0) return result;
  result.volume = CGAL::to_double(CGAL::Polygon_mesh_processing::volume(mesh));
  for (const auto face : mesh.faces()) {
    std::vector<Vec3> corners;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(face))) {
      const auto& p = mesh.point(v);
      corners.push_back({CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())});
    }
    result.area += area_of(corners[0], corners[1], corners[2]);
  }
  return result;
}

// What of the mesh is nearer to site i than to any other.
Measures cell_of(const Mesh& whole, const std::vector<Vec3>& sites, std::size_t i) {
  Mesh part = whole;
  const Kernel::Point_3 own = exact(sites[i]);
  for (std::size_t j = 0; j < sites.size() && part.number_of_faces() > 0; ++j) {
    if (j == i) continue;
    const Kernel::Point_3 other = exact(sites[j]);
    const Kernel::Plane_3 plane(CGAL::midpoint(own, other), other - own);
    CGAL::Polygon_mesh_processing::clip(part, plane, CGAL::parameters::clip_volume(true));
    part.collect_garbage();
  }
  return measured(part);
}

std::size_t nearest(const std::vector<Vec3>& sites, Vec3 p) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < sites.size(); ++i)
    if (length(sites[i] - p) < length(sites[best] - p)) best = i;
  return best;
}

void expect_cells(const TriMesh& mesh, Vec3 low, Vec3 size, std::uint64_t seed) {
  SolidVoronoiParams pattern;
  for (std::uint64_t i = 0; i < 5; ++i) {
    // On the solid's lattice, so that it takes them as they are.
    const auto at = [&](std::uint64_t axis, double from, double length) {
      return std::round((from + length * random_unit(seed, i, axis)) * 0x1p18) * 0x1p-18;
    };
    pattern.sites.push_back({at(0, low.x, size.x), at(1, low.y, size.y), at(2, low.z, size.z)});
  }
  const SolidAsset asset = fractured(mesh, pattern, seed);
  std::vector<Measures> found(pattern.sites.size());
  for (std::uint32_t c = 0; c < asset.chunks.size(); ++c) {
    Measures& cell = found[nearest(pattern.sites, asset.chunks[c].centroid)];
    cell.volume += asset.chunks[c].volume;
    const SolidPartition& p = asset.partition;
    for (std::uint32_t t = p.chunk_begin[c]; t < p.chunk_begin[c + 1]; ++t) {
      const auto& v = p.triangles[t].corners;
      cell.area += area_of(p.vertices[v[0]], p.vertices[v[1]], p.vertices[v[2]]);
    }
  }
  const Mesh whole = exact(mesh);
  const Measures all = measured(whole);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Measures expected = cell_of(whole, pattern.sites, i);
    EXPECT_NEAR(found[i].volume, expected.volume, 1e-9 * all.volume) << "cell " << i;
    EXPECT_NEAR(found[i].area, expected.area, 1e-9 * all.area) << "cell " << i;
  }
}

TEST(SolidAgainstCgal, CellsOfABoxHaveTheSameVolumesAndAreas) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    expect_cells(box({0, 0, 0}, {2, 1, 3}), {0, 0, 0}, {2, 1, 3}, seed);
}

TEST(SolidAgainstCgal, CellsOfAnLHaveTheSameVolumesAndAreas) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    expect_cells(l_shape(), {0, 0, 0}, {2, 2, 1}, seed);
}

TEST(SolidAgainstCgal, CellsOfATorusHaveTheSameVolumesAndAreas) {
  expect_cells(torus(1, 0.3, 12, 8), {-1.25, -1.25, -0.25}, {2.5, 2.5, 0.5}, 1);
}

TEST(SolidAgainstCgal, CellsOfAGearHaveTheSameVolumesAndAreas) {
  expect_cells(gear(), {-1, -1, 0}, {2, 2, 0.25}, 2);
}

}  // namespace
}  // namespace sunder::test
