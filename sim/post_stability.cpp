// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/post_stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sunder {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnknown = -1;
/// A beam holds its node in directions within 60° of its own.
constexpr double kBraces = 0.5;

bool is_splice(const FrameJoint& joint) {
  return joint.kind == FrameJoint::Kind::splice;
}

}  // namespace

PostStability::PostStability(const Frame& frame, const std::string& rule)
    : frame_(frame),
      rule_(rule),
      intact_(frame.joints.size(), 1),
      joints_at_(frame.nodes.size()),
      joints_of_(frame.members.size()),
      resistance_(frame.members.size(), kUnknown) {
  for (std::uint32_t m = 0; m < frame.members.size(); ++m)
    if (frame.members[m].kind == FrameMember::Kind::post) posts_.push_back(m);
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    const FrameJoint& joint = frame.joints[j];
    if (joint.node != kNoPart) joints_at_[joint.node].push_back(j);
    for (const std::uint32_t part : {joint.a, joint.b})
      if (part < frame.members.size()) joints_of_[part].push_back(j);
  }
}

void PostStability::break_joint(std::uint32_t j) {
  const FrameJoint& joint = frame_.joints[j];
  if (joint.node != kNoPart) forget_column(joint.node);
  intact_[j] = 0;
}

void PostStability::forget_column(std::uint32_t node) {
  for (const std::uint32_t j : joints_at_[node]) {
    for (const std::uint32_t part : {frame_.joints[j].a, frame_.joints[j].b}) {
      if (part >= frame_.members.size()) continue;
      if (frame_.members[part].kind != FrameMember::Kind::post) continue;
      for (const bool up : {false, true}) {
        resistance_[part] = kUnknown;
        std::uint32_t post = part;
        for (;;) {
          const FrameMember& member = frame_.members[post];
          const std::uint32_t splice = next_splice(up ? member.to : member.from);
          if (splice == kNoPart) break;
          post = frame_.joints[splice].a == post ? frame_.joints[splice].b : frame_.joints[splice].a;
          resistance_[post] = kUnknown;
        }
      }
    }
  }
}

bool PostStability::is_braced(std::uint32_t node, Vec3 direction) const {
  return std::ranges::any_of(joints_at_[node], [&](std::uint32_t j) {
    const FrameJoint& joint = frame_.joints[j];
    return intact_[j] != 0 && (joint.kind == FrameJoint::Kind::base ||
                               (joint.kind == FrameJoint::Kind::beam_end &&
                                std::fabs(dot(joint.axes.x, direction)) > kBraces));
  });
}

/// The intact joint of two posts at a node.
std::uint32_t PostStability::next_splice(std::uint32_t node) const {
  for (const std::uint32_t j : joints_at_[node])
    if (intact_[j] != 0 && is_splice(frame_.joints[j])) return j;
  return kNoPart;
}

PostStability::Reach PostStability::reach(std::uint32_t post, bool upwards, Vec3 direction) const {
  Reach result;
  for (;;) {
    const FrameMember& member = frame_.members[post];
    const std::uint32_t node = upwards ? member.to : member.from;
    if (is_braced(node, direction)) {
      result.held = true;
      return result;
    }
    const std::uint32_t splice = next_splice(node);
    if (splice == kNoPart) return result;
    const FrameJoint& joint = frame_.joints[splice];
    post = joint.a == post ? joint.b : joint.a;
    result.length += frame_.length(frame_.members[post]);
    result.splices.push_back(splice);
  }
}

double PostStability::free_length(std::uint32_t post, Vec3 direction) const {
  const Reach below = reach(post, false, direction), above = reach(post, true, direction);
  if (!below.held && !above.held) return kInfinity;
  const double length = frame_.length(frame_.members[post]) + below.length + above.length;
  return below.held && above.held ? length : 2 * length;
}

/// Buckling about an axis moves the post across it.
FreeLength PostStability::free_length(std::uint32_t post) const {
  const Axes axes = axes_of(frame_, frame_.members[post]);
  return {free_length(post, axes.z), free_length(post, axes.y)};
}

double PostStability::resistance(std::uint32_t post) {
  if (rule_ != "ec3" && rule_ != "euler") return kInfinity;
  double& known = resistance_[post];
  if (known != kUnknown) return known;
  const FrameMember& member = frame_.members[post];
  const Section& section = frame_.sections[member.section];
  const SteelGrade& steel = frame_.steels[member.steel];
  const FreeLength length = free_length(post);
  if (std::isinf(length.about_y) || std::isinf(length.about_z)) return known = kInfinity;
  return known = rule_ == "ec3" ? buckling_resistance(section, steel, length)
                                : euler_load(section, steel, length);
}

std::uint32_t PostStability::foot(std::uint32_t post) const {
  for (const std::uint32_t j : joints_of_[post]) {
    const FrameJoint& joint = frame_.joints[j];
    if (intact_[j] != 0 && joint.a == post && joint.end_a == 0) return j;
  }
  return kNoPart;
}

std::vector<std::uint32_t> PostStability::joints_of_buckling(std::uint32_t post) const {
  const Axes axes = axes_of(frame_, frame_.members[post]);
  const FreeLength free = free_length(post);
  const Vec3 across = free.about_y > free.about_z ? axes.z : axes.y;
  const Reach below = reach(post, false, across), above = reach(post, true, across);
  std::vector<std::uint32_t> splices(below.splices.rbegin(), below.splices.rend());
  splices.insert(splices.end(), above.splices.begin(), above.splices.end());
  if (splices.empty()) {
    std::vector<std::uint32_t> all;
    for (const std::uint32_t j : joints_of_[post])
      if (intact_[j] != 0) all.push_back(j);
    return all;
  }
  // The middle of the free length, from the end of the lowest post on.
  const FrameMember& member = frame_.members[post];
  const double low = -below.length, high = frame_.length(member) + above.length;
  const double height = frame_.nodes[member.from].position.y + (low + high) / 2;
  return {*std::ranges::min_element(splices, {}, [&](std::uint32_t j) {
    return std::fabs(frame_.joints[j].point.y - height);
  })};
}

std::uint32_t PostStability::unbraced_splice(std::uint32_t broken) const {
  const FrameJoint& joint = frame_.joints[broken];
  if (rule_ != "unbraced" || joint.kind != FrameJoint::Kind::beam_end) return kNoPart;
  for (const std::uint32_t j : joints_at_[joint.node])
    if (intact_[j] != 0 && frame_.joints[j].kind == FrameJoint::Kind::beam_end) return kNoPart;
  return next_splice(joint.node);
}

}  // namespace sunder
