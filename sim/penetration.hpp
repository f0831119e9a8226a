// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace sunder {

/// A hard missile against a concrete slab, SI units.
struct ConcreteShot {
  double mass = 1, diameter = 0.1, speed = 40;
  double nose = 0.84;         ///< NDRC's N: .72 flat, .84 hemispherical, 1 blunt, 1.14 sharp
  double hughes_nose = 1.26;  ///< Hughes' N_h: 1 flat, 1.12 blunt, 1.26 spherical, 1.39 sharp
  double compressive_strength = 38e6, tensile_strength = 2.9e6, density = 2400;
  double reinforcement = 0.3;  ///< UKAEA's r, % each way in each face
};

/// Depth and limits for one shot, m; a negative value: the formula does not give it.
struct Penetration {
  double depth = -1;        ///< x, into a thick slab
  double perforation = -1;  ///< e, slab that is just perforated
  double scabbing = -1;     ///< s, slab that just scabs
};

/// Four published fits to tests of hard missiles at 25-300 m/s; they differ by a factor 2 in
/// perforation thickness and up to 10 in shallow depths, and no range of validity is enforced.
/// At speed <= 0 everything they give is 0. What is confirmed of them: docs/accuracy.md.
Penetration ndrc(const ConcreteShot& shot);
Penetration hughes(const ConcreteShot& shot);
Penetration cea_edf(const ConcreteShot& shot);
Penetration ukaea(const ConcreteShot& shot);

/// Speeds at which a slab of `thickness` is just perforated by each formula (speed in `shot`
/// ignored), and the band they span, m/s. Infinity: not below 100 km/s.
struct BallisticBand {
  double ndrc = 0, hughes = 0, cea_edf = 0, ukaea = 0;
  double low() const;
  double high() const;
};
BallisticBand ballistic_band(const ConcreteShot& shot, double thickness);

/// NDRC's formula the other way round: the speed at which a slab is just perforated, m/s. Of the
/// four it is nearest to the tests we know (Hanchak, IRIS; docs/impact.md), so blow_of uses it.
double ndrc_ballistic_speed(const ConcreteShot& shot, double thickness);

/// CEA-EDF: V_bl = 1.3 ρ^(1/6) √f_c (d H²/M)^(2/3), m/s: the inverse of its perforation thickness
/// 0.82 √(M/d) V^¾ / (ρ^⅛ f_c^⅜) but for the rounding of 0.82 (0.2 %).
double cea_edf_ballistic_speed(double mass, double diameter, double thickness,
                               double compressive_strength, double density);

}  // namespace sunder
