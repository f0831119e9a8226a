// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bench/frame_world.hpp"

namespace sunder {

/// Bullet as its users take it.
struct BulletParams {
  JointSolver solver = JointSolver::sequential_impulse;
  int iterations = 10;
  double compliance = 0;  ///< global constraint force mixing; Bullet's default is 0
  bool sleep = false;
};

/// The assembly as Bullet 3 itself carries it: a convex hull and a body each, btFixedConstraint,
/// loads from btJointFeedback. Its parts touch the ground and balls, not each other.
std::unique_ptr<FrameWorld> bullet_frame(const Assembly& assembly, const BulletParams& params);

}  // namespace sunder
