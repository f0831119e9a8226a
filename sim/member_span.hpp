// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "sim/joint_strength.hpp"

namespace sunder {

/// What a member carries between its ends: section loads follow from those at its start and from
/// what loads it on the way, by balance alone. Axes of the member, m from its start.
struct MemberSpan {
  struct Point {
    double at = 0;
    Vec3 force, moment;  ///< N, N m
  };
  double length = 0;
  JointLoad start;            ///< as JointLoad: what lies beyond gives the positive cut face
  Vec3 load_a, load_b;        ///< N/m at start and end, linear in between
  Vec3 turn;                  ///< N m/m, the same everywhere
  std::vector<Point> points;  ///< ascending
};

/// Section load there, before the point loads at that place or beyond them.
JointLoad load_at(const MemberSpan& span, double at, bool beyond);

/// Where a member fails between its ends.
struct WeakPlace {
  double at = 0;  ///< m from the start
  double utilisation = 0;
  std::string_view component;
};

/// The most utilised place at least `margin` from both ends where the utilisation has a peak of 1
/// or more. Peaks are looked for where point loads are and where a sum of N, M_y and M_z, each by
/// its resistance, has an extreme: shear 0 for one bending moment. So they are exact for the rules
/// that add up ratios, and for any rule under bending about one axis. A constant or monotonous
/// utilisation has none: that is for the end joints. O(point loads²).
std::optional<WeakPlace> weakest_inside(const MemberSpan& span, const JointStrength& strength,
                                        double margin);

/// False: a quick bound says that no place reaches a utilisation of 1. O(point loads).
bool may_fail_inside(const MemberSpan& span, const JointStrength& strength);

}  // namespace sunder
