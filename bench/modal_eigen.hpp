// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim/frame_solver.hpp"

namespace sunder {

/// How a frame swings that is let go at rest, without damping: u(t) = u_s + Σ c_i φ_i cos(ω_i t)
/// with all of its modes, K φ = ω² M φ. Exact but for rounding; O(freedoms³).
class ModalMotion {
 public:
  /// From displacements `start` about those that the solver's loads have at rest, `rest`.
  ModalMotion(const FrameSolver& solver, std::span<const double> start,
              std::span<const double> rest);
  ~ModalMotion();
  std::vector<double> at(double time) const;  ///< displacements, as FrameSolver has them

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunder
