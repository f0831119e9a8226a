// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/material.hpp"

namespace sunder {

template <>
std::span<const Field<Material>> fields() {
  using P = Material;
  static const Field<P> table[] = {
      {.name = "name",
       .member = &P::name,
       .unit = "",
       .effect = "Letters, digits, _ and - only, at most 40.",
       .required = true},
      {"density",
       &P::density,
       "kg/m³",
       "Mass per volume; a new material must give it.",
       {0, 1e5, true}},
      {"youngs_modulus", &P::youngs_modulus, "Pa", "Stiffness; 0: not known.", {0, 1e13}},
      {"poisson_ratio", &P::poisson_ratio, "", "Sideways strain by lengthwise strain.", {-1, 0.5}},
      {"tensile_strength",
       &P::tensile_strength,
       "Pa",
       "Stress that breaks it; 0: not known.",
       {0, 1e12}},
      {"compressive_strength",
       &P::compressive_strength,
       "Pa",
       "Stress that crushes it; 0: not known.",
       {0, 1e12}},
      {"fracture_energy",
       &P::fracture_energy,
       "J/m²",
       "Energy that a new crack takes per area, one side counted; 0: not known.",
       {0, 1e9}},
      {"stored_energy",
       &P::stored_energy,
       "J/m³",
       "Elastic energy that toughening left in it: once a crack opens, the whole wall breaks.",
       {0, 1e9}},
      {"friction", &P::friction, "", "Coulomb's coefficient of dry friction.", {0, 10}},
      {"restitution", &P::restitution, "", "Speed after by speed before a contact.", {0, 1}},
      {"source", &P::source, "", "Where the numbers are from."},
  };
  return table;
}

}  // namespace sunder
