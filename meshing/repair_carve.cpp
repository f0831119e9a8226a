// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "meshing/repair.hpp"
#include "meshing/repair_draft.hpp"
#include "meshing/repair_remake.hpp"

namespace sunder {
namespace {

// In [-1, 1], smooth, with bumps of about one unit: values at whole points, cubic between.
double bumps(Vec3 p, std::uint64_t seed) {
  const Vec3 base{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const Vec3 t{ease(p.x - base.x), ease(p.y - base.y), ease(p.z - base.z)};
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const int x = c & 1, y = c >> 1 & 1, z = c >> 2;
    const auto key = [](double at) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(at)) & 0x1FFFFF;
    };
    const std::uint64_t cell = key(base.x + x) << 42 | key(base.y + y) << 21 | key(base.z + z);
    sum += (x ? t.x : 1 - t.x) * (y ? t.y : 1 - t.y) * (z ? t.z : 1 - t.z) *
           (2 * random_unit(seed, cell) - 1);
  }
  return sum;
}

// Signed distance of the crater's shape: a ball, or the part of one below and just above an opening
// of the crater's radius.
struct Crater {
  const CarveParams& params;
  Vec3 centre;  // of the ball
  double radius = 0;
  double bump = 0;  // size of the roughness, m

  explicit Crater(const CarveParams& p) : params(p), centre(p.centre), radius(p.radius) {
    if (p.depth > 0) {
      radius = (p.radius * p.radius + p.depth * p.depth) / (2 * p.depth);
      centre = p.centre - (radius - p.depth) * p.into;
    }
    bump = std::max(p.radius / 4, p.roughness);
  }

  double distance(Vec3 p) const {
    double d = length(p - centre) - radius;
    if (params.roughness > 0)
      d += params.roughness * bumps((1 / bump) * (p - params.centre), params.seed);
    if (params.depth == 0) return d;
    const Vec3 from = p - params.centre;
    const double along = dot(from, params.into);
    if (along > 0) return d;
    const double beside = length(from - along * params.into) - params.radius;
    return std::max({d, beside, -along - params.radius});
  }

  Box3 box() const {
    const double reach = std::max(params.radius, params.depth) + params.roughness;
    const double ball = params.depth > 0 && params.depth < params.radius
                            ? reach * std::sqrt(2.0)
                            : std::max(reach, radius + length(centre - params.centre));
    const Vec3 r{ball, ball, ball};
    return {params.centre - r, params.centre + r};
  }
};

void check_params(const CarveParams& p) {
  const auto refuse = [](const char* what, double value, const char* valid) {
    char text[160];
    std::snprintf(text, sizeof text, "carve: %s = %g, must be %s", what, value, valid);
    throw Error(ErrorCode::geometry, text);
  };
  if (!(p.radius > 0)) refuse("radius", p.radius, "above 0 m");
  if (!(p.depth >= 0)) refuse("depth", p.depth, "at least 0 m");
  if (!(p.roughness >= 0 && p.roughness < p.radius))
    refuse("roughness", p.roughness, "at least 0 m and below the radius");
  if (!(std::abs(length(p.into) - 1) < 1e-6)) refuse("length of into", length(p.into), "1");
}

}  // namespace

ModelSurface carve(const ModelSurface& surface, const CarveParams& params) {
  check_params(params);
  if (const auto diagnosis = diagnose(surface); !diagnosis.is_solid())
    throw Error(ErrorCode::geometry, "carve: the surface is not a solid's: " + diagnosis.text());
  const double error =
      params.max_error > 0 ? params.max_error : kErrorShare * diagonal(box_of(surface.mesh));
  const Crater crater(params);
  LevelSet set = level_set(surface.mesh, kVoxelShare * error);
  take_away(set, crater.box(), [&](Vec3 p) { return crater.distance(p); });
  ModelSurface made = surface;
  made.mesh = solid_surface(set);
  if (made.mesh.triangles.empty())
    throw Error(ErrorCode::geometry, "carve: nothing of the solid is left");
  made.corners.assign(3 * made.mesh.triangles.size(), {});
  made.material.assign(made.mesh.triangles.size(), 0);
  carry_over(surface, TriangleTree(surface.mesh), made,
             std::vector<bool>(made.mesh.triangles.size(), true));
  return made;
}

}  // namespace sunder
