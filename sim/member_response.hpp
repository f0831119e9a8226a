// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sim/beam_element.hpp"

namespace sunder {

/// A beam element without arms, as the few numbers that make its end forces: quick to apply.
struct MemberResponse {
  /// Moments at the ends by the ends' rotations against the chord, N m/rad, and by a uniform load
  /// across, N m per N/m.
  struct Bending {
    double aa = 0, ab = 0, bb = 0;
    double load_a = 0, load_b = 0;
  };
  Axes axes;
  double length = 0;
  double stretch = 0, twist = 0;  ///< N/m, N m/rad
  Bending about_y, about_z;
};

/// The same forces as stiffness_of and fixed_end_of give, hinges included.
MemberResponse response_of(const BeamElement& element);
/// Force of the nodes on the element.
Twelve end_forces(const MemberResponse& response, const Twelve& displacements);
/// Adds what holds the ends under a uniform load, world, N/m.
void add_uniform(const MemberResponse& response, Vec3 load, Twelve& sum);

}  // namespace sunder
