// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/repair.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "meshing/error.hpp"
#include "meshing/repair_draft.hpp"
#include "meshing/repair_remake.hpp"

namespace sunder {
namespace {

// Vertices of open edges within this share of the diagonal, or this many times the rounding of a
// float at the farthest coordinate, are one.
constexpr double kWeldShare = 1e-6, kWeldRounding = 4 * 0x1p-24;
// Parts that meet in a point are drawn apart by this share of the diagonal.
constexpr double kApartShare = 1e-5;
constexpr int kMostTries = 3;

double weld_distance(const Box3& box, double max_error) {
  double farthest = 0;
  for (const double x : {box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z})
    farthest = std::max(farthest, std::abs(x));
  return std::min(std::max(kWeldShare * diagonal(box), kWeldRounding * farthest), max_error / 2);
}

double volume_about_centroid(const TriMesh& mesh) {
  Vec3 middle;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t)
      middle = middle + (1 / (3.0 * static_cast<double>(mesh.triangles.size()))) * mesh.vertices[v];
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += dot(mesh.vertices[t[0]] - middle,
               cross(mesh.vertices[t[1]] - middle, mesh.vertices[t[2]] - middle));
  return sum / 6;
}

void clean(Draft& draft, const Box3& box, double max_error) {
  join_equal_vertices(draft);
  take_out_flat_faces(draft);
  weld_open_edges(draft, weld_distance(box, max_error));
  take_out_flat_faces(draft);
  turn_flipped_faces(draft);
  fill_holes(draft);
  drop_empty_shells(draft, weld_distance(box, max_error));
  split_vertices(draft, std::min(kApartShare * diagonal(box), max_error / 2));
  turn_shells(draft);
  drop_unused_vertices(draft);
}

[[noreturn]] void give_up(const SurfaceDiagnosis& left, const char* why) {
  throw Error(ErrorCode::geometry,
              std::string("the surface cannot be made a solid's ") + why + ": " +
                  (left.is_solid() ? "nothing encloses a volume" : left.text()));
}

// The surface made anew by a level set; finer where the first is further away than it may be.
double remake(Draft& draft, double max_error) {
  const TriMesh closed = closed_by_fans(draft.mesh());
  const TriangleTree tree(closed);
  double voxel = kVoxelShare * max_error;
  for (int attempt = 1;; ++attempt, voxel /= 2) {
    TriMesh made = solid_surface(level_set(closed, voxel));
    const bool is_near =
        !made.triangles.empty() && farthest(made, tree, max_error / 2) <= max_error;
    if (!is_near && attempt < kMostTries) continue;
    draft.surface.mesh = std::move(made);
    break;
  }
  ModelSurface& s = draft.surface;
  s.corners.assign(3 * s.mesh.triangles.size(), {});
  s.material.assign(s.mesh.triangles.size(), 0);
  draft.is_new.assign(s.mesh.triangles.size(), true);
  char text[120];
  std::snprintf(text, sizeof text, "made anew by a level set with voxels of %.3g m: %zu triangles",
                voxel, s.mesh.triangles.size());
  draft.steps.emplace_back(text);
  return voxel;
}

}  // namespace

Repair repair(const ModelSurface& surface, const RepairParams& params) {
  Repair result;
  result.before = diagnose(surface);
  Draft draft = make_draft(surface);
  drop_bad_numbers(draft);
  if (draft.mesh().triangles.empty()) give_up({}, "because no face is left");
  const ModelSurface given = draft.surface;
  const TriangleTree tree(given.mesh);
  const Box3 box = box_of(given.mesh);
  if (diagonal(box) == 0) give_up(result.before, "because it is a point");
  const double max_error = params.max_error > 0 ? params.max_error : kErrorShare * diagonal(box);
  result.volume_before = volume_about_centroid(given.mesh);

  clean(draft, box, max_error);
  result.after = diagnose(draft.mesh());
  if (!result.after.is_solid() && cut_out_crossings(draft, tree, max_error))
    result.after = diagnose(draft.mesh());
  if (!result.after.is_solid() || draft.mesh().triangles.empty()) {
    if (!params.level_set || draft.mesh().triangles.empty())
      give_up(result.after, "by turning, joining and filling");
    result.voxel = remake(draft, max_error);
    result.after = diagnose(draft.mesh());
    if (!result.after.is_solid() || draft.mesh().triangles.empty())
      give_up(result.after, "even by a level set");
  }
  carry_over(given, tree, draft.surface, draft.is_new);
  result.surface = std::move(draft.surface);
  result.steps = std::move(draft.steps);
  result.volume_after = mass_properties(result.surface.mesh).volume;
  const double spacing = max_error / 2;
  result.hausdorff = std::max(farthest(given.mesh, TriangleTree(result.surface.mesh), spacing),
                              farthest(result.surface.mesh, tree, spacing));
  return result;
}

}  // namespace sunder
