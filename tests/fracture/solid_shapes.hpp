// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "meshing/model_surface.hpp"
#include "meshing/triangulate.hpp"

namespace sunder::test {

inline void append(TriMesh& mesh, const TriMesh& other, bool flipped = false) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (auto t : other.triangles) {
    if (flipped) std::swap(t[1], t[2]);
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

inline ModelSurface as_surface(TriMesh mesh) {
  ModelSurface surface;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]];
    const Vec3 n = cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
    const double size = length(n);
    Corner corner;
    if (size > 0)
      corner.normal = {static_cast<float>(n.x / size), static_cast<float>(n.y / size),
                       static_cast<float>(n.z / size)};
    for (int k = 0; k < 3; ++k) surface.corners.push_back(corner);
  }
  surface.material.assign(mesh.triangles.size(), 0);
  surface.materials.resize(1);
  surface.mesh = std::move(mesh);
  return surface;
}

inline TriMesh box(Vec3 low, Vec3 size) {
  TriMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back({low.x + ((i & 1) ? size.x : 0), low.y + ((i & 2) ? size.y : 0),
                             low.z + ((i & 4) ? size.z : 0)});
  for (const auto& q : {std::array<std::uint32_t, 4>{0, 4, 6, 2},
                        {1, 3, 7, 5},
                        {0, 1, 5, 4},
                        {2, 6, 7, 3},
                        {0, 2, 3, 1},
                        {4, 5, 7, 6}}) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

/// Around the y axis; profile radius(v), height(v) for v of 0 … rows.
inline TriMesh sphere(Vec3 centre, double radius, int rows) {
  TriMesh mesh;
  const int columns = 2 * rows;
  const auto id = [&](int i, int j) -> std::uint32_t {
    if (i == 0) return 0;
    if (i == rows) return 1;
    return static_cast<std::uint32_t>(2 + (i - 1) * columns + j % columns);
  };
  mesh.vertices = {centre + Vec3{0, radius, 0}, centre - Vec3{0, radius, 0}};
  for (int i = 1; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double a = std::numbers::pi * i / rows, b = 2 * std::numbers::pi * j / columns;
      mesh.vertices.push_back(centre + radius * Vec3{std::sin(a) * std::cos(b), std::cos(a),
                                                     -std::sin(a) * std::sin(b)});
    }
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      if (i > 0) mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i, j + 1)});
      if (i + 1 < rows) mesh.triangles.push_back({id(i, j + 1), id(i + 1, j), id(i + 1, j + 1)});
    }
  return mesh;
}

inline TriMesh torus(double ring, double tube, int n, int m) {
  TriMesh mesh;
  const auto id = [&](int i, int j) { return static_cast<std::uint32_t>((i % n) * m + j % m); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / m;
      const double r = ring + tube * std::cos(b);
      mesh.vertices.push_back({r * std::cos(a), r * std::sin(a), tube * std::sin(b)});
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  return mesh;
}

/// Polygon with holes (loops of points, outer counter-clockwise) from z = 0 to `height`.
inline TriMesh prism(const std::vector<std::vector<Vec2>>& loops, double height) {
  TriMesh mesh;
  std::vector<Vec2> points;
  IndexLoops indices;
  for (const auto& loop : loops) {
    indices.emplace_back();
    for (const Vec2& p : loop) {
      indices.back().push_back(static_cast<std::uint32_t>(points.size()));
      points.push_back(p);
    }
  }
  const auto n = static_cast<std::uint32_t>(points.size());
  for (const double z : {0.0, height})
    for (const Vec2& p : points) mesh.vertices.push_back({p.x, p.y, z});
  for (const auto& t : triangulate(points, indices)) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({n + t[0], n + t[1], n + t[2]});
  }
  for (const auto& loop : indices)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const std::uint32_t a = loop[k], b = loop[(k + 1) % loop.size()];
      mesh.triangles.push_back({a, b, n + b});
      mesh.triangles.push_back({a, n + b, n + a});
    }
  return mesh;
}

