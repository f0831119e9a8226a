// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/bond_spring.hpp"

#include <algorithm>
#include <cmath>

namespace sunder {
namespace {

constexpr double kLeastShare = 1e-3;      // of h, by the distance of the two ends
constexpr double kShearShare = 5.0 / 12;  // 5/6 G by E, of a rectangle with G = E/2
constexpr double kHinge = 1e-6;           // of the bending stiffness left at a hinge
constexpr Vec3 kUp{0, 0, 1};              // across the wall's plane

}  // namespace

BondSpring::BondSpring(const Bond& bond, const BondEnds& ends, double thickness,
                       double youngs_modulus)
    : normal_(bond.normal),
      along_(cross(kUp, bond.normal)),
      length_(bond.area / thickness),
      thickness_(thickness) {
  const Vec2 n{normal_.x, normal_.y}, t{along_.x, along_.y};
  // On a hinge the shear acts at the face: no moment there.
  const Vec2 middle = ends.is_hinged ? ends.site_b : 0.5 * (ends.site_a + ends.site_b);
  const Vec2 arm = middle - Vec2{bond.centroid.x, bond.centroid.y};
  ahead_ = dot(arm, n);
  aside_ = dot(arm, t);
  const double h =
      std::max(dot(ends.site_b - ends.site_a, n), kLeastShare * length(ends.at_b - ends.at_a));
  const double e = youngs_modulus / h, area = bond.area, t2 = thickness * thickness;
  const double plate = e * length_ * t2 * thickness / 12;
  // Flexibility h/κGA + h³/12EI; a cantilever's, h/κGA + h³/3EI, on a hinge.
  const double slender = (ends.is_hinged ? 4 : 1) * kShearShare * h * h / t2;
  const double shear = e * area * kShearShare / (1 + slender);
  spring_ = {e * area,
             e * area,
             shear,
             plate,
             (ends.is_hinged ? kHinge : 1) * plate,
             e * area * length_ * length_ / 12};

  set_mode(0, normal_, bond.centroid, ends);
  set_mode(1, along_, bond.centroid, ends);
  set_mode(2, kUp, {middle.x, middle.y, 0}, ends);
  const Vec3 axes[3] = {normal_, along_, kUp};
  for (std::size_t k = 0; k < 3; ++k) {
    const double turn[3] = {axes[k].x, axes[k].y, axes[k].z};
    for (std::size_t i = 0; i < 3; ++i) {
      modes_[3 + k][3 + i] = -turn[i];
      modes_[3 + k][9 + i] = turn[i];
    }
  }
  for (int r = 0; r < 12; ++r)
    for (int c = 0; c <= r; ++c) {
      double sum = 0;
      for (std::size_t m = 0; m < 6; ++m)
        sum += modes_[m][static_cast<std::size_t>(r)] * spring_[m] *
               modes_[m][static_cast<std::size_t>(c)];
      stiffness_(r, c) = stiffness_(c, r) = sum;
    }
}

void BondSpring::set_mode(std::size_t mode, Vec3 direction, Vec3 point, const BondEnds& ends) {
  for (const bool is_b : {false, true}) {
    const Vec3 turn = cross(point - (is_b ? ends.at_b : ends.at_a), direction);
    const double six[6] = {direction.x, direction.y, direction.z, turn.x, turn.y, turn.z};
    for (std::size_t i = 0; i < 6; ++i) modes_[mode][i + (is_b ? 6 : 0)] = is_b ? six[i] : -six[i];
  }
}

BondStress BondSpring::stress(const Twelve& displacements, const Material& material) const {
  double s[6];  // N, V along, V across, T, M about the edge, M about z; as the springs act
  for (std::size_t m = 0; m < 6; ++m) {
    s[m] = 0;
    for (std::size_t i = 0; i < 12; ++i) s[m] += modes_[m][i] * displacements[i];
    s[m] *= spring_[m];
  }
  const double bending = s[4] - ahead_ * s[2];  // at the face
  BondStress result;
  result.force = s[0] * normal_ + s[1] * along_ + s[2] * kUp;
  result.moment = (s[3] + aside_ * s[2]) * normal_ + bending * along_ + s[5] * kUp;

  const double area = length_ * thickness_;
  const double fibre = 6 / area * (std::abs(bending) / thickness_ + std::abs(s[5]) / length_);
  const double most = s[0] / area + fibre, least = s[0] / area - fibre;
  const double shear =
      std::hypot((std::abs(s[1]) + 6 * std::abs(s[3]) / thickness_) / area, s[2] / area);
  const double ft = material.tensile_strength, fc = material.compressive_strength;
  const double root = std::sqrt(fc * ft), friction = (fc - ft) / (2 * root);
  const auto judge = [&](double value, const char* mode) {
    if (value <= result.utilisation) return;
    result.utilisation = value;
    result.mode = mode;
  };
  judge(most / ft, "tension");
  judge((shear + most * friction) / (root / 2), "shear");
  judge(-least / fc, "compression");
  return result;
}

}  // namespace sunder
