// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "sim/chunk_network.hpp"

namespace sunder {

/// A slab or wall as an elastic element of a frame (FrameSolver::set_panels): what the four nodes
/// at its corners must give it as they move. World axes; translations only, node by node, so that
/// it twists nothing, and stands in the plane of its nodes. Weight, mass and contacts of the part
/// stay on its carriers as without it.
///
/// It takes part as long as every member along its edges is whole, held at both ends and has its
/// joint with the panel, and never again afterwards. It stores ½ qᵀ K q, q from `at_rest`.
struct PanelElement {
  std::uint32_t part = 0;
  std::array<std::uint32_t, 4> nodes{};  ///< of the frame: the corners, in order around
  Matrix12 stiffness{};                  ///< N/m, symmetric; rigid motions ask for nothing
  Twelve at_rest{};                      ///< motion of the nodes at which it is without force, m
};

/// Of an element that has cracked.
struct PanelStiffness {
  std::uint32_t part = 0;
  Matrix12 stiffness{};
};

/// What corners with these translations must put on a network that is held straight (PanelHold),
/// whose frame `to_world` turns. As ChunkNetwork::stiffness().
Matrix12 stiffness_of(ChunkNetwork& network, const Quaternion& to_world);

}  // namespace sunder
