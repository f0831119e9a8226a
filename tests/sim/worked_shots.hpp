// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>

#include "sim/penetration.hpp"

namespace sunder {

/// Four shots computed independently of this code, as printed: mm, m/s. Densities of 2500 and
/// 2440 kg/m³ and the strength in tension of the last two are what the printed digits imply.
struct Worked {
  const char* name;
  ConcreteShot shot;
  double thickness;
  const char* printed[11];  // NDRC x e s, Hughes x e s, CEA-EDF e V, UKAEA x s V
};
inline const Worked kWorked[] = {
    {"A ball ⌀100 mm, 4.11 kg, 40 m/s, 0.10 m",
     {4.11, 0.1, 40, 0.84, 1.26, 30e6, 2.9e6, 2400, 0.3},
     0.1,
     {"21.5", "65", "147", "30.0", "108", "150", "50", "101.5", "2.2", "122", "80.6"}},
    {"B flat ⌀300 mm, 100 kg, 60 m/s, 0.50 m",
     {100, 0.3, 60, 0.72, 1, 35e6, 3.2e6, 2400, 0.3},
     0.5,
     {"87.7", "261", "564", "97.0", "349", "485", "181", "232", "12.6", "447", "203"}},
    {"C IRIS, 47 kg, 135 m/s, 0.25 m",
     {47, 0.168, 135, 0.72, 1, 60e6, 4e6, 2500, 0.3},
     0.25,
     {"137", "358", "543", "125", "433", "604", "247", "136.6", "110", "494", "85.4"}},
    {"D Hanchak, 0.5 kg, 434 m/s, 0.178 m",
     {0.5, 0.0254, 434, 1.14, 1.39, 48e6, 4e6, 2440, 0.3},
     0.178,
     {"155", "226", "265", "203", "356", "411", "172", "454", "154", "231", "426"}},
};

/// What our formulas give, in the order of `printed`.
inline std::array<double, 11> values_of(const Worked& row) {
  const Penetration n = ndrc(row.shot), h = hughes(row.shot), c = cea_edf(row.shot),
                    u = ukaea(row.shot);
  const BallisticBand band = ballistic_band(row.shot, row.thickness);
  return {n.depth * 1e3,       n.perforation * 1e3, n.scabbing * 1e3,    h.depth * 1e3,
          h.perforation * 1e3, h.scabbing * 1e3,    c.perforation * 1e3, band.cea_edf,
          u.depth * 1e3,       u.scabbing * 1e3,    band.ukaea};
}

/// Half of the last printed digit.
inline double half_digit(const std::string& printed) {
  return printed.find('.') == std::string::npos ? 0.5 : 0.05;
}

}  // namespace sunder
