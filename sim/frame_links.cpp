// SPDX-License-Identifier: GPL-3.0-or-later
// Clusters of member ends at a frame node, by merging labels over the intact joints there.
#include "sim/frame_links.hpp"

#include <algorithm>

#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kGround = 0xFFFFFFFFu;

std::uint32_t node_of(const Frame& frame, std::uint32_t end) {
  const FrameMember& member = frame.members[end / 2];
  return end % 2 == 0 ? member.from : member.to;
}

std::uint32_t end_a(const FrameJoint& joint) {
  return 2 * joint.a + joint.end_a;
}

std::uint32_t end_b(const FrameJoint& joint) {
  return joint.b == kNoPart ? kGround : 2 * joint.b + joint.end_b;
}

/// Items by the node that `node` gives, each node's in their order: first and items.
template <class NodeOf>
void group(std::size_t nodes, std::uint32_t items, const NodeOf& node,
           std::vector<std::uint32_t>& first, std::vector<std::uint32_t>& grouped) {
  first.assign(nodes + 1, 0);
  for (std::uint32_t i = 0; i < items; ++i)
    if (node(i) != kNoPart) ++first[node(i) + 1];
  for (std::size_t n = 0; n < nodes; ++n) first[n + 1] += first[n];
  grouped.resize(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t i = 0; i < items; ++i)
    if (node(i) != kNoPart) grouped[next[node(i)]++] = i;
}

}  // namespace

FrameLinks::FrameLinks(const Frame& frame)
    : frame_(frame), intact_(frame.joints.size(), 1), ends_(2 * frame.members.size()) {
  group(
      frame.nodes.size(), static_cast<std::uint32_t>(ends_.size()),
      [&](std::uint32_t end) { return node_of(frame, end); }, first_end_, ends_by_node_);
  group(
      frame.nodes.size(), static_cast<std::uint32_t>(frame.joints.size()),
      [&](std::uint32_t joint) { return frame.joints[joint].node; }, first_joint_, joints_by_node_);
  number_nodes();
  for (std::uint32_t n = 0; n < frame.nodes.size(); ++n) link(n);
}

void FrameLinks::number_nodes() {
  own_node_.assign(ends_.size(), kFree);
  main_node_.assign(frame_.nodes.size(), kFree);
  for (std::uint32_t n = 0; n < frame_.nodes.size(); ++n) {
    const auto give = [&](std::uint32_t end) {
      if (end == kGround || own_node_[end] != kFree) return;
      own_node_[end] = static_cast<std::uint32_t>(frame_node_.size());
      frame_node_.push_back(n);
    };
    const std::uint32_t first = node_count();
    first_owned_.push_back(first);
    for (const std::uint32_t j : joints_at(n)) give(end_b(frame_.joints[j]));
    if (frame_.nodes[n].support) {
      main_node_[n] = kFixed;
      continue;
    }
    // The tip of a cantilever moves too.
    if (node_count() == first && !ends_at(n).empty()) give(ends_at(n).front());
    if (node_count() > first) main_node_[n] = first;
  }
  first_owned_.push_back(node_count());
}

void FrameLinks::link(std::uint32_t frame_node) {
  const auto here = ends_at(frame_node);
  for (const std::uint32_t end : here) ends_[end] = {.node = own_node_[end]};
  const auto merge = [&](std::uint32_t from, std::uint32_t to) {
    if (from == kFree) return;
    for (const std::uint32_t end : here)
      if (ends_[end].node == from) ends_[end].node = to;
  };
  // Ends that own no solver node are on the side a of their only joint, or on the ground.
  for (const std::uint32_t j : joints_at(frame_node)) {
    if (!intact_[j]) continue;
    const FrameJoint& joint = frame_.joints[j];
    const std::uint32_t a = end_a(joint), b = end_b(joint);
    const std::uint32_t of_a = ends_[a].node, of_b = b == kGround ? kFixed : ends_[b].node;
    if (of_a == of_b) {
      throw Error(ErrorCode::input, "joint " + joint.name + " closes a ring of joints at node " +
                                        frame_.nodes[frame_node].name +
                                        ": how they share the load has no one answer");
    }
    const bool grounded = of_a == kFixed || of_b == kFixed;
    const std::uint32_t both = grounded ? kFixed : std::min(of_a, of_b);
    ends_[a].node = both;
    merge(of_a, both);
    if (b != kGround) {
      merge(of_b, both);
      ends_[b].held = true;
    }
    ends_[a].held = true;
    ends_[a].hinged |= !frame_.classes[joint.joint_class].rigid;
  }
}

std::uint32_t FrameLinks::moving_node(std::uint32_t frame_node) const {
  if (main_node_[frame_node] == kFixed) return kFixed;
  for (const std::uint32_t end : ends_at(frame_node))
    if (ends_[end].held) return ends_[end].node;
  return main_node_[frame_node];
}

void FrameLinks::cut(std::uint32_t joint) {
  intact_[joint] = 0;
  if (frame_.joints[joint].node != kNoPart) link(frame_.joints[joint].node);
}

void FrameLinks::add_edges(std::uint32_t frame_node_a, std::uint32_t frame_node_b,
                           Edges& edges) const {
  for (std::uint32_t a = first_owned_[frame_node_a]; a < first_owned_[frame_node_a + 1]; ++a)
    for (std::uint32_t b = first_owned_[frame_node_b]; b < first_owned_[frame_node_b + 1]; ++b)
      edges.emplace_back(a, b);
}

FrameLinks::Edges FrameLinks::edges() const {
  Edges edges;
  for (const FrameMember& member : frame_.members) add_edges(member.from, member.to, edges);
  return edges;
}

void FrameLinks::ends_beyond(std::uint32_t joint, std::vector<std::uint32_t>& ends) const {
  ends.assign(1, end_a(frame_.joints[joint]));
  const auto joints = joints_at(frame_.joints[joint].node);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (const std::uint32_t j : joints) {
      if (j == joint || !intact_[j]) continue;
      const std::uint32_t a = end_a(frame_.joints[j]), b = end_b(frame_.joints[j]);
      const std::uint32_t other = a == ends[i] ? b : b == ends[i] ? a : kGround;
      if (other == kGround || std::ranges::find(ends, other) != ends.end()) continue;
      ends.push_back(other);
    }
  }
}

}  // namespace sunder
