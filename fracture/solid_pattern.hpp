// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "fracture/solid_complex.hpp"
#include "fracture/solid_model.hpp"
#include "meshing/tri_mesh.hpp"

namespace sunder {

/// The cells of a solid's pattern in its frame; the same for the same seed. Throws Error{geometry}
/// for parameters out of range and patterns of more than kMaxSolidCells cells.
SolidComplex make_solid_complex(const SolidPatternParams& pattern, const TriMesh& mesh,
                                const SolidFrame& frame, std::uint64_t seed);

/// Most cells of a solid's pattern: about 3 kB each while it is cut.
constexpr std::int64_t kMaxSolidCells = 1 << 20;

/// Points that are surely or very nearly inside a closed mesh, by parity along z: for placing
/// sites, not for deciding topology. O(sqrt(triangles)) a query for even meshes.
class InsideTest {
 public:
  explicit InsideTest(const TriMesh& mesh);
  bool contains(Vec3 point) const;
  Vec3 low() const { return low_; }
  Vec3 high() const { return high_; }

 private:
  std::uint32_t column(double share, std::uint32_t limit) const;
  const TriMesh& mesh_;
  Vec3 low_, high_;
  std::uint32_t columns_ = 1;  ///< per axis
  std::vector<std::uint32_t> begin_, triangles_;
};

}  // namespace sunder
