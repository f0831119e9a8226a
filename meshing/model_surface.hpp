// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "meshing/tri_mesh.hpp"

namespace sunder {

/// How a face looks, as its file says (glTF's metallic-roughness model; linear colour).
struct SurfaceMaterial {
  std::string name;  ///< empty: the file gives none, and it looks as what the solid consists of
  std::array<float, 4> base_colour{0.8f, 0.8f, 0.8f, 1};
  float metallic = 0, roughness = 0.9f;
  std::string texture;  ///< path of the base colour's image relative to the model; empty: none
  friend bool operator==(const SurfaceMaterial&, const SurfaceMaterial&) = default;
};

/// What a triangle carries at one of its corners.
struct Corner {
  std::array<float, 3> normal{};  ///< unit
  std::array<float, 2> uv{};
  std::array<float, 4> colour{1, 1, 1, 1};  ///< linear
};

/// The surface of a body as a file has it: triangles that share vertices by index (vertices of one
/// place are one vertex: equal bits, never a tolerance), with what they carry. A solid one is
/// closed, faces outwards and does not meet itself (see diagnose).
struct ModelSurface {
  TriMesh mesh;
  std::vector<Corner> corners;          ///< three per triangle
  std::vector<std::uint32_t> material;  ///< per triangle, an index of `materials`
  std::vector<SurfaceMaterial> materials;
  bool has_uvs = false, has_colours = false;
};

/// A mesh as a surface of one material, each face with the normal of its plane.
ModelSurface flat_surface(TriMesh mesh);
/// Unit normal of a triangle; 0 of one without area.
Vec3 face_normal(const TriMesh& mesh, std::size_t triangle);

}  // namespace sunder
