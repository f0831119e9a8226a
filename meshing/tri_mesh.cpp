// SPDX-License-Identifier: GPL-3.0-or-later
// Volume integrals of a polyhedron as sums over signed tetrahedra from a base point: exact for
// polynomials up to degree two (Mirtich 1996; Eberly, "Polyhedral Mass Properties (Revisited)").
#include "meshing/tri_mesh.hpp"

#include <algorithm>

namespace sunder {
namespace {

struct Integrals {
  double one = 0;                                         // ∫ 1
  Vec3 first;                                             // ∫ x
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;  // ∫ x x …
};

// Tetrahedron (0, a, b, c): ∫ p q = V/20 (Σ p_i q_i + Σ p_i Σ q_i).
void add_tetrahedron(Integrals& sum, Vec3 a, Vec3 b, Vec3 c) {
  const double volume = dot(a, cross(b, c)) / 6;
  const Vec3 s = a + b + c;
  sum.one += volume;
  sum.first = sum.first + (volume / 4) * s;
  const double w = volume / 20;
  sum.xx += w * (a.x * a.x + b.x * b.x + c.x * c.x + s.x * s.x);
  sum.yy += w * (a.y * a.y + b.y * b.y + c.y * c.y + s.y * s.y);
  sum.zz += w * (a.z * a.z + b.z * b.z + c.z * c.z + s.z * s.z);
  sum.xy += w * (a.x * a.y + b.x * b.y + c.x * c.y + s.x * s.y);
  sum.xz += w * (a.x * a.z + b.x * b.z + c.x * c.z + s.x * s.z);
  sum.yz += w * (a.y * a.z + b.y * b.z + c.y * c.z + s.y * s.z);
}

}  // namespace

MassProperties mass_properties(const TriMesh& mesh) {
  if (mesh.triangles.empty()) return {};
  const Vec3 base = mesh.vertices[mesh.triangles[0][0]];
  Integrals sum;
  for (const auto& t : mesh.triangles)
    add_tetrahedron(sum, mesh.vertices[t[0]] - base, mesh.vertices[t[1]] - base,
                    mesh.vertices[t[2]] - base);
  if (sum.one == 0) return {0, base, {}};
  const Vec3 c = (1 / sum.one) * sum.first;
  const double v = sum.one;
  const double xx = sum.xx - v * c.x * c.x, yy = sum.yy - v * c.y * c.y,
               zz = sum.zz - v * c.z * c.z;
  return {v,
          base + c,
          {yy + zz, xx + zz, xx + yy, -(sum.xy - v * c.x * c.y), -(sum.xz - v * c.x * c.z),
           -(sum.yz - v * c.y * c.z)}};
}

MeshDefects check(const TriMesh& mesh) {
  MeshDefects defects;
  using Edge = std::array<std::uint32_t, 2>;
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    if (std::ranges::any_of(t, [&](std::uint32_t v) { return v >= mesh.vertices.size(); })) {
      ++defects.bad_indices;
      continue;
    }
    const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    const bool repeated = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    if (repeated || length(cross(b - a, c - a)) == 0) ++defects.degenerate_triangles;
    for (int i = 0; i < 3; ++i) edges.push_back({t[i], t[(i + 1) % 3]});
  }
  if (defects.bad_indices > 0) return defects;
  std::ranges::sort(edges);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    defects.nonmanifold_edges += i > 0 && edges[i] == edges[i - 1];
    defects.open_edges += !std::ranges::binary_search(edges, Edge{edges[i][1], edges[i][0]});
  }
  defects.inside_out = defects.open_edges == 0 && !(mass_properties(mesh).volume > 0);
  return defects;
}

}  // namespace sunder
