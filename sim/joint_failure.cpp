// SPDX-License-Identifier: GPL-3.0-or-later
// Which joints fail: by their load, by the buckling or the lost bracing of a post, by a hit.
#include <algorithm>
#include <cmath>

#include "sim/collapse_run.hpp"

namespace sunder {

bool CollapseRun::is_awake(const FrameJoint& joint) const {
  return world_.is_awake(parts_[joint.a].body);
}

/// Section forces of part a: tension positive. What holds its beginning pulls the other way.
JointLoad CollapseRun::load_of(std::uint32_t j) const {
  const JointReaction reaction = world_.joint_reaction(joints_[j].id);
  const double side = frame_.joints[j].end_a == 1 ? 1 : -1;
  return {side * reaction.force, side * reaction.torque};
}

/// A first-order lag, by the implicit rule; the first reading is taken as it is.
void CollapseRun::follow(Joint& state, const JointLoad& load) const {
  const double share = last_dt_ > 0 ? last_dt_ / (last_dt_ + scene_.rules.load_time) : 1;
  state.load.force = state.load.force + share * (load.force - state.load.force);
  state.load.torque = state.load.torque + share * (load.torque - state.load.torque);
}

void CollapseRun::break_overloaded() {
  std::vector<Failure> failures, overloads;
  read_loads(overloads);
  check_hits(failures);
  check_posts(failures);
  failures.insert(failures.end(), overloads.begin(), overloads.end());
  if (breaks_) break_joints(std::move(failures));
}

void CollapseRun::read_loads(std::vector<Failure>& failures) {
  for (std::uint32_t j = 0; j < joints_.size(); ++j) {
    Joint& state = joints_[j];
    if (!state.intact) continue;
    const FrameJoint& joint = frame_.joints[j];
    if (is_awake(joint)) {
      follow(state, load_of(j));
    } else if (params_.skip && state.peak.utilisation > 0) {
      ++result_.joint_steps_not_read;
      continue;
    }
    const JointLoad& load = state.load;
    const Utilisation use = utilisation(load, joint.strength);
    state.utilisation = use.total;
    result_.max_utilisation = std::max(result_.max_utilisation, use.total);
    if (use.total >= state.peak.utilisation) {
      const auto narrow = [](Vec3 v) {
        return std::array{static_cast<float>(v.x), static_cast<float>(v.y),
                          static_cast<float>(v.z)};
      };
      state.peak = {narrow(load.force), narrow(load.torque), static_cast<float>(use.force),
                    static_cast<float>(use.torque), static_cast<float>(use.total)};
    }
    if (use.total >= 1)
      failures.push_back({j, use.total, "strength", frame_.classes[joint.joint_class].interaction,
                          std::string(use.component), true});
  }
}

void CollapseRun::check_posts(std::vector<Failure>& failures) {
  for (const std::uint32_t post : posts_.posts()) {
    const std::uint32_t foot = posts_.foot(post);
    if (foot == kNoPart || parts_[post].body == kNoBody || !is_awake(frame_.joints[foot])) continue;
    const double compression = -joints_[foot].load.force.x;
    if (compression <= 0) continue;
    const double use = compression / posts_.resistance(post);
    result_.max_utilisation = std::max(result_.max_utilisation, use);
    if (use < 1) continue;
    for (const std::uint32_t j : posts_.joints_of_buckling(post))
      failures.push_back({j, use, "buckling", scene_.rules.post_rule, "N", false});
  }
}

/// The joint's place now, world.
Vec3 CollapseRun::place_of(std::uint32_t j) const {
  const FrameJoint& joint = frame_.joints[j];
  const PartSolid& solid = parts_[joint.a].solid;
  return world_.pose(parts_[joint.a].body) * into(solid.axes, joint.point - solid.centre);
}

/// A projectile breaks the joints of what it touches that lie within its radius of the contact.
void CollapseRun::check_hits(std::vector<Failure>& failures) {
  for (const Contact& contact : world_.contacts()) {
    for (std::uint32_t s = 0; s < shots_.size(); ++s) {
      const BodyId ball = shots_[s].body;
      if (ball == kNoBody || (contact.a != ball && contact.b != ball)) continue;
      const std::uint32_t part = body_part(contact.a == ball ? contact.b : contact.a);
      if (part == kNoPart) continue;
      disturbed_ = true;
      note_hit(contact, s, last_dt_);
      if (!scene_.rules.hit_breaks) continue;
      for (const std::uint32_t j : joints_of_[part]) {
        if (!joints_[j].intact) continue;
        if (length(place_of(j) - contact.point) > scene_.projectiles[s].radius) continue;
        failures.push_back(
            {j, joints_[j].utilisation, "hit", scene_.projectiles[s].name, {}, true});
      }
    }
  }
}

void CollapseRun::note_hit(const Contact& contact, std::uint32_t shot, double dt) {
  ProjectileOutcome& outcome = result_.projectiles[shot];
  if (outcome.hit) return;
  outcome.hit = true;
  outcome.speed_before = length(shots_[shot].velocity);
  outcome.contact_force = contact.impulse / dt;
}

/// Joint by joint; the reason that came first counts. What follows from a loss of bracing follows at
/// once.
void CollapseRun::break_joints(std::vector<Failure> failures) {
  std::ranges::stable_sort(failures, {}, &Failure::joint);
  for (std::size_t i = 0; i < failures.size(); ++i) {
    const Failure failure = failures[i];
    if (!joints_[failure.joint].intact) continue;
    break_joint(failure);
    const std::uint32_t splice = posts_.unbraced_splice(failure.joint);
    if (splice != kNoPart)
      failures.push_back({splice, joints_[splice].utilisation, "unbraced", "paper", {}, false});
  }
}

void CollapseRun::break_joint(const Failure& failure) {
  Joint& state = joints_[failure.joint];
  const FrameJoint& joint = frame_.joints[failure.joint];
  state.intact = false;
  state.broken = now_;
  posts_.break_joint(failure.joint);
  world_.remove_joint(state.id);
  if (!failure.bears_on && joint.b != kNoPart)
    world_.separate(parts_[joint.a].body, parts_[joint.b].body);
  if (!disturbed_) ++result_.broken_at_rest;
  if (scene_.scenario.load_rate > 0 && result_.first_failure_load == 0) {
    double live = 0, area = 0;
    for (std::uint32_t s = 0; s < frame_.slabs.size(); ++s) {
      live += frame_.slabs[s].live_load * slab_area(frame_, s);
      area += slab_area(frame_, s);
    }
    result_.first_failure_load = added_load_ + (area > 0 ? live / area : 0);
  }
  recorder_.add_broken_joint(failure.joint, now_);
  result_.broken_joints.push_back(
      {failure.joint, now_, failure.utilisation, failure.mode, failure.rule, failure.component});
}

}  // namespace sunder
