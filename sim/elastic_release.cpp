// SPDX-License-Identifier: GPL-3.0-or-later
// How parts of the ringing frame move, and with what motion they leave it.
#include <algorithm>

#include "sim/elastic_motion.hpp"

namespace sunder {

std::vector<std::uint32_t> ElasticMotion::nodes_of(std::uint32_t part) const {
  if (part < frame_.members.size()) return {frame_.members[part].from, frame_.members[part].to};
  const auto& nodes = part < frame_.wall_part(0) ? frame_.slabs[part - frame_.slab_part(0)].nodes
                                                 : frame_.walls[part - frame_.wall_part(0)].nodes;
  return {nodes.begin(), nodes.end()};
}

/// Of a part at its node; an end whose joint broke earlier goes with the part's other end.
Vec3 ElasticMotion::velocity_of_end(std::uint32_t part, std::uint32_t node) const {
  std::uint32_t held = node;
  const auto holds = [&](std::uint32_t j) {
    return frame_.joints[j].node == held &&
           (links_.intact(j) || std::ranges::binary_search(broken_, j));
  };
  if (part < frame_.members.size() && std::ranges::none_of(links_.joints_of(part), holds)) {
    const FrameMember& member = frame_.members[part];
    held = member.from == node ? member.to : member.from;
    if (std::ranges::none_of(links_.joints_of(part), holds)) held = node;
  }
  const StandingFrame::Motion motion = standing_.motion(held);
  return motion.velocity +
         cross(motion.spin, frame_.nodes[node].position - frame_.nodes[held].position);
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

/// The rigid motion with the momentum and angular momentum of the parts. Between its nodes a part's
/// velocity is linear in each direction: neighbours share their masses as finite elements do.
void ElasticMotion::take_frames_motion(BodyParams& body,
                                       const std::vector<std::uint32_t>& parts) const {
  if (!standing_.in_time()) return;
  Vec3 momentum, angular;
  for (const std::uint32_t part : parts) {
    const std::vector<std::uint32_t> nodes = nodes_of(part);
    const std::size_t count = nodes.size();
    const double share = bodies_.mass_of(part) / (count == 2 ? 6 : 36), size = count == 2 ? 2 : 4;
    Vec3 middle;
    std::array<Vec3, 4> velocity;
    for (std::size_t i = 0; i < count; ++i) {
      middle = middle + (1 / size) * frame_.nodes[nodes[i]].position;
      velocity[i] = velocity_of_end(part, nodes[i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 arm = solids_[part].centre + frame_.nodes[nodes[i]].position - middle;
      for (std::size_t j = 0; j < count; ++j) {
        const std::size_t apart = (i + count - j) % count;
        const double parted = apart == 0 ? size : apart == 2 ? 1 : size / 2;
        const Vec3 p = share * parted * velocity[j];
        momentum = momentum + p;
        angular = angular + cross(arm - body.centroid, p);
      }
    }
  }
  body.velocity = (1 / body.mass) * momentum;
  body.angular_velocity = inverse(body.inertia) * angular;
}

}  // namespace sunder
