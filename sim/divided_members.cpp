// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/divided_members.hpp"

#include <algorithm>
#include <cstdio>

#include "meshing/error.hpp"
#include "sim/part_pose.hpp"

namespace sunder {
namespace {

bool is_post(const FrameMember& member) {
  return member.kind == FrameMember::Kind::post;
}

std::string name_at(const std::string& member, double at) {
  char text[32];
  std::snprintf(text, sizeof text, "@%.3fm", at);
  return member + text;
}

/// That no part has.
std::string free_name(const Frame& frame, std::string name) {
  const auto is_taken = [&](std::uint32_t part) { return frame.part_name(part) == name; };
  for (std::uint32_t part = 0; part < frame.part_count();) {
    if (!is_taken(part)) {
      ++part;
      continue;
    }
    name += "_";
    part = 0;
  }
  return name;
}

/// Rigid, and as strong as the section, whatever the joints of the class are.
std::uint32_t class_inside(Frame& frame, std::uint32_t joint_class) {
  JointClass inside = frame.classes[joint_class];
  inside.name += ", inside";
  const auto found = std::ranges::find(frame.classes, inside.name, &JointClass::name);
  if (found != frame.classes.end())
    return static_cast<std::uint32_t>(found - frame.classes.begin());
  inside.strength = 1;
  inside.force = inside.torque = {};
  inside.rigid = true;
  frame.classes.push_back(std::move(inside));
  return static_cast<std::uint32_t>(frame.classes.size() - 1);
}

/// A joint of a slab or wall goes on to the first part, and a new one to the second; they stand in
/// the middles of these.
void divide_plate_joint(Frame& frame, std::uint32_t j, const MemberDivision& division) {
  const auto middle = [&](std::uint32_t m) {
    const FrameMember& member = frame.members[m];
    return 0.5 * (frame.nodes[member.from].position + frame.nodes[member.to].position);
  };
  const auto take = [&](FrameJoint& joint, std::uint32_t member, double share) {
    joint.b = member;
    joint.point = middle(member);
    joint.share *= share;
    joint.strength.force = share * joint.strength.force;
    joint.strength.torque = share * joint.strength.torque;
  };
  FrameJoint second = frame.joints[j];
  second.name = frame.part_name(second.a) + "@" + frame.members[division.part].name;
  take(second, division.part, 1 - division.share);
  take(frame.joints[j], division.member, division.share);
  frame.joints.push_back(std::move(second));
}

/// Turns like the direction a into b, by the shorter way.
Vec3 turned_along(Vec3 a, Vec3 b, Vec3 v) {
  const Vec3 axis = cross(a, b);
  const double cosine = dot(a, b);
  return cosine * v + cross(axis, v) + dot(axis, v) / (1 + cosine) * axis;
}

/// About a place, so that what was in the direction of `was` is in that of `is`.
PartSolid swung(PartSolid solid, Vec3 about, Vec3 was, Vec3 is) {
  const Vec3 from = 1 / length(was - about) * (was - about),
             to = 1 / length(is - about) * (is - about);
  solid.centre = about + turned_along(from, to, solid.centre - about);
  solid.axes = {turned_along(from, to, solid.axes.x), turned_along(from, to, solid.axes.y),
                turned_along(from, to, solid.axes.z)};
  return solid;
}

/// Of the node between the parts, from the line between the ends.
Vec3 off_line(const MemberDivision& division, const Kinks::Displacement& displacement) {
  return displacement(division.node) - (1 - division.share) * displacement(division.from) -
         division.share * displacement(division.to);
}

PartSolid cut_out(const PartSolid& solid, double low, double high) {
  PartSolid part = solid;
  part.half_length = (high - low) / 2;
  part.centre = solid.centre + (high + low) / 2 * solid.axes.z;
  const double share = part.half_length / solid.half_length;
  part.mass = share * solid.mass;
  // Of a prism: m l²/12 by its length l = 2 half_length, across it, besides what its outline gives.
  const double less = solid.mass / 3 * solid.half_length * solid.half_length;
  const double more = part.mass / 3 * part.half_length * part.half_length;
  part.inertia = {share * (solid.inertia.xx - less) + more,
                  share * (solid.inertia.yy - less) + more,
                  share * solid.inertia.zz,
                  share * solid.inertia.xy,
                  share * solid.inertia.xz,
                  share * solid.inertia.yz};
  return part;
}

}  // namespace

std::uint32_t class_within(const Frame& frame, std::uint32_t member,
                           const std::vector<std::uint32_t>& joints) {
  for (const std::uint32_t j : joints)
    if (frame.joints[j].a == member && frame.joints[j].node != kNoPart)
      return frame.joints[j].joint_class;
  const std::string kind = is_post(frame.members[member]) ? "post" : "beam";
  const auto found = std::ranges::find(frame.classes, kind, &JointClass::name);
  if (found == frame.classes.end())
    throw Error(ErrorCode::input, "member " + frame.members[member].name +
                                      ": hangs on no joint, and there is no joint class \"" + kind +
                                      "\" that says how it fails");
  return static_cast<std::uint32_t>(found - frame.classes.begin());
}

JointStrength strength_within(const Frame& frame, std::uint32_t m, std::uint32_t joint_class) {
  const FrameMember& member = frame.members[m];
  const Section& section = frame.sections[member.section];
  const JointClass& rule = frame.classes[joint_class];
  Interaction interaction = interaction_named(rule.interaction);
  if (interaction == Interaction::ec3_i && section.shape != "i") interaction = Interaction::linear;
  JointStrength strength = section_strength(section, frame.steels[member.steel], interaction);
  strength.bearing = rule.bearing;
  strength.friction = rule.friction;
  strength.web_share = web_share_of(section);
  return strength;
}

MemberDivision divide_member(Frame& frame, const MemberCut& cut,
                             const std::function<bool(std::uint32_t joint)>& is_intact) {
  const auto part = static_cast<std::uint32_t>(frame.members.size());
  const std::uint32_t m = cut.member, from = frame.members[m].from, to = frame.members[m].to;
  const std::string place = name_at(frame.members[m].name, cut.at);
  const MemberDivision division{.member = m,
                                .part = part,
                                .node = static_cast<std::uint32_t>(frame.nodes.size()),
                                .joint = static_cast<std::uint32_t>(frame.joints.size()),
                                .from = from,
                                .to = to,
                                .share = cut.at / frame.length(frame.members[m])};
  const Vec3 start = frame.nodes[from].position, end = frame.nodes[to].position;
  const std::string first = free_name(frame, frame.members[m].name + "_a");
  const std::string second = free_name(frame, frame.members[m].name + "_b");
  frame.nodes.push_back({place, start + division.share * (end - start), false});
  for (FrameJoint& joint : frame.joints) {
    joint.a = moved_up(joint.a, part, 1);
    joint.b = moved_up(joint.b, part, 1);
    if (joint.node == kNoPart) continue;
    if (joint.a == m && joint.end_a == 1) joint.a = part;
    if (joint.b == m && joint.end_b == 1) joint.b = part;
  }
  frame.members.push_back(frame.members[m]);
  frame.members[m].to = frame.members[part].from = division.node;
  frame.members[m].name = first;
  frame.members[part].name = second;
  FrameJoint joint;
  joint.name = place;
  joint.kind = is_post(frame.members[m]) ? FrameJoint::Kind::splice : FrameJoint::Kind::inside;
  joint.a = part;
  joint.b = m;
  joint.node = division.node;
  joint.end_a = 0;
  joint.end_b = 1;
  joint.point = frame.nodes[division.node].position;
  joint.axes = axes_of(frame, frame.members[part]);
  joint.strength = cut.strength;
  joint.joint_class = class_inside(frame, cut.joint_class);
  frame.joints.push_back(std::move(joint));
  for (std::uint32_t j = 0; j < division.joint; ++j)
    if (frame.joints[j].b == m && frame.joints[j].node == kNoPart && is_intact(j))
      divide_plate_joint(frame, j, division);
  return division;
}

std::pair<PartSolid, PartSolid> divided(const PartSolid& solid, double z) {
  return {cut_out(solid, -solid.half_length, z), cut_out(solid, z, solid.half_length)};
}

void Kinks::add(const MemberDivision& division, const std::array<PartSolid, 2>& stood,
                const Displacement& displacement) {
  bends_.push_back(
      {division, stood, {pose_of(stood[0]), pose_of(stood[1])}, off_line(division, displacement)});
}

Kinks::Poses Kinks::follow(const Displacement& displacement, const Holds& holds) {
  Poses moved;
  for (Bend& bend : bends_) {
    const MemberDivision& division = bend.division;
    if (!holds(division)) continue;
    const Vec3 way = off_line(division, displacement) - bend.start;
    const Vec3 node = frame_.nodes[division.node].position;
    for (const std::size_t i : {0, 1}) {
      const std::uint32_t part = i == 1 ? division.part : division.member;
      const Vec3 end = frame_.nodes[i == 1 ? division.to : division.from].position;
      const Pose pose = pose_of(swung(bend.stood[i], end, node, node + way));
      if (pose == bend.drawn[i]) continue;
      bend.drawn[i] = pose;
      moved.emplace_back(part, pose);
    }
  }
  std::ranges::sort(moved, {}, &Poses::value_type::first);
  return moved;
}

}  // namespace sunder
