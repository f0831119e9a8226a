// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/frame.hpp"

namespace sunder {

/// The joints of a frame's parts, and which of them are intact. Keeps a reference to the frame.
class PartLinks {
 public:
  explicit PartLinks(const Frame& frame);

  /// The frame's joints have other parts now, or there are more of both. O(joints).
  void list_again();
  void cut(std::uint32_t joint) { intact_[joint] = 0; }
  bool intact(std::uint32_t joint) const { return intact_[joint] != 0; }
  std::span<const std::uint32_t> joints_of(std::uint32_t part) const { return joints_of_[part]; }
  std::vector<std::uint32_t> broken() const;  ///< all joints that are, ascending

  // Of these parts; O(their joints, times a logarithm).
  /// What intact joints hold together, each ascending, by their first parts.
  std::vector<std::vector<std::uint32_t>> components(std::vector<std::uint32_t> parts) const;
  /// Intact joints, ascending.
  std::vector<std::uint32_t> joints_within(std::span<const std::uint32_t> parts) const;
  /// Those of a loose piece that what is left of their joints cannot hold: members without joints
  /// or on one hinge, slabs and walls on too few (PlateSupport). Ascending, if the parts are.
  std::vector<std::uint32_t> unheld(std::span<const std::uint32_t> parts) const;

 private:
  bool member_is_held(std::uint32_t member) const;
  bool plate_is_held(std::uint32_t part) const;

  const Frame& frame_;
  std::vector<std::uint8_t> intact_;
  std::vector<std::vector<std::uint32_t>> joints_of_;  ///< by part
};

}  // namespace sunder
