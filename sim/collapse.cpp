// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/collapse.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "meshing/error.hpp"
#include "sim/collapse_run.hpp"
#include "sim/part_pose.hpp"
#include "sim/step_times.hpp"

namespace sunder {
namespace {

/// A projectile may start so much of a step late.
constexpr double kLeastSubstep = 0.02;
/// A step is divided at most so often for what flies through panels.
constexpr double kMostSubsteps = 4096;
/// Contacts of projectiles that end a substep early, per step; later ones are left to the solver.
constexpr int kMostArrivals = 64;
/// Reactions that miss the weight by more are told, relative.
constexpr double kUneven = 0.02;
/// Speeds beyond this at the end of settling are told, m/s.
constexpr double kStillMoving = 0.01;

WorldParams world_params(const CollapseScene& scene) {
  const SimulationParams& simulation = scene.simulation;
  WorldParams world;
  world.gravity = simulation.gravity;
  world.iterations = static_cast<int>(simulation.iterations);
  world.has_ground = simulation.ground;
  world.ground_height = simulation.ground_height;
  world.sleep = simulation.sleep && scene.scenario.ground_motion.times.empty();
  world.max_bodies = static_cast<std::uint32_t>(simulation.max_bodies);
  world.warm_start = simulation.warm_start;
  if (simulation.joint_solver == "nncg") world.joint_solver = JointSolver::nncg;
  if (simulation.joint_solver == "dantzig") world.joint_solver = JointSolver::dantzig;
  if (simulation.joint_solver == "lemke") world.joint_solver = JointSolver::lemke;
  return world;
}

}  // namespace

CollapseRun::CollapseRun(const CollapseScene& scene, const CollapseParams& params)
    : scene_(scene),
      params_(params),
      frame_(scene_.frame),
      world_(world_params(scene)),
      posts_(scene_.frame, scene.rules.post_rule),
      joints_of_(scene.frame.part_count()),
      kinks_(scene_.frame),
      shots_(scene.projectiles.size()) {
  const std::vector<FrameDefect> defects = defects_of(frame_);
  if (!defects.empty())
    throw Error(ErrorCode::input, "\"" + defects.front().part + "\" " + defects.front().what);
  solids_ = solids_of(frame_);
  parts_.resize(solids_.size());
  for (std::uint32_t i = 0; i < solids_.size(); ++i) {
    if (!(solids_[i].mass > 0 && solids_[i].half_length > 0))
      throw Error(ErrorCode::input, "\"" + frame_.part_name(i) +
                                        "\" has no room between its members; make the storey "
                                        "higher, the bay wider or the members slimmer");
    result_.weight += solids_[i].mass * scene_.simulation.gravity;
  }
  for (const Projectile& projectile : scene.projectiles) {
    refuse_overlap(projectile);
    result_.projectiles.emplace_back();
    result_.projectiles.back().name = projectile.name;
    result_.projectiles.back().ballistic_speed = std::numeric_limits<double>::infinity();
  }
  joints_.resize(frame_.joints.size());
  intact_joints_ = joints_.size();
  present_parts_ = parts_.size();
  for (std::uint32_t j = 0; j < frame_.joints.size(); ++j) {
    joints_of_[frame_.joints[j].a].push_back(j);
    if (frame_.joints[j].b != kNoPart) joints_of_[frame_.joints[j].b].push_back(j);
  }
  motion_ = scene.simulation.solver == "bullet" ? jointed_motion(scene_, world_, solids_)
                                                : elastic_motion(scene_, world_, solids_);
  if (!frame_.patterns.empty()) add_panels();
  if (scene.rules.members_divide && motion_->finds_spans()) add_members();
}

void CollapseRun::add_panels() {
  panels_ = std::make_unique<Panels>(
      scene_, params_.skip,
      Panels::Host{.world = world_,
                   .recorder = recorder_,
                   .motion = *motion_,
                   .solids = solids_,
                   .break_off = [this](std::uint32_t part) { break_off(part); },
                   .is_intact = [this](std::uint32_t j) { return joints_[j].intact; },
                   .broken_joints = [this] { return result_.broken_joints.size(); },
                   .track_of =
                       [this](std::uint32_t part) {
                         std::uint32_t& track = parts_[part].track;
                         if (track == kNoTrack) track = recorder_.add_track(kNoTrack);
                         parts_[part].removed = now_;
                         --present_parts_;
                         return track;
                       }});
  motion_->when_released([this](BodyId body) { panels_->stand_before(body); });
}

/// A panel falls apart, or out of the frame.
void CollapseRun::break_off(std::uint32_t part) {
  std::vector<Failure> all;
  for (const std::uint32_t j : joints_of_[part])
    if (joints_[j].intact)
      all.push_back({j, joints_[j].utilisation, "panel", frame_.part_name(part), {}, true});
  break_joints(std::move(all));
  motion_->settle_breaks();
}

CollapseResult CollapseRun::run() {
  const SimulationParams& simulation = scene_.simulation;
  settle();
  start();
  // The last step takes along what is too short for a step of its own.
  const double whole = simulation.duration / simulation.step;
  const auto steps = static_cast<std::uint64_t>(std::max(1.0, std::ceil(whole - kLeastSubstep)));
  std::vector<double> milliseconds;
  for (std::uint64_t i = 1; i <= steps; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    step_once(i < steps ? static_cast<double>(i) * simulation.step : simulation.duration);
    record(now_);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    milliseconds.push_back(took.count());
    if (params_.progress)
      params_.progress((simulation.settle + now_) / (simulation.settle + simulation.duration));
  }
  result_.steps = steps;
  result_.simulated_s = now_;
  result_.step_ms_median = percentile(milliseconds, 0.5);
  result_.step_ms_p95 = percentile(milliseconds, 0.95);
  result_.step_ms_max = percentile(milliseconds, 1);
  return outcome();
}

/// The building takes up its weight; nothing breaks, nothing is recorded.
void CollapseRun::settle() {
  motion_->settle(params_.progress);
  result_.supports = motion_->supports();
  Vec3 sum;
  for (const SupportReaction& support : result_.supports) sum = sum + support.force;
  if (result_.weight > 0)
    result_.reaction_error =
        length(sum - Vec3{0, result_.weight - motion_->unsupported(), 0}) / result_.weight;
  note_sag();
}

/// Parts that end a column on top; of a frame without posts all members.
std::vector<std::uint32_t> CollapseRun::tops() const {
  std::vector<std::uint8_t> goes_on(frame_.nodes.size(), 0);
  for (const std::uint32_t post : posts_.posts()) goes_on[frame_.members[post].from] = 1;
  std::vector<std::uint32_t> found;
  for (const std::uint32_t post : posts_.posts())
    if (goes_on[frame_.members[post].to] == 0) found.push_back(post);
  if (!found.empty()) return found;
  found.resize(frame_.members.size());
  std::iota(found.begin(), found.end(), 0u);
  return found;
}

void CollapseRun::note_sag() {
  const std::vector<std::uint32_t> ends = tops();
  double sum = 0, largest = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t member : ends) {
    const double sag = motion_->sag(member);
    sum += sag;
    if (sag <= largest) continue;
    largest = sag;
    result_.sag_node = frame_.nodes[frame_.members[member].to].name;
  }
  result_.sag_max = largest;
  result_.sag_mean = sum / static_cast<double>(ends.size());
}

