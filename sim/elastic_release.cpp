// SPDX-License-Identifier: GPL-3.0-or-later
// How parts of the ringing frame move, and with what motion they leave it.
#include <algorithm>
#include <iterator>
#include <utility>

#include "sim/elastic_motion.hpp"

namespace sunder {

std::vector<std::uint32_t> ElasticMotion::nodes_of(std::uint32_t part) const {
  if (part < frame_.members.size()) return {frame_.members[part].from, frame_.members[part].to};
  const auto& nodes = part < frame_.wall_part(0) ? frame_.slabs[part - frame_.slab_part(0)].nodes
                                                 : frame_.walls[part - frame_.wall_part(0)].nodes;
  return {nodes.begin(), nodes.end()};
}

/// The node that an end of a part moves with: an end whose joint broke earlier goes with the part's
/// other end.
std::uint32_t ElasticMotion::held_node(std::uint32_t part, std::uint32_t node) const {
  std::uint32_t held = node;
  const auto holds = [&](std::uint32_t j) {
    return frame_.joints[j].node == held &&
           (links_.intact(j) || std::ranges::binary_search(broken_, j));
  };
  if (part >= frame_.members.size() || std::ranges::any_of(links_.joints_of(part), holds))
    return node;
  const FrameMember& member = frame_.members[part];
  held = member.from == node ? member.to : member.from;
  return std::ranges::any_of(links_.joints_of(part), holds) ? held : node;
}

/// Of a part at its node.
Vec3 ElasticMotion::velocity_of_end(std::uint32_t part, std::uint32_t node) const {
  const std::uint32_t held = held_node(part, node);
  if (held != node)
    if (const std::optional<StandingFrame::TipMotion> tip = standing_.tip(part))
      return tip->velocity;
  const StandingFrame::Motion motion = standing_.motion(held);
  return motion.velocity +
         cross(motion.spin, frame_.nodes[node].position - frame_.nodes[held].position);
}

Vec3 ElasticMotion::way_of_end(std::uint32_t part, std::uint32_t node) const {
  const std::uint32_t held = held_node(part, node);
  if (held != node)
    if (const std::optional<StandingFrame::TipMotion> tip = standing_.tip(part))
      return tip->displacement;
  return standing_.displacement(held) +
         cross(standing_.rotation(held), frame_.nodes[node].position - frame_.nodes[held].position);
}

/// Of a member linear between its ends, of a plate the mean of its corners.
Vec3 ElasticMotion::velocity_at(std::uint32_t part, Vec3 point) const {
  const std::vector<std::uint32_t> nodes = nodes_of(part);
  if (nodes.size() > 2) {
    Vec3 sum;
    for (const std::uint32_t node : nodes) sum = sum + velocity_of_end(part, node);
    return 0.25 * sum;
  }
  const Vec3 from = frame_.nodes[nodes[0]].position;
  const Vec3 along = frame_.nodes[nodes[1]].position - from;
  const double share = std::clamp(dot(point - from, along) / dot(along, along), 0.0, 1.0);
  return (1 - share) * velocity_of_end(part, nodes[0]) + share * velocity_of_end(part, nodes[1]);
}

/// The rigid motion, small, that moves the parts' masses as they were in the frame.
void ElasticMotion::take_frames_place(BodyParams& body,
                                      const std::vector<std::uint32_t>& parts) const {
  Vec3 way, turn;
  for (const std::uint32_t part : parts) {
    const Vec3 moved = bodies_.mass_of(part) * places_[part].way;
    way = way + moved;
    turn = turn + places_[part].turned + cross(solids_[part].centre - body.centroid, moved);
  }
  way = (1 / body.mass) * way;
  turn = inverse(body.inertia) * turn;
  body.pose = small_motion(body.centroid, way, turn);
}

/// The rigid motion with the momentum and angular momentum of the parts. Added live loads have none
/// in the frame.
void ElasticMotion::take_frames_motion(BodyParams& body,
                                       const std::vector<std::uint32_t>& parts) const {
  if (!standing_.in_time()) return;
  Vec3 momentum, angular;
  for (const std::uint32_t part : parts) {
    const Vec3 p = bodies_.own_mass_of(part) * places_[part].velocity;
    momentum = momentum + p;
    angular = angular + places_[part].turning + cross(solids_[part].centre - body.centroid, p);
  }
  body.velocity = (1 / body.mass) * momentum;
  body.angular_velocity = rotate(
      body.pose.rotation, inverse(body.inertia) * rotate(conjugate(body.pose.rotation), angular));
}

/// The first moment of a part that turns as its mass, lines on members, did in the frame. A line
/// says nothing of turns about itself.
Vec3 ElasticMotion::of_solid(std::uint32_t part, const FrameSolver::MassWay& way) const {
  constexpr double kLittle = 1e-6;
  const PartSolid& solid = solids_[part];
  const SymMat3 own = rotated(solid.axes, solid.inertia);
  SymMat3 whole = way.inertia;
  for (double SymMat3::*each :
       {&SymMat3::xx, &SymMat3::yy, &SymMat3::zz, &SymMat3::xy, &SymMat3::xz, &SymMat3::yz})
    whole.*each += kLittle * own.*each;
  return (bodies_.own_mass_of(part) / solid.mass) * (own * (inverse(whole) * way.turned));
}

void ElasticMotion::note_places(std::span<const std::uint32_t> parts,
                                std::span<const FrameSolver::MassWay> ways) {
  const std::vector<FrameSolver::MassWay> speeds =
      standing_.in_time() ? standing_.speeds(parts)
                          : std::vector<FrameSolver::MassWay>(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::uint32_t part = parts[i];
    if (!bodies_.stands(part) || !(ways[i].mass > 0)) continue;
    places_[part].way = (1 / ways[i].mass) * ways[i].moved + offsets_[part];
    places_[part].turned = of_solid(part, ways[i]);
    if (!(speeds[i].mass > 0)) continue;
    places_[part].velocity = (1 / speeds[i].mass) * speeds[i].moved;
    places_[part].turning = of_solid(part, speeds[i]);
  }
}

/// Before the frame loses these joints of its own and the parts that leave. In balance at any time
/// it is a wreck between two breaks of a cascade, displaced by kilometres: places are those before
/// the first one.
ElasticMotion::Ways ElasticMotion::note_ways(std::vector<std::uint32_t> joints,
                                             std::span<const SupportGraph::Island> leaving) {
  std::vector<std::uint32_t> parts;
  for (const SupportGraph::Island& island : leaving)
    for (const std::uint32_t part : island.chunks) {
      parts.push_back(part);
      std::ranges::copy_if(links_.joints_of(part), std::back_inserter(joints),
                           [this](std::uint32_t j) { return links_.intact(j); });
    }
  Ways before{standing_.parts_at(joints, parts), {}};
  before.ways = standing_.ways(before.parts);
  if (standing_.in_time()) {
    note_places(before.parts, before.ways);
  } else if (std::exchange(noted_, now_) != now_) {
    std::vector<std::uint32_t> all;
    for (std::uint32_t part = 0; part < places_.size(); ++part)
      if (bodies_.stands(part)) all.push_back(part);
    note_places(all, standing_.ways(all));
  }
  return before;
}

/// What still stands is where it was, whatever bears it now.
void ElasticMotion::keep_places(const Ways& before) {
  const std::vector<FrameSolver::MassWay> now = standing_.ways(before.parts);
  const auto way = [](const FrameSolver::MassWay& w) {
    return w.mass > 0 ? (1 / w.mass) * w.moved : Vec3{};
  };
  for (std::size_t i = 0; i < now.size(); ++i)
    if (const std::uint32_t part = before.parts[i]; bodies_.stands(part))
      offsets_[part] = offsets_[part] + (way(before.ways[i]) - way(now[i]));
}

}  // namespace sunder
