// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>

#include "meshing/level_set.hpp"
#include "meshing/repair_draft.hpp"
#include "meshing/repair_remake.hpp"
#include "meshing/surface_defects.hpp"
#include "meshing/surface_edges.hpp"

namespace sunder {
namespace {

// More shells than this are not each asked whether they lie in another.
constexpr std::size_t kMostShellsAsked = 100;
// Shells and bubbles of less than this share of a voxel are noise: there the lattice says nothing.
constexpr double kSpeck = 0.1;

// The mesh with fans, and per triangle the shell it belongs to.
std::pair<TriMesh, std::vector<std::uint32_t>> with_fans(const TriMesh& mesh,
                                                         const std::vector<std::uint32_t>& shells) {
  std::pair<TriMesh, std::vector<std::uint32_t>> result{mesh, shells};
  auto& [closed, shell] = result;
  std::vector<std::uint32_t> shell_at(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t]) shell_at[v] = shells[t];
  for (const auto& loop : open_loops(mesh)) {
    Vec3 middle;
    for (const std::uint32_t v : loop)
      middle = middle + (1 / static_cast<double>(loop.size())) * mesh.vertices[v];
    const auto centre = static_cast<std::uint32_t>(closed.vertices.size());
    closed.vertices.push_back(middle);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      closed.triangles.push_back({loop[k], loop[(k + 1) % loop.size()], centre});
      shell.push_back(shell_at[loop[k]]);
    }
  }
  return result;
}

bool is_inside_others(const TriMesh& closed, const std::vector<std::uint32_t>& shell,
                      std::uint32_t which) {
  std::vector<bool> others;
  for (const std::uint32_t s : shell) others.push_back(s != which);
  const Vec3 p = closed.vertices[closed.triangles[which][0]];
  return TriangleTree(closed, others).winding_number(p) > 0.5;
}

double distance2(const std::array<float, 2>& a, const std::array<float, 2>& b) {
  return std::pow(a[0] - b[0], 2) + std::pow(a[1] - b[1], 2);
}

// What the surface carries at a place on one of its triangles; the weights may be of a place
// beyond.
Corner carried_at(const ModelSurface& s, std::uint32_t triangle, const std::array<double, 3>& w) {
  Corner c;
  c.uv = {};
  c.colour = {};
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner& from = s.corners[3 * triangle + k];
    const auto share = static_cast<float>(w[k]);
    for (std::size_t i = 0; i < 2; ++i) c.uv[i] += share * from.uv[i];
    for (std::size_t i = 0; i < 4; ++i) c.colour[i] += share * from.colour[i];
  }
  return c;
}

// Weights of p's foot in the plane of a triangle.
std::array<double, 3> plane_weights(const TriMesh& mesh, std::uint32_t triangle, Vec3 p) {
  const auto& t = mesh.triangles[triangle];
  const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
  const Vec3 n = cross(b - a, c - a);
  const double size = dot(n, n);
  if (size == 0) return {1, 0, 0};
  const double v = dot(cross(p - a, c - a), n) / size, w = dot(cross(b - a, p - a), n) / size;
  return {1 - v - w, v, w};
}

// The surface without shells that enclose less than `least`, either way round; the largest stays.
TriMesh without_specks(const TriMesh& mesh, double least) {
  const auto uses = edge_uses(mesh.triangles, std::vector<bool>(mesh.triangles.size(), true));
  const auto shell = orient(mesh.triangles, uses).shell;
  std::vector<double> volume(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 base = mesh.vertices[mesh.triangles[shell[t]][0]];
    const auto place = [&](std::size_t k) { return mesh.vertices[mesh.triangles[t][k]] - base; };
    volume[shell[t]] += dot(place(0), cross(place(1), place(2))) / 6;
  }
  double most = 0;
  for (const double v : volume) most = std::max(most, std::abs(v));
  std::vector<bool> keep;
  for (const std::uint32_t s : shell) keep.push_back(std::abs(volume[s]) >= std::min(least, most));
  if (std::ranges::all_of(keep, [](bool kept) { return kept; })) return mesh;
  Draft draft = make_draft(flat_surface(mesh));
  keep_triangles(draft, keep);
  drop_unused_vertices(draft);
  return draft.mesh();
}

}  // namespace

TriMesh closed_by_fans(const TriMesh& mesh) {
  TriMesh turned = mesh;
  const auto uses = edge_uses(mesh.triangles, std::vector<bool>(mesh.triangles.size(), true));
  const auto shells = orient(mesh.triangles, uses).shell;
  const auto [closed, shell] = with_fans(mesh, shells);
  std::vector<double> volume(mesh.triangles.size());
  for (std::size_t t = 0; t < closed.triangles.size(); ++t) {
    const auto place = [&](std::size_t k) {
      return closed.vertices[closed.triangles[t][k]] -
             closed.vertices[closed.triangles[shell[t]][0]];
    };
    volume[shell[t]] += dot(place(0), cross(place(1), place(2)));
  }
  const auto inverted = std::count_if(volume.begin(), volume.end(), [](double v) { return v < 0; });
  for (std::uint32_t s = 0; s < volume.size(); ++s)
    if (volume[s] < 0 && (static_cast<std::size_t>(inverted) > kMostShellsAsked ||
                          !is_inside_others(closed, shell, s)))
      for (std::size_t t = 0; t < shells.size(); ++t)
        if (shells[t] == s) std::swap(turned.triangles[t][1], turned.triangles[t][2]);
  return with_fans(turned, shells).first;
}

TriMesh solid_surface(const LevelSet& set) {
  const double speck = kSpeck * set.voxel * set.voxel * set.voxel;
  TriMesh mesh = without_specks(smooth_surface(set), speck);
  if (diagnose(mesh, 1).is_solid()) return mesh;
  Draft draft = make_draft(flat_surface(mesh));
  if (cut_out_crossings(draft, TriangleTree(mesh), set.voxel / 2)) return draft.mesh();
  return without_specks(sound_surface(set), speck);
}

void carry_over(const ModelSurface& given, const TriangleTree& tree, ModelSurface& made,
                const std::vector<bool>& is_new) {
  for (std::size_t t = 0; t < made.mesh.triangles.size(); ++t) {
    if (!is_new[t]) continue;
    const auto& corners = made.mesh.triangles[t];
    const auto place = [&](std::size_t k) { return made.mesh.vertices[corners[k]]; };
    const auto middle = tree.nearest((1.0 / 3) * (place(0) + place(1) + place(2)));
    made.material[t] = given.material[middle.triangle];
    const Vec3 n = face_normal(made.mesh, t);
    // A corner beyond a seam of the UVs takes those of the middle's triangle, continued.
    std::array<Corner, 3> continued;
    for (std::size_t k = 0; k < 3; ++k)
      continued[k] =
          carried_at(given, middle.triangle, plane_weights(given.mesh, middle.triangle, place(k)));
    const double size2 = std::max({distance2(continued[0].uv, continued[1].uv),
                                   distance2(continued[1].uv, continued[2].uv),
                                   distance2(continued[2].uv, continued[0].uv)});
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = tree.nearest(place(k));
      Corner corner = carried_at(given, at.triangle, at.weights);
      if (distance2(corner.uv, continued[k].uv) > size2) corner.uv = continued[k].uv;
      corner.normal = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
      made.corners[3 * t + k] = corner;
    }
  }
}

}  // namespace sunder
