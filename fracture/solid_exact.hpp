// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "fracture/solid_complex.hpp"

namespace sunder {

/// A line in a triangle's plane: one of its edges (that opposite `corner`), or where a plane cuts
/// it. Inside is where its value is above 0: `sign` times n·x - d of the plane.
struct TriangleLine {
  int corner = -1;
  const SolidComplex::Plane* plane = nullptr;
  double sign = 1;
};
/// Corners of a triangle, lattice steps.
using Corners3 = std::array<Vec3, 3>;

/// A number with a bound on what its rounding errors scale with: what the expression would be with
/// all terms taken positive. Expressions of up to some twenty operations deep.
struct Bounded {
  double value = 0, magnitude = 0;
  Bounded() = default;
  explicit Bounded(double v) : value(v), magnitude(std::abs(v)) {}
  Bounded(double v, double m) : value(v), magnitude(m) {}
  bool is_certain() const { return std::abs(value) > 64 * 0x1p-53 * magnitude; }
};
inline Bounded operator+(Bounded a, Bounded b) {
  return {a.value + b.value, a.magnitude + b.magnitude};
}
inline Bounded operator-(Bounded a, Bounded b) {
  return {a.value - b.value, a.magnitude + b.magnitude};
}
inline Bounded operator*(Bounded a, Bounded b) {
  return {a.value * b.value, a.magnitude * b.magnitude};
}

/// n·x - d.
template <class T>
T plane_value(const SolidComplex::Plane& plane, Vec3 x) {
  return T(plane.n.x) * T(x.x) + T(plane.n.y) * T(x.y) + T(plane.n.z) * T(x.z) - T(plane.d);
}
template <class T>
std::array<T, 3> line_values(const Corners3& triangle, const TriangleLine& line) {
  if (line.corner >= 0) {
    std::array<T, 3> unit{T(0.0), T(0.0), T(0.0)};
    unit[static_cast<std::size_t>(line.corner)] = T(1.0);
    return unit;
  }
  std::array<T, 3> values;
  for (std::size_t k = 0; k < 3; ++k)
    values[k] = T(line.sign) * plane_value<T>(*line.plane, triangle[k]);
  return values;
}
/// Where two lines meet, in homogeneous barycentric coordinates.
template <class T>
std::array<T, 3> meeting(const std::array<T, 3>& p, const std::array<T, 3>& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
template <class T>
T value_at(const std::array<T, 3>& point, const std::array<T, 3>& line) {
  return point[0] * line[0] + point[1] * line[1] + point[2] * line[2];
}

/// Where the planes' line cuts the triangle's plane: distance along the line's direction
/// (n of p × n of q), as a quotient.
template <class T>
std::array<T, 2> along_line(const Corners3& t, const SolidComplex::Plane& p,
                            const SolidComplex::Plane& q) {
  const T px(p.n.x), py(p.n.y), pz(p.n.z), qx(q.n.x), qy(q.n.y), qz(q.n.z);
  const T dx = py * qz - pz * qy, dy = pz * qx - px * qz, dz = px * qy - py * qx;
  const auto b = meeting(line_values<T>(t, {-1, &p, 1}), line_values<T>(t, {-1, &q, 1}));
  std::array<T, 2> result{T(0.0), b[0] + b[1] + b[2]};
  for (std::size_t k = 0; k < 3; ++k)
    result[0] = result[0] + b[k] * (dx * T(t[k].x) + dy * T(t[k].y) + dz * T(t[k].z));
  return result;
}

/// Signs in exact arithmetic: of `c` where a and b meet, a and b being sides of a polygon, one
/// after the other counter-clockwise; and of how far t is along the line after s.
int exact_side(const Corners3& triangle, const TriangleLine& a, const TriangleLine& b,
               const TriangleLine& c);
int exact_order(const Corners3& s, const Corners3& t, const SolidComplex::Plane& p,
                const SolidComplex::Plane& q);

/// Value of s where p, q and r meet, and the determinant it is to be divided by.
template <class T>
std::array<T, 2> corner_value(const std::array<const SolidComplex::Plane*, 3>& corner,
                              const SolidComplex::Plane& s) {
  const auto n = [](const SolidComplex::Plane& p) {
    return std::array<T, 3>{T(p.n.x), T(p.n.y), T(p.n.z)};
  };
  const auto a = n(*corner[0]), b = n(*corner[1]), c = n(*corner[2]);
  const auto bc = meeting(b, c), ca = meeting(c, a), ab = meeting(a, b);
  const T det = value_at(a, bc), da(corner[0]->d), db(corner[1]->d), dc(corner[2]->d);
  T value = T(0.0) - T(s.d) * det;
  const auto normal = n(s);
  for (std::size_t k = 0; k < 3; ++k)
    value = value + normal[k] * (da * bc[k] + db * ca[k] + dc * ab[k]);
  return {value, det};
}
/// Exact sign of their quotient.
int exact_corner_side(const std::array<const SolidComplex::Plane*, 3>& corner,
                      const SolidComplex::Plane& s);

}  // namespace sunder
