// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "fracture/solid_cut.hpp"
#include "fracture/solid_model.hpp"
#include "meshing/tri_mesh.hpp"

namespace sunder {

/// A smooth displacement of space that turns planes into rough or wavy faces: the solid is moved
/// by it, cut by planes, and moved back. It is one to one, since it moves near points by nearly the
/// same (Lipschitz constant below 1, to which roughness and amplitude are cut down if need be).
class SolidWarp {
 public:
  /// `chunk`: size of a typical chunk, m; `share` of the roughness and amplitude that
  /// are asked for and one to one.
  SolidWarp(const SolidModel& solid, double chunk, double share, std::uint64_t seed);
  bool is_none() const { return roughness_ == 0 && amplitude_ == 0; }
  double roughness() const { return roughness_; }  ///< m, most
  double amplitude() const { return amplitude_; }  ///< m, most
  double edge() const;                             ///< m: longest edge that shows the bumps
  Vec3 warped(Vec3 place) const { return place + displacement(place); }
  Vec3 unwarped(Vec3 place) const;

 private:
  Vec3 displacement(Vec3 place) const;
  Vec3 noise(Vec3 place) const;
  double roughness_ = 0, size_ = 1, amplitude_ = 0, wavelength_ = 1;
  Vec3 waves_;  ///< 1 for axes with slices
  std::array<double, 6> phases_{};  ///< of their waves, two for each axis, turns
  std::uint64_t seed_;
};

/// A mesh with no edge above `edge` (m), and the triangle each of its triangles is part of: edges
/// are halved, in both their triangles. Throws Error{geometry} for more than 2^24 triangles.
struct FineMesh {
  TriMesh mesh;
  std::vector<std::uint32_t> parents;
};
FineMesh refined(const TriMesh& mesh, double edge);

/// The same for a cut solid's facets, but for the edges that they share with the surface.
void refine_facets(CutSolid& cut, double edge);

}  // namespace sunder
