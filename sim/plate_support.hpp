// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "sim/frame.hpp"

namespace sunder {

/// A force on a rigid part shared by the points that hold it: those forces of least squares that
/// balance force and moment. Where the points lie in line (or are one), what moment they cannot
/// take goes to each in equal parts as a torque. A point may count as part of one: `weights`, none:
/// 1 each.
struct SharedForce {
  std::vector<Vec3> force;
  Vec3 torque;  ///< at each point of weight 1
};
SharedForce share_force(std::span<const Vec3> points, Vec3 at, Vec3 force,
                        std::span<const double> weights = {});

/// How a slab or wall rests on the members around it as its joints break.
struct PlateSupport {
  enum class Rest : std::uint8_t {
    lines,   ///< weight as line loads on the carriers
    points,  ///< weight as equal point loads at the joints
    ground,  ///< weight on the ground
    none     ///< too few joints: loose
  };
  std::uint32_t part = 0;
  std::vector<std::uint32_t> joints;  ///< all of the part's, intact or not
  std::uint32_t joint_count = 0;
  double mass = 0;         ///< kg
  double area = 0;         ///< of slabs, m²: takes added live load; of walls 0
  Vec3 centre;             ///< of slabs
  bool on_ground = false;  ///< a wall of the ground floor

  Rest rest = Rest::none;
  std::vector<double> share;          ///< of the weight, per joint; 0 where it does not carry
  std::vector<std::uint8_t> carries;  ///< joints that carry

  void add_joint(std::uint32_t joint, bool does_carry);
};

/// Slabs and walls with their joints; `rest` is not yet known. Walls weigh this, kg, by number, or,
/// if that is empty, as their solids. O(parts).
std::vector<PlateSupport> plates_of(const Frame& frame, std::span<const double> wall_mass = {});

/// Rest and shares by the joints that carry. A slab: as a rigid plate on three or four of them that
/// are not in line, of a rectangle with all four a quarter each. A wall: on its lower beam, or the
/// ground; without its lower beam's joint it hangs evenly on at least two others.
void settle(const Frame& frame, PlateSupport& plate);

}  // namespace sunder
