// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "meshing/vec.hpp"

namespace sunder {

/// Triangle mesh with shared vertices; counter-clockwise seen from outside. Metres.
struct TriMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Volume (m³), centroid (m) and inertia about the centroid at density 1 (m⁵) of a closed mesh, by
/// the exact polyhedral formulas (Mirtich 1996; Eberly, "Polyhedral Mass Properties"). Summed about
/// the first vertex, so that a far origin costs no digits. O(triangles).
struct MassProperties {
  double volume = 0;
  Vec3 centroid;
  SymMat3 inertia;
};
MassProperties mass_properties(const TriMesh& mesh);

/// What is wrong with a mesh as a solid; all zero for a sound one. Edges are matched by vertex
/// index: a directed edge must occur once, and its reverse once.
struct MeshDefects {
  std::uint64_t open_edges = 0;            ///< directed edges without their reverse
  std::uint64_t nonmanifold_edges = 0;     ///< directed edges that occur more than once
  std::uint64_t degenerate_triangles = 0;  ///< two equal corners, or no area at all
  std::uint64_t bad_indices = 0;
  bool inside_out = false;  ///< closed, but the volume is not above 0
  friend bool operator==(const MeshDefects&, const MeshDefects&) = default;
};
MeshDefects check(const TriMesh& mesh);

}  // namespace sunder