inline TriMesh l_shape() {
  return prism({{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}}, 1);
}

inline std::vector<Vec2> circle(Vec2 centre, double radius, int n, bool clockwise = false) {
  std::vector<Vec2> loop;
  for (int i = 0; i < n; ++i) {
    const double a = (clockwise ? -2 : 2) * std::numbers::pi * i / n;
    loop.push_back(centre + radius * Vec2{std::cos(a), std::sin(a)});
  }
  return loop;
}

inline TriMesh gear() {
  std::vector<Vec2> outer;
  for (int i = 0; i < 72; ++i) {
    const double a = 2 * std::numbers::pi * i / 72;
    outer.push_back((i / 3 % 2 ? 1.0 : 0.8) * Vec2{std::cos(a), std::sin(a)});
  }
  std::vector<std::vector<Vec2>> loops{outer, circle({0, 0}, 0.2, 24, true)};
  for (int i = 0; i < 5; ++i) {
    const double a = 2 * std::numbers::pi * i / 5;
    loops.push_back(circle(0.5 * Vec2{std::cos(a), std::sin(a)}, 0.12, 16, true));
  }
  return prism(loops, 0.3);
}

inline TriMesh nested_cavity() {
  TriMesh mesh = box({0, 0, 0}, {2, 2, 2});
  append(mesh, sphere({1, 1, 1}, 0.7, 10), true);
  append(mesh, sphere({1, 1, 1}, 0.4, 8));
  append(mesh, box({0.9, 0.9, 0.9}, {0.2, 0.2, 0.2}), true);
  return mesh;
}

inline TriMesh two_shells() {
  TriMesh mesh = sphere({0, 0, 0}, 1, 12);
  append(mesh, box({2, -0.5, -0.5}, {1, 1, 1}));
  return mesh;
}

/// A vase: a wall of 1 cm around a hollow.
inline TriMesh vase() {
  TriMesh mesh;
  std::vector<Vec2> profile;  // radius, height: up outside, down inside
  const int n = 24, m = 40;
  for (int i = 0; i <= n; ++i) {
    const double h = 0.5 * i / n;
    profile.push_back({0.1 + 0.05 * std::sin(7 * h), h});
  }
  for (int i = n; i >= 0; --i) {
    const double h = 0.5 * i / n;
    profile.push_back({0.09 + 0.05 * std::sin(7 * h), i == 0 ? 0.01 : h});
  }
  const auto rows = static_cast<int>(profile.size());
  mesh.vertices = {{0, 0, 0}, {0, 0.01, 0}};
  const auto id = [&](int i, int j) { return static_cast<std::uint32_t>(2 + i * m + j % m); };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < m; ++j) {
      const double a = 2 * std::numbers::pi * j / m;
      const Vec2 p = profile[static_cast<std::size_t>(i)];
      mesh.vertices.push_back({p.x * std::cos(a), p.y, -p.x * std::sin(a)});
    }
  for (int j = 0; j < m; ++j) {
    mesh.triangles.push_back({0, id(0, j + 1), id(0, j)});
    mesh.triangles.push_back({1, id(rows - 1, j), id(rows - 1, j + 1)});
    for (int i = 0; i + 1 < rows; ++i) {
      mesh.triangles.push_back({id(i, j), id(i, j + 1), id(i + 1, j + 1)});
      mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i + 1, j)});
    }
  }
  return mesh;
}

struct Shape {
  const char* name;
  TriMesh mesh;
};
inline std::vector<Shape> shapes() {
  return {{"box", box({0, 0, 0}, {1, 1, 1})},
          {"sphere", sphere({0, 0, 0}, 1, 16)},
          {"torus", torus(1, 0.3, 40, 20)},
          {"L", l_shape()},
          {"gear", gear()},
          {"cavity", nested_cavity()},
          {"two", two_shells()},
          {"vase", vase()}};
}

}  // namespace sunder::test
