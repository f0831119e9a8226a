// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/recorder.hpp"

#include <bit>
#include <cassert>

#include "meshing/random.hpp"

namespace sunder {

std::uint32_t Recorder::add_track(std::uint32_t parent) {
  Track track;
  track.parent = parent;
  track.first = static_cast<std::uint32_t>(recording_.times.size());
  recording_.tracks.push_back(track);
  mix(std::uint64_t{parent});
  return static_cast<std::uint32_t>(recording_.tracks.size() - 1);
}

void Recorder::add_time(double time) {
  assert(time > recording_.times.back());
  recording_.times.push_back(time);
  mix(time);
}

void Recorder::add_pose(std::uint32_t track, const Pose& pose) {
  Track& t = recording_.tracks[track];
  const std::size_t due = recording_.times.size() - t.first;  // poses there will be with this one
  // It slept meanwhile: the poses between are those it slept in.
  while (!t.poses.empty() && t.poses.size() + 1 < due) t.poses.push_back(t.poses.back());
  if (t.poses.empty()) t.first = static_cast<std::uint32_t>(recording_.times.size() - 1);
  t.poses.push_back(pose);
  ++poses_;
  mix(std::uint64_t{track});
  for (const double value : {pose.position.x, pose.position.y, pose.position.z, pose.rotation.x,
                             pose.rotation.y, pose.rotation.z, pose.rotation.w})
    mix(value);
}

std::uint32_t Recorder::divide_track(std::uint32_t track, const Pose& first, const Pose& second) {
  Track other = recording_.tracks[track];
  for (Pose& pose : other.poses) pose = pose * second;
  for (Pose& pose : recording_.tracks[track].poses) pose = pose * first;
  recording_.tracks.push_back(std::move(other));
  mix(std::uint64_t{track});
  return static_cast<std::uint32_t>(recording_.tracks.size() - 1);
}

void Recorder::add_event(const BreakEvent& event) {
  recording_.events.push_back(event);
  mix(event.time);
  mix(event.speed);
  mix(std::uint64_t{event.wall} << 32 | event.bonds_broken);
  mix(std::uint64_t{event.chunks_freed});
}

void Recorder::add_broken_joint(std::uint32_t joint, double time) {
  mix(std::uint64_t{joint});
  mix(time);
}

void Recorder::mix(double value) {
  mix(std::bit_cast<std::uint64_t>(value));
}

void Recorder::mix(std::uint64_t value) {
  hash_ = mix_bits(hash_ ^ value) + 0x9E3779B97F4A7C15u;
}

}  // namespace sunder
