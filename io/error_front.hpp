// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/simulation_params.hpp"

namespace sunder {

/// Settings that were measured: what they cost and how far off they are.
struct FrontPoint {
  // What a point does not say is any.
  std::optional<double> step;  ///< s
  std::optional<std::int64_t> iterations;
  std::optional<std::string> solver;
  double error = 0;    ///< relative, see ErrorFront
  double time_ms = 0;  ///< as ErrorFront says, on the machine of data/error_fronts.json
};

/// Measured points of a job ("impact", "collapse"), none of which is both dearer and less exact
/// than another, by ascending time. `./dev bench front` measures them.
struct ErrorFront {
  std::string job, error, time_ms, not_in_it;  ///< what the numbers mean, in words
  std::vector<FrontPoint> points;
};
/// data/error_fronts.json, compiled in. Throws Error{usage} for a job it does not have.
const ErrorFront& error_front(std::string_view job);

/// What `max_error` made of the settings that a scene leaves open.
struct ErrorChoice {
  double asked = 0;                 ///< max_error
  std::vector<std::string> chosen;  ///< keys of the simulation, by name; empty: none were open
  std::optional<double> expected;   ///< error of the measured point that is no finer than that
  bool is_met() const { return expected && *expected <= asked; }
};

/// Sets the keys of `simulation` that are not among `given` to those of the cheapest point whose
/// error is at most simulation.max_error; of the most exact point when none is so exact. What is
/// given restricts the points: to the step nearest above a given one, the iterations nearest below,
/// the solver itself. So less error asked for never gets a point of more error. O(points).
ErrorChoice choose_settings(const ErrorFront& front, std::span<const std::string_view> given,
                            SimulationParams& simulation);

/// What is to be expected of settings that are all given: nothing is changed.
ErrorChoice expected_error(const ErrorFront& front, const SimulationParams& simulation);

}  // namespace sunder
