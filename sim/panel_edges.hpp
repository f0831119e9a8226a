// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "meshing/vec.hpp"
#include "sim/beam_element.hpp"

namespace sunder {

/// Displacement and rotation (three each, m and rad, wall frame) of the four corners of what a
/// panel hangs in, or forces and moments there (N, N m).
using PanelFreedoms = std::array<double, 24>;
/// The four corners, wall frame: lower left, lower right, upper right, upper left. Edge k runs from
/// corner k to the next: 0 bottom, 1 right, 2 top, 3 left.
using PanelCorners = std::array<Vec3, 4>;

/// What a panel hangs in.
struct PanelHold {
  PanelCorners corners{};
  /// Edges on which the panel's anchors turn freely about the edge: a slab that lies on beams.
  std::array<bool, 4> hinged{};
  /// How its anchors follow the corners: by their translations alone (surface_motion), else as
  /// beams between them do (edge_motion).
  bool is_straight = false;
};

/// How a place on an edge follows its two corners: six numbers of the place, row by row, from those
/// of the edge's first corner and those of its second.
using EdgeMotion = std::array<std::array<double, 12>, 6>;

/// The edge that a place (m, wall frame) hangs on: the nearest of those that face the way of
/// `outward` to within 60°, else the nearest of all.
std::uint32_t edge_of(const PanelCorners& corners, Vec3 place, Vec3 outward);

/// Motion of a place that an edge carries by a rigid arm from its nearest point. The edge moves as
/// an Euler–Bernoulli beam without loads between its corners: cubic across (Hermite), linear along
/// and in twist. So every rigid motion of the corners is one of the place, and every quadratic
/// deflection of a plate is met on a straight edge.
EdgeMotion edge_motion(const PanelCorners& corners, std::uint32_t edge, Vec3 place);

/// How a place (m, wall frame, in the plane of the corners) follows the translations of the four
/// corners, row by row as EdgeMotion, columns three by three: bilinear between them, turned as that
/// surface turns in the mean: θ_x = ∂w/∂y, θ_y = -∂w/∂x, θ_z = (∂v/∂x - ∂u/∂y)/2. Edges stay
/// straight; every uniform strain and twist of the corners is one of the places.
EdgeMotion surface_motion(const PanelCorners& corners, Vec3 place);

}  // namespace sunder
