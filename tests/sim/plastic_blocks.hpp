// SPDX-License-Identifier: GPL-3.0-or-later
// Strength of an I of plates in compression and bending by its fully plastic stress blocks.
#pragma once

#include <algorithm>

#include "sim/section.hpp"

namespace sunder {

struct Plastic {
  double axial = 0, moment = 0;
};

/// Fully plastic stress blocks with the neutral axis at z, f_y = 1.
inline Plastic plastic_blocks(const Section& s, double z) {
  Plastic sum;
  const auto add = [&](double low, double high, double width) {
    const double cut = std::clamp(z, low, high);
    sum.axial += width * ((high - cut) - (cut - low));
    sum.moment += width * ((high * high - cut * cut) - (cut * cut - low * low)) / 2;
  };
  const double top = s.height / 2, clear = top - s.flange;
  add(-top, -clear, s.width);
  add(-clear, clear, s.web);
  add(clear, top, s.width);
  return sum;
}

/// N/N_pl and M/M_pl of the strength where they are as `axial` : `moment`, by bisection of the
/// axis.
inline Plastic exact_strength(const Section& s, double axial, double moment) {
  double low = -s.height / 2, high = 0;  // from all tension to bending alone
  Plastic found;
  for (int i = 0; i < 100; ++i) {
    const double z = (low + high) / 2;
    const Plastic blocks = plastic_blocks(s, z);
    found = {blocks.axial / s.area, blocks.moment / s.wpl_y};
    (found.axial * moment > found.moment * axial ? low : high) = z;
  }
  return found;
}

}  // namespace sunder
