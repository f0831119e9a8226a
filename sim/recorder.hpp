// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "sim/recording.hpp"

namespace sunder {

/// Fills a Recording step by step and hashes everything that goes in.
class Recorder {
 public:
  Recorder() { recording_.times.push_back(0); }

  std::uint32_t add_track(std::uint32_t parent);
  /// The end of a step; then every moving body's pose.
  void add_time(double time);
  void add_pose(std::uint32_t track, const Pose& pose);
  /// What moved along a track is two from now on, which stood there in its frame from the start.
  /// Returns the track of the second one.
  std::uint32_t divide_track(std::uint32_t track, const Pose& first, const Pose& second);
  void add_event(const BreakEvent& event);
  void add_broken_joint(std::uint32_t joint, double time);

  bool is_empty(std::uint32_t track) const { return recording_.tracks[track].poses.empty(); }
  std::uint32_t parent(std::uint32_t track) const { return recording_.tracks[track].parent; }
  std::uint64_t hash() const { return hash_; }
  std::uint64_t poses() const { return poses_; }
  Recording take() { return std::move(recording_); }

 private:
  void mix(double value);
  void mix(std::uint64_t value);
  Recording recording_;
  std::uint64_t hash_ = 0, poses_ = 0;
};

}  // namespace sunder
