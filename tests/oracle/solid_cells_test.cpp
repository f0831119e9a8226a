// SPDX-License-Identifier: GPL-3.0-or-later
// Chunks of solids against voro++ (cells of a box) and against a sum over the signed tetrahedra
// between a point and the triangles of a mesh, each cut down to what lies nearest to a site.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <voro++/voro++.hh>

#include "fracture/solid_shapes.hpp"
#include "fracture/solid_sound.hpp"
#include "meshing/random.hpp"

namespace sunder::test {
namespace {

// Sites on the solid's lattice, so that it takes them as they are.
SolidVoronoiParams sites_in(Vec3 low, Vec3 size, int count, std::uint64_t seed) {
  SolidVoronoiParams pattern;
  const auto part = [&](int i, std::uint64_t axis, double from, double length) {
    const double v = from + length * random_unit(seed, static_cast<std::uint64_t>(i), axis);
    return std::round(v * 0x1p18) * 0x1p-18;
  };
  for (int i = 0; i < count; ++i)
    pattern.sites.push_back(
        {part(i, 0, low.x, size.x), part(i, 1, low.y, size.y), part(i, 2, low.z, size.z)});
  return pattern;
}

std::size_t nearest(const std::vector<Vec3>& sites, Vec3 p) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < sites.size(); ++i)
    if (length(sites[i] - p) < length(sites[best] - p)) best = i;
  return best;
}

TEST(SolidAgainstVoropp, CellsOfABoxHaveTheSameVolumesAndAreas) {
  const Vec3 size{4, 2, 1};
  const SolidVoronoiParams pattern = sites_in({0, 0, 0}, size, 400, 3);
  const SolidAsset asset = fractured(box({0, 0, 0}, size), pattern);
  voro::container container(0, size.x, 0, size.y, 0, size.z, 8, 4, 2, false, false, false, 8);
  for (std::size_t i = 0; i < pattern.sites.size(); ++i)
    container.put(static_cast<int>(i), pattern.sites[i].x, pattern.sites[i].y, pattern.sites[i].z);
  std::map<std::array<std::uint32_t, 2>, double> areas;
  std::vector<double> volumes(pattern.sites.size());
  voro::c_loop_all loop(container);
  voro::voronoicell_neighbor cell;
  if (loop.start()) do {
      ASSERT_TRUE(container.compute_cell(cell, loop));
      const auto i = static_cast<std::uint32_t>(loop.pid());
      volumes[i] = cell.volume();
      std::vector<int> neighbours;
      std::vector<double> face_areas;
      cell.neighbors(neighbours);
      cell.face_areas(face_areas);
      for (std::size_t f = 0; f < neighbours.size(); ++f)
        if (neighbours[f] > loop.pid())
          areas[{i, static_cast<std::uint32_t>(neighbours[f])}] = face_areas[f];
    } while (loop.inc());
  ASSERT_EQ(asset.partition.chunk_count(), volumes.size());
  for (std::size_t i = 0; i < volumes.size(); ++i)
    EXPECT_NEAR(asset.chunks[i].volume, volumes[i], 1e-10);
  double missing = 0;
  for (const Bond& bond : asset.bonds) {
    const auto found = areas.find({bond.a, bond.b});
    if (found == areas.end()) {
      missing = std::max(missing, bond.area);
      continue;
    }
    EXPECT_NEAR(bond.area, found->second, 1e-10);
    areas.erase(found);
  }
  for (const auto& [pair, area] : areas) missing = std::max(missing, area);
  EXPECT_LT(missing, 1e-9);  // voro++ drops faces within its tolerance
}

using Tetrahedron = std::array<Vec3, 4>;

// Volume of the part of a tetrahedron that is nearest to site i, by cutting it into tetrahedra at
// one bisecting plane after the other.
double nearest_volume(Tetrahedron t, const std::vector<Vec3>& sites, std::size_t i,
                      std::size_t j = 0) {
  if (j == i) ++j;
  if (j == sites.size()) return std::abs(dot(t[1] - t[0], cross(t[2] - t[0], t[3] - t[0]))) / 6;
  const Vec3 n = sites[j] - sites[i], middle = 0.5 * (sites[i] + sites[j]);
  const auto beyond = [&](Vec3 p) { return dot(p - middle, n); };
  std::ranges::sort(t, {}, beyond);
  const auto inside = std::ranges::count_if(t, [&](Vec3 p) { return beyond(p) < 0; });
  const auto cut = [&](std::size_t a, std::size_t b) {
    const double p = beyond(t[a]), q = beyond(t[b]);
    return t[a] + (p / (p - q)) * (t[b] - t[a]);
  };
  const auto rest = [&](const Tetrahedron& part) { return nearest_volume(part, sites, i, j + 1); };
  const auto prism = [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e, Vec3 f) {  // abc below def
    return rest({a, b, c, d}) + rest({b, c, d, e}) + rest({c, d, e, f});
  };
  if (inside == 0) return 0;
  if (inside == 1) return rest({t[0], cut(0, 1), cut(0, 2), cut(0, 3)});
  if (inside == 2) return prism(t[0], cut(0, 2), cut(0, 3), t[1], cut(1, 2), cut(1, 3));
  if (inside == 3) return prism(t[0], t[1], t[2], cut(0, 3), cut(1, 3), cut(2, 3));
  return rest(t);
}

// Of a closed mesh: the signed tetrahedra between a point and its triangles.
std::vector<double> nearest_volumes(const TriMesh& mesh, const std::vector<Vec3>& sites) {
  std::vector<double> volumes(sites.size());
  const Vec3 o{-0.317, -0.271, -0.193};
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    const double sign = dot(a - o, cross(b - o, c - o)) < 0 ? -1 : 1;
    for (std::size_t i = 0; i < sites.size(); ++i)
      volumes[i] += sign * nearest_volume({o, a, b, c}, sites, i);
  }
  return volumes;
}

TEST(SolidAgainstTetrahedra, CellsOfSolidsThatAreNotConvexHaveTheSameVolumes) {
  struct Case {
    const char* name;
    TriMesh mesh;
    Vec3 low, size;
  };
  for (const Case& c :
       {Case{"L", l_shape(), {0, 0, 0}, {2, 2, 1}}, Case{"gear", gear(), {-1, -1, 0}, {2, 2, 0.25}},
        Case{"torus", torus(1, 0.3, 20, 12), {-1.25, -1.25, -0.25}, {2.5, 2.5, 0.5}},
        Case{"cavity", nested_cavity(), {0, 0, 0}, {2, 2, 2}}}) {
    SCOPED_TRACE(c.name);
    const SolidVoronoiParams pattern = sites_in(c.low, c.size, 12, 7);
    const SolidAsset asset = fractured(c.mesh, pattern);
    std::vector<double> volumes(pattern.sites.size());
    for (const auto& chunk : asset.chunks)
      volumes[nearest(pattern.sites, chunk.centroid)] += chunk.volume;
    const std::vector<double> expected = nearest_volumes(c.mesh, pattern.sites);
    for (std::size_t i = 0; i < volumes.size(); ++i)
      EXPECT_NEAR(volumes[i], expected[i], 1e-12 * asset.volume_expected) << "cell " << i;
  }
}

}  // namespace
}  // namespace sunder::test