/// Time 0: from now on everything counts.
void CollapseRun::start() {
  std::vector<Failure> overloaded;
  read_loads(overloaded);
  check_posts(overloaded);
  result_.utilisation_at_rest = result_.max_utilisation;
  for (std::uint32_t j = 0; j < joints_.size(); ++j)
    result_.joint_gap = std::max(result_.joint_gap, motion_->joint_gap(j));
  const double mass = result_.weight / std::max(scene_.simulation.gravity, 1e-9);
  const double speed = std::sqrt(2 * world_.kinetic_energy() / mass);
  if (speed > kStillMoving)
    result_.warnings.push_back("the building still moves at " + std::to_string(speed) +
                               " m/s when it should have settled; give a longer \"settle\", more "
                               "\"iterations\" or a shorter \"step\"");
  if (result_.reaction_error > kUneven)
    result_.warnings.push_back("the supports carry " +
                               std::to_string(100 * result_.reaction_error) +
                               " % more or less than the building weighs: it has not settled, or "
                               "parts of it overlap");
  breaks_ = scene_.rules.breaking;
  start_ = motion_->strain() + motion_->potential();
  if (panels_) panels_->start();
  sample(0);
  break_overloaded();  // what is over its strength at rest
  disturbed_ = !scene_.scenario.remove.empty() || scene_.scenario.load_rate > 0 ||
               !scene_.scenario.ground_motion.times.empty();
  remove_parts();
  launch_due();
  sample_run();
}

