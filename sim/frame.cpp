// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/frame.hpp"

#include <cassert>
#include <cmath>

#include "meshing/trig.hpp"

namespace sunder {
namespace {

constexpr double kTurn = 6.283185307179586;
constexpr double kParallel = 1e-6;  // sine below which a member has no side that looks up (or to z)

Axes rolled(const Axes& axes, double roll) {
  const Vec2 turn = unit_at_turns(roll / kTurn);
  return {axes.x, turn.x * axes.y + turn.y * axes.z, turn.x * axes.z - turn.y * axes.y};
}

}  // namespace

template <>
std::span<const Field<JointClass>> fields() {
  using P = JointClass;
  static const Field<P> table[] = {
      {.name = "name",
       .member = &P::name,
       .unit = "",
       .effect = "post, beam, slab and wall are taken by kind; others by joints that name them.",
       .required = true},
      {"strength", &P::strength, "", "Factor on all six resistances.", {0, 1e6, true}},
      {.name = "interaction",
       .member = &P::interaction,
       .unit = "",
       .effect = "How the six components combine: box each alone, linear the sum of N, My and Mz, "
                 "ec3-i EN 1993-1-1 for I-sections, ellipsoid the root of the sum of squares, bolt "
                 "EN 1993-1-8, mohr friction with cohesion.",
       .choices = kInteractionNames},
      {"rigid", &P::rigid, "",
       "Whether torque passes; without it the parts turn freely about the joint."},
      {"bearing", &P::bearing, "", "Whether compression passes by contact and never breaks it."},
      {"friction", &P::friction, "", "For mohr: tangent of the friction angle.", {0, 10}},
      {"rotation_capacity",
       &P::rotation_capacity,
       "rad",
       "For hybrid: what its rule breaks bends in a plastic hinge, until it has turned so far; 0: "
       "brittle. bullet ignores it.",
       {0, 3}},
  };
  return table;
}

std::vector<JointClass> built_in_classes() {
  const Vec3 force{0.3e6, 0.3e6, 0.3e6}, torque{100e3, 100e3, 100e3};
  return {{.name = "post", .bearing = true},
          {.name = "beam"},
          {.name = "slab", .force = force, .torque = torque, .interaction = "ellipsoid"},
          {.name = "wall", .force = force, .torque = torque, .interaction = "ellipsoid"}};
}

const std::string& Frame::part_name(std::uint32_t part) const {
  assert(part < part_count() && "parts are members, then slabs, then walls");
  if (part < members.size()) return members[part].name;
  if (part < wall_part(0)) return slabs[part - members.size()].name;
  return walls[part - members.size() - slabs.size()].name;
}

double Frame::length(const FrameMember& member) const {
  return sunder::length(nodes[member.to].position - nodes[member.from].position);
}

Axes axes_of(const Frame& frame, const FrameMember& member) {
  const double size = frame.length(member);
  if (!(size > 0)) return {};
  const Vec3 x = (1 / size) * (frame.nodes[member.to].position - frame.nodes[member.from].position);
  Vec3 side = member.kind == FrameMember::Kind::beam ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  if (length(cross(side, x)) < kParallel) side = {1, 0, 0};
  const Vec3 across = side - dot(side, x) * x;
  const Vec3 z = (1 / length(across)) * across;
  return rolled({x, cross(z, x), z}, member.roll);
}

double slab_area(const Frame& frame, std::uint32_t slab) {
  double twice = 0;
  const auto& corners = frame.slabs[slab].nodes;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = frame.nodes[corners[i]].position;
    const Vec3 b = frame.nodes[corners[(i + 1) % corners.size()]].position;
    twice += a.x * b.z - b.x * a.z;
  }
  return std::fabs(twice) / 2;
}

}  // namespace sunder
