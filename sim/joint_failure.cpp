// SPDX-License-Identifier: GPL-3.0-or-later
// Which joints fail: by their load, by the buckling or the lost bracing of a post, by a hit.
#include <algorithm>
#include <cmath>

#include "sim/collapse_run.hpp"

namespace sunder {

namespace {

/// Of the largest utilisation: what is nearly as far over its strength breaks with it.
constexpr double kTogether = 0.9;
/// Rounds of breaking and redistribution in a step; what is over its strength then waits for the
/// next.
constexpr int kMostRounds = 100;

/// Share of its bending moments with which a load lies on the failure surface; 0: it is beyond it
/// without them.
double share_of_moments(const JointLoad& load, const JointStrength& strength) {
  const auto fails = [&](double share) {
    JointLoad part = load;
    part.torque.y *= share;
    part.torque.z *= share;
    return utilisation(part, strength).total >= 1;
  };
  if (fails(0)) return 0;
  double low = 0, high = 1;
  for (int round = 0; round < 60; ++round) {
    const double middle = 0.5 * (low + high);
    (fails(middle) ? high : low) = middle;
  }
  return low;
}

/// About its centre, kg m².
double inertia_of(const Projectile& ball) {
  return 0.4 * ball.mass * ball.radius * ball.radius;
}

/// The largest share of a change whose energy, linear x + square x² at a share x, is at most
/// `room`.
double share_within(double linear, double square, double room) {
  if (linear + square <= room) return 1;
  return (std::sqrt(linear * linear + 4 * square * room) - linear) / (2 * square);
}

}  // namespace

void CollapseRun::break_overloaded() {
  const std::size_t broken_before = result_.broken_joints.size();
  std::vector<Failure> failures, overloads;
  read_loads(overloads);
  check_hits(failures);
  check_posts(overloads);
  if (!breaks_) return give_way(broken_before, {});
  std::vector<Weak> weak = weak_members();
  if (motion_->redistributes()) keep_most_utilised(overloads, weak);
  if (overloads.empty() && weak.empty()) add_mechanisms(failures);
  failures.insert(failures.end(), overloads.begin(), overloads.end());
  break_joints(std::move(failures));
  give_way(broken_before, weak);
  divide_members(weak);
  cascade();
}

/// Loads redistribute after each break: most utilised first, until what is left carries.
void CollapseRun::cascade() {
  bool divided = false;
  for (int round = 0; round < kMostRounds && (motion_->settle_breaks() || divided); ++round) {
    std::vector<Failure> failures;
    read_loads(failures);
    check_posts(failures);
    std::vector<Weak> weak = weak_members();
    keep_most_utilised(failures, weak);
    for (const std::uint32_t j : motion_->unheld_joints())
      failures.push_back({j, joints_[j].utilisation, "unheld", "balance", {}, true});
    if (failures.empty() && weak.empty()) add_mechanisms(failures);
    break_joints(std::move(failures));
    divided = !weak.empty();
    divide_members(weak);
  }
}

/// What moves without resistance, or has moved too far to stand, lets go of what stands.
void CollapseRun::add_mechanisms(std::vector<Failure>& failures) const {
  for (const std::uint32_t j : motion_->mechanism_joints())
    failures.push_back({j, joints_[j].utilisation, "mechanism", "balance", {}, true});
}

/// Panels crack, joints take over what they bore, and so on. While the frame rings displacements
/// stay, and that is one round.
void CollapseRun::crack_panels() {
  for (int round = 0; panels_->crack(); ++round) {
    panels_->follow_frame();
    if (round == kMostRounds) {
      ++unsettled_steps_;
      break;
    }
    if (!breaks_ || !motion_->redistributes()) continue;
    std::vector<Failure> overloads;
    read_loads(overloads);
    check_posts(overloads);
    std::vector<Weak> weak = weak_members();
    keep_most_utilised(overloads, weak);
    break_joints(std::move(overloads));
    divide_members(weak);
    cascade();
    panels_->follow_frame();
  }
  panels_->follow_frame();
}

void CollapseRun::keep_most_utilised(std::vector<Failure>& failures,
                                     std::vector<Weak>& weak) const {
  double most = 0;
  for (const Failure& failure : failures) most = std::max(most, failure.utilisation);
  for (const Weak& each : weak) most = std::max(most, each.place.utilisation);
  std::erase_if(failures, [&](const Failure& f) { return f.utilisation < kTogether * most; });
  std::erase_if(weak, [&](const Weak& w) { return w.place.utilisation < kTogether * most; });
}

/// Of a projectile, J.
double CollapseRun::kinetic_energy(std::size_t shot) const {
  const Projectile& ball = scene_.projectiles[shot];
  const Vec3 v = world_.velocity(shots_[shot].body), w = world_.angular_velocity(shots_[shot].body);
  return (ball.mass * dot(v, v) + inertia_of(ball) * dot(w, w)) / 2;
}

/// What a projectile met stood as if fixed. If joints of it, or the part itself, broke under the
/// blow, or it ran ahead, the projectile keeps what the frame did not take up of its momentum.
void CollapseRun::give_way(std::size_t broken_before, const std::vector<Weak>& weak) {
  if (!motion_->redistributes()) return;
  for (std::size_t i = 0; i < shots_.size(); ++i) {
    Shot& shot = shots_[i];
    if (shot.body == kNoBody) continue;
    Vec3 lost;
    const std::map<std::uint32_t, Vec3> struck = pressed_by(shot.body, lost);
    const double mass = scene_.projectiles[i].mass;
    const Vec3 now = world_.velocity(shot.body);
    // What passes through it from something else is not its own.
    const double own = mass * length(shot.velocity - now);
    if (own < length(lost)) lost = (own / length(lost)) * lost;
    shot.given = struck.empty() ? Vec3{} : shot.given + lost;
    Vec3 back, across, moment;
    for (const auto& [part, pressed] : struck) {
      const double share = borne_share(part, broken_before, weak);
      if (share == 1 && motion_->borne(part) == 1) continue;
      const Vec3 more = motion_->give_back(part, share);
      back = back + more;
      const double squared = dot(pressed, pressed);
      if (squared == 0) continue;
      across = across + (dot(more, pressed) / squared) * pressed;
      moment = moment + cross((scene_.projectiles[i].radius / std::sqrt(squared)) * pressed, more);
    }
    if (back == Vec3{}) continue;
    // Friction turned it, too: that goes back as well. But it gets no more energy than it brought.
    const double inertia = inertia_of(scene_.projectiles[i]), has = kinetic_energy(i);
    const Vec3 spin = world_.angular_velocity(shot.body);
    const double kept =
        std::min({1.0, length(shot.given) / length(back),
                  share_within(dot(now, back) + dot(spin, moment),
                               (dot(back, back) / mass + dot(moment, moment) / inertia) / 2,
                               std::max(0.0, shot.brought - has))});
    back = kept * back;
    shot.given = shot.given - back;
    const Vec3 mean = now + (0.5 / mass) * back, turn = (kept / inertia) * moment;
    world_.set_velocity(shot.body, now + (1 / mass) * back, spin + turn);
    result_.energy.contact -= kept * dot(across, mean);
    result_.energy.friction -=
        dot(back - kept * across, mean) + inertia * dot(turn, spin + 0.5 * turn);
  }
}

/// Standing parts that a ball touches, and the impulse across their surface on each; in `lost` with
/// friction, on all of them, N s.
std::map<std::uint32_t, Vec3> CollapseRun::pressed_by(BodyId ball, Vec3& lost) const {
  std::map<std::uint32_t, Vec3> struck;
  for (const Contact& contact : world_.contacts()) {
    if (contact.a != ball && contact.b != ball) continue;
    const std::uint32_t part = struck_part(contact, ball);
    if (part == kNoPart || !motion_->stands(part)) continue;
    const double side = contact.a == ball ? -1 : 1;
    Vec3& pressed = struck[part];
    pressed = pressed + side * contact.impulse * contact.normal;
    lost = lost + side * (contact.impulse * contact.normal + contact.tangential);
  }
  return struck;
}

/// By the utilisation at which its joints, or it itself, broke in this step; 1: none did. In
/// balance at any time the blow is on all of the frame at once.
double CollapseRun::borne_share(std::uint32_t part, std::size_t broken_before,
                                const std::vector<Weak>& weak) const {
  const bool at_once = scene_.simulation.quasi_static;
  double most = 1;
  for (const Weak& each : weak)
    if ((at_once || each.member == part) && is_brittle(each))
      most = std::max(most, each.place.utilisation);
  for (std::size_t i = broken_before; i < result_.broken_joints.size(); ++i) {
    const JointBreak& broken = result_.broken_joints[i];
    const FrameJoint& joint = frame_.joints[broken.joint];
    if (at_once || joint.a == part || joint.b == part) most = std::max(most, broken.utilisation);
  }
  return 1 / most;
}

/// The part that a ball touches; kNoPart: something else.
std::uint32_t CollapseRun::struck_part(const Contact& contact, BodyId ball) const {
  return contact.a == ball ? motion_->part_of(contact.b, contact.part_b)
                           : motion_->part_of(contact.a, contact.part_a);
}

void CollapseRun::read_loads(std::vector<Failure>& failures) {
  if (params_.skip && all_known_ && !motion_->any_live()) {
    result_.joint_steps_not_read += intact_joints_;
    return;
  }
  all_known_ = true;
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
    const Utilisation use = demand_on(j, load);
    state.utilisation = use.total;
    note_use(use.total);
    if (!state.is_read || use.total >= static_cast<double>(state.peak.utilisation)) {
      const auto narrow = [](Vec3 v) {
        return std::array{static_cast<float>(v.x), static_cast<float>(v.y),
                          static_cast<float>(v.z)};
      };
      state.peak = {narrow(load.force), narrow(load.torque), static_cast<float>(use.force),
                    static_cast<float>(use.torque), static_cast<float>(use.total)};
    }
    state.is_read = true;
    all_known_ &= use.total < 1;
    if (use.total >= 1)
      failures.push_back({j, use.total, "strength", frame_.classes[joint.joint_class].interaction,
                          std::string(use.component), true});
  }
}