void CollapseRun::remove_parts() {
  for (const std::string& name : scene_.scenario.remove) {
    std::uint32_t part = 0;
    while (part < frame_.part_count() && frame_.part_name(part) != name) ++part;
    if (part == frame_.part_count())
      throw Error(ErrorCode::input, "no part \"" + name + "\" to remove");
    if (std::isfinite(parts_[part].removed)) continue;
    if (part < frame_.members.size()) hand_over(part);
    std::vector<Failure> all;
    for (const std::uint32_t j : joints_of_[part])
      if (joints_[j].intact) all.push_back({j, joints_[j].utilisation, "removed", name, {}, true});
    break_joints(std::move(all));
    motion_->settle_breaks();
    motion_->remove_part(part);
    parts_[part].removed = now_;
    --present_parts_;
  }
}

/// The other members at the ends of one that is taken away still meet (alternate path method).
void CollapseRun::hand_over(std::uint32_t member) {
  // It carries nothing of parts that have been taken away before.
  std::vector<std::uint32_t> broken;
  for (const std::uint32_t j : joints_of_[member])
    if (frame_.joints[j].b == member && !joints_[j].intact) broken.push_back(j);
  for (const std::uint32_t j : broken) frame_.joints[j].b = kNoPart;
  const std::vector<std::uint32_t> changed = hand_over_joints(frame_, member);
  for (const std::uint32_t j : broken) frame_.joints[j].b = member;
  for (const std::uint32_t j : changed) {
    std::erase(joints_of_[member], j);
    joints_of_[frame_.joints[j].b].push_back(j);
  }
  motion_->rejoin(changed);
}

void CollapseRun::step_once(double end) {
  const double least = scene_.simulation.step / kMostSubsteps, nothing = 1e-3 * least;
  int arrivals = 0;
  while (end - now_ > nothing) {
    double dt = next_substep(end - now_);
    std::optional<WallRun::Arrival> arrival;
    if (panels_) {
      dt = std::min(dt, std::max(panels_->prepare(dt), least));
      if (arrivals < kMostArrivals) arrival = panels_->next_arrival(dt);
      if (arrival) dt = arrival->time;
    }
    if (dt > nothing) {
      raise_load(dt);
      advance(dt, end - (now_ + dt) <= nothing);
      if (panels_) {
        panels_->after_step(now_, dt);
        panels_->follow_frame();
        disturbed_ |= panels_->any_awake();
      }
      break_overloaded();
      if (panels_) crack_panels();
    }
    if (arrival) {
      ++arrivals;
      panels_->arrive(*arrival);
    }
    launch_due();
  }
  now_ = end;
}

/// Never much shorter than the others: a joint's load is its impulse by the time, and iterations
/// start from the last impulses.
/// A step is divided where a projectile starts; for panels besides, see step_once.
double CollapseRun::next_substep(double left) const {
  double dt = left;
  for (std::size_t i = 0; i < shots_.size(); ++i) {
    const double until = scene_.projectiles[i].time - now_;
    if (shots_[i].body == kNoBody && until > 0) dt = std::min(dt, until);
  }
  const double least = kLeastSubstep * scene_.simulation.step;
  dt = std::max(dt, least);
  return left - dt < least ? left : dt;
}

