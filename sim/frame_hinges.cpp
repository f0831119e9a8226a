// SPDX-License-Identifier: GPL-3.0-or-later
// Plastic hinges of the static solver. A hinge is a rotation between a node and the end of a member
// that is not elastic: the member's ends turn by less than its nodes. While a hinge turns, its
// moments are given and its rotation follows from them, condensed within the member; else its
// rotation is given.
#include <algorithm>

#include "sim/frame_solver_impl.hpp"

namespace sunder {
namespace {

Vec3 moment_at(const Twelve& v, std::size_t end) {
  return {v[6 * end + 3], v[6 * end + 4], v[6 * end + 5]};
}

/// Rotations that take what is over the held moments from ends that turn.
void turn(const MemberResponse::Bending& k, const std::array<bool, 2>& flows, double over_a,
          double over_b, double& a, double& b) {
  if (flows[0] && flows[1]) {
    const double whole = k.aa * k.bb - k.ab * k.ab;
    a = (over_a * k.bb - over_b * k.ab) / whole;
    b = (over_b * k.aa - over_a * k.ab) / whole;
  } else if (flows[0]) {
    a = (over_a - k.ab * b) / k.aa;
  } else if (flows[1]) {
    b = (over_b - k.ab * a) / k.bb;
  }
}

double product(const Twelve& a, const Twelve& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 12; ++i) sum += a[i] * b[i];
  return sum;
}

Twelve difference(Twelve a, const Twelve& b) {
  for (std::size_t i = 0; i < 12; ++i) a[i] -= b[i];
  return a;
}

/// From the load of a joint to the moment of the node on the member that ends there, and back.
double side_of(const FrameJoint& joint) {
  return joint.end_a == 1 ? 1 : -1;
}

}  // namespace

/// Only where the member's own end passes the joint, and can turn against its node.
bool FrameSolver::Impl::can_bend(std::uint32_t j) const {
  const FrameJoint& joint = frame.joints[j];
  if (joint.node == kNoPart || !links.intact(j) || !frame.classes[joint.joint_class].rigid)
    return false;
  std::vector<std::uint32_t> ends;
  links.ends_beyond(j, ends);
  return ends.size() == 1 && members[joint.a].role == Role::elastic && !members[joint.a].tip;
}

const BeamElement& FrameSolver::Impl::unbent(std::uint32_t m) const {
  return bent_of[m] == kNone ? elements[m] : bent[bent_of[m]].element;
}

void FrameSolver::Impl::set_hinges(std::span<const Hinge> hinges) {
  std::vector<std::uint32_t> touched;
  for (const Hinge& hinge : hinges) {
    if (!can_bend(hinge.joint)) continue;
    const FrameJoint& joint = frame.joints[hinge.joint];
    if (bent_of[joint.a] == kNone) {
      bent_of[joint.a] = static_cast<std::uint32_t>(bent.size());
      bent.push_back(
          {.member = joint.a, .element = elements[joint.a], .response = members[joint.a].response});
    }
    Bent& b = bent[bent_of[joint.a]];
    const std::size_t end = joint.end_a;
    b.joint[end] = hinge.joint;
    b.moment[end] = side_of(joint) * hinge.moment;
    b.rotation[end] = side_of(joint) * hinge.rotation;
    b.flows[end] = hinge.flows;
    touched.push_back(joint.a);
  }
  if (!touched.empty()) update(std::move(touched), {});
}

/// Springs of a member's element by its hinges; they go with the joint or with the last hold.
void FrameSolver::Impl::bend(std::uint32_t m) {
  if (bent_of[m] == kNone) return;
  Bent& b = bent[bent_of[m]];
  for (std::size_t end = 0; end < 2; ++end) {
    if (b.joint[end] != kNone && links.intact(b.joint[end]) &&
        members[m].role == Role::elastic && !members[m].tip)
      continue;
    b.joint[end] = kNone;
    b.flows[end] = false;
    b.moment[end] = b.rotation[end] = {};
  }
  if (members[m].role != Role::elastic) return;
  BeamElement& element = elements[m];
  b.element = element;
  b.response = members[m].response;
  const Vec3 about_x{BeamElement::kRigid, 0, 0};
  if (b.flows[0]) element.spring_a = about_x;
  if (b.flows[1]) element.spring_b = about_x;
  members[m].response = response_of(element);
}

