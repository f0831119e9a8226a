// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "sim/chunk_network.hpp"

namespace sunder {

/// How much a motion of its corners asks of a panel at most. Utilisation is sublinear in what loads
/// a panel (BondSpring::stress), so those of any parts of a motion add up to a bound: here the mean
/// plane, its curvatures, and what is left corner by corner; each measured on the panel's own
/// network. Valid as long as nothing of it is broken, whatever else loads it.
class PanelSense {
 public:
  /// The network's gravity and contacts are 0 afterwards. Thirty solves.
  PanelSense(ChunkNetwork& network, const PanelCorners& corners);
  /// Upper bound of what this motion adds to the largest utilisation. In the plane of the panel it
  /// is infinite: those freedoms are not measured.
  double added(const PanelFreedoms& moved) const;

 private:
  static constexpr std::size_t kModes = 6;
  std::array<Vec2, 4> at_;  ///< corners, from their middle
  std::array<PanelFreedoms, kModes> modes_{};
  std::array<double, kModes> of_mode_{};
  std::array<double, 24> of_freedom_{};
};

}  // namespace sunder
