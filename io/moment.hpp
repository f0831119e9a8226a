// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "sim/recording.hpp"

namespace sunder {

/// The step of a recording that is nearest to a time (s); of two equally near the earlier. Throws
/// Error{usage} unless 0 <= time <= the last step's.
std::uint32_t step_nearest(const Recording& recording, double time);

/// A projectile has started, a part has not been taken away at a step.
bool is_there(const Recording& recording, const RecordedProjectile& projectile, std::uint32_t step);
bool is_there(const Recording& recording, const RecordedPart& part, std::uint32_t step);

/// Poses at a step: of a chunk relative to its standing wall, exactly none while it stands; of a
/// projectile's centre and of a part's frame in the world.
Pose pose_in_wall(const Recording& recording, const RecordedWall& wall, std::uint32_t chunk,
                  std::uint32_t step);
Pose pose_of(const Recording& recording, const RecordedProjectile& projectile, std::uint32_t step);
Pose pose_of(const Recording& recording, const RecordedPart& part, std::uint32_t step);

}  // namespace sunder