/// Of a hinge that turns: what breaks it, its rotation or what it carries besides its moments.
Utilisation CollapseRun::demand_on(std::uint32_t j, const JointLoad& load) {
  const FrameJoint& joint = frame_.joints[j];
  Utilisation use = utilisation(load, joint.strength);
  if (joints_[j].yield == kNoPart) return use;
  const FrameMotion::HingeState hinge = motion_->hinge(j);
  double& farthest = result_.yielded_joints[joints_[j].yield].rotation;
  farthest = std::max(farthest, hinge.rotation);
  if (!hinge.flows) return use;
  use = utilisation({load.force, {load.torque.x, 0, 0}}, joint.strength);
  const double turned = hinge.rotation / frame_.classes[joint.joint_class].rotation_capacity;
  if (turned > use.total) use.total = turned, use.component = "rotation";
  return use;
}

/// What can turn bends instead of breaking.
bool CollapseRun::yields(const Failure& failure) {
  const std::uint32_t j = failure.joint;
  const FrameJoint& joint = frame_.joints[j];
  if (failure.mode != "strength" || frame_.classes[joint.joint_class].rotation_capacity <= 0 ||
      motion_->hinge(j).flows)
    return false;
  const JointLoad load = motion_->load(j);
  const double share = share_of_moments(load, joint.strength);
  if (share <= 0 || !motion_->yield(j, {0, share * load.torque.y, share * load.torque.z}))
    return false;
  if (joints_[j].yield == kNoPart) {
    joints_[j].yield = static_cast<std::uint32_t>(result_.yielded_joints.size());
    result_.yielded_joints.push_back({j, now_, failure.utilisation, 0});
  }
  return true;
}

