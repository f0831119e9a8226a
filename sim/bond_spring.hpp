// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "fracture/bonds.hpp"
#include "sim/beam_element.hpp"
#include "sim/material.hpp"

namespace sunder {

/// Stress in a bond: worst over its face.
struct BondStress {
  Vec3 force, moment;      ///< on chunk a, about the bond's centroid, wall frame, N, N m
  double utilisation = 0;  ///< demand by strength; 1 breaks
  const char* mode = "";   ///< "tension", "shear", "compression"; "": no stress
};

/// The two ends of a bond: points about which displacement and rotation are told, and sites. The
/// world's site is that of chunk a, put perpendicularly onto the face.
struct BondEnds {
  Vec3 at_a, at_b;
  Vec2 site_a, site_b;
  /// The face turns freely about its long axis, as on a hinge; a millionth of its stiffness stays,
  /// so that what hangs on hinges in one line can be solved.
  bool is_hinged = false;
};

/// The springs of a bond's face, L long and t thick, between rigid chunks whose sites are h apart:
/// those of the slice of homogeneous material, Poisson's ratio 0, that reaches from site to site
/// (Kawai 1978; Bolander and Saito 1998). In the plane of the wall they act at the face's centroid:
/// E A/h along and across, E t L³/12h in rotation about z. Across the plane the slice is a beam,
/// its springs act half way between the sites: E L t³/12h in bending; the same in torsion, that of
/// a plate, D (1 - ν) twice as uniform as St. Venant's; in shear 5/6 G A/h with G = E/2, in series
/// with the beam's own bending h³/12EI, which a single bending spring leaves out (the residual
/// bending flexibility of MacNeal 1978). Then on Voronoi cells every uniform strain and every
/// uniform curvature is a solution.
class BondSpring {
 public:
  /// h is at least a thousandth of the distance of the two points: a flat cell stays solvable.
  BondSpring(const Bond& bond, const BondEnds& ends, double thickness, double youngs_modulus);

  /// Force of the ends on the spring = stiffness × displacements of a and b.
  const Matrix12& stiffness() const { return stiffness_; }
  /// Stress at these displacements; utilisation by the material's strengths:
  /// tension σ/f_t at the extreme fibre; crushing -σ/f_c at the other; shear by Mohr and Coulomb,
  /// (τ + σ tan φ)/c, with the line that touches the circles of the two strengths (Mohr's envelope;
  /// Chen 1982, section 5.3): c = √(f_c f_t)/2, tan φ = (f_c - f_t)/2√(f_c f_t).
  /// σ = N/A ± M/W about both axes, τ = √((V_t/A + 6T/L t²)² + (V_z/A)²).
  BondStress stress(const Twelve& displacements, const Material& material) const;

 private:
  /// A spring's stretch is b's motion at a point, in a direction, less a's.
  void set_mode(std::size_t mode, Vec3 direction, Vec3 point, const BondEnds& ends);

  std::array<std::array<double, 12>, 6> modes_{};  ///< displacements → stretch of each spring
  std::array<double, 6> spring_{};                 ///< N/m and N m/rad
  Matrix12 stiffness_;
  Vec3 normal_, along_;
  double length_ = 0, thickness_ = 0;
  double ahead_ = 0, aside_ = 0;  ///< where the springs across the plane act, from the centroid
};

}  // namespace sunder
