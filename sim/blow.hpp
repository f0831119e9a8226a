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
/// *global*, when the striker is heavy for the plate (heavier than its disc of radius H): bending
/// waves run further than twice the thickness while it presses, and cracks open where the bending
/// stress exceeds the tensile strength. *Local* otherwise: it has to tunnel through.
struct Blow {
  double force = 0;            ///< peak contact force at this speed, N
  double duration = 0;         ///< of the contact, s
  double engaged_radius = 0;   ///< reach R_e of the bending wave in that time, m
  bool is_global = false;      ///< mass > π ρ H³, whatever the speed
  double ballistic_speed = 0;  ///< normal speed from which it breaks (global) or perforates
                               ///< (local), m/s; infinity: never
  double crack_radius = 0;     ///< bonds nearer to the contact are over-stressed at this speed, m
  double utilisation = 0;      ///< demand by capacity at the contact, 1 breaks
};

/// `speed`: normal component, m/s; at or below 0 there is no force. A material without strengths
/// (0: not known) never breaks; of one strength alone the other is taken as f_c = 10 f_t.
/// Without a stiffness nothing is known of force and bending: 0, and the blow is local.
///
/// Force: the least of
///   plate impedance  Z v, Z = 8 √(D ρ H)                (point impedance of a plate; derived in
///                                                         docs/impact.md, Cremer & Heckl)
///   Hertz            K^0.4 (5/4 m v²)^0.6, K = 4/3 E* √R
///   crushing         4 f_c π R²                           (only when f_c is known)
/// Duration: m/Z + Hertz' 2.87 (m² / (R E*² v))^0.2; once it crushes, from the speed v_c on, that
/// of v_c and m (v - v_c) / force more, the time that the rest of the momentum takes.
/// Bending stress at distance r in a plate under a step force of that duration:
///   σ(r) = 6/H² · F (1+ν)/(4π) · ln(R_e / r),  R_e² = 4 e^{-γ} √(D/ρH) T   (small-argument form of
/// the cosine integral in the plate's response); at and inside r0 = min(max(H/2, R/4), R_e/4) it
/// is that at r0.
/// Global: utilisation σ(r0)/f_t; ballistic_speed is the speed for which it is 1, sought up to
/// 100 km/s; crack_radius solves σ(r) = f_t. Local: ballistic_speed by NDRC's formula, a fit to concrete
/// (sim/penetration.hpp); utilisation (v/ballistic_speed)²; crack_radius R + H/2 once it
/// perforates.
/// Force and utilisation never fall with speed or mass. crack_radius can: it is bounded by the
/// engaged radius, which shrinks with the contact's duration – a fast shot makes a small hole.
/// About 50 µs, nearly all of it for ballistic_speed.
Blow blow_of(const Striker& striker, double speed, double thickness, const Material& material);

/// Its utilisation alone: what most contacts are asked, at a hundredth of the cost.
double utilisation_of(const Striker& striker, double speed, double thickness,
                      const Material& material);

/// Demand by capacity of a bond at distance r from the contact: σ(r)/f_t for a global blow, 0 for
/// a local one. Never more than the blow's own utilisation; 1 at crack_radius.
double utilisation_at(const Blow& blow, double distance, double thickness,
                      const Material& material);

/// Speed after perforation (Recht & Ipson 1963): M/(M+m_p) √(V² - V_bl²), 0 at or below V_bl.
double residual_speed(double mass, double plug_mass, double speed, double ballistic_speed);

/// Expected number of radial cracks of a brittle plate hit by a hard sphere: n = C √(V/c)
/// (E h/Γ)^¼ with c = √(E/ρ). Published is only √V (Vandenberghe et al., PRL 110, 174302, 2013);
/// the rest is dimensional, and C = 4.07 is fitted to two photographs of their 1 mm PMMA plates
/// under a 4 mm steel ball (4 cracks at 22.2 m/s, 8 at 56.7; it gives 4.5 and 7.2). At least 3,
/// also where the material's E or Γ is not known.
double radial_crack_count(double speed, double thickness, const Material& material);

}  // namespace sunder
