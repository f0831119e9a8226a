// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

#include "meshing/tri_mesh.hpp"

namespace sunder {

inline void append(TriMesh& mesh, const TriMesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles)
    mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
}

inline TriMesh turned_over(TriMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// A box by its corners; 12 triangles.
inline TriMesh box_mesh(Vec3 low, Vec3 high) {
  TriMesh mesh;
  for (int c = 0; c < 8; ++c)
    mesh.vertices.push_back(
        {c & 1 ? high.x : low.x, c & 2 ? high.y : low.y, c & 4 ? high.z : low.z});
  for (const auto& q : {std::array<std::uint32_t, 4>{0, 2, 3, 1},
                        {4, 5, 7, 6},
                        {0, 1, 5, 4},
                        {2, 6, 7, 3},
                        {0, 4, 6, 2},
                        {1, 3, 7, 5}}) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}
inline TriMesh unit_cube() {
  return box_mesh({0, 0, 0}, {1, 1, 1});
}

/// An octahedron whose triangles are cut into n² each, on the sphere: 8 n² triangles.
inline TriMesh sphere_mesh(double radius, int n, Vec3 centre = {}) {
  TriMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> index;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [it, is_new] = index.emplace(p, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) {
      const Vec3 v{double(p[0]), double(p[1]), double(p[2])};
      mesh.vertices.push_back(centre + (radius / length(v)) * v);
    }
    return it->second;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const int sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1, sz = octant & 4 ? -1 : 1;
    const auto at = [&](int i, int k) { return vertex({sx * (n - i - k), sy * i, sz * k}); };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      if (sx * sy * sz > 0)
        mesh.triangles.push_back({a, b, c});
      else
        mesh.triangles.push_back({a, c, b});
    };
    for (int i = 0; i < n; ++i)
      for (int k = 0; i + k < n; ++k) {
        add(at(i, k), at(i + 1, k), at(i, k + 1));
        if (i + k + 1 < n) add(at(i + 1, k), at(i + 1, k + 1), at(i, k + 1));
      }
  }
  return mesh;
}

/// About the z axis; n × m quads, two triangles each.
inline TriMesh torus_mesh(double radius, double tube, int n, int m) {
  TriMesh mesh;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < m; ++k) {
      const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * k / m;
      const double r = radius + tube * std::cos(v);
      mesh.vertices.push_back({r * std::cos(u), r * std::sin(u), tube * std::sin(v)});
    }
  const auto at = [&](int i, int k) { return static_cast<std::uint32_t>(i % n * m + k % m); };
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < m; ++k) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  return mesh;
}

}  // namespace sunder
