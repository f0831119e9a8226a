// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "meshing/vec.hpp"
#include "sim/world_body.hpp"

class btSequentialImpulseConstraintSolver;

// Internal to the rigid world.
namespace sunder {

/// What the solver reads besides Bullet's bodies and manifolds; a manifold point's m_index0 is its
/// number among the meetings. Results are in the manifold points and in the bodies.
struct SolverTask {
  std::vector<Meeting> meetings;
  Vec3 gravity;
  double dt = 0;
  bool warm_joints = true;      ///< joints start from their last impulses
  std::uint64_t fallbacks = 0;  ///< solves that a direct method gave up
};

/// Bullet's solver with a friction cone instead of a box, sweeps there and back, restitution after
/// the solve without it, and overlaps removed last, by what remains of them at the end of the step.
/// Joints as the method says; the direct ones (Dantzig, Lemke) take contacts and their friction,
/// as a box, into the same problem, and take O(rows³).
std::unique_ptr<btSequentialImpulseConstraintSolver> impulse_solver(SolverTask& task,
                                                                    JointSolver method);

}  // namespace sunder
