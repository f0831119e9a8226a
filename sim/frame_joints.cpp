// SPDX-License-Identifier: GPL-3.0-or-later
// Which parts are joined where. At a node the members make a star: one carries, every other end is
// joined to it, so that each end has exactly one joint and none closes a ring.
#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

#include "meshing/error.hpp"
#include "sim/frame.hpp"
#include "sim/frame_numbers.hpp"

namespace sunder {
namespace {

using Kind = FrameJoint::Kind;

struct MemberEnd {
  std::uint32_t member = kNoPart;
  std::uint8_t end = 2;
};

bool is_post(const FrameMember& member) {
  return member.kind == FrameMember::Kind::post;
}

[[noreturn]] void refuse(const std::string& message) {
  throw Error(ErrorCode::input, message);
}

bool all_positive(Vec3 v) {
  return v.x > 0 && v.y > 0 && v.z > 0;
}

std::uint32_t find_class(const Frame& frame, const std::string& name) {
  const auto found = std::find_if(frame.classes.begin(), frame.classes.end(),
                                  [&](const JointClass& c) { return c.name == name; });
  return found == frame.classes.end() ? kNoPart
                                      : static_cast<std::uint32_t>(found - frame.classes.begin());
}

/// What the class makes of a section; of slabs and walls, which have none, what the built-in class
/// of that kind carries.
JointStrength strength_of(const JointClass& c, const Section* section, const SteelGrade* steel) {
  const Interaction interaction = interaction_named(c.interaction);
  JointStrength result;
  if (c.force == Vec3{} && c.torque == Vec3{}) {
    if (section) {
      result = section_strength(*section, *steel, interaction, c.strength);
    } else {
      const JointClass slab = built_in_classes()[2];
      result.force = c.strength * slab.force;
      result.torque = c.strength * slab.torque;
    }
  } else {
    if (!all_positive(c.force) || !all_positive(c.torque)) {
      refuse("joint class " + c.name + ": each component of force and torque must be above 0");
    }
    result.force = c.strength * c.force;
    result.torque = c.strength * c.torque;
  }
  result.interaction = interaction;
  result.bearing = c.bearing;
  result.friction = c.friction;
  if (section) result.web_share = web_share_of(*section);
  return result;
}

class Joints {
 public:
  explicit Joints(Frame& frame) : frame_(frame) {
    for (const JointClass& c : built_in_classes()) {
      if (find_class(frame, c.name) == kNoPart) frame.classes.push_back(c);
    }
    post_ = find_class(frame, "post");
    beam_ = find_class(frame, "beam");
    frame.joints.clear();
  }

  void join_members();
  void join_slabs();
  void join_walls();
  /// `joint_class` kNoPart: by kind. `b.member` kNoPart: the ground.
  void add(MemberEnd a, MemberEnd b, std::uint32_t joint_class);

 private:
  std::vector<std::uint32_t> carriers() const;
  std::string ground_name(MemberEnd a) const;
  const FrameMember& weaker(MemberEnd a, MemberEnd b) const;
  FrameJoint plate_joint(Kind kind, std::uint32_t part, std::uint32_t member, Vec3 into,
                         std::size_t edge) const;

