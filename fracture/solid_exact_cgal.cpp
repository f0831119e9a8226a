// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/MP_Float.h>

#include "fracture/solid_exact.hpp"

namespace sunder {
namespace {

using Exact = CGAL::MP_Float;

int sign_of(const Exact& value) {
  return static_cast<int>(CGAL::sign(value));
}

}  // namespace

int exact_side(const Corners3& triangle, const TriangleLine& a, const TriangleLine& b,
               const TriangleLine& c) {
  return sign_of(value_at(meeting(line_values<Exact>(triangle, a), line_values<Exact>(triangle, b)),
                          line_values<Exact>(triangle, c)));
}

int exact_order(const Corners3& s, const Corners3& t, const SolidComplex::Plane& p,
                const SolidComplex::Plane& q) {
  const auto x = along_line<Exact>(s, p, q), y = along_line<Exact>(t, p, q);
  return sign_of(y[0] * x[1] - x[0] * y[1]) * sign_of(x[1]) * sign_of(y[1]);
}

int exact_corner_side(const std::array<const SolidComplex::Plane*, 3>& corner,
                      const SolidComplex::Plane& s) {
  const auto value = corner_value<Exact>(corner, s);
  return sign_of(value[0]) * sign_of(value[1]);
}

}  // namespace sunder
