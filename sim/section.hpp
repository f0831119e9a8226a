// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "meshing/field.hpp"
#include "meshing/region.hpp"

namespace sunder {

/// Cross-section of a member. Axes as in EN 1993-1-1, 1.7: x along the member, y the strong axis
/// (across the web), z the weak axis (along the web); `iy` resists bending about y. SI units.
struct Section {
  std::string name = {};        ///< "HEB300"
  std::string shape = "i";      ///< i, rhs (square ones too), chs
  double height = 0;            ///< h, along z, m; of chs the diameter
  double width = 0;             ///< b, along y, m
  double web = 0;               ///< t_w; wall thickness of rhs and chs, m
  double flange = 0;            ///< t_f, of i only, m
  double radius = 0;            ///< r, of i: root radius; of rhs: outer corner radius, m
  double area = 0;              ///< m²
  double iy = 0, iz = 0;        ///< second moments of area, m⁴
  double it = 0;                ///< St. Venant torsion, m⁴
  double wel_y = 0, wel_z = 0;  ///< elastic moduli, m³
  double wpl_y = 0, wpl_z = 0;  ///< plastic moduli, m³
  double avy = 0, avz = 0;      ///< shear areas along y and z, EN 1993-1-1, 6.2.6 (3), m²
  double wt = 0;                ///< torsion modulus: torque / largest shear stress, m³
  std::string curve_y = "b", curve_z = "c";  ///< buckling curves about y and z: a0 a b c d
  std::string source = {};                   ///< where the numbers are from
};
template <>
std::span<const Field<Section>> fields();

struct SteelGrade {
  std::string name = {};          ///< "s235"
  double density = 7850;          ///< kg/m³
  double youngs_modulus = 210e9;  ///< Pa
  double poisson_ratio = 0.3;
  double yield_strength = 235e6;     ///< f_y, Pa
  double ultimate_strength = 360e6;  ///< f_u, Pa
  std::string source = {};
};
template <>
std::span<const Field<SteelGrade>> fields();

/// Outline in its own plane, x to the right = local y, y up = local z, centroid at the origin, m.
/// Counter-clockwise, with `corners` points per fillet and rounded corner, both ends of the arc
/// counted (below 2: square); tubes have their hole as opening, round ones 4 × corners points (at
/// least 24) on each circle.
Region outline_of(const Section& section, int corners = 0);

/// The properties and buckling curves of a shape from its dimensions (height, width, web, flange,
/// radius), fillets included; what the tables of data/sections.json are checked against. Exact but
/// `it` of i (El Darwish and Johnston 1965, as the mills print) and of rhs, whose inner corner
/// radius is 2/3 of the outer one (both EN 10210-2: 1.5 t and 1.0 t); `wt` of i is `it` by the
/// thickest wall, of rhs that of EN 10210-2; `avy` of i is A − h_w t_w. Curves: EN 1993-1-1, table
/// 6.2, rolled and hot finished, S235 to S420. The dimensions must have no fault.
Section with_properties(Section dimensions);

/// What is wrong with the dimensions of a shape, for example `2 flange = 0.2 m is not below the
/// height = 0.1 m`; empty: they are sound.
std::string dimension_fault(const Section& section);

}  // namespace sunder
