// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/moment.hpp"

#include <algorithm>

#include "io/printable.hpp"
#include "meshing/error.hpp"

namespace sunder {

std::uint32_t step_nearest(const Recording& recording, double time) {
  const std::vector<double>& times = recording.times;
  if (!(time >= 0 && time <= times.back())) {
    throw Error(ErrorCode::usage, "at = " + number_text(time) +
                                      " s is outside the recording, [0, " +
                                      number_text(times.back()) + "] s");
  }
  const auto next = std::ranges::lower_bound(times, time);
  const auto step = static_cast<std::uint32_t>(next - times.begin());
  return step > 0 && time - times[step - 1] <= times[step] - time ? step - 1 : step;
}

bool is_there(const Recording& recording, const RecordedProjectile& projectile,
              std::uint32_t step) {
  if (projectile.track == kNoTrack) return projectile.projectile.time <= recording.times.back();
  const TimeRange moving = moving_range(recording, projectile.track);
  return moving.first >= moving.end || step >= moving.first;
}

bool is_there(const Recording& recording, const RecordedPart& part, std::uint32_t step) {
  return recording.times[step] < part.removed;
}

Pose pose_in_wall(const Recording& recording, const RecordedWall& wall, std::uint32_t chunk,
                  std::uint32_t step) {
  const Pose standing{wall.asset.wall.position, wall.asset.wall.rotation};
  const Pose pose = pose_at(recording, wall.track[chunk], step, standing);
  // Exactly at rest, not by way of an inverse.
  if (pose == standing) return {};
  return inverse(standing) * pose;
}

Pose pose_of(const Recording& recording, const RecordedProjectile& projectile, std::uint32_t step) {
  return pose_at(recording, projectile.track, step, {projectile.projectile.position, {}});
}

Pose pose_of(const Recording& recording, const RecordedPart& part, std::uint32_t step) {
  return pose_at(recording, part.track, step, part.standing);
}

}  // namespace sunder
