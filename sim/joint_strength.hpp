// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "meshing/field.hpp"
#include "meshing/vec.hpp"
#include "sim/section.hpp"

namespace sunder {

/// What a joint carries, in its own axes (x along the member it ends, y and z those of its
/// section): force (N, V_y, V_z), N; torque at the joint (T, M_y, M_z), N m. Tension is positive.
struct JointLoad {
  Vec3 force, torque;
};

/// The rule that combines six components; each has a ratio |S/R|, V the root of the sum of squares
/// of the two shears'.
/// box: each alone, the largest ratio.
/// linear: the sum of N, M_y, M_z (EN 1993-1-1, (6.2)); shears and torsion each alone.
/// ec3-i: N, M_y, M_z by EN 1993-1-1, 6.2.9.1 (5), (6) for I-sections; shears and torsion alone.
/// ellipsoid: root of the sum of squares of all six.
/// bolt: F_v/F_v,R + F_t/(1.4 F_t,R) and F_t/F_t,R, EN 1993-1-8, table 3.4, of the outermost bolt:
/// shear V + T, tension N + M_y + M_z. Compression passes between the plates.
/// mohr: |τ| <= c − σ tan φ with tension cut-off, for masonry and concrete interfaces. Shear c A is
/// the resistance along V, torsion uses it too; the cut-off is that of the edge: N + M_y + M_z, N
/// with its sign. Compression alone never breaks it.
enum class Interaction : std::uint8_t { box, linear, ec3_i, ellipsoid, bolt, mohr };

/// Names in files, in the order of the values.
inline constexpr std::array<std::string_view, 6> kInteractionNames{"box",       "linear", "ec3-i",
                                                                   "ellipsoid", "bolt",   "mohr"};
std::string_view name_of(Interaction interaction);
/// Throws Error{input} with the valid names.
Interaction interaction_named(std::string_view name);

/// Six resistances, and the rule that combines them.
struct JointStrength {
  Vec3 force = {};   ///< N_R, V_y,R, V_z,R, N; infinity: never fails that way
  Vec3 torque = {};  ///< T_R, M_y,R, M_z,R, N m
  Interaction interaction = Interaction::linear;
  bool bearing = false;  ///< compression passes by contact: it does not use N_R
  double web_share = 0;  ///< ec3-i: a = (A − 2 b t_f)/A, at most 0.5
  double friction = 0;   ///< mohr: tan φ
};

/// Demand by capacity; 1 breaks. `force` and `torque` are those of the two halves of the load
/// alone, for the picture; `total` is the rule's and decides: the number by which the load has to
/// be divided to lie on the failure surface. So all rules are positive homogeneous in the load and
/// 1 exactly on the surface. A load on a resistance of 0 gives infinity.
struct Utilisation {
  double force = 0, torque = 0, total = 0;
  std::string_view component;  ///< largest ratio of what decides: N, Vy, Vz, T, My, Mz; "": no load
};
Utilisation utilisation(const JointLoad& load, const JointStrength& strength);

/// Of ec3-i: a = (A − 2 b t_f)/A, at most 0.5; 0 for tubes.
double web_share_of(const Section& section);

/// The section's plastic resistances (EN 1993-1-1, 6.2.3–6.2.7, γ_M0 = 1) × `factor`: N_pl = A f_y,
/// V_pl = A_v f_y/√3, M_pl = W_pl f_y, T = W_t f_y/√3. Throws Error{input} for ec3-i with a tube.
JointStrength section_strength(const Section& section, const SteelGrade& steel,
                               Interaction interaction, double factor = 1);

}  // namespace sunder
