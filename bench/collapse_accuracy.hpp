// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "bench/frame_world.hpp"
#include "sim/collapse.hpp"

namespace sunder {

/// A way to carry a building.
struct Method {
  enum class Engine : std::uint8_t { bullet, cold, warm };
  Engine engine = Engine::warm;  ///< Bullet itself; ours without and with warm start
  JointSolver solver = JointSolver::sequential_impulse;
  int iterations = 30;
  double step = 1.0 / 240;
  double compliance = 0;  ///< of Bullet itself
  bool primed = true;     ///< warm: the first steps iterate more, as simulate_collapse has it
};
/// "sunder, warm", "Bullet, NNCG" …
std::string name_of(const Method& method);
std::unique_ptr<FrameWorld> frame_world(const Assembly& assembly, const Method& method);
/// One step; `number` counts from 0. Its processor time, ms.
double step_once(FrameWorld& world, const Method& method, int number);

/// Building at rest. Flat, for it comes through a pipe from a child process.
struct Rest {
  double sag_mean = 0, sag_max = 0;            ///< of the tops after the first half, m
  double sag_mean_end = 0, sag_max_end = 0;    ///< at the end, m
  double off = 0;                              ///< largest sag or rise of a top, at the end, m
  double gap = 0;                              ///< widest at the end, m
  double sum = 0;                              ///< base reactions, mean of the second half, N
  double corner = 0, centre = 0;               ///< of these posts; the corners' mean, N
  double overloaded = 0, utilisation = 0;      ///< joints at or over 1; largest, at the end
  double ever_overloaded = 0;                  ///< joints over 1 in any step
  double beam_moment = 0;                      ///< largest M_y of a beam's end, N m
  double step_ms = 0;                          ///< median
  double step_ms_least = 0, step_ms_most = 0;  ///< the 5th and the 95th of 100
  double start_ms = 0;                         ///< all of the first `kPrimedSteps` steps
  double steps = 0, fallbacks = 0;
};
/// Ends early when `budget_s` of wall time is used up.
Rest rest(const Frame& frame, const Method& method, double seconds, double budget_s = 1e9);

/// Largest utilisation of joint `j` of the frame by a reaction on its part a.
double utilisation_of(const Frame& frame, std::uint32_t j, const PartReaction& reaction);

/// Sag against solver settings: tables and the plot.
void measure_rest(bool is_long);
/// Dantzig's and Lemke's direct solvers on few storeys.
void measure_direct_solvers();
/// Columns, cantilevers, buckling, strength rules, removal of a post against closed forms.
void measure_closed_forms();

}  // namespace sunder
