// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "bench/collapse_accuracy.hpp"

namespace sunder {

/// A frame at rest by finite elements.
struct Truth {
  double sag = 0;              ///< mean of the roof, m
  std::vector<double> foot;    ///< by joint, N; 0: none
  std::vector<double> moment;  ///< by joint, M_y of beams' ends, N m
  double largest_moment = 0;
};
/// By FrameSolver, shear on.
Truth truth_of(const Frame& frame);

/// What rigid members make of it.
struct RigidStanding {
  double sag = 0;                        ///< mean of the roof, m
  double foot = 0;                       ///< the worst foot's force off, relative
  double moment = 0;                     ///< the worst beam end's moment off, by the largest
  double rms = 0;                        ///< of them all
  double rest_ms = 0;                    ///< a step, median
  double rest_least = 0, rest_most = 0;  ///< the 5th and the 95th of 100
  double hit_ms = 0;                     ///< the same after a hit
  double steps = 0, failures = 0;  ///< before the hit; of those, steps a direct solver gave up
};
/// 3 s from a cold start (forces: the mean of the last 0.5 s), then 0.5 s from the hit of a ball,
/// or what of it `budget_s` of processor time allow, and no hit.
RigidStanding stand(const Frame& frame, const Truth& truth, const Method& method,
                    double budget_s = 1e9);

}  // namespace sunder
