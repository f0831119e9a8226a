// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/frame.hpp"

namespace sunder {

/// Some parts of a frame and joints among them as a frame of its own, in the same place; nothing of
/// it is held by the ground. Numbers keep their order.
struct SubFrame {
  Frame frame;
  std::vector<std::uint32_t> parts, joints;           ///< of the whole, by number here; ascending
  std::uint32_t part(std::uint32_t of_whole) const;   ///< kNoPart: not in it
  std::uint32_t joint(std::uint32_t of_whole) const;  ///< kNoPart: not in it
};

/// Joints must be among the parts and, like those, ascending. What neighbours a slab or wall had
/// that are not among the parts is forgotten. O(parts and joints, times a logarithm).
SubFrame sub_frame(const Frame& whole, std::span<const std::uint32_t> parts,
                   std::span<const std::uint32_t> joints);

}  // namespace sunder