void CollapseRun::advance(double dt, bool ends_step) {
  const GroundMotion& motion = scene_.scenario.ground_motion;
  const Vec3 gravity{0, -scene_.simulation.gravity, 0};
  if (!motion.times.empty()) world_.set_gravity(gravity - motion.at(now_ + dt / 2));
  for (std::size_t i = 0; i < shots_.size(); ++i) {
    Shot& shot = shots_[i];
    if (shot.body == kNoBody) continue;
    shot.velocity = world_.velocity(shot.body);
    if (shot.given == Vec3{}) shot.brought = kinetic_energy(i);
  }
  const Vec3 before = world_.momentum();
  world_.step(dt);
  now_ += dt;
  last_dt_ = dt;
  ++result_.substeps;
  const Vec3 after = world_.momentum();
  impulse_ = impulse_ + world_.reaction();
  // What stands has next to no momentum: the impulse of its weight is the measure then.
  largest_momentum_ =
      std::max({largest_momentum_, length(before), length(after), length(world_.weight())});
  largest_momentum_error_ = std::max(largest_momentum_error_,
                                     length(after - before - world_.reaction() - world_.weight()));
  result_.penetration_max = std::max(result_.penetration_max, world_.overlap());
  const StepWork work = world_.work();
  result_.energy.contact += work.contact;
  result_.energy.friction += work.friction;
  result_.energy_in += work.driven;
  motion_->follow(now_, dt, ends_step);
}

/// People come in.
void CollapseRun::raise_load(double dt) {
  if (!(scene_.scenario.load_rate > 0) || !(scene_.simulation.gravity > 0)) return;
  if (result_.first_failure_load > 0) return;
  added_load_ += scene_.scenario.load_rate * dt;
  motion_->add_load(scene_.scenario.load_rate * dt);
}

void CollapseRun::launch_due() {
  for (std::uint32_t i = 0; i < shots_.size(); ++i)
    if (shots_[i].body == kNoBody && scene_.projectiles[i].time <= now_) launch(i);
}

void CollapseRun::launch(std::uint32_t index) {
  const Projectile& p = scene_.projectiles[index];
  Shot& shot = shots_[index];
  BodyParams body = body_of(p, index);
  // It appeared up to two shortest substeps ago.
  const double flown = now_ - p.time;
  const Vec3 gravity{0, -scene_.simulation.gravity, 0};
  body.pose.position = p.position + flown * p.velocity + (flown * flown / 2) * gravity;
  body.velocity = p.velocity + flown * gravity;
  shot.body = world_.add_sphere(body, p.radius);
  motion_->add_projectile(shot.body, p.mass);
  shot.track = recorder_.add_track(kNoTrack);
  recorder_.add_pose(shot.track, body.pose);
  if (panels_) panels_->follow_shot(index, shot.body, shot.track);
  result_.energy_in += 0.5 * p.mass * dot(p.velocity, p.velocity);
  baseline_ += p.mass * scene_.simulation.gravity * p.position.y;
}

void CollapseRun::refuse_overlap(const Projectile& p) const {
  const auto fail = [&](const std::string& where) {
    throw Error(ErrorCode::input, "projectile \"" + p.name + "\" starts " + where +
                                      "; move its position or change its radius");
  };
  const SimulationParams& simulation = scene_.simulation;
  if (simulation.ground && p.position.y - p.radius < simulation.ground_height)
    fail("below the ground (y = " + std::to_string(simulation.ground_height) + " m)");
  if (p.time > 0) return;  // debris may lie anywhere: contacts push out of it
  for (std::uint32_t i = 0; i < solids_.size(); ++i)
    if (distance_to(solids_[i], p.position) < p.radius)
      fail("inside \"" + frame_.part_name(i) + "\"");
}

