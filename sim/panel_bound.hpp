// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "sim/material.hpp"
#include "sim/panel_edges.hpp"

namespace sunder {

/// A rectangular panel that has not been fractured: its lower left corner and that of what it hangs
/// in are the origin of the wall's frame.
struct PanelPlate {
  Vec2 size;             ///< m
  double thickness = 0;  ///< m
  /// Edges with anchors: bottom, right, top, left.
  std::array<bool, 4> held{true, true, true, true};
};

/// Upper bound of the largest utilisation that a ChunkNetwork of this plate can show in any of its
/// bonds, for corners moved like this and its weight (m/s², wall frame), without contacts; whatever
/// its hinges, and its cells if they are 3 × 3 to 20 × 20 of a Voronoi grid. Utilisation is a
/// seminorm of the loads, so the bounds of parts of the motion add up: a rigid one (nothing),
/// uniform strains and curvatures, the rest corner by corner. Their coefficients are 30 % above the
/// largest of 12000 random networks (2 to 8 m, 0.05 to 0.4 m thick): measured, not proved. In the
/// middle too high by a factor of 4 (weight) to 20 (random motions). A few hundred operations.
double panel_stress_bound(const PanelPlate& plate, const Material& material,
                          const PanelFreedoms& freedoms, Vec3 gravity);

}  // namespace sunder
