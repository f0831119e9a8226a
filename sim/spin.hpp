// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/vec.hpp"
#include "sim/pose.hpp"

namespace sunder {

/// Rotation as its three columns: the images of the x, y and z axis.
struct Axes {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};
constexpr Vec3 operator*(const Axes& r, Vec3 v) {
  return {r.x.x * v.x + r.y.x * v.y + r.z.x * v.z, r.x.y * v.x + r.y.y * v.y + r.z.y * v.z,
          r.x.z * v.x + r.y.z * v.y + r.z.z * v.z};
}
/// The inverse rotation.
constexpr Vec3 into(const Axes& r, Vec3 v) {
  return {dot(r.x, v), dot(r.y, v), dot(r.z, v)};
}
Axes axes_of(const Quaternion& rotation);
Quaternion normalised(const Quaternion& q);
/// `rotation` followed by the small rotation vector `angle` (rad, world axes), exact to O(angle³).
Quaternion turned(const Quaternion& rotation, Vec3 angle);
/// Moves a centre by `way` and turns about it by the small rotation vector.
Pose small_motion(Vec3 centre, Vec3 way, Vec3 angle);

constexpr Vec3 operator*(const SymMat3& m, Vec3 v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}
/// Of a positive definite matrix.
SymMat3 inverse(const SymMat3& m);
/// R M Rᵀ.
SymMat3 rotated(const Axes& r, const SymMat3& m);

/// Attitude after `dt` of free rotation at constant angular momentum (world): fourth-order
/// Runge–Kutta on q' = ½ ω q, ω = R I⁻¹ Rᵀ L, at most 0.1 rad per stage; second order is enough
/// below 1e-3 rad. What spins too fast to follow turns about L alone, which keeps L and energy.
Quaternion spun(Quaternion rotation, const SymMat3& inverse_inertia, Vec3 angular_momentum,
                double dt);

}  // namespace sunder