void CollapseRun::record(double time) {
  recorder_.add_time(time);
  const auto note = [&](bool moves, std::uint32_t& track, const auto& pose) {
    if (!moves) {
      ++result_.body_steps_asleep;
      ++result_.poses_not_recorded;
      return;
    }
    if (track == kNoTrack) track = recorder_.add_track(kNoTrack);
    recorder_.add_pose(track, pose());
  };
  const Kinks::Poses bent = follow_kinks();
  const auto drawn = [&](std::uint32_t i) {
    const auto found = std::ranges::lower_bound(bent, i, {}, &Kinks::Poses::value_type::first);
    return found != bent.end() && found->first == i ? &found->second : nullptr;
  };
  const bool any_moving = motion_->any_moving() || !bent.empty();
  if (!any_moving) result_.body_steps_asleep += present_parts_;
  if (!any_moving) result_.poses_not_recorded += present_parts_;
  for (std::uint32_t i = 0; any_moving && i < parts_.size(); ++i)
    if (!std::isfinite(parts_[i].removed))
      note(motion_->is_moving(i) || drawn(i), parts_[i].track,
           [&] { return drawn(i) ? *drawn(i) : motion_->pose(i); });
  for (Shot& shot : shots_)
    if (shot.body != kNoBody)
      note(world_.is_awake(shot.body), shot.track, [&] { return world_.pose(shot.body); });
  if (panels_) panels_->record();
  if (time + 1e-9 < next_sample_) return;
  sample_run();
  sample(time);
}

void CollapseRun::sample(double time) {
  next_sample_ = time + scene_.simulation.history_step;
  for (std::uint32_t j = 0; j < joints_.size(); ++j)
    if (joints_[j].intact) result_.joint_gap = std::max(result_.joint_gap, motion_->joint_gap(j));
  if (!params_.keep_history) return;
  all_known_ = false;
  const double last = sample_times_.empty() ? -1 : sample_times_.back();
  sample_times_.push_back(time);
  sample_starts_.push_back(samples_.size());
  for (Joint& joint : joints_) {
    samples_.push_back(joint.broken > last ? joint.peak : JointSample{});
    joint.is_read = false;  // the next reading takes its place
  }
}

/// Parts that hang on the ground by intact joints.
std::vector<std::uint8_t> CollapseRun::grounded() const {
  std::vector<std::uint8_t> reached(parts_.size(), 0);
  std::vector<std::uint32_t> queue;
  const auto reach = [&](std::uint32_t part) {
    if (reached[part] == 0) queue.push_back(part);
    reached[part] = 1;
  };
  for (std::uint32_t j = 0; j < joints_.size(); ++j)
    if (joints_[j].intact && frame_.joints[j].b == kNoPart) reach(frame_.joints[j].a);
  while (!queue.empty()) {
    const std::uint32_t part = queue.back();
    queue.pop_back();
    for (const std::uint32_t j : joints_of_[part]) {
      if (!joints_[j].intact || frame_.joints[j].b == kNoPart) continue;
      reach(frame_.joints[j].a == part ? frame_.joints[j].b : frame_.joints[j].a);
    }
  }
  return reached;
}

