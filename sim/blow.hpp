// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sim/material.hpp"

namespace sunder {

/// What strikes: a sphere or something taken for one.
struct Striker {
  double mass = 1;                ///< kg
  double radius = 0.1;            ///< of its surface where it touches, m
  double youngs_modulus = 210e9;  ///< Pa
  double poisson_ratio = 0.3;
};

/// How a plate answers a striker, before anything broke; everything in SI units. Two regimes:
/// *global*, when the striker is heavy for the plate and bending waves run further than twice the
/// thickness while it presses (engaged_radius > 2 H): cracks open where the bending stress exceeds
/// the tensile strength. *Local* otherwise: it has to tunnel through, CEA-EDF's ballistic speed.
struct Blow {
  double force = 0;            ///< peak contact force at this speed, N
  double duration = 0;         ///< of the contact, s
  double engaged_radius = 0;   ///< reach of the bending wave in that time, m
  bool is_global = false;
  double ballistic_speed = 0;  ///< normal speed from which it goes through, m/s; infinity: never
  double crack_radius = 0;     ///< bonds nearer to the contact are over-stressed at this speed, m
  double utilisation = 0;      ///< demand by capacity at the contact, 1 breaks
};

/// `speed`: normal component, m/s. A material without strengths (0: not known) never breaks.
///
/// Force: the least of
///   plate impedance  Z v, Z = 8 √(D ρ H)                (point impedance of a plate; derived in
///                                                         docs/accuracy.md, Cremer & Heckl)
///   Hertz            K^0.4 (5/4 m v²)^0.6, K = 4/3 E* √R
///   crushing         4 f_c π R²                           (only when f_c is known)
/// Duration: m/Z + Hertz' 2.87 (m² / (R E*² v))^0.2.
/// Bending stress at distance r in a plate under a step force of that duration:
///   σ(r) = 6/H² · F (1+ν)/(4π) · ln(R_e / r),  R_e² = 4 e^{-γ} √(D/ρH) T   (small-argument form of
/// the cosine integral in the plate's response); at and inside r0 = max(H/2, R/4) it is that at r0.
/// crack_radius solves σ(r) = f_t; global ballistic_speed is the speed for which σ(r0) = f_t.
/// Uses the project's own exp, log and power.
Blow blow_of(const Striker& striker, double speed, double thickness, const Material& material);

/// Demand by capacity of a bond at distance r from the contact: σ(r)/f_t for a global blow, 0 for
/// a local one.
double utilisation_at(const Blow& blow, double distance, double thickness,
                      const Material& material);

/// Speed after perforation (Recht & Ipson 1963): M/(M+m_p) √(V² - V_bl²), 0 at or below V_bl.
double residual_speed(double mass, double plug_mass, double speed, double ballistic_speed);

/// Expected number of radial cracks of a brittle plate hit by a hard sphere: n = C √(V/c)
/// (E h/Γ)^¼ with c = √(E/ρ); √V: Vandenberghe et al., PRL 110, 174302 (2013); the rest is
/// dimensional, C fits their 1 mm PMMA plate (4 cracks at 22.2 m/s, 8 at 56.7). At least 3.
double radial_crack_count(double speed, double thickness, const Material& material);

}  // namespace sunder
