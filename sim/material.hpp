// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "meshing/field.hpp"

namespace sunder {

/// What a wall is made of; 0 stands for "not known", except in the ratios.
struct Material {
  std::string name;
  double density = 0;               ///< kg/m³
  double youngs_modulus = 0;        ///< Pa
  double poisson_ratio = 0.2;
  double tensile_strength = 0;      ///< Pa
  double compressive_strength = 0;  ///< Pa
  double fracture_energy = 0;       ///< J per m² of crack, one side counted
  double stored_energy = 0;         ///< J/m³ that toughening left in it; drives every crack on
  double friction = 0.6;            ///< Coulomb's µ of dry contact with itself
  double restitution = 0.1;         ///< of a contact with itself
  std::string source;               ///< where the numbers are from
};
template <>
std::span<const Field<Material>> fields();

}  // namespace sunder
