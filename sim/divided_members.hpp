// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "sim/frame.hpp"

namespace sunder {

/// A member divides in two parts at a node of its own. The first part keeps its number and its
/// start, the second one is a member after all others: slabs and walls have higher numbers from
/// then on.
struct MemberCut {
  std::uint32_t member = 0;
  double at = 0;                  ///< m from its start, between its ends
  std::uint32_t joint_class = 0;  ///< of its own end joints, by which the parts are joined
  JointStrength strength;         ///< of its section
};
struct MemberDivision {
  std::uint32_t member = 0, part = 0;  ///< the two parts; `part` is the new one
  std::uint32_t node = 0, joint = 0;   ///< between them; part a of the joint is the new one
  std::uint32_t from = 0, to = 0;      ///< nodes at the ends of the whole
  double share = 0;                    ///< of the whole's length that the first part has
};

/// The class whose rule a member keeps between its ends: that of its first own joint of these, else
/// that of its kind.
std::uint32_t class_within(const Frame& frame, std::uint32_t member,
                           const std::vector<std::uint32_t>& joints);
/// What a member bears between its ends by that class: its section's strength, whatever its joints
/// bear. A tube of a class with `ec3-i`, which knows I-sections only, keeps `linear`.
JointStrength strength_within(const Frame& frame, std::uint32_t member, std::uint32_t joint_class);

/// Divides a member of a frame. What ended or was joined at its far end is at the new part's; slabs
/// and walls that `is_intact` joints hold on it rest on both parts, by length. O(frame).
MemberDivision divide_member(Frame& frame, const MemberCut& cut,
                             const std::function<bool(std::uint32_t joint)>& is_intact);
/// The parts of a prism below and above z; together they weigh and turn as the whole.
std::pair<PartSolid, PartSolid> divided(const PartSolid& solid, double z);

/// A part's number after `count` members came in before `first`; kNoPart stays.
inline std::uint32_t moved_up(std::uint32_t part, std::uint32_t first, std::uint32_t count) {
  return part == kNoPart || part < first ? part : part + count;
}

/// How members that bend between their ends are drawn while they stand: each part straight, from an
/// end that stands where it stood to the node between the parts, where that has moved to, from the
/// line between the ends, since the member divided.
class Kinks {
 public:
  using Displacement = std::function<Vec3(std::uint32_t node)>;
  using Holds = std::function<bool(const MemberDivision&)>;
  explicit Kinks(const Frame& frame) : frame_(frame) {}

  bool none() const { return bends_.empty(); }
  /// A member that stood divided; its parts as they stood.
  void add(const MemberDivision& division, const std::array<PartSolid, 2>& stood,
           const Displacement& displacement);
  /// Poses of the parts that hold together and stand, where they changed; by part.
  using Poses = std::vector<std::pair<std::uint32_t, Pose>>;
  Poses follow(const Displacement& displacement, const Holds& holds);

 private:
  struct Bend {
    MemberDivision division;
    std::array<PartSolid, 2> stood;
    std::array<Pose, 2> drawn;
    Vec3 start;  ///< of the node from the line between the ends, m
  };

  const Frame& frame_;
  std::vector<Bend> bends_;
};

}  // namespace sunder
