// SPDX-License-Identifier: GPL-3.0-or-later
// Where the energy of a falling building is, at the end and at the times in between.
#include <algorithm>
#include <utility>

#include "sim/collapse_run.hpp"

namespace sunder {

/// The ledger now; utilisations are left to sample_run().
RunSample CollapseRun::balance() const {
  const MotionLosses losses = motion_->losses();
  RunSample s;
  s.time = now_;
  s.kinetic = world_.kinetic_energy() + motion_->kinetic();
  s.strain = motion_->strain() + motion_->potential() - start_;
  s.potential = world_.potential_energy() - baseline_ - motion_->baseline();
  s.contact = result_.energy.contact + losses.contact;
  s.friction = result_.energy.friction;
  s.fracture = losses.fracture;
  if (panels_) {
    s.potential -= panels_->baseline();
    s.contact += panels_->energy().contact;
    s.friction += panels_->energy().friction;
    s.fracture += panels_->energy().fracture;
    s.broken_bonds = panels_->broken_bonds();
  }
  s.joint = losses.joint;
  s.damping = losses.damping;
  s.plastic = losses.plastic;
  s.numerical = energy_in() - s.kinetic - s.potential - s.strain - s.fracture - s.friction -
                s.contact - s.joint - s.damping - s.plastic;
  s.broken_joints = result_.broken_joints.size();
  s.moving = world_.awake_count();
  return s;
}

void CollapseRun::note_use(double utilisation) {
  used_ = std::max(used_, utilisation);
  result_.max_utilisation = std::max(result_.max_utilisation, utilisation);
}

/// What has not changed since it was read counts too.
double CollapseRun::most_used_now() const {
  double most = posts_use_;
  for (const Joint& joint : joints_)
    if (joint.intact) most = std::max(most, joint.utilisation);
  return most;
}

void CollapseRun::sample_run() {
  series_.push_back(balance());
  series_.back().max_utilisation = std::max(std::exchange(used_, 0), most_used_now());
}

void CollapseRun::take_balance() {
  CollapseResult& r = result_;
  const RunSample s = balance();
  r.energy_in = energy_in();
  r.energy = {s.kinetic, s.potential, s.strain, s.fracture, s.friction, s.contact, s.numerical};
  r.joint_work = s.joint;
  r.damping = s.damping;
  r.plastic = s.plastic;
}

}  // namespace sunder
