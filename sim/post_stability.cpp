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
std::uint32_t other_part(const FrameJoint& joint, std::uint32_t part) {
  return joint.a == part ? joint.b : joint.a;
}

}  // namespace

PostStability::PostStability(const Frame& frame, const std::string& rule)
    : frame_(frame), rule_(rule) {
  list_again();
}

void PostStability::list_again() {
  intact_.resize(frame_.joints.size(), 1);
  joints_at_.assign(frame_.nodes.size(), {});
  joints_of_.assign(frame_.members.size(), {});
  resistance_.assign(frame_.members.size(), kUnknown);
  posts_.clear();
  for (std::uint32_t m = 0; m < frame_.members.size(); ++m)
    if (frame_.members[m].kind == FrameMember::Kind::post) posts_.push_back(m);
  for (std::uint32_t j = 0; j < frame_.joints.size(); ++j) {
    const FrameJoint& joint = frame_.joints[j];
    if (joint.node != kNoPart) joints_at_[joint.node].push_back(j);
    for (const std::uint32_t part : {joint.a, joint.b})
      if (part < frame_.members.size()) joints_of_[part].push_back(j);
  }
}

void PostStability::break_joint(std::uint32_t j) {
  const FrameJoint& joint = frame_.joints[j];
  if (joint.node != kNoPart) {
    const FrameMember& member = frame_.members[joint.a];
    forget_column(member.from);
    forget_column(member.to);
  }
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
          const std::uint32_t splice = next_splice(post, up);
          if (splice == kNoPart) break;
          post = other_part(frame_.joints[splice], post);
          resistance_[post] = kUnknown;
        }
      }
    }
  }
}

/// Whether a beam's end at a node is fixed to it, and to a post or the ground there; where it has
/// divided, whether the other part's end is.
bool PostStability::is_held(std::uint32_t beam, std::uint32_t node) const {
  if (!joints_at_[node].empty() &&
      frame_.joints[joints_at_[node].front()].kind == FrameJoint::Kind::inside) {
    const std::uint32_t inside = joints_at_[node].front();
    const std::uint32_t other = other_part(frame_.joints[inside], beam);
    const FrameMember& member = frame_.members[other];
    return intact_[inside] != 0 && is_held(other, member.from == node ? member.to : member.from);
  }
  bool fixed = true, stands = frame_.nodes[node].support;
  for (const std::uint32_t j : joints_at_[node]) {
    const FrameJoint& joint = frame_.joints[j];
    if (joint.a == beam) fixed = intact_[j] != 0;
    for (const std::uint32_t part : {joint.a, joint.b})
      stands |= part != beam && intact_[j] != 0 && part < frame_.members.size() &&
                frame_.members[part].kind == FrameMember::Kind::post;
  }
  return fixed && stands;
}

/// By a joint to the ground, or by a beam whose far end holds.
bool PostStability::is_braced(std::uint32_t node, Vec3 direction) const {
  return std::ranges::any_of(joints_at_[node], [&](std::uint32_t j) {
    const FrameJoint& joint = frame_.joints[j];
    if (intact_[j] == 0) return false;
    if (joint.kind == FrameJoint::Kind::base) return true;
    if (joint.kind != FrameJoint::Kind::beam_end) return false;
    if (std::fabs(dot(joint.axes.x, direction)) <= kBraces) return false;
    const FrameMember& beam = frame_.members[joint.a];
    return is_held(joint.a, beam.from == node ? beam.to : beam.from);
  });
}

/// The intact joint with the post that goes on from this one's end. Posts that lean on each other
/// with the same end do not go on: every step leads further up or down.
std::uint32_t PostStability::next_splice(std::uint32_t post, bool upwards) const {
  const FrameMember& member = frame_.members[post];
  const std::uint32_t node = upwards ? member.to : member.from;
  for (const std::uint32_t j : joints_at_[node]) {
    const FrameJoint& joint = frame_.joints[j];
    if (intact_[j] == 0 || !is_splice(joint) || (joint.a != post && joint.b != post)) continue;
    const FrameMember& next = frame_.members[other_part(joint, post)];
    if (next.kind == FrameMember::Kind::post && (upwards ? next.from : next.to) == node) return j;
  }
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
    const std::uint32_t splice = next_splice(post, upwards);
    if (splice == kNoPart) return result;
    result.splices.push_back({splice, result.length});
    post = other_part(frame_.joints[splice], post);
    result.length += frame_.length(frame_.members[post]);
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

double PostStability::resistance_about(std::uint32_t post, bool y) const {
  const FrameMember& member = frame_.members[post];
  const Section& section = frame_.sections[member.section];
  const SteelGrade& steel = frame_.steels[member.steel];
  const FreeLength both = free_length(post);
  const double length = y ? both.about_y : both.about_z;
  if (std::isinf(length)) return kInfinity;
  const FreeLength one = y ? FreeLength{length, 0} : FreeLength{0, length};
  const double squash = section.area * steel.yield_strength;
  return rule_ == "ec3" ? buckling_resistance(section, steel, one)
                        : std::min(squash, euler_load(section, steel, one));
}

double PostStability::resistance(std::uint32_t post) {
  if (rule_ != "ec3" && rule_ != "euler") return kInfinity;
  double& known = resistance_[post];
  if (known == kUnknown)
    known = std::min(resistance_about(post, true), resistance_about(post, false));
  return known;
}

std::uint32_t PostStability::foot(std::uint32_t post) const {
  for (const std::uint32_t j : joints_of_[post]) {
    const FrameJoint& joint = frame_.joints[j];
    if (intact_[j] == 0 || joint.node != frame_.members[post].from) continue;
    const bool is_own = joint.a == post || is_splice(joint);
    if (is_own) return j;
  }
  return kNoPart;
}

std::vector<std::uint32_t> PostStability::joints_of_buckling(std::uint32_t post) const {
  const Axes axes = axes_of(frame_, frame_.members[post]);
  const bool about_y = resistance_about(post, true) < resistance_about(post, false);
  const Vec3 across = about_y ? axes.z : axes.y;
  const Reach below = reach(post, false, across), above = reach(post, true, across);
  const double own = frame_.length(frame_.members[post]);
  // Distances upwards from the post's foot.
  const double middle = (own + above.length - below.length) / 2;
  std::uint32_t nearest = kNoPart;
  double least = kInfinity;
  const auto consider = [&](std::uint32_t splice, double at) {
    if (std::fabs(at - middle) >= least) return;
    least = std::fabs(at - middle);
    nearest = splice;
  };
  for (const auto& [splice, beyond] : below.splices) consider(splice, -beyond);
  for (const auto& [splice, beyond] : above.splices) consider(splice, own + beyond);
  if (nearest != kNoPart) return {nearest};
  std::vector<std::uint32_t> all;
  for (const std::uint32_t j : joints_of_[post])
    if (intact_[j] != 0) all.push_back(j);
  return all;
}

std::uint32_t PostStability::unbraced_splice(std::uint32_t broken) const {
  const FrameJoint& joint = frame_.joints[broken];
  if (rule_ != "unbraced" || joint.kind != FrameJoint::Kind::beam_end) return kNoPart;
  for (const std::uint32_t j : joints_at_[joint.node])
    if (intact_[j] != 0 && frame_.joints[j].kind == FrameJoint::Kind::beam_end) return kNoPart;
  for (const std::uint32_t j : joints_at_[joint.node])
    if (intact_[j] != 0 && is_splice(frame_.joints[j])) return j;
  return kNoPart;
}

}  // namespace sunder
