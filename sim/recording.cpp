// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/recording.hpp"

#include <algorithm>

namespace sunder {

TimeRange moving_range(const Recording& recording, std::uint32_t track) {
  if (track == kNoTrack) return {};
  const Track& last = recording.tracks[track];
  const auto end = static_cast<std::uint32_t>(last.first + last.poses.size());
  while (recording.tracks[track].parent != kNoTrack) track = recording.tracks[track].parent;
  return {recording.tracks[track].first, end};
}

Pose pose_at(const Recording& recording, std::uint32_t track, std::uint32_t i,
             const Pose& standing) {
  for (; track != kNoTrack; track = recording.tracks[track].parent) {
    const Track& t = recording.tracks[track];
    if (i < t.first || t.poses.empty()) continue;
    return t.poses[std::min<std::size_t>(i - t.first, t.poses.size() - 1)];
  }
  return standing;
}

}  // namespace sunder
