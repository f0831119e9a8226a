// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/self_crossing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "meshing/surface_defects.hpp"
#include "meshing/triangle_tree.hpp"

namespace sunder {
namespace {

constexpr double kMost = std::numeric_limits<double>::infinity();

// By how much the shadows of two triangles on an axis overlap.
double overlap(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, Vec3 axis) {
  double a_low = kMost, a_high = -kMost, b_low = kMost, b_high = -kMost;
  for (std::size_t k = 0; k < 3; ++k) {
    const double p = dot(axis, a[k] - a[0]), q = dot(axis, b[k] - a[0]);
    a_low = std::min(a_low, p);
    a_high = std::max(a_high, p);
    b_low = std::min(b_low, q);
    b_high = std::max(b_high, q);
  }
  return std::min(a_high - b_low, b_high - a_low);
}

// The least overlap along the axes that can part two triangles, or one not above `enough`.
double least_overlap(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b, double enough) {
  double least = kMost;
  const auto try_axis = [&](Vec3 axis) {
    const double size = length(axis);
    if (size > 0) least = std::min(least, overlap(a, b, (1 / size) * axis));
    return least <= enough;
  };
  const Vec3 normal = cross(a[1] - a[0], a[2] - a[0]), other = cross(b[1] - b[0], b[2] - b[0]);
  if (try_axis(normal) || try_axis(other)) return least;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (try_axis(cross(a[(i + 1) % 3] - a[i], b[(k + 1) % 3] - b[k]))) return least;
  return least;
}

// Whether a mesh has parts that share no vertex.
bool has_shells(const TriMesh& mesh) {
  std::vector<std::uint32_t> root(mesh.vertices.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) root[find(v)] = find(t[0]);
  return std::ranges::any_of(
      mesh.triangles, [&](const auto& t) { return find(t[0]) != find(mesh.triangles[0][0]); });
}

}  // namespace

double crossing_depth(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  return least_overlap(a, b, -kMost);
}

bool crosses_itself(const TriMesh& mesh, double depth) {
  const auto corners = [&](std::uint32_t t) {
    const auto& v = mesh.triangles[t];
    return std::array{mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
  };
  const TriangleTree tree(mesh);
  return tree.any_overlapping([&](std::uint32_t a, std::uint32_t b) {
    return least_overlap(corners(a), corners(b), depth) > depth;
  });
}

double float_rounding(const TriMesh& mesh) {
  double largest = 0;
  for (const Vec3& p : mesh.vertices)
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  // Half a unit in the last place, √3 for the axes, two corners: 2^-23 · √3; twice that.
  return 0x1p-21 * largest;
}

bool is_tangled(const TriMesh& mesh) {
  constexpr auto kInsideOut = static_cast<std::size_t>(SurfaceDefect::Kind::inside_out);
  for (const Vec3& p : mesh.vertices)
    if (!std::isfinite(p.x + p.y + p.z)) return false;  // the volume is not finite either
  return crosses_itself(mesh, float_rounding(mesh)) ||
         (has_shells(mesh) && diagnose(mesh, 0).counts[kInsideOut] > 0);
}

}  // namespace sunder
