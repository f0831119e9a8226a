// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "meshing/vec.hpp"
#include "sim/touch.hpp"

namespace sunder {

/// What the solver needs of a body. Number 0 of a table is whatever does not move.
struct SolverBody {
  Vec3 velocity, spin;
  Vec3 push, turn;  ///< displacement that removes overlap, m and rad; leaves velocities alone
  double inverse_mass = 0;
  SymMat3 inverse_inertia;  ///< world axes
};

/// An impulse's direction at a contact and what it does to the two bodies.
struct ContactRow {
  Vec3 direction;
  Vec3 arm_a, arm_b;    ///< r × direction
  Vec3 spin_a, spin_b;  ///< I⁻¹ of it
};

/// One contact point.
struct ContactPoint {
  std::uint32_t a = 0, b = 0;  ///< in the table of bodies
  ContactRow normal, along, across;
  double normal_mass = 0;               ///< 1 / effective inverse mass
  double k_aa = 0, k_ac = 0, k_cc = 0;  ///< inverse of the tangential 2×2 inverse mass
  double slide_mass = 0;                ///< 1 / its larger eigenvalue
  double friction = 0;
  double bound = 0;     ///< the normal velocity may not fall below it, m/s
  double push_out = 0;  ///< overlap to remove in this step, m
  double impulse = 0, impulse_along = 0, impulse_across = 0;  ///< so far, N s
  /// Impulses that acted before the moment of impact: applied by warm_start, not solved for.
  double given = 0, given_along = 0, given_across = 0;
  double push_impulse = 0;
};

/// Sets directions, arms and masses; `arm_a`, `arm_b` lead from the centres of mass to the point.
void prepare(ContactPoint& point, std::span<const SolverBody> bodies, Vec3 normal, Vec3 arm_a,
             Vec3 arm_b);
/// Applies the impulses that the points already carry, and the given ones.
void warm_start(std::span<const ContactPoint> points, std::span<SolverBody> bodies);
/// Sequential impulses (Catto 2005), there and back: first friction, as one vector within the
/// Coulomb cone, then the normal impulse, accumulated and never below 0.
void solve_velocities(std::span<ContactPoint> points, std::span<SolverBody> bodies, int sweeps);
/// Fills push and turn.
void solve_overlaps(std::span<ContactPoint> points, std::span<SolverBody> bodies, int sweeps);

}  // namespace sunder
