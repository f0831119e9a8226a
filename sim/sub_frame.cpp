// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/sub_frame.hpp"

#include <algorithm>

namespace sunder {
namespace {

/// Number of a thing in a sorted list.
std::uint32_t place_in(const std::vector<std::uint32_t>& sorted, std::uint32_t value) {
  const auto found = std::ranges::lower_bound(sorted, value);
  if (found == sorted.end() || *found != value) return kNoPart;
  return static_cast<std::uint32_t>(found - sorted.begin());
}

/// Things of the whole frame that parts of the new one use, numbered as they come.
template <class T>
class Used {
 public:
  Used(const std::vector<T>& all, std::vector<T>& some) : all_(all), some_(some) {}
  std::uint32_t operator()(std::uint32_t index) {
    const auto found = std::ranges::find(used_, index);
    const auto place = static_cast<std::uint32_t>(found - used_.begin());
    if (found != used_.end()) return place;
    used_.push_back(index);
    some_.push_back(all_[index]);
    return place;
  }

 private:
  const std::vector<T>& all_;
  std::vector<T>& some_;
  std::vector<std::uint32_t> used_;
};

class Excerpt {
 public:
  Excerpt(const Frame& whole, SubFrame& sub)
      : whole_(whole),
        sub_(sub),
        section_(whole.sections, sub.frame.sections),
        steel_(whole.steels, sub.frame.steels),
        material_(whole.materials, sub.frame.materials),
        class_(whole.classes, sub.frame.classes) {}
  void take() {
    take_nodes();
    for (const std::uint32_t part : sub_.parts) take_part(part);
    for (const std::uint32_t j : sub_.joints) take_joint(j);
  }

 private:
  void take_nodes() {
    const auto add = [&](const auto& list) {
      nodes_.insert(nodes_.end(), list.begin(), list.end());
    };
    for (const std::uint32_t part : sub_.parts) {
      if (part < whole_.slab_part(0)) {
        add(std::array{whole_.members[part].from, whole_.members[part].to});
      } else {
        add(part < whole_.wall_part(0) ? whole_.slabs[part - whole_.slab_part(0)].nodes
                                       : whole_.walls[part - whole_.wall_part(0)].nodes);
      }
    }
    std::ranges::sort(nodes_);
    nodes_.erase(std::ranges::unique(nodes_).begin(), nodes_.end());
    // A node where nothing meets is no freedom: what ends there hangs on its other end. Nodes that
    // are held have none either, and no joint there makes that the same.
    for (const std::uint32_t n : nodes_)
      sub_.frame.nodes.push_back({whole_.nodes[n].name, whole_.nodes[n].position, true});
    for (const std::uint32_t j : sub_.joints)
      if (whole_.joints[j].node != kNoPart)
        sub_.frame.nodes[node(whole_.joints[j].node)].support = false;
  }

  std::uint32_t node(std::uint32_t of_whole) const { return place_in(nodes_, of_whole); }

  template <std::size_t N>
  std::array<std::uint32_t, N> nodes(const std::array<std::uint32_t, N>& of_whole) const {
    std::array<std::uint32_t, N> result;
    std::ranges::transform(of_whole, result.begin(), [&](std::uint32_t n) { return node(n); });
    return result;
  }

  std::array<std::uint32_t, 4> members(const std::array<std::uint32_t, 4>& of_whole) const {
    std::array<std::uint32_t, 4> result;
    std::ranges::transform(of_whole, result.begin(), [&](std::uint32_t m) { return sub_.part(m); });
    return result;
  }

  void take_part(std::uint32_t part) {
    Frame& frame = sub_.frame;
    if (part < whole_.slab_part(0)) {
      FrameMember& member = frame.members.emplace_back(whole_.members[part]);
      member.from = node(member.from);
      member.to = node(member.to);
      member.section = section_(member.section);
      member.steel = steel_(member.steel);
    } else if (part < whole_.wall_part(0)) {
      FrameSlab& slab = frame.slabs.emplace_back(whole_.slabs[part - whole_.slab_part(0)]);
      slab.nodes = nodes(slab.nodes);
      slab.beams = members(slab.beams);
      slab.material = material_(slab.material);
    } else {
      FrameWall& wall = frame.walls.emplace_back(whole_.walls[part - whole_.wall_part(0)]);
      wall.nodes = nodes(wall.nodes);
      wall.edges = members(wall.edges);
      wall.material = material_(wall.material);
    }
  }

  void take_joint(std::uint32_t j) {
    FrameJoint& joint = sub_.frame.joints.emplace_back(whole_.joints[j]);
    joint.a = sub_.part(joint.a);
    joint.b = sub_.part(joint.b);
    if (joint.node != kNoPart) joint.node = node(joint.node);
    joint.joint_class = class_(joint.joint_class);
  }

  const Frame& whole_;
  SubFrame& sub_;
  std::vector<std::uint32_t> nodes_;
  Used<Section> section_;
  Used<SteelGrade> steel_;
  Used<Material> material_;
  Used<JointClass> class_;
};

}  // namespace

std::uint32_t SubFrame::part(std::uint32_t of_whole) const {
  return place_in(parts, of_whole);
}

std::uint32_t SubFrame::joint(std::uint32_t of_whole) const {
  return place_in(joints, of_whole);
}

SubFrame sub_frame(const Frame& whole, std::span<const std::uint32_t> parts,
                   std::span<const std::uint32_t> joints) {
  SubFrame sub;
  sub.parts.assign(parts.begin(), parts.end());
  sub.joints.assign(joints.begin(), joints.end());
  Excerpt(whole, sub).take();
  return sub;
}

}  // namespace sunder
