// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/projectile.hpp"

namespace sunder {

template <>
std::span<const Field<Projectile>> fields() {
  using P = Projectile;
  static const Field<P> table[] = {
      {"name", &P::name, "",
       "Letters, digits, _ and - only, at most 40, unlike every other projectile's and wall's. "
       "Left out: projectile, projectile_2, projectile_3 …"},
      {"radius", &P::radius, "m", "Of the sphere.", {1e-6, 1e3}},
      {"mass", &P::mass, "kg", "Spread evenly over the sphere.", {1e-9, 1e9}},
      {"time", &P::time, "s", "When it appears; before, it is not there.", {0, 3600}},
      {"youngs_modulus", &P::youngs_modulus, "Pa", "Stiffness; steel if left out.", {1e3, 1e13}},
      {"poisson_ratio",
       &P::poisson_ratio,
       "",
       "Sideways strain by lengthwise strain.",
       {-1, 0.5, true}},
      {"friction",
       &P::friction,
       "",
       "Coulomb's coefficient; two bodies that touch take the geometric mean of theirs.",
       {0, 10}},
      {"restitution",
       &P::restitution,
       "",
       "Speed after by speed before a contact; two bodies take the geometric mean of theirs.",
       {0, 1}},
  };
  return table;
}

}  // namespace sunder