  Frame& frame_;
  std::uint32_t post_ = 0, beam_ = 0;
};

std::uint32_t node_of(const FrameMember& member, std::uint8_t end) {
  return end == 0 ? member.from : member.to;
}

/// Per node the member that the others are joined to: a post below, else one above, else any; of
/// several the first.
std::vector<std::uint32_t> Joints::carriers() const {
  std::vector<std::uint32_t> carrier(frame_.nodes.size(), kNoPart);
  std::vector<std::uint8_t> rank(frame_.nodes.size(), 3);
  for (std::uint32_t m = 0; m < frame_.members.size(); ++m) {
    const FrameMember& member = frame_.members[m];
    for (std::uint8_t end = 0; end < 2; ++end) {
      const std::uint32_t node = node_of(member, end);
      const std::uint8_t mine = !is_post(member) ? 2 : end == 1 ? 0 : 1;
      if (mine >= rank[node]) continue;
      rank[node] = mine;
      carrier[node] = m;
    }
  }
  return carrier;
}

/// A member that stands on the ground with both ends has two joints with it: the nodes tell them
/// apart.
std::string Joints::ground_name(MemberEnd a) const {
  const FrameMember& member = frame_.members[a.member];
  const FrameNode& node = frame_.nodes[node_of(member, a.end)];
  const FrameNode& other = frame_.nodes[node_of(member, 1 - a.end)];
  return member.name + "@ground" + (other.support ? "@" + node.name : "");
}

/// Whose section decides: of the member that ends, between posts of the one that yields first.
const FrameMember& Joints::weaker(MemberEnd a, MemberEnd b) const {
  const FrameMember& first = frame_.members[a.member];
  if (b.member == kNoPart) return first;
  const FrameMember& second = frame_.members[b.member];
  if (!is_post(first) || !is_post(second)) return first;
  const auto squash = [&](const FrameMember& m) {
    return frame_.sections[m.section].area * frame_.steels[m.steel].yield_strength;
  };
  return squash(second) < squash(first) ? second : first;
}

void Joints::add(MemberEnd a, MemberEnd b, std::uint32_t joint_class) {
  const FrameMember& member = frame_.members[a.member];
  if (joint_class == kNoPart) joint_class = is_post(member) ? post_ : beam_;
  const bool grounded = b.member == kNoPart;
  const FrameMember& decides = weaker(a, b);
  FrameJoint joint;
  joint.name = grounded ? ground_name(a) : member.name + "@" + frame_.members[b.member].name;
  joint.kind = grounded ? Kind::base : is_post(member) ? Kind::splice : Kind::beam_end;
  joint.a = a.member;
  joint.b = b.member;
  joint.node = node_of(member, a.end);
  joint.end_a = a.end;
  joint.end_b = b.end;
  joint.point = frame_.nodes[joint.node].position;
  joint.axes = axes_of(frame_, member);
  joint.joint_class = joint_class;
  joint.strength = strength_of(frame_.classes[joint_class], &frame_.sections[decides.section],
                               &frame_.steels[decides.steel]);
  frame_.joints.push_back(std::move(joint));
}

void Joints::join_members() {
  const std::vector<std::uint32_t> carrier = carriers();
  for (std::uint32_t m = 0; m < frame_.members.size(); ++m) {
    for (std::uint8_t end = 0; end < 2; ++end) {
      const std::uint32_t node = node_of(frame_.members[m], end);
      if (frame_.nodes[node].support) {
        add({m, end}, {}, kNoPart);
      } else if (const std::uint32_t other = carrier[node]; other != m) {
        const std::uint8_t other_end = frame_.members[other].from == node ? 0 : 1;
        add({m, end}, {other, other_end}, kNoPart);
      }
    }
  }
}

/// At the middle of a member that carries a slab or wall lying to the side `into`.
FrameJoint Joints::plate_joint(Kind kind, std::uint32_t part, std::uint32_t member, Vec3 into,
                               std::size_t edge) const {
  const FrameMember& carrier = frame_.members[member];
  const Vec3 along = axes_of(frame_, carrier).x;
  const Vec3 normal = cross(into, along);
  const Vec3 z = (1 / std::max(length(normal), 1e-300)) * normal;
  FrameJoint joint;
  joint.name = frame_.part_name(part) + "@" + carrier.name;
  joint.kind = kind;
  joint.a = part;
  joint.b = member;
  joint.point = 0.5 * (frame_.nodes[carrier.from].position + frame_.nodes[carrier.to].position);
  joint.axes = {cross(along, z), along, z};
  joint.joint_class = find_class(frame_, kind == Kind::slab ? "slab" : "wall");
  joint.strength = strength_of(frame_.classes[joint.joint_class], nullptr, nullptr);
  joint.edge = static_cast<std::uint8_t>(edge);
  return joint;
}

void Joints::join_slabs() {
  for (std::uint32_t s = 0; s < frame_.slabs.size(); ++s) {
    for (std::size_t i = 0; i < 4; ++i) {
      frame_.joints.push_back(
          plate_joint(Kind::slab, frame_.slab_part(s), frame_.slabs[s].beams[i], {0, 1, 0}, i));
    }
  }
}

void Joints::join_walls() {
  for (std::uint32_t w = 0; w < frame_.walls.size(); ++w) {
    const FrameWall& wall = frame_.walls[w];
    for (std::size_t i = 0; i < 4; ++i) {
      if (wall.edges[i] == kNoPart) continue;
      // The opposite edge less this one.
      const auto at = [&](std::size_t k) { return frame_.nodes[wall.nodes[k % 4]].position; };
      const Vec3 into = (at(i + 2) + at(i + 3)) - (at(i) + at(i + 1));
      frame_.joints.push_back(plate_joint(Kind::wall, frame_.wall_part(w), wall.edges[i], into, i));
    }
  }
}

/// Joints that are asked for, names resolved.
class GivenJoints {
 public:
  explicit GivenJoints(const Frame& frame) : frame_(frame) {
    for (std::uint32_t m = 0; m < frame.members.size(); ++m) {
      members_.emplace(frame.members[m].name, m);
    }
    for (std::uint32_t n = 0; n < frame.nodes.size(); ++n) nodes_.emplace(frame.nodes[n].name, n);
  }

