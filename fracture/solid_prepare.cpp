// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/solid_prepare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "meshing/error.hpp"

namespace sunder {
namespace {

// Of a triangle with corners a, b, c nearest to p (Ericson, Real-Time Collision Detection, 5.1.5).
Vec3 nearest_point(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
  const Vec3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  const double scale = 1 / (va + vb + vc);
  return a + (vb * scale) * ab + (vc * scale) * ac;
}

// Against the normal of the triangle that is nearest to a point; the first of several.
Vec3 inwards_at(const TriMesh& mesh, Vec3 p) {
  double least = std::numeric_limits<double>::infinity();
  Vec3 normal{0, 0, 1};
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    const Vec3 n = cross(b - a, c - a);
    const Vec3 away = p - nearest_point(p, a, b, c);
    const double distance = dot(away, away);
    if (!(distance < least) || !(length(n) > 0)) continue;
    least = distance;
    normal = (1 / length(n)) * n;
  }
  return -1.0 * normal;
}

[[noreturn]] void refuse(const SolidModel& solid, const std::string& what) {
  throw Error(ErrorCode::geometry, solid.file + ": " + what);
}

}  // namespace

PreparedSolid prepare_solid(const SolidModel& solid, ModelSurface model, std::uint64_t seed) {
  if (solid.scale != 1)
    for (Vec3& vertex : model.mesh.vertices) vertex = solid.scale * vertex;
  PreparedSolid result{std::move(model), {}};
  const SurfaceDiagnosis diagnosis = diagnose(result.surface);
  if (!diagnosis.is_solid()) {
    if (!solid.repair)
      refuse(solid, "is not a solid: " + diagnosis.text() +
                        "; --repair (in a scene \"repair\": true) makes it one");
    try {
      result.repair = repair(result.surface, {.max_error = solid.max_error});
    } catch (const Error& error) {
      refuse(solid, error.what());
    }
    result.surface = std::move(result.repair->surface);
    result.repair->surface = {};
  }
  for (CarveParams crater : solid.craters) {
    if (crater.into == Vec3{}) crater.into = inwards_at(result.surface.mesh, crater.centre);
    crater.max_error = solid.max_error;
    crater.seed = seed;
    try {
      result.surface = carve(result.surface, crater);
    } catch (const Error& error) {
      refuse(solid, error.what());
    }
  }
  return result;
}

}  // namespace sunder
