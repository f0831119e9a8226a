// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sim/blow.hpp"

namespace sunder {

/// A blow in the plane of a wall, against its edge: contact force as in blow_of without the plate's
/// impedance; stress at distance r below it F / (π r H) (a line load on a half-plane, Flamant;
/// the tension across the load's line when a disc splits has the same form), as far as a shear
/// wave runs while the contact lasts. Global by definition.
Blow edge_blow_of(const Striker& striker, double speed, double thickness, const Material& material);
double edge_utilisation_at(const Blow& blow, double distance, double thickness,
                           const Material& material);

/// Its contact force, N; and the force from which the nearest bonds open.
double edge_force_of(const Striker& striker, double speed, const Material& material);
double least_edge_force(const Striker& striker, double thickness, const Material& material);

/// Force that splits a lump of this size between two faces: (π/2) f_t size H (Brazilian test).
double splitting_force(double size, double thickness, const Material& material);

}  // namespace sunder