  void add(Joints& joints, const GivenJoint& given) {
    const std::string where = "joint of " + given.of + " to " + given.to + " at " + given.at;
    const auto node = nodes_.find(given.at);
    if (node == nodes_.end()) refuse(where + ": there is no node " + given.at);
    const MemberEnd a = end_at(given.of, node->second, where);
    MemberEnd b;
    if (given.to != "ground") {
      b = end_at(given.to, node->second, where);
    } else if (!frame_.nodes[node->second].support) {
      refuse(where + ": node " + given.at + " is not a support");
    }
    if (a.member == b.member) refuse(where + ": a part cannot be joined to itself");
    const auto pair = std::minmax(a.member, b.member);
    if (!seen_.insert({pair.first, pair.second, node->second}).second) {
      refuse(where + ": is given twice");
    }
    joints.add(a, b, class_of(given, where));
  }

 private:
  MemberEnd end_at(const std::string& name, std::uint32_t node, const std::string& where) const {
    const auto found = members_.find(name);
    if (found == members_.end()) refuse(where + ": there is no post or beam " + name);
    const FrameMember& member = frame_.members[found->second];
    if (member.from != node && member.to != node) {
      refuse(where + ": " + name + " does not end at node " + frame_.nodes[node].name);
    }
    return {found->second, static_cast<std::uint8_t>(member.from == node ? 0 : 1)};
  }

  std::uint32_t class_of(const GivenJoint& given, const std::string& where) const {
    if (given.joint_class.empty()) return kNoPart;
    const std::uint32_t found = find_class(frame_, given.joint_class);
    if (found == kNoPart) refuse(where + ": there is no joint class " + given.joint_class);
    return found;
  }

  const Frame& frame_;
  std::unordered_map<std::string, std::uint32_t> members_, nodes_;
  std::set<std::array<std::uint32_t, 3>> seen_;
};

}  // namespace

void join(Frame& frame, const std::vector<GivenJoint>& given) {
  const std::vector<FrameDefect> dangling = dangling_numbers(frame);
  if (!dangling.empty()) refuse(dangling.front().part + " " + dangling.front().what);
  Joints joints(frame);
  if (given.empty()) {
    joints.join_members();
  } else {
    GivenJoints resolver(frame);
    for (const GivenJoint& g : given) resolver.add(joints, g);
  }
  joints.join_slabs();
  joints.join_walls();
}

std::vector<std::uint32_t> hand_over_joints(Frame& frame, std::uint32_t member) {
  std::vector<std::uint32_t> changed;
  for (const std::uint32_t node : {frame.members[member].from, frame.members[member].to}) {
    std::vector<std::uint32_t> carried;
    std::uint32_t heir = kNoPart;
    for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
      const FrameJoint& joint = frame.joints[j];
      if (joint.node != node || joint.b != member) continue;
      const bool is_post = frame.members[joint.a].kind == FrameMember::Kind::post;
      if (heir == kNoPart || is_post) heir = joint.a;
      carried.push_back(j);
    }
    for (const std::uint32_t j : carried) {
      FrameJoint& joint = frame.joints[j];
      if (joint.a == heir) continue;
      joint.b = heir;
      joint.end_b = frame.members[heir].from == node ? 0 : 1;
      changed.push_back(j);
    }
  }
  return changed;
}

}  // namespace sunder
