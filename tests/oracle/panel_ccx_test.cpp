// SPDX-License-Identifier: GPL-3.0-or-later
// Bending of a panel in its plane against CalculiX 2.20 and its plane stress element CPS8.
#include <gtest/gtest.h>

#include <array>
#include <sstream>
#include <string>

#include "sim/chunk_network.hpp"
#include "tests/oracle/ccx.hpp"
#include "tests/sim/panels.hpp"

namespace sunder {
namespace {

constexpr Vec2 kSize{6, 3.5};
constexpr double kThickness = 0.15, kYoung = 33.6e9, kMove = 1e-3;

/// Corners move by ±kMove, alternately, along x (way 0) or y (1), edges as straight lines between
/// them: `nx` × `ny` elements of eight nodes.
std::string bent_plate(int way, int nx, int ny) {
  const auto number = [&](int i, int j) { return 1 + i + j * (2 * nx + 1); };
  const auto is_middle = [](int i, int j) { return i % 2 == 1 && j % 2 == 1; };
  std::ostringstream out, edge;
  out.precision(12), edge.precision(12);
  out << "*NODE,NSET=NALL\n";
  for (int j = 0; j <= 2 * ny; ++j)
    for (int i = 0; i <= 2 * nx; ++i) {
      if (is_middle(i, j)) continue;
      const double u = i / (2.0 * nx), v = j / (2.0 * ny);
      out << number(i, j) << "," << kSize.x * u << "," << kSize.y * v << ",0\n";
      if (i != 0 && i != 2 * nx && j != 0 && j != 2 * ny) continue;
      for (int k = 0; k < 2; ++k)
        edge << number(i, j) << "," << k + 1 << "," << k + 1 << ","
             << (k == way ? kMove * (1 - 2 * u) * (1 - 2 * v) : 0) << "\n";
    }
  out << "*ELEMENT,TYPE=CPS8,ELSET=EALL\n";
  for (int j = 0, e = 0; j < 2 * ny; j += 2)
    for (int i = 0; i < 2 * nx; i += 2) {
      out << ++e;
      for (const auto& [a, b] : std::array<std::array<int, 2>, 8>{
               {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {2, 1}, {1, 2}, {0, 1}}})
        out << "," << number(i + a, j + b);
      out << "\n";
    }
  out << "*MATERIAL,NAME=M\n*ELASTIC\n"
      << kYoung << ",0\n*SOLID SECTION,ELSET=EALL,MATERIAL=M\n"
      << kThickness << "\n*STEP\n*STATIC\n*BOUNDARY\n"
      << edge.str() << "*EL PRINT,ELSET=EALL,TOTALS=ONLY\nELSE\n*END STEP\n";
  return out.str();
}

/// J. The last number of what is printed.
double energy_by_ccx(int way) {
  std::istringstream words(run_ccx(bent_plate(way, 24, 14)));
  double last = 0;
  for (std::string word; words >> word;) {
    std::istringstream number(word);
    if (double value = 0; number >> value && number.eof()) last = value;
  }
  return last;
}

// Measured over five seeds: softer by 2.5 and 0.8 % in the mean with cells of half a metre (3.7 %
// at most), by 0.6 and 0.1 % with half of that.
TEST(PanelAgainstCalculix, BendsInItsPlaneTheSameWithinItsCells) {
  const double theirs[2] = {energy_by_ccx(0), energy_by_ccx(1)};
  for (const auto& [cell, error] : {std::pair{0.5, 0.04}, {0.25, 0.01}})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const PanelKind kind{.size = kSize, .thickness = kThickness, .cell = cell, .jitter = 0.9};
      ChunkNetwork network(panel_asset(kind, seed), panel_concrete(), straight_hold(kind.size));
      const PanelMatrix& k = network.stiffness();
      for (std::size_t way = 0; way < 2; ++way) {
        double energy = 0;
        for (std::size_t a = 0; a < 4; ++a)
          for (std::size_t b = 0; b < 4; ++b)
            energy += ((a + b) % 2 == 0 ? 0.5 : -0.5) * kMove * kMove *
                      k[24 * (6 * a + way) + 6 * b + way];
        EXPECT_NEAR(energy / theirs[way], 1, error) << "cell " << cell << ", seed " << seed;
      }
    }
}

}  // namespace
}  // namespace sunder
