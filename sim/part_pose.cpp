// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/part_pose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sunder {
namespace {

constexpr Surface kSteel{0.3, 0.2};

}  // namespace

/// By the largest component (Shepperd 1978), which keeps all digits.
Quaternion rotation_of(const Axes& axes) {
  const double xx = axes.x.x, yy = axes.y.y, zz = axes.z.z, trace = xx + yy + zz;
  Quaternion q;
  if (trace >= std::max({xx, yy, zz})) {
    q = {axes.y.z - axes.z.y, axes.z.x - axes.x.z, axes.x.y - axes.y.x, 1 + trace};
  } else if (xx >= std::max(yy, zz)) {
    q = {1 + xx - yy - zz, axes.y.x + axes.x.y, axes.z.x + axes.x.z, axes.y.z - axes.z.y};
  } else if (yy >= zz) {
    q = {axes.y.x + axes.x.y, 1 - xx + yy - zz, axes.z.y + axes.y.z, axes.z.x - axes.x.z};
  } else {
    q = {axes.z.x + axes.x.z, axes.z.y + axes.y.z, 1 - xx - yy + zz, axes.x.y - axes.y.x};
  }
  return normalised(q);
}

Pose pose_of(const PartSolid& solid) {
  return {solid.centre, rotation_of(solid.axes)};
}

Surface surface_of(const Frame& frame, std::uint32_t part) {
  const auto members = static_cast<std::uint32_t>(frame.members.size());
  if (part < members) return kSteel;
  const std::uint32_t material = part < frame.wall_part(0)
                                     ? frame.slabs[part - members].material
                                     : frame.walls[part - frame.wall_part(0)].material;
  return {frame.materials[material].friction, frame.materials[material].restitution};
}

double distance_to(const PartSolid& solid, Vec3 point) {
  const Vec3 local = into(solid.axes, point - solid.centre);
  const double beyond = std::max(std::fabs(local.z) - solid.half_length, 0.0);
  double aside = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < solid.hull.size(); ++i) {
    const Vec2 a = solid.hull[i], edge = solid.hull[(i + 1) % solid.hull.size()] - a;
    aside = std::max(aside, -cross(edge, Vec2{local.x, local.y} - a) / length(edge));
  }
  return std::hypot(beyond, std::max(aside, 0.0));
}

}  // namespace sunder
