// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "io/strip_paper.hpp"
#include "sim/recording.hpp"

namespace sunder {

/// What the joints at an end of a member bear.
struct EndLoad {
  double force = 0, torque = 0;  ///< largest utilisations of those that hold
  bool has_failed = false;       ///< the joint by which the member ends there did, or all of them
};

/// Loads of all parts' ends at z = -half_length and +half_length, from the joints' sample at or
/// after a time (s), or the last one. Joints in between do not count. O(parts + joints).
std::vector<std::array<EndLoad, 2>> end_loads(const Recording& recording, double time);

/// Light on a member's end: red for force, green for torque, yellow for both, blue for a failed
/// joint, the stronger the nearer it is to failure.
struct StressLight {
  StripColour colour{};
  double strength = 0;  ///< 0: none … 1: the member's own colour is not seen
};
StressLight light_of(const EndLoad& load);

/// Number of joints broken at a time.
std::size_t broken_joints(const Recording& recording, double time);

}  // namespace sunder