CollapseResult CollapseRun::outcome() {
  CollapseResult& r = result_;
  r.bodies = world_.body_count();
  r.merged_bodies = world_.merged_count();
  if (series_.back().time < now_) sample_run();
  take_balance();
  if (panels_) impulse_ = impulse_ + panels_->impulse();
  r.solves = motion_->solves();
  r.residual = motion_->residual();
  if (const std::optional<Buckling> buckling = motion_->buckling()) {
    r.buckles.push_back(*buckling);
    r.warnings.push_back("at " + std::to_string(buckling->time) + " s " + buckling->what +
                         "; from then on axial forces no longer make it softer");
  }
  r.momentum_error = largest_momentum_ > 0 ? largest_momentum_error_ / largest_momentum_ : 0;
  r.reactions[0] = impulse_.x, r.reactions[1] = impulse_.y, r.reactions[2] = impulse_.z;
  r.solver_fallbacks = world_.solver_fallbacks();
  const std::vector<std::uint8_t> stands = grounded();
  r.parts_freed = static_cast<std::uint64_t>(std::ranges::count(stands, 0));
  for (const std::uint32_t member : tops())
    if (stands[member] != 0) r.sag_end = std::max(r.sag_end, motion_->sag(member));
  if (r.broken_at_rest > 0)
    r.warnings.push_back(
        std::to_string(r.broken_at_rest) +
        " joints were over their strength at rest and broke before anything happened; look at "
        "utilisation_at_rest: more \"iterations\", a shorter \"step\" or a longer \"settle\" make "
        "the solver's forces truer, stronger sections or joints the building");
  if (unsettled_steps_ > 0)
    r.warnings.push_back("in " + std::to_string(unsettled_steps_) +
                         " steps panels and joints still broke each other after 100 rounds; what "
                         "was over its strength then broke in the next step");
  r.hash = recorder_.hash();
  r.recording = recording();
  if (panels_) add_outcome(panels_->finish(r.recording));
  return std::move(r);
}

/// What became of the panels.
void CollapseRun::add_outcome(const ImpactResult& panels) {
  CollapseResult& r = result_;
  r.chunks = panels.chunks;
  r.chunks_freed = panels.chunks_freed;
  r.chunks_split = panels.chunks_split;
  r.broken_bonds = panels.broken_bonds;
  r.crack_area = panels.crack_area;
  r.panels = panels_->count();
  r.panels_meshed = r.recording.walls.size();
  r.panels_broken = r.panels_meshed - panels.walls_untouched;
  r.panels_not_meshed = r.panels - panels_->meshed();
  r.panel_solves = panels_->solves();
  r.panel_solves_skipped = panels_->solves_skipped();
  for (std::size_t i = 0; i < panels.projectiles.size(); ++i) {
    ProjectileOutcome& outcome = r.projectiles[i];
    const ProjectileOutcome& there = panels.projectiles[i];
    if (there.hit && there.speed_before > outcome.speed_before) outcome = there;
  }
}

Recording CollapseRun::recording() {
  Recording recording = recorder_.take();
  for (std::uint32_t i = 0; i < parts_.size(); ++i) {
    const PartSolid& solid = solids_[i];
    recording.parts.push_back({frame_.part_name(i), solid.outline, solid.half_length,
                               solid.material, solid.mass,
                               pose_of(solid), parts_[i].track,
                               i < frame_.members.size(), parts_[i].removed});
  }
  for (std::uint32_t j = 0; j < joints_.size(); ++j) {
    const FrameJoint& joint = frame_.joints[j];
    recording.joints.push_back({joint.name, joint.a, joint.b == kNoPart ? kNoTrack : joint.b,
                                joint.end_a, joint.end_b, joint.point, joints_[j].broken});
  }
  recording.sample_times = std::move(sample_times_);
  recording.seed = scene_.seed;
  recording.series = std::move(series_);
  // Joints that came in carried nothing before.
  for (std::size_t i = 0; i < sample_starts_.size(); ++i) {
    const auto row = samples_.begin() + static_cast<long>(sample_starts_[i]);
    const bool is_last = i + 1 == sample_starts_.size();
    const auto end =
        is_last ? samples_.end() : samples_.begin() + static_cast<long>(sample_starts_[i + 1]);
    recording.samples.insert(recording.samples.end(), row, end);
    recording.samples.resize((i + 1) * joints_.size());
  }
  for (std::size_t i = 0; i < shots_.size(); ++i)
    recording.projectiles.push_back({scene_.projectiles[i], shots_[i].track});
  return recording;
}

CollapseResult simulate_collapse(const CollapseScene& scene, const CollapseParams& params) {
  return CollapseRun(scene, params).run();
}

}  // namespace sunder
