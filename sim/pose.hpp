// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fracture/wall.hpp"
#include "meshing/vec.hpp"

namespace sunder {

/// Where a frame is: a point p of it is at rotate(rotation, p) + position.
struct Pose {
  Vec3 position;
  Quaternion rotation;
  friend bool operator==(const Pose&, const Pose&) = default;
};

inline Vec3 operator*(const Pose& pose, Vec3 point) {
  return rotate(pose.rotation, point) + pose.position;
}

constexpr Quaternion conjugate(const Quaternion& q) { return {-q.x, -q.y, -q.z, q.w}; }
constexpr Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
          a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

/// The inverse motion.
inline Pose inverse(const Pose& pose) {
  const Quaternion back = conjugate(pose.rotation);
  return {-1.0 * rotate(back, pose.position), back};
}
inline Pose operator*(const Pose& a, const Pose& b) {
  return {a * b.position, a.rotation * b.rotation};
}

}  // namespace sunder
