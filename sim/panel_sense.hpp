// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "sim/chunk_network.hpp"

namespace sunder {

/// How much a motion of its corners asks of a panel at most that is held straight (PanelHold).
/// Utilisation is sublinear in what loads a panel (BondSpring::stress), so those of any parts of a
/// motion add up to a bound: here the six ways in which four corners strain what is between them
/// (stretch along x and y, shear, and what of each component alternates from corner to corner:
/// twist across the plane); each measured on the panel's own network. Valid as long as nothing of
/// it is broken, whatever else loads it.
class PanelSense {
 public:
  /// The network's gravity and contacts are 0 afterwards. Twelve solves.
  PanelSense(ChunkNetwork& network, const PanelCorners& corners);
  /// Upper bound of what these translations add to the largest utilisation; rotations do nothing.
  double added(const PanelFreedoms& moved) const;

 private:
  std::array<double, 6> strains_of(const PanelFreedoms& moved) const;

  std::array<Vec2, 4> slope_{};          ///< of a linear field, by its values at the corners
  std::array<double, 4> alternating_{};  ///< what alternates, by the values at the corners
  std::array<double, 6> of_strain_{};
};

}  // namespace sunder
