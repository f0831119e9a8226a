// SPDX-License-Identifier: GPL-3.0-or-later
// An oracle for frames that fall apart: explicit in time, members in several elements, no code
// shared with the frame solver.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/frame.hpp"

namespace sunder {

struct ExplicitParams {
  int elements = 4;              ///< per member
  double step = 2e-5;            ///< s
  double gravity = 9.81;         ///< m/s²
  double damping_mass = 0;       ///< 1/s, times the mass
  double damping_stiffness = 0;  ///< s, times the stiffness
  /// Joints are judged by a first-order lag of so long, s; 0: at once.
  double lag = 0;
  bool breaking = true;
};

/// Members of a frame as Timoshenko elements with lumped masses and rotary inertia (central
/// differences, Belytschko and Hughes 1983), linear about the undeformed place. Slabs and walls are
/// left out. Joints are stars around a carrier and break as soon as they are over their strength;
/// what comes loose goes on ringing, and falls. Nothing touches anything.
class ExplicitFrame {
 public:
  /// Keeps a reference. At rest under its weight; these members are then taken away.
  ExplicitFrame(const Frame& frame, const ExplicitParams& params,
                const std::vector<std::uint32_t>& removed = {});
  ~ExplicitFrame();
  ExplicitFrame(const ExplicitFrame&) = delete;
  ExplicitFrame& operator=(const ExplicitFrame&) = delete;

  struct Break {
    double time = 0;  ///< s
    std::uint32_t joint = 0;
    double utilisation = 0;
  };
  void run(double until);  ///< s
  const std::vector<Break>& breaks() const;
  JointLoad load(std::uint32_t joint) const;          ///< at the last step
  double energy() const;                              ///< kinetic, strain and of the weight, J
  double kinetic() const;                             ///< J
  Vec3 displacement(std::uint32_t m, int end) const;  ///< of a member's end, m

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunder
