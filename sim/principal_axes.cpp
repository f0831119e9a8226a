// SPDX-License-Identifier: GPL-3.0-or-later
// Cyclic Jacobi rotations (Golub & Van Loan, "Matrix Computations", 8.5); square roots only.
#include "sim/principal_axes.hpp"

#include <cmath>
#include <utility>

namespace sunder {
namespace {

constexpr int kMaxSweeps = 30;         // quadratic convergence: five are enough
constexpr double kNegligible = 1e-17;  // of the trace

/// Rotates the plane of p and q so that m[p][q] becomes 0; the columns of v follow.
void annul(double (&m)[3][3], double (&v)[3][3], int p, int q) {
  const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
  const double root = std::sqrt(theta * theta + 1);
  const double t = theta < 0 ? -1 / (root - theta) : 1 / (root + theta);
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  for (auto& row : m) {
    const double a = row[p], b = row[q];
    row[p] = c * a - s * b;
    row[q] = s * a + c * b;
  }
  for (int k = 0; k < 3; ++k) {
    const double a = m[p][k], b = m[q][k];
    m[p][k] = c * a - s * b;
    m[q][k] = s * a + c * b;
  }
  m[p][q] = m[q][p] = 0;
  for (auto& row : v) {
    const double a = row[p], b = row[q];
    row[p] = c * a - s * b;
    row[q] = s * a + c * b;
  }
}

}  // namespace

PrincipalAxes principal_axes(const SymMat3& s) {
  double m[3][3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double least = kNegligible * (std::fabs(s.xx) + std::fabs(s.yy) + std::fabs(s.zz));
  bool turned_any = true;
  for (int sweep = 0; sweep < kMaxSweeps && turned_any; ++sweep) {
    turned_any = false;
    for (const auto& [p, q] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
      if (std::fabs(m[p][q]) <= least) continue;
      annul(m, v, p, q);
      turned_any = true;
    }
  }
  return {{{v[0][0], v[1][0], v[2][0]}, {v[0][1], v[1][1], v[2][1]}, {v[0][2], v[1][2], v[2][2]}},
          {m[0][0], m[1][1], m[2][2]}};
}

}  // namespace sunder
