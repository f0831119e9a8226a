// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "meshing/repair_draft.hpp"
#include "meshing/surface_defects.hpp"

namespace sunder {
namespace {

// Beyond this share of the faces it is not a matter of a few folds.
constexpr double kMostCrossingShare = 0.1;
constexpr int kMostRings = 3;

// Faces that cross or meet others wrongly.
std::vector<bool> bad_faces(const TriMesh& mesh) {
  using Kind = SurfaceDefect::Kind;
  std::vector<bool> bad(mesh.triangles.size());
  for (const SurfaceDefect& d : diagnose(mesh, 3 * mesh.triangles.size()).defects)
    if (d.kind == Kind::self_intersection || d.kind == Kind::nonmanifold_edge ||
        d.kind == Kind::nonmanifold_vertex)
      bad[d.a] = bad[d.b] = true;
  return bad;
}

void grow(const TriMesh& mesh, std::vector<bool>& faces) {
  std::vector<bool> touched(mesh.vertices.size());
  for (std::size_t t = 0; t < faces.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      if (faces[t]) touched[v] = true;
  for (std::size_t t = 0; t < faces.size(); ++t)
    faces[t] = std::ranges::any_of(mesh.triangles[t], [&](std::uint32_t v) { return touched[v]; });
}

// Of the triangles from `first` on.
double farthest_new(const TriMesh& mesh, std::size_t first, const TriangleTree& tree,
                    double spacing) {
  TriMesh made;
  made.vertices = mesh.vertices;
  made.triangles.assign(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first),
                        mesh.triangles.end());
  return farthest(made, tree, spacing);
}

}  // namespace

bool cut_out_crossings(Draft& draft, const TriangleTree& tree, double max_error) {
  std::vector<bool> cut = bad_faces(draft.mesh());
  const auto crossing = std::count(cut.begin(), cut.end(), true);
  const auto most = kMostCrossingShare * static_cast<double>(cut.size());
  if (crossing == 0 || static_cast<double>(crossing) > most) return false;
  for (int ring = 0; ring <= kMostRings; ++ring) {
    if (ring > 0) grow(draft.mesh(), cut);
    Draft attempt = draft;
    std::vector<bool> keep = cut;
    keep.flip();
    keep_triangles(attempt, keep);
    const std::size_t kept = attempt.mesh().triangles.size();
    fill_holes(attempt);
    drop_unused_vertices(attempt);
    if (!diagnose(attempt.mesh(), 1).is_solid() ||
        farthest_new(attempt.mesh(), kept, tree, max_error / 2) > max_error)
      continue;
    const auto count = std::count(cut.begin(), cut.end(), true);
    attempt.steps = draft.steps;
    attempt.steps.push_back(counted(static_cast<std::uint64_t>(crossing),
                                    "face that crosses another", "faces that cross others") +
                            " cut out with their neighbours (" + std::to_string(count) +
                            " in all), the holes filled");
    draft = std::move(attempt);
    return true;
  }
  return false;
}

}  // namespace sunder