/// Motion of the nodes that the hinges alone make.
Twelve FrameSolver::Impl::plastic_motion(const Bent& b, const std::array<Vec3, 2>& rotation) {
  Twelve motion{};
  for (std::size_t end = 0; end < 2; ++end) {
    const Vec3 turn = b.response.axes * rotation[end];
    motion[6 * end + 3] = turn.x;
    motion[6 * end + 4] = turn.y;
    motion[6 * end + 5] = turn.z;
  }
  return motion;
}

/// With these forces of the nodes were no hinge turned.
std::array<Vec3, 2> FrameSolver::Impl::plastic_rotations(const Bent& b, const Twelve& force) {
  std::array<Vec3, 2> r = b.rotation;
  const Vec3 over_a = into(b.response.axes, moment_at(force, 0)) - b.moment[0];
  const Vec3 over_b = into(b.response.axes, moment_at(force, 1)) - b.moment[1];
  turn(b.response.about_y, b.flows, over_a.y, over_b.y, r[0].y, r[1].y);
  turn(b.response.about_z, b.flows, over_a.z, over_b.z, r[0].z, r[1].z);
  return r;
}

/// What holds the nodes of members with hinges under the load collected.
void FrameSolver::Impl::load_hinges() {
  for (Bent& b : bent) {
    b.fixed = fixed[b.member];
    if (members[b.member].role != Role::elastic) continue;
    const Twelve motion = plastic_motion(b, plastic_rotations(b, b.fixed));
    fixed[b.member] = difference(b.fixed, end_forces(b.response, motion));
  }
}

void FrameSolver::Impl::turn_hinges() {
  for (Bent& b : bent) {
    if (members[b.member].role != Role::elastic) continue;
    Twelve force = end_forces(b.response, displacements_of(members[b.member], u));
    for (std::size_t i = 0; i < 12; ++i) force[i] += b.fixed[i];
    b.rotation = plastic_rotations(b, force);
  }
}

/// What the hinges change in the strain energy of the stiffness as it is.
double FrameSolver::Impl::strain_of_hinges() const {
  double twice = 0;
  for (const Bent& b : bent) {
    const Member& member = members[b.member];
    if (member.role != Role::elastic) continue;
    const Twelve motion = displacements_of(member, u);
    const Twelve elastic = difference(motion, plastic_motion(b, b.rotation));
    twice += product(elastic, end_forces(b.response, elastic)) -
             product(motion, end_forces(member.response, motion));
  }
  return twice / 2;
}

double FrameSolver::Impl::work_of(const FrameLoads& loads) {
  if (pieces.empty()) return work_on_elastic(loads);
  std::vector<double> load(u.size());
  collect(loads, load);
  double work = 0;
  for (std::size_t i = 0; i < load.size(); ++i) work += load[i] * u[i];
  for (const Bent& b : bent) {
    const Member& member = members[b.member];
    if (member.role != Role::elastic) continue;
    const Twelve motion = displacements_of(member, u);
    work += product(fixed[b.member], motion) -
            product(b.fixed, difference(motion, plastic_motion(b, b.rotation)));
  }
  return work;
}

double FrameSolver::Impl::power_of(const FrameLoads::OnPart& contact, std::span<const double> v) {
  double power = 0;
  for (auto [m, holding] : contacts_of({.gravity = {}, .contacts = {contact}}).members) {
    if (members[m].role == Role::elastic && bent_of[m] != kNone) {
      Bent free = bent[bent_of[m]];
      free.rotation = free.moment = {};
      const Twelve turned = plastic_motion(free, plastic_rotations(free, holding));
      holding = difference(holding, end_forces(free.response, turned));
    }
    power -= product(holding, displacements_of(members[m], v));
  }
  return power;
}

void FrameSolver::set_hinges(std::span<const Hinge> hinges) {
  impl_->set_hinges(hinges);
}

bool FrameSolver::can_bend(std::uint32_t joint) const {
  return impl_->can_bend(joint);
}

double FrameSolver::work_of(const FrameLoads& loads) const {
  return impl_->work_of(loads);
}

double FrameSolver::power_of(const FrameLoads::OnPart& contact, std::span<const double> v) const {
  return impl_->power_of(contact, v);
}

std::vector<FrameSolver::Hinge> FrameSolver::hinges() const {
  std::vector<Hinge> result;
  for (const Impl::Bent& b : impl_->bent)
    for (std::size_t end = 0; end < 2; ++end) {
      if (b.joint[end] == Impl::kNone) continue;
      const double side = side_of(impl_->frame.joints[b.joint[end]]);
      result.push_back({b.joint[end], side * b.moment[end], side * b.rotation[end], b.flows[end]});
    }
  std::ranges::sort(result, {}, &Hinge::joint);
  return result;
}

}  // namespace sunder
