// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/model_surface.hpp"

#include <utility>

namespace sunder {

Vec3 face_normal(const TriMesh& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Vec3 a = mesh.vertices[t[0]];
  const Vec3 n = cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
  const double size = length(n);
  return size > 0 ? (1 / size) * n : Vec3{};
}

ModelSurface flat_surface(TriMesh mesh) {
  ModelSurface surface;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 n = face_normal(mesh, t);
    Corner corner;
    corner.normal = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
    surface.corners.insert(surface.corners.end(), 3, corner);
  }
  surface.material.assign(mesh.triangles.size(), 0);
  surface.materials.emplace_back();
  surface.mesh = std::move(mesh);
  return surface;
}

}  // namespace sunder
