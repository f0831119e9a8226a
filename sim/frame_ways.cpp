// SPDX-License-Identifier: GPL-3.0-or-later
// How far the masses of parts move with the nodes: as the weight on them says, so that mass times
// way times gravity is the weight's work.
#include <algorithm>

#include "sim/frame_solver_impl.hpp"

namespace sunder {
namespace {

Vec3 minus_product(const std::array<Twelve, 3>& held_nodes, const Twelve& motion) {
  std::array<double, 3> sum{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < 12; ++i) sum[axis] -= held_nodes[axis][i] * motion[i];
  return {sum[0], sum[1], sum[2]};
}

}  // namespace

/// What holds a member's nodes under a unit force along each axis: on a metre of it, or at a point.
template <class Held>
std::array<Twelve, 3> FrameSolver::Impl::by_axis(const Held& held_nodes) {
  return {held_nodes(Vec3{1, 0, 0}), held_nodes(Vec3{0, 1, 0}), held_nodes(Vec3{0, 0, 1})};
}

std::vector<FrameSolver::MassWay> FrameSolver::Impl::mass_ways(std::span<const double> motion,
                                                               const std::vector<double>& live,
                                                               bool bends) const {
  std::vector<MassWay> ways(frame.part_count());
  std::vector<Twelve> of_member(members.size());
  std::vector<Vec3> along(members.size());  // of a metre's mass, summed up over the member
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    if (!members[m].present()) continue;
    of_member[m] = displacements_of(members[m], motion);
    if (bends && members[m].role == Role::elastic && bent_of[m] != kNone) {
      const Twelve plastic = plastic_motion(bent[bent_of[m]], bent[bent_of[m]].rotation);
      for (std::size_t i = 0; i < 12; ++i) of_member[m][i] -= plastic[i];
    }
    const auto uniform =
        by_axis([&](Vec3 force) { return held_under(m, {.uniform = force, .points = {}}); });
    along[m] = minus_product(uniform, of_member[m]);
    ways[m] = {members[m].mass * members[m].response.length, members[m].mass * along[m]};
  }
  for (const PlateSupport& plate : plates) {
    MassWay& way = ways[plate.part];
    const std::size_t p = plate.part - frame.slab_part(0);
    const double added = p < live.size() ? live[p] * plate.area / kLoadGravity : 0;
    for (std::uint32_t i = 0; i < plate.joint_count; ++i) {
      const FrameJoint& joint = frame.joints[plate.joints[i]];
      if (plate.share[i] == 0 || !members[joint.b].present()) continue;
      const bool on_line = plate.rest == PlateSupport::Rest::lines;
      const double line = plate.share[i] * (added + (on_line ? plate.mass : 0));
      way.mass += plate.share[i] * (added + plate.mass);
      way.moved = way.moved + (line / members[joint.b].response.length) * along[joint.b];
      if (on_line) continue;
      const auto point =
          by_axis([&](Vec3 force) { return held_at(joint.b, joint.point, force, {}); });
      way.moved =
          way.moved + plate.share[i] * plate.mass * minus_product(point, of_member[joint.b]);
    }
  }
  return ways;
}

std::vector<FrameSolver::MassWay> FrameSolver::ways_of_displacements(
    const std::vector<double>& live) const {
  return impl_->mass_ways(impl_->u, live, true);
}

std::vector<FrameSolver::MassWay> FrameSolver::ways_of(std::span<const double> velocities) const {
  return impl_->mass_ways(velocities, {}, false);
}

}  // namespace sunder
