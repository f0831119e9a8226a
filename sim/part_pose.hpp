// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "sim/frame.hpp"
#include "sim/pose.hpp"
#include "sim/rigid_world.hpp"

namespace sunder {

/// The rotation that has these axes.
Quaternion rotation_of(const Axes& axes);
/// Where a part's frame stands.
Pose pose_of(const PartSolid& solid);
/// Friction and restitution of a part's material; steel: usual values of dry contact, from memory.
Surface surface_of(const Frame& frame, std::uint32_t part);
/// Of a point from a part where it stands, 0 inside, m.
double distance_to(const PartSolid& solid, Vec3 point);

}  // namespace sunder
