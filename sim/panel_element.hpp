// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "sim/chunk_network.hpp"

namespace sunder {

/// A slab as an elastic element of a frame (FrameSolver::set_panel): what its four edges hang on
/// must give them, force and moment at both corners of each, as the corners move. World axes.
///
/// Edge k runs from corner k to corner k + 1 and follows them as a beam without loads between them
/// would (edge_motion). So its two ends get the consistent end forces of what the panel's anchors
/// put on it. The member along it passes them on through its own end joints, but moments at hinged
/// ends: those go to what the hinge is on. Weight, mass and contacts of the slab stay on its
/// carriers as without it. In a piece that flies `load` must be balanced in itself.
///
/// It takes part while every edge that bears anything has its joint with the slab and its member,
/// held at both ends; what it stores is ½ qᵀ K q + loadᵀ q, q from `at_rest`.
struct PanelElement {
  std::array<std::uint32_t, 4> nodes{};  ///< of the frame: the corners, in order around
  std::array<EdgeStiffness, 4> edges{};  ///< N/m, N, N m; their sum at the corners is symmetric
  std::array<Twelve, 4> load{};          ///< of the edges, whatever the corners do, N, N m
  PanelFreedoms at_rest{};               ///< corners' motion at which only `load` is there
};

/// The element of a network whose frame `to_world` turns; `at_rest` is 0. With what weight and
/// contacts ask of the edges as load if `loaded`. As ChunkNetwork::stiffness().
PanelElement element_of(ChunkNetwork& network, const std::array<std::uint32_t, 4>& nodes,
                        const Quaternion& to_world, bool loaded);

/// Stiffness about the four corners: the edges' sum without what rounding leaves unsymmetric.
PanelMatrix stiffness_of(const PanelElement& element);

}  // namespace sunder
