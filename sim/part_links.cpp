// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/part_links.hpp"

#include <algorithm>

#include "sim/plate_support.hpp"

namespace sunder {

PartLinks::PartLinks(const Frame& frame)
    : frame_(frame), intact_(frame.joints.size(), 1), joints_of_(frame.part_count()) {
  list_again();
}

void PartLinks::list_again() {
  intact_.resize(frame_.joints.size(), 1);
  joints_of_.resize(frame_.part_count());
  for (std::vector<std::uint32_t>& list : joints_of_) list.clear();
  for (std::uint32_t j = 0; j < frame_.joints.size(); ++j) {
    joints_of_[frame_.joints[j].a].push_back(j);
    if (frame_.joints[j].b != kNoPart) joints_of_[frame_.joints[j].b].push_back(j);
  }
}

std::vector<std::uint32_t> PartLinks::broken() const {
  std::vector<std::uint32_t> joints;
  for (std::uint32_t j = 0; j < intact_.size(); ++j)
    if (intact_[j] == 0) joints.push_back(j);
  return joints;
}

std::vector<std::vector<std::uint32_t>> PartLinks::components(
    std::vector<std::uint32_t> parts) const {
  std::vector<std::vector<std::uint32_t>> found;
  std::ranges::sort(parts);
  std::vector<std::uint8_t> reached(parts.size(), 0);
  const auto place = [&](std::uint32_t part) {
    return static_cast<std::size_t>(std::ranges::lower_bound(parts, part) - parts.begin());
  };
  for (const std::uint32_t seed : parts) {
    if (reached[place(seed)] != 0) continue;
    std::vector<std::uint32_t> group{seed};
    reached[place(seed)] = 1;
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (const std::uint32_t j : joints_of_[group[i]]) {
        const FrameJoint& joint = frame_.joints[j];
        if (intact_[j] == 0 || joint.b == kNoPart) continue;
        const std::uint32_t other = joint.a == group[i] ? joint.b : joint.a;
        if (reached[place(other)] != 0) continue;
        reached[place(other)] = 1;
        group.push_back(other);
      }
    }
    std::ranges::sort(group);
    found.push_back(std::move(group));
  }
  return found;
}

std::vector<std::uint32_t> PartLinks::joints_within(std::span<const std::uint32_t> parts) const {
  std::vector<std::uint32_t> joints;
  for (const std::uint32_t part : parts)
    for (const std::uint32_t j : joints_of_[part])
      if (intact_[j] != 0 && frame_.joints[j].a == part) joints.push_back(j);
  std::ranges::sort(joints);
  return joints;
}

bool PartLinks::member_is_held(std::uint32_t member) const {
  bool held[2] = {false, false}, hinged[2] = {false, false};
  for (const std::uint32_t j : joints_of_[member]) {
    const FrameJoint& joint = frame_.joints[j];
    if (intact_[j] == 0 || joint.node == kNoPart) continue;
    const bool ends = joint.a == member;
    const std::size_t end = ends ? joint.end_a : joint.end_b;
    held[end] = true;
    hinged[end] |= ends && !frame_.classes[joint.joint_class].rigid;
  }
  if (held[0] && held[1]) return true;
  return held[0] ? !hinged[0] : held[1] && !hinged[1];
}

bool PartLinks::plate_is_held(std::uint32_t part) const {
  PlateSupport plate;
  plate.part = part;
  for (const std::uint32_t j : joints_of_[part])
    plate.add_joint(j, intact_[j] != 0 && member_is_held(frame_.joints[j].b));
  settle(frame_, plate);
  return plate.rest != PlateSupport::Rest::none;
}

std::vector<std::uint32_t> PartLinks::unheld(std::span<const std::uint32_t> parts) const {
  std::vector<std::uint32_t> loose;
  for (const std::uint32_t part : parts) {
    const bool held = part < frame_.slab_part(0) ? member_is_held(part) : plate_is_held(part);
    if (!held) loose.push_back(part);
  }
  return loose;
}

}  // namespace sunder
