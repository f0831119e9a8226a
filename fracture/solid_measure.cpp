// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "fracture/solid_parts.hpp"
#include "meshing/parallel.hpp"
#include "meshing/self_crossing.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = ~0u;

TriMesh chunk_triangles(const SolidPartition& partition, std::uint32_t chunk) {
  TriMesh mesh;
  for (std::uint32_t t = partition.chunk_begin[chunk]; t < partition.chunk_begin[chunk + 1]; ++t) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const std::uint32_t v : partition.triangles[t].corners)
      mesh.vertices.push_back(partition.vertices[v]);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

// A chunk as a file holds it: float32 positions. `local` is all kNone before and after.
TriMesh chunk_in_file(const SolidPartition& partition, std::uint32_t chunk, Vec3 origin,
                      std::vector<std::uint32_t>& local) {
  TriMesh mesh;
  const auto in_file = [](double x) { return static_cast<double>(static_cast<float>(x)); };
  const std::span triangles(partition.triangles.begin() + partition.chunk_begin[chunk],
                            partition.triangles.begin() + partition.chunk_begin[chunk + 1]);
  for (const auto& t : triangles) {
    auto& triangle = mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& v = local[t.corners[k]];
      if (v == kNone) {
        v = static_cast<std::uint32_t>(mesh.vertices.size());
        const Vec3 p = partition.vertices[t.corners[k]] - origin;
        mesh.vertices.push_back({in_file(p.x), in_file(p.y), in_file(p.z)});
      }
      triangle[k] = v;
    }
  }
  for (const auto& t : triangles)
    for (const std::uint32_t v : t.corners) local[v] = kNone;
  return mesh;
}

// A bond while it is summed up: the normal is that of the areas' sum.
struct Sum {
  std::uint32_t a = 0, b = 0;
  double area = 0;
  Vec3 moment, vector;
};

}  // namespace

Vec3 origin_for(const TriMesh& surface) {
  constexpr double kFar = 4;  // half extents: what float32 loses there, three bits, is let go
  Vec3 low = surface.vertices.front(), high = low;
  for (const Vec3 v : surface.vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  const auto along = [&](double from, double to) {
    const double middle = (from + to) / 2;
    if (!(std::abs(middle) > kFar * (to - from) / 2)) return 0.0;
    return static_cast<double>(static_cast<float>(middle));
  };
  return {along(low.x, high.x), along(low.y, high.y), along(low.z, high.z)};
}

bool has_crossings(const SolidPartition& partition, Vec3 origin) {
  std::vector<std::uint32_t> local(partition.vertices.size(), kNone);
  for (std::uint32_t c = 0; c < partition.chunk_count(); ++c)
    if (is_tangled(chunk_in_file(partition, c, origin, local))) return true;
  return false;
}

std::vector<Bond> solid_bonds(const SolidPartition& partition) {
  std::vector<Sum> faces(partition.faces.size());
  for (std::uint32_t c = 0; c < partition.chunk_count(); ++c)
    for (std::uint32_t t = partition.chunk_begin[c]; t < partition.chunk_begin[c + 1]; ++t) {
      const auto& triangle = partition.triangles[t];
      if (!triangle.is_inner() || partition.faces[triangle.face()].a != c) continue;
      const Vec3 p = partition.vertices[triangle.corners[0]],
                 q = partition.vertices[triangle.corners[1]],
                 r = partition.vertices[triangle.corners[2]];
      Sum& sum = faces[triangle.face()];
      const Vec3 vector = 0.5 * cross(q - p, r - p);
      const double area = length(vector);
      sum.area += area;
      sum.moment = sum.moment + (area / 3) * (p + q + r);
      sum.vector = sum.vector + vector;
    }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto& face = partition.faces[f];
    faces[f].a = std::min(face.a, face.b);
    faces[f].b = std::max(face.a, face.b);
    if (face.a > face.b) faces[f].vector = -1.0 * faces[f].vector;
  }
  std::ranges::stable_sort(faces, {}, [](const Sum& s) { return std::pair(s.a, s.b); });
  std::vector<Bond> bonds;
  for (std::size_t f = 0; f < faces.size();) {
    Sum sum = faces[f];
    for (++f; f < faces.size() && faces[f].a == sum.a && faces[f].b == sum.b; ++f) {
      sum.area += faces[f].area;
      sum.moment = sum.moment + faces[f].moment;
      sum.vector = sum.vector + faces[f].vector;
    }
    const double size = length(sum.vector);
    if (!(sum.area > 0)) continue;
    bonds.push_back({sum.a, sum.b, sum.area, (1 / sum.area) * sum.moment,
                     size > 0 ? (1 / size) * sum.vector : Vec3{1, 0, 0}});
  }
  return bonds;
}

std::vector<MassProperties> solid_masses(const SolidPartition& partition, int threads) {
  std::vector<MassProperties> masses(partition.chunk_count());
  for_each_range(masses.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      masses[c] = mass_properties(chunk_triangles(partition, static_cast<std::uint32_t>(c)));
  });
  return masses;
}

}  // namespace sunder
