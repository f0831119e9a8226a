// SPDX-License-Identifier: GPL-3.0-or-later
// Six ways to deform: stretch, twist, and in either plane the rotations of the two ends against the
// chord; shears follow from the moments.
#include "sim/member_response.hpp"

namespace sunder {
namespace {

/// a · (3 × 3 block at row, column) · a.
double quadratic(const Matrix12& matrix, int row, int column, Vec3 a) {
  const double v[3] = {a.x, a.y, a.z};
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) sum += v[i] * matrix(row + i, column + j) * v[j];
  return sum;
}

Vec3 three(const Twelve& v, std::size_t first) {
  return {v[first], v[first + 1], v[first + 2]};
}

void add_to(Twelve& v, std::size_t first, Vec3 value) {
  v[first] += value.x;
  v[first + 1] += value.y;
  v[first + 2] += value.z;
}

MemberResponse::Bending bending_of(const BeamElement& element, const Matrix12& stiffness, Vec3 axis,
                                   Vec3 across) {
  const Twelve held = fixed_end_of(element, {.uniform = across, .points = {}});
  return {.aa = quadratic(stiffness, 3, 3, axis),
          .ab = quadratic(stiffness, 3, 9, axis),
          .bb = quadratic(stiffness, 9, 9, axis),
          .load_a = dot(axis, three(held, 3)),
          .load_b = dot(axis, three(held, 9))};
}

}  // namespace

MemberResponse response_of(const BeamElement& element) {
  const Matrix12 stiffness = stiffness_of(element);
  const Axes& axes = element.axes;
  return {.axes = axes,
          .length = element.length,
          .stretch = quadratic(stiffness, 0, 0, axes.x),
          .twist = quadratic(stiffness, 3, 3, axes.x),
          .about_y = bending_of(element, stiffness, axes.y, axes.z),
          .about_z = bending_of(element, stiffness, axes.z, axes.y)};
}

Twelve end_forces(const MemberResponse& r, const Twelve& u) {
  const Vec3 apart = into(r.axes, three(u, 6) - three(u, 0));
  const Vec3 turn_a = into(r.axes, three(u, 3)), turn_b = into(r.axes, three(u, 9));
  const double chord_y = -apart.z / r.length, chord_z = apart.y / r.length;
  const double ya = turn_a.y - chord_y, yb = turn_b.y - chord_y;
  const double za = turn_a.z - chord_z, zb = turn_b.z - chord_z;
  const Vec3 moment_a{r.twist * (turn_a.x - turn_b.x), r.about_y.aa * ya + r.about_y.ab * yb,
                      r.about_z.aa * za + r.about_z.ab * zb};
  const Vec3 moment_b{-moment_a.x, r.about_y.ab * ya + r.about_y.bb * yb,
                      r.about_z.ab * za + r.about_z.bb * zb};
  const Vec3 force = r.axes * Vec3{r.stretch * apart.x, -(moment_a.z + moment_b.z) / r.length,
                                   (moment_a.y + moment_b.y) / r.length};
  Twelve result{};
  add_to(result, 0, -1 * force);
  add_to(result, 3, r.axes * moment_a);
  add_to(result, 6, force);
  add_to(result, 9, r.axes * moment_b);
  return result;
}

void add_uniform(const MemberResponse& r, Vec3 load, Twelve& sum) {
  const Vec3 q = into(r.axes, load);
  const Vec3 moment_a{0, r.about_y.load_a * q.z, r.about_z.load_a * q.y};
  const Vec3 moment_b{0, r.about_y.load_b * q.z, r.about_z.load_b * q.y};
  const Vec3 half = -r.length / 2 * load;
  const Vec3 shear =
      r.axes * Vec3{0, -(moment_a.z + moment_b.z) / r.length, (moment_a.y + moment_b.y) / r.length};
  add_to(sum, 0, half - shear);
  add_to(sum, 3, r.axes * moment_a);
  add_to(sum, 6, half + shear);
  add_to(sum, 9, r.axes * moment_b);
}

}  // namespace sunder
