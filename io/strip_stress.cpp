// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/strip_stress.hpp"

#include <algorithm>
#include <cstdint>

namespace sunder {
namespace {

constexpr StripColour kForce{232, 30, 22}, kTorque{28, 176, 52}, kBoth{255, 208, 0};
constexpr StripColour kFailed{28, 84, 245};

// Loads of the joints at the sample at or after a time; null: there are none.
const JointSample* samples_at(const Recording& recording, double time) {
  const std::vector<double>& times = recording.sample_times;
  if (times.empty()) return nullptr;
  const auto next = std::min(std::ranges::lower_bound(times, time), times.end() - 1);
  const auto row = static_cast<std::size_t>(next - times.begin());
  return recording.samples.data() + row * recording.joints.size();
}

// Which joints of an end hold, and whether the one by which the part itself ends there does not.
struct EndState {
  bool has_joint = false, holds = false, is_loose = false;
};

}  // namespace

std::vector<std::array<EndLoad, 2>> end_loads(const Recording& recording, double time) {
  std::vector<std::array<EndLoad, 2>> loads(recording.parts.size());
  std::vector<std::array<EndState, 2>> states(recording.parts.size());
  const JointSample* samples = samples_at(recording, time);
  for (std::size_t j = 0; j < recording.joints.size(); ++j) {
    const RecordedJoint& joint = recording.joints[j];
    const bool holds = joint.broken > time;
    const auto add = [&](std::uint32_t part, std::uint8_t end, bool is_own) {
      if (part == kNoTrack || end > 1) return;
      EndState& state = states[part][end];
      state.has_joint = true;
      state.holds = state.holds || holds;
      state.is_loose = state.is_loose || (is_own && !holds);
      if (!holds || !samples) return;
      EndLoad& load = loads[part][end];
      load.force = std::max<double>(load.force, samples[j].force_utilisation);
      load.torque = std::max<double>(load.torque, samples[j].torque_utilisation);
    };
    add(joint.part_a, joint.end_a, true);
    add(joint.part_b, joint.end_b, false);
  }
  for (std::size_t p = 0; p < loads.size(); ++p) {
    for (std::size_t end = 0; end < 2; ++end) {
      const EndState& state = states[p][end];
      loads[p][end].has_failed = state.is_loose || (state.has_joint && !state.holds);
    }
  }
  return loads;
}

StressLight light_of(const EndLoad& load) {
  if (load.has_failed) return {kFailed, 1};
  const double force = std::clamp(load.force, 0.0, 1.0);
  const double torque = std::clamp(load.torque, 0.0, 1.0);
  const double most = std::max(force, torque);
  if (most == 0) return {};
  const StripColour& pure = force > torque ? kForce : kTorque;
  return {mix_colours(pure, kBoth, std::min(force, torque) / most), most};
}

std::size_t broken_joints(const Recording& recording, double time) {
  return static_cast<std::size_t>(std::ranges::count_if(
      recording.joints, [&](const RecordedJoint& joint) { return joint.broken <= time; }));
}

}  // namespace sunder
