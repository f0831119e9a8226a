// SPDX-License-Identifier: GPL-3.0-or-later
// How far the masses of parts move with the nodes: as the weight on them says, so that mass times
// way times gravity is the weight's work.
#include <algorithm>
#include <cmath>

#include "sim/frame_solver_impl.hpp"

namespace sunder {
namespace {

const double kGauss = std::sqrt(0.6);  // outer points of Gauss's rule of three, weight 5/9

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

/// Of a metre's mass on a member, summed up over it; moments about its middle.
FrameSolver::Impl::LineWay FrameSolver::Impl::line_way(std::uint32_t m,
                                                       const Twelve& motion) const {
  const double length = members[m].response.length, out = kGauss * length / 2;
  const auto uniform =
      by_axis([&](Vec3 force) { return held_under(m, {.uniform = force, .points = {}}); });
  // Gauss's rule of three: the outer points see what is linear.
  const auto turning = by_axis([&](Vec3 axis) {
    const Vec3 force = 5.0 / 18 * length * cross(axis, out * members[m].response.axes.x);
    return held_under(
        m, {.uniform = {},
            .points = {{length / 2 - out, -1 * force, {}}, {length / 2 + out, force, {}}}});
  });
  return {minus_product(uniform, motion), minus_product(turning, motion)};
}

std::vector<FrameSolver::MassWay> FrameSolver::Impl::mass_ways(std::span<const double> motion,
                                                               const std::vector<double>& live,
                                                               bool bends) const {
  std::vector<MassWay> ways(frame.part_count());
  // Sums about the origin first; a line of mass reaches `half` to both sides.
  const auto add = [&](std::uint32_t part, double mass, Vec3 at, Vec3 half, Vec3 moved,
                       Vec3 turned) {
    MassWay& way = ways[part];
    add_moment(way.inertia, mass, at);
    add_moment(way.inertia, mass / 3, half);
    way.mass += mass;
    way.moved = way.moved + moved;
    way.centre = way.centre + mass * at;
    way.turned = way.turned + turned + cross(at, moved);
  };
  std::vector<Twelve> of_member(members.size());
  std::vector<LineWay> lines(members.size());
  const auto middle = [&](std::uint32_t m) {
    return members[m].at(members[m].response.length / 2);
  };
  const auto half = [&](std::uint32_t m) {
    return members[m].response.length / 2 * members[m].response.axes.x;
  };
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    if (!members[m].present()) continue;
    of_member[m] = displacements_of(members[m], motion);
    if (bends && members[m].role == Role::elastic && bent_of[m] != kNone) {
      const Twelve plastic = plastic_motion(bent[bent_of[m]], bent[bent_of[m]].rotation);
      for (std::size_t i = 0; i < 12; ++i) of_member[m][i] -= plastic[i];
    }
    lines[m] = line_way(m, of_member[m]);
    const double mass = members[m].mass;
    add(m, mass * members[m].response.length, middle(m), half(m), mass * lines[m].moved,
        mass * lines[m].turned);
  }
  for (const PlateSupport& plate : plates) {
    const std::size_t p = plate.part - frame.slab_part(0);
    const double added = p < live.size() ? live[p] * plate.area / kLoadGravity : 0;
    for (std::uint32_t i = 0; i < plate.joint_count; ++i) {
      const FrameJoint& joint = frame.joints[plate.joints[i]];
      const std::uint32_t m = joint.b;
      if (plate.share[i] == 0 || !members[m].present()) continue;
      const bool on_line = plate.rest == PlateSupport::Rest::lines;
      const double on_it = plate.share[i] * (added + (on_line ? plate.mass : 0));
      const double line = on_it / members[m].response.length;
      add(plate.part, on_it, middle(m), half(m), line * lines[m].moved, line * lines[m].turned);
      if (on_line) continue;
      const auto point = by_axis([&](Vec3 force) { return held_at(m, joint.point, force, {}); });
      const double mass = plate.share[i] * plate.mass;
      add(plate.part, mass, joint.point, {}, mass * minus_product(point, of_member[m]), {});
    }
  }
  for (MassWay& way : ways) {
    if (!(way.mass > 0)) continue;
    way.centre = (1 / way.mass) * way.centre;
    way.turned = way.turned - cross(way.centre, way.moved);
    add_moment(way.inertia, -way.mass, way.centre);
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
