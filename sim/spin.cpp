// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/spin.hpp"

#include <algorithm>
#include <cmath>

#include "meshing/trig.hpp"

namespace sunder {
namespace {

constexpr double kMaxTurn = 0.1;     // rad per Runge–Kutta step
constexpr double kSmallTurn = 1e-3;  // rad, below it the midpoint rule's error is rounding
constexpr double kMaxSteps = 256;
constexpr double kMaxDrift = 1e-3;  // of the energy in one call

Quaternion plus(const Quaternion& q, double s, const Quaternion& d) {
  return {q.x + s * d.x, q.y + s * d.y, q.z + s * d.z, q.w + s * d.w};
}

Vec3 spin_of(const Quaternion& q, const SymMat3& inverse_inertia, Vec3 l) {
  const Axes r = axes_of(normalised(q));
  return r * (inverse_inertia * into(r, l));
}

Quaternion rate(const Quaternion& q, const SymMat3& inverse_inertia, Vec3 l) {
  const Vec3 w = 0.5 * spin_of(q, inverse_inertia, l);
  return Quaternion{w.x, w.y, w.z, 0} * q;
}

Quaternion runge_kutta(const Quaternion& q, const SymMat3& i, Vec3 l, double h) {
  const Quaternion k1 = rate(q, i, l);
  const Quaternion k2 = rate(plus(q, h / 2, k1), i, l);
  const Quaternion k3 = rate(plus(q, h / 2, k2), i, l);
  const Quaternion k4 = rate(plus(q, h, k3), i, l);
  Quaternion sum = plus(k1, 2, k2);
  sum = plus(plus(sum, 2, k3), 1, k4);
  return normalised(plus(q, h / 6, sum));
}

/// Too fast to follow: the turn about L alone, which keeps L and the energy exactly.
Quaternion precessed(const Quaternion& q, Vec3 spin, Vec3 l, double dt) {
  const double size = length(l);
  const Vec3 axis = (1 / size) * l;
  constexpr double kTurn = 6.283185307179586;
  const double turns = dot(spin, axis) * dt / kTurn;
  const Vec2 half = unit_at_turns((turns - std::floor(turns)) / 2);
  return normalised(Quaternion{half.y * axis.x, half.y * axis.y, half.y * axis.z, half.x} * q);
}

}  // namespace

Axes axes_of(const Quaternion& q) {
  const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  return {{1 - 2 * (yy + zz), 2 * (xy + wz), 2 * (xz - wy)},
          {2 * (xy - wz), 1 - 2 * (xx + zz), 2 * (yz + wx)},
          {2 * (xz + wy), 2 * (yz - wx), 1 - 2 * (xx + yy)}};
}

Quaternion normalised(const Quaternion& q) {
  const double s = 1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {s * q.x, s * q.y, s * q.z, s * q.w};
}

Quaternion turned(const Quaternion& rotation, Vec3 angle) {
  return normalised(Quaternion{angle.x / 2, angle.y / 2, angle.z / 2, 1} * rotation);
}

Pose small_motion(Vec3 centre, Vec3 way, Vec3 angle) {
  const Quaternion rotation = turned({}, angle);
  return {centre + way - rotate(rotation, centre), rotation};
}

SymMat3 inverse(const SymMat3& m) {
  const double xx = m.yy * m.zz - m.yz * m.yz;
  const double xy = m.xz * m.yz - m.xy * m.zz;
  const double xz = m.xy * m.yz - m.xz * m.yy;
  const double s = 1 / (m.xx * xx + m.xy * xy + m.xz * xz);
  return {.xx = s * xx,
          .yy = s * (m.xx * m.zz - m.xz * m.xz),
          .zz = s * (m.xx * m.yy - m.xy * m.xy),
          .xy = s * xy,
          .xz = s * xz,
          .yz = s * (m.xy * m.xz - m.xx * m.yz)};
}

SymMat3 rotated(const Axes& r, const SymMat3& m) {
  // Columns of R M; then rows against R.
  const Vec3 a = r * Vec3{m.xx, m.xy, m.xz};
  const Vec3 b = r * Vec3{m.xy, m.yy, m.yz};
  const Vec3 c = r * Vec3{m.xz, m.yz, m.zz};
  return {.xx = a.x * r.x.x + b.x * r.y.x + c.x * r.z.x,
          .yy = a.y * r.x.y + b.y * r.y.y + c.y * r.z.y,
          .zz = a.z * r.x.z + b.z * r.y.z + c.z * r.z.z,
          .xy = a.x * r.x.y + b.x * r.y.y + c.x * r.z.y,
          .xz = a.x * r.x.z + b.x * r.y.z + c.x * r.z.z,
          .yz = a.y * r.x.z + b.y * r.y.z + c.y * r.z.z};
}

Quaternion spun(Quaternion q, const SymMat3& inverse_inertia, Vec3 l, double dt) {
  const Vec3 spin = spin_of(q, inverse_inertia, l);
  const double energy = dot(spin, l) / 2;
  if (!(energy > 0)) return q;
  // A bound of the spin while energy lasts: needles turn far faster about their axis than across.
  const double turn =
      dt * std::sqrt(2 * energy * (inverse_inertia.xx + inverse_inertia.yy + inverse_inertia.zz));
  if (turn < kSmallTurn) {
    const Quaternion half = plus(q, dt / 2, rate(q, inverse_inertia, l));
    return normalised(plus(q, dt, rate(half, inverse_inertia, l)));
  }
  const double steps = std::ceil(turn / kMaxTurn);
  if (steps > kMaxSteps) return precessed(q, spin, l, dt);
  Quaternion end = q;
  for (int i = 0; i < static_cast<int>(steps); ++i) {
    end = runge_kutta(end, inverse_inertia, l, dt / steps);
  }
  const double drift = dot(spin_of(end, inverse_inertia, l), l) / 2 - energy;
  return std::fabs(drift) < kMaxDrift * energy ? end : precessed(q, spin, l, dt);
}

}  // namespace sunder
