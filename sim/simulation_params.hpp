// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "meshing/field.hpp"

namespace sunder {

/// How long and how exactly to simulate.
struct SimulationParams {
  double duration = 5;           ///< s
  double step = 1.0 / 240;       ///< s; divided further where something moves fast
  std::int64_t iterations = 20;  ///< of the contact solver
  double max_error = 0.01;       ///< relative error asked for: decides how far steps are divided
  double gravity = 9.81;         ///< m/s²
  bool ground = true;
  double ground_height = 0;        ///< m
  std::int64_t break_depth = 1;    ///< how often a free chunk may break again; 0: never
  bool sleep = true;               ///< bodies at rest leave the solver
  double history_step = 1.0 / 30;  ///< s between samples of the joints' loads and of the energies
  std::int64_t max_bodies = 4000;  ///< with more, those at rest are fixed; 0: never
  std::string solver = "hybrid";   ///< for buildings
  // Of buildings with the solver "bullet".
  std::string joint_solver = "sequential-impulse";  ///< or nncg, dantzig, lemke
  bool warm_start = true;  ///< joints start from the impulses of the last step
  double settle = 1;       ///< s before time 0, in which joints hold whatever happens
  // Of buildings with the solver "hybrid".
  bool quasi_static = false;   ///< the standing frame is in balance at any time: it does not ring
  bool p_delta = false;        ///< second-order effect of axial forces, while nothing rings
  bool diaphragms = false;     ///< slabs are stiff in their plane
  double damping_mass = 0.23;  ///< 1/s; Rayleigh's C = this × M + the next × K: 2 % at 1 and 10 Hz
  double damping_stiffness = 5.8e-4;  ///< s
};
template <>
std::span<const Field<SimulationParams>> fields();

}  // namespace sunder
