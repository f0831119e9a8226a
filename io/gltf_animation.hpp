// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/recording.hpp"

namespace sunder {

constexpr std::uint32_t kNoHistory = UINT32_MAX;

/// What the animation of a recording holds, planned before a byte is written. A *key* is a step of
/// the recording; every step is kept but the first of two whose times are the same float32. Seconds
/// are seconds: key k stands at times[steps[k]], nothing is resampled.
struct GltfAnimation {
  /// Half-open range of keys; one time accessor each.
  struct Keys {
    std::uint32_t first = 0, count = 0;
    friend auto operator<=>(const Keys&, const Keys&) = default;
  };
  /// The motion that all chunks of one body share, or that of a projectile.
  struct History {
    std::uint32_t track = kNoTrack;
    Pose standing;            ///< before the track: of the wall, of the sphere's start
    bool local = false;       ///< poses are written relative to `standing` (a chunk in its wall)
    std::uint32_t keys = 0;   ///< in key_ranges
    std::uint64_t begin = 0;  ///< its first key among those of all histories
  };
  /// A projectile that is not there from the start: scale 0, then 1 (`appears`), or 0 for good.
  struct Arrival {
    std::uint32_t projectile = 0, keys = 0;
    bool appears = true;
  };

  /// A part that is taken away: scale 1, then 0, or 0 for good when it was at the first step.
  struct Departure {
    std::uint32_t part = 0, keys = 0;
  };

  std::vector<std::uint32_t> steps;  ///< of the recording, per key; ascending
  std::vector<Keys> key_ranges;      ///< distinct, in order of first use
  std::vector<History> histories;    ///< those of projectiles first
  std::vector<Arrival> arrivals;
  std::vector<Departure> departures;
  std::vector<std::uint32_t> of_projectile;          ///< → histories or kNoHistory
  std::vector<std::vector<std::uint32_t>> of_chunk;  ///< per wall and chunk: the same
  std::vector<std::uint32_t> of_part;                ///< → histories or kNoHistory
  std::uint64_t pose_count = 0;                      ///< keys of all histories

  bool empty() const { return histories.empty() && arrivals.empty() && departures.empty(); }
  /// Scales that samplers look into: 0, 1 and, when something departs, 0 again.
  std::uint32_t scale_count() const {
    if (!departures.empty()) return 3;
    return arrivals.empty() ? 0 : 2;
  }
  std::uint32_t key_count(const History& history) const { return key_ranges[history.keys].count; }
};

/// A body's keys are the steps at which it moves and one before, at which it still stands: linear
/// interpolation does not creep towards the break. Players hold the last pose; the first history
/// goes on to the last step, so that the animation lasts as long as the recording. O(chunks +
/// steps).
GltfAnimation plan_animation(const Recording& recording);

/// Pose of a history at key `key` (counted over all steps), as its node has it.
Pose pose_of(const Recording& recording, const GltfAnimation& animation,
             const GltfAnimation::History& history, std::uint32_t key);

/// Throws Error{output} that names what is at fault unless the recording can be written: tables
/// agree, tracks exist and start within the recording, poses are finite with unit rotations, times
/// ascend; names of projectiles and parts are portable and unlike those of walls, chunks and each
/// other; parts have valid outlines and joints parts; every joint has a load at every sampling
/// time.
void validate(const Recording& recording);

}  // namespace sunder
