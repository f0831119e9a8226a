// SPDX-License-Identifier: GPL-3.0-or-later
// Loads of a frame none of which flies, where weight stays and contacts come and go: the weight is
// kept for a unit field along each axis, and what contacts and hinges change is laid on it and
// taken away again.
#include <algorithm>

#include "sim/frame_solver_impl.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kFixed = FrameLinks::kFixed;

std::array<double, 3> parts_of(Vec3 v) {
  return {v.x, v.y, v.z};
}

void add(Twelve& sum, double factor, const Twelve& v) {
  for (std::size_t i = 0; i < 12; ++i) sum[i] += factor * v[i];
}

double product(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

bool same(const FrameLoads& a, const FrameLoads& b) {
  return a.gravity == b.gravity && a.live == b.live &&
         std::ranges::equal(a.contacts, b.contacts, [](const auto& c, const auto& d) {
           return c.part == d.part && c.point == d.point && c.force == d.force;
         });
}

}  // namespace

/// What the loads' own weight needs.
void FrameSolver::Impl::know_weight(const FrameLoads& loads) {
  if (weight.live != loads.live) {
    weight.live = loads.live;
    weight.known = {};
    laid.weight = false;
  }
  const std::array<double, 3> along = parts_of(loads.gravity);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (along[axis] == 0 || weight.known[axis]) continue;
    weight.known[axis] = true;
    lay_live(loads.live);
    const Vec3 unit{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
    std::vector<Twelve> kept(members.size());
    kept.swap(fixed);
    for (std::uint32_t m = 0; m < members.size(); ++m)
      if (members[m].present()) add_field(m, {{}, unit, {}, {}});
    weight.f[axis].resize(f.size());
    sum_at_nodes(weight.f[axis]);
    kept.swap(fixed);
    weight.fixed[axis] = std::move(kept);
  }
}

/// What would hold the nodes of a member under these loads, of which the contacts are given.
Twelve FrameSolver::Impl::held_by(std::uint32_t m, const FrameLoads& loads,
                                  const ContactLoads& contacts) const {
  const std::array<double, 3> along = parts_of(loads.gravity);
  Twelve held_nodes{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (along[axis] != 0) add(held_nodes, along[axis], weight.fixed[axis][m]);
  for (const auto& [loaded, more] : contacts.members)
    if (loaded == m) add(held_nodes, 1, more);
  return held_nodes;
}

void FrameSolver::Impl::nodal_load(const FrameLoads& loads, std::span<double> result) {
  know_weight(loads);
  const std::array<double, 3> along = parts_of(loads.gravity);
  std::ranges::fill(result, 0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (along[axis] == 0) continue;
    const std::span<const double> own = weight.f[axis];
    for (std::size_t i = 0; i < result.size(); ++i) result[i] += along[axis] * own[i];
  }
  const auto take = [&](const Member& member, double sign, const Twelve& held_nodes) {
    for (std::size_t i = 0; i < 12; ++i)
      if (member.node[i / 6] < kFixed)
        result[6 * std::size_t{member.node[i / 6]} + i % 6] -= sign * held_nodes[i];
  };
  const ContactLoads& contacts = contacts_of(loads);
  for (const auto& [m, held_nodes] : contacts.members) take(members[m], 1, held_nodes);
  for (const Bent& b : bent) {
    if (members[b.member].role != Role::elastic) continue;
    const Twelve rigid = held_by(b.member, loads, contacts);
    take(members[b.member], -1,
         end_forces(b.response, plastic_motion(b, plastic_rotations(b, rigid))));
  }
}

/// The model changed, or its loads are collected anew.
void FrameSolver::Impl::unlay() {
  weight.known = {};
  laid.weight = laid.carries = false;
}

/// Brings `fixed` and `plate_loads` to these loads.
void FrameSolver::Impl::lay(const FrameLoads& loads) {
  know_weight(loads);
  laid.carries = false;
  const ContactLoads none;
  if (laid.weight && laid.loads.gravity == loads.gravity) {
    for (const std::uint32_t m : laid.members) fixed[m] = held_by(m, loads, none);
    for (const std::uint32_t j : laid.joints) plate_loads[j] = {};
    for (const std::uint32_t j : laid.joints) {
      const PlateSupport& plate = plates[frame.joints[j].a - frame.slab_part(0)];
      for (std::uint32_t i = 0; i < plate.joint_count; ++i)
        if (plate.joints[i] == j && plate.share[i] != 0)
          plate_loads[j].force = plate_weight(plate, i, loads);
    }
  } else {
    fixed.resize(members.size());
    for (std::uint32_t m = 0; m < members.size(); ++m) fixed[m] = held_by(m, loads, none);
    weigh_plates(loads);
    laid.weight = true;
  }
  laid.loads = loads;
  points_known = false;
  laid.members.clear();
  laid.joints.clear();
  const ContactLoads& contacts = contacts_of(loads);
  for (const auto& [m, held_nodes] : contacts.members) {
    add(fixed[m], 1, held_nodes);
    laid.members.push_back(m);
  }
  for (const auto& [j, load] : contacts.plates) {
    plate_loads[j].force = plate_loads[j].force + load.force;
    plate_loads[j].torque = plate_loads[j].torque + load.torque;
    laid.joints.push_back(j);
  }
  load_hinges();
  for (const Bent& b : bent) laid.members.push_back(b.member);
}

/// Whether `forces` are those of these displacements and loads already.
bool FrameSolver::Impl::carries(std::span<const double> motion, const FrameLoads& loads) const {
  return laid.carries && same(laid.loads, loads) && std::ranges::equal(u, motion);
}

/// Work of the loads on what of the displacements is no plastic rotation, J: linear in the loads.
double FrameSolver::Impl::work_on_elastic(const FrameLoads& loads) {
  know_weight(loads);
  const std::array<double, 3> along = parts_of(loads.gravity);
  double work = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (along[axis] == 0) continue;
    work += along[axis] * product(weight.f[axis], u);
    for (const Bent& b : bent)
      if (members[b.member].role == Role::elastic)
        work += along[axis] * product(weight.fixed[axis][b.member], plastic_motion(b, b.rotation));
  }
  for (const auto& [m, held_nodes] : contacts_of(loads).members) {
    work -= product(held_nodes, displacements_of(members[m], u));
    if (members[m].role == Role::elastic && bent_of[m] != kNone)
      work += product(held_nodes, plastic_motion(bent[bent_of[m]], bent[bent_of[m]].rotation));
  }
  return work;
}

}  // namespace sunder
