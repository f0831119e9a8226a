// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "sim/section.hpp"

namespace sunder {

/// Free lengths of a post about its section's axes, times the factors of its ends, m: those of the
/// equivalent pinned column.
struct FreeLength {
  double about_y = 0, about_z = 0;
};

/// π² E I / L² for the axis that gives less, N.
double euler_load(const Section& section, const SteelGrade& steel, const FreeLength& length);

/// N_b,Rd = χ A f_y of EN 1993-1-1, 6.3.1.2 with γ_M1 = 1 for the axis that gives less, N. The
/// imperfection factor of curves a0, a, b, c, d is 0.13, 0.21, 0.34, 0.49, 0.76 (table 6.1).
double buckling_resistance(const Section& section, const SteelGrade& steel,
                           const FreeLength& length);

/// Of a curve: χ(λ), 1 for λ <= 0.2.
double buckling_reduction(double slenderness, std::string_view curve);

}  // namespace sunder
