// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "meshing/vec.hpp"
#include "sim/spin.hpp"

namespace sunder {

/// Six numbers of a node: displacement and rotation (m, rad), or force and moment (N, N m); world.
using Six = std::array<double, 6>;
using Twelve = std::array<double, 12>;  ///< of the two ends of an element
/// Symmetric 12 × 12, row by row: of the two ends of an element.
struct Matrix12 {
  std::array<double, 144> at{};
  double& operator()(int row, int column) {
    return at[static_cast<std::size_t>(12 * row + column)];
  }
  double operator()(int row, int column) const {
    return at[static_cast<std::size_t>(12 * row + column)];
  }
};

/// A straight prismatic beam with shear (Timoshenko) and St. Venant torsion. Sign of section forces
/// as JointLoad: those that the end beyond gives the positive cut face, tension positive.
struct BeamElement {
  double length = 0;        ///< of the elastic part, m
  Axes axes;                ///< world; x along, y and z principal
  double ea = 0;            ///< N
  double eiy = 0, eiz = 0;  ///< bending about y and z, N m²
  double gj = 0;            ///< N m²
  double gay = 0, gaz = 0;  ///< shear along y and z, N; 0: no shear deformation (Euler–Bernoulli)
  double mass = 0;          ///< kg/m
  /// Rotary inertia about x, kg m²/m; about y and z its shares as eiy : eiz (of one material I_x =
  /// I_y + I_z), so that a piece's inertia turns with it.
  double polar = 0;
  /// Rigid arms from the nodes to the ends of the elastic part, world, m.
  Vec3 arm_a, arm_b;
  /// Springs between the ends and the nodes about local x, y, z, N m/rad; infinity: rigid, 0: free.
  Vec3 spring_a{kRigid, kRigid, kRigid}, spring_b{kRigid, kRigid, kRigid};
  static constexpr double kRigid = 1e300;
};

/// A load on an element.
struct BeamLoad {
  Vec3 uniform;  ///< N per m of its elastic length, world
  struct Point {
    double at = 0;  ///< from the start of the elastic part, m
    Vec3 force;     ///< world, N
    Vec3 moment;    ///< world, N m
  };
  std::vector<Point> points;
};

/// Force of the nodes on the element = stiffness × displacements (at the nodes, world) + fixed_end.
/// Exact for the differential equation of the Timoshenko beam (Przemieniecki 1968, section 5.6).
Matrix12 stiffness_of(const BeamElement& element);
/// Forces of the nodes on an element whose nodes are held: what balances its load.
Twelve fixed_end_of(const BeamElement& element, const BeamLoad& load);
/// Of several loads, each alone, into as many results: the same numbers, but what they share of the
/// element is made once.
void fixed_ends_of(const BeamElement& element, std::span<const BeamLoad> loads,
                   std::span<Twelve> results);
/// Geometric stiffness for an axial force (tension positive), consistent with the cubic shapes that
/// shear and springs leave; arms turn with their nodes under that force.
Matrix12 geometric_stiffness_of(const BeamElement& element, double axial);
/// Consistent mass (the same shapes, translation and rotation; arms weigh nothing), so that a rigid
/// motion has exactly the momentum and angular momentum of the rod.
Matrix12 mass_of(const BeamElement& element);

/// Section force (N, V_y, V_z) and moment (T, M_y, M_z), local axes, at both ends of the elastic
/// part.
struct SectionForces {
  Vec3 force_a, moment_a, force_b, moment_b;
};
SectionForces section_forces(const BeamElement& element, const Twelve& displacements,
                             const BeamLoad& load);

}  // namespace sunder