void CollapseRun::check_posts(std::vector<Failure>& failures) {
  if (params_.skip && posts_known_ && !motion_->any_live()) return;
  posts_known_ = true;
  posts_use_ = 0;
  for (const std::uint32_t post : posts_.posts()) {
    const std::uint32_t foot = posts_.foot(post);
    if (foot == kNoPart) continue;
    const double compression = -motion_->load(foot).force.x;
    if (compression <= 0) continue;
    const double use = compression / posts_.resistance(post);
    posts_known_ &= use < 1;
    note_use(use);
    posts_use_ = std::max(posts_use_, use);
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

/// A projectile breaks the joints of what it touches that lie within its radius of the contact, not
/// the members themselves.
void CollapseRun::check_hits(std::vector<Failure>& failures) {
  for (const Contact& contact : world_.contacts()) {
    for (std::uint32_t s = 0; s < shots_.size(); ++s) {
      const BodyId ball = shots_[s].body;
      if (ball == kNoBody || (contact.a != ball && contact.b != ball)) continue;
      const std::uint32_t part = struck_part(contact, ball);
      if (part == kNoPart) continue;
      disturbed_ = true;
      if (!panels_ || !panels_->is_wall(part)) note_hit(contact, s, last_dt_);
      if (!scene_.rules.hit_breaks) continue;
      for (const std::uint32_t j : joints_of_[part]) {
        if (!joints_[j].intact || is_inside(j)) continue;
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

/// Joint by joint; the reason that came first counts. What follows from a loss of bracing follows
/// at once.
void CollapseRun::break_joints(std::vector<Failure> failures) {
  std::ranges::stable_sort(failures, {}, &Failure::joint);
  for (std::size_t i = 0; i < failures.size(); ++i) {
    const Failure failure = failures[i];
    if (!joints_[failure.joint].intact || yields(failure)) continue;
    break_joint(failure);
    const std::uint32_t splice = posts_.unbraced_splice(failure.joint);
    if (breaks_ && splice != kNoPart)
      failures.push_back({splice, joints_[splice].utilisation, "unbraced", "paper", {}, false});
  }
}

void CollapseRun::break_joint(const Failure& failure) {
  Joint& state = joints_[failure.joint];
  state.intact = false;
  --intact_joints_;
  state.broken = now_;
  posts_.break_joint(failure.joint);
  motion_->break_joint(failure.joint, failure.bears_on);
  if (!disturbed_ && failure.mode != "panel") ++result_.broken_at_rest;
  const bool fails = failure.mode != "removed" && failure.mode != "panel";
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
