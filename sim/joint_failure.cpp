// SPDX-License-Identifier: GPL-3.0-or-later
// Which joints fail: by their load, by the buckling or the lost bracing of a post, by a hit.
#include <algorithm>
#include <cmath>

#include "sim/collapse_run.hpp"

namespace sunder {

namespace {

/// Of the largest utilisation: what is nearly as far over its strength breaks with it.
constexpr double kTogether = 0.9;
/// Rounds of breaking and redistribution in a step; what is over its strength then waits for the next.
constexpr int kMostRounds = 100;

}  // namespace

void CollapseRun::break_overloaded() {
  const std::size_t broken_before = result_.broken_joints.size();
  std::vector<Failure> failures, overloads;
  read_loads(overloads);
  check_hits(failures);
  check_posts(overloads);
  if (!breaks_) return;
  if (motion_->redistributes()) keep_most_utilised(overloads);
  failures.insert(failures.end(), overloads.begin(), overloads.end());
  break_joints(std::move(failures));
  cascade();
  give_way(broken_before);
}

/// Loads redistribute after each break: most utilised first, until what is left carries.
void CollapseRun::cascade() {
  for (int round = 0; round < kMostRounds && motion_->settle_breaks(); ++round) {
    std::vector<Failure> failures;
    read_loads(failures);
    check_posts(failures);
    keep_most_utilised(failures);
    for (const std::uint32_t j : motion_->unheld_joints())
      failures.push_back({j, joints_[j].utilisation, "unheld", "balance", {}, true});
    break_joints(std::move(failures));
  }
}

void CollapseRun::keep_most_utilised(std::vector<Failure>& failures) const {
  double most = 0;
  for (const Failure& failure : failures) most = std::max(most, failure.utilisation);
  std::erase_if(failures, [&](const Failure& f) { return f.utilisation < kTogether * most; });
}

/// What a projectile met stood as if fixed. If joints of it broke under the blow, it could not give
/// more impulse than they bore: the projectile keeps the rest of its speed.
void CollapseRun::give_way(std::size_t broken_before) {
  if (!motion_->redistributes() || result_.broken_joints.size() == broken_before) return;
  std::vector<std::pair<std::uint32_t, double>> over;  // part, utilisation
  for (std::size_t i = broken_before; i < result_.broken_joints.size(); ++i) {
    const JointBreak& broken = result_.broken_joints[i];
    for (const std::uint32_t part : {frame_.joints[broken.joint].a, frame_.joints[broken.joint].b})
      over.emplace_back(part, broken.utilisation);
  }
  for (std::size_t s = 0; s < shots_.size(); ++s) {
    double most = 0;
    for (const Contact& contact : world_.contacts()) {
      if (shots_[s].body == kNoBody ||
          (contact.a != shots_[s].body && contact.b != shots_[s].body))
        continue;
      for (const auto& [part, utilisation] : over)
        if (part != kNoPart && part == struck_part(contact, shots_[s].body))
          most = std::max(most, utilisation);
    }
    if (most <= 1) continue;
    const Vec3 now = world_.velocity(shots_[s].body);
    const Vec3 fall{0, -scene_.simulation.gravity * last_dt_, 0};
    const Vec3 free = shots_[s].velocity + fall;
    const double before = world_.kinetic_energy();
    world_.set_velocity(shots_[s].body, free + (1 / most) * (now - free),
                        world_.angular_velocity(shots_[s].body));
    result_.energy.contact -= world_.kinetic_energy() - before;
  }
}

/// The part that a ball touches; kNoPart: something else.
std::uint32_t CollapseRun::struck_part(const Contact& contact, BodyId ball) const {
  return contact.a == ball ? motion_->part_of(contact.b, contact.part_b)
                           : motion_->part_of(contact.a, contact.part_a);
}

void CollapseRun::read_loads(std::vector<Failure>& failures) {
  for (std::uint32_t j = 0; j < joints_.size(); ++j) {
    Joint& state = joints_[j];
    if (!state.intact) continue;
    const FrameJoint& joint = frame_.joints[j];
    const bool is_known = state.is_read && state.utilisation < 1;
    if (params_.skip && is_known && !motion_->is_live(j)) {
      ++result_.joint_steps_not_read;
      continue;
    }
    const JointLoad load = motion_->load(j);
    const Utilisation use = utilisation(load, joint.strength);
    state.utilisation = use.total;
    result_.max_utilisation = std::max(result_.max_utilisation, use.total);
    if (!state.is_read || use.total >= static_cast<double>(state.peak.utilisation)) {
      const auto narrow = [](Vec3 v) {
        return std::array{static_cast<float>(v.x), static_cast<float>(v.y),
                          static_cast<float>(v.z)};
      };
      state.peak = {narrow(load.force), narrow(load.torque), static_cast<float>(use.force),
                    static_cast<float>(use.torque), static_cast<float>(use.total)};
    }
    state.is_read = true;
    if (use.total >= 1)
      failures.push_back({j, use.total, "strength", frame_.classes[joint.joint_class].interaction,
                          std::string(use.component), true});
  }
}

void CollapseRun::check_posts(std::vector<Failure>& failures) {
  for (const std::uint32_t post : posts_.posts()) {
    const std::uint32_t foot = posts_.foot(post);
    if (foot == kNoPart) continue;
    const double compression = -motion_->load(foot).force.x;
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
  const PartSolid& solid = solids_[joint.a];
  return motion_->pose(joint.a) * into(solid.axes, joint.point - solid.centre);
}

/// A projectile breaks the joints of what it touches that lie within its radius of the contact.
void CollapseRun::check_hits(std::vector<Failure>& failures) {
  for (const Contact& contact : world_.contacts()) {
    for (std::uint32_t s = 0; s < shots_.size(); ++s) {
      const BodyId ball = shots_[s].body;
      if (ball == kNoBody || (contact.a != ball && contact.b != ball)) continue;
      const std::uint32_t part = struck_part(contact, ball);
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
  outcome.contact_force = contact.impulse / std::max(dt, scene_.rules.load_time);
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
    if (breaks_ && splice != kNoPart)
      failures.push_back({splice, joints_[splice].utilisation, "unbraced", "paper", {}, false});
  }
}

void CollapseRun::break_joint(const Failure& failure) {
  Joint& state = joints_[failure.joint];
  state.intact = false;
  state.broken = now_;
  posts_.break_joint(failure.joint);
  motion_->break_joint(failure.joint, failure.bears_on);
  if (!disturbed_) ++result_.broken_at_rest;
  const bool fails = failure.mode != "removed";
  if (fails && scene_.scenario.load_rate > 0 && result_.first_failure_load == 0) {
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
