// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/collapse.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "meshing/error.hpp"
#include "sim/collapse_run.hpp"
#include "sim/step_times.hpp"

namespace sunder {
namespace {

/// Keys of the contact order: projectiles, then parts.
constexpr std::uint64_t kShotOrder = std::uint64_t{1} << 60;
constexpr std::uint64_t kPartOrder = std::uint64_t{2} << 60;
/// A step is divided where a projectile would cover more than its radius, at most so often.
constexpr double kMostSubsteps = 64;
/// Dry steel on steel, and its impacts (usual values, from memory).
constexpr Surface kSteel{0.3, 0.2};
/// Speeds beyond this at the end of settling are told, m/s.
constexpr double kStillMoving = 0.01;
/// The first steps of settling iterate so many times more: from then on the joints' impulses start
/// from what carries the building.
constexpr std::uint64_t kFirstSteps = 4;
constexpr int kFirstIterations = 100;

WorldParams world_params(const CollapseScene& scene) {
  const SimulationParams& simulation = scene.simulation;
  WorldParams world;
  world.gravity = simulation.gravity;
  world.iterations = static_cast<int>(simulation.iterations);
  world.has_ground = simulation.ground;
  world.ground_height = simulation.ground_height;
  world.sleep = simulation.sleep && scene.scenario.ground_motion.times.empty();
  world.warm_start = simulation.warm_start;
  if (simulation.joint_solver == "nncg") world.joint_solver = JointSolver::nncg;
  if (simulation.joint_solver == "dantzig") world.joint_solver = JointSolver::dantzig;
  if (simulation.joint_solver == "lemke") world.joint_solver = JointSolver::lemke;
  return world;
}

Quaternion rotation_of(const Axes& axes) {
  // Shepperd's choice of the largest component keeps all digits.
  const double xx = axes.x.x, yy = axes.y.y, zz = axes.z.z, trace = xx + yy + zz;
  Quaternion q;
  if (trace >= std::max({xx, yy, zz})) {
    q = {axes.y.z - axes.z.y, axes.z.x - axes.x.z, axes.x.y - axes.y.x, 1 + trace};
  } else if (xx >= std::max(yy, zz)) {
    q = {1 + xx - yy - zz, axes.y.x + axes.x.y, axes.z.x + axes.x.z, axes.y.z - axes.z.y};
  } else if (yy >= zz) {
    q = {axes.y.x + axes.x.y, 1 - xx + yy - zz, axes.z.y + axes.y.z, axes.z.x - axes.x.z};
  } else {
    q = {axes.z.x + axes.x.z, axes.z.y + axes.y.z, 1 - xx - yy + zz, axes.x.y - axes.y.x};
  }
  return normalised(q);
}

/// Of a point from a convex prism, 0 inside.
double distance_to(const PartSolid& solid, Vec3 point) {
  const Vec3 local = into(solid.axes, point - solid.centre);
  const double beyond = std::max(std::fabs(local.z) - solid.half_length, 0.0);
  double aside = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < solid.hull.size(); ++i) {
    const Vec2 a = solid.hull[i], edge = solid.hull[(i + 1) % solid.hull.size()] - a;
    aside = std::max(aside, -cross(edge, Vec2{local.x, local.y} - a) / length(edge));
  }
  return std::hypot(beyond, std::max(aside, 0.0));
}

}  // namespace

CollapseRun::CollapseRun(const CollapseScene& scene, const CollapseParams& params)
    : scene_(scene),
      params_(params),
      frame_(scene.frame),
      world_(world_params(scene)),
      posts_(scene.frame, scene.rules.post_rule),
      joints_of_(scene.frame.part_count()),
      shots_(scene.projectiles.size()) {
  const std::vector<FrameDefect> defects = defects_of(frame_);
  if (!defects.empty())
    throw Error(ErrorCode::input, "\"" + defects.front().part + "\" " + defects.front().what);
  add_parts();
  for (const Projectile& projectile : scene.projectiles) {
    refuse_overlap(projectile);
    result_.projectiles.emplace_back();
    result_.projectiles.back().name = projectile.name;
    result_.projectiles.back().ballistic_speed = std::numeric_limits<double>::infinity();
  }
  add_joints();
}

void CollapseRun::add_parts() {
  std::vector<PartSolid> solids = solids_of(frame_);
  for (std::uint32_t i = 0; i < solids.size(); ++i) {
    Part part;
    part.solid = std::move(solids[i]);
    BodyParams body;
    body.mass = part.solid.mass;
    body.inertia = part.solid.inertia;
    body.pose = {part.solid.centre, rotation_of(part.solid.axes)};
    body.order = kPartOrder + i;
    body.surface = kSteel;
    for (const Material& material : frame_.materials)
      if (material.name == part.solid.material && i >= frame_.members.size())
        body.surface = {material.friction, material.restitution};
    const Prism prism{part.solid.hull, part.solid.half_length};
    part.body = world_.add_body(body, {&prism, 1});
    parts_of_body_.resize(part.body + 1, kNoPart);
    parts_of_body_[part.body] = i;
    result_.weight += body.mass * scene_.simulation.gravity;
    parts_.push_back(std::move(part));
  }
}

void CollapseRun::add_joints() {
  for (std::uint32_t j = 0; j < frame_.joints.size(); ++j) {
    const FrameJoint& joint = frame_.joints[j];
    Joint state;
    state.id = world_.add_joint({parts_[joint.a].body,
                                 joint.b == kNoPart ? kGround : parts_[joint.b].body, joint.point,
                                 joint.axes, frame_.classes[joint.joint_class].rigid});
    joints_.push_back(state);
    joints_of_[joint.a].push_back(j);
    if (joint.b != kNoPart) joints_of_[joint.b].push_back(j);
    if (joint.b == kNoPart)
      result_.supports.push_back({joint.node, {}, {}});
  }
}

std::uint32_t CollapseRun::body_part(BodyId body) const {
  return body < parts_of_body_.size() ? parts_of_body_[body] : kNoPart;
}

CollapseResult CollapseRun::run() {
  const SimulationParams& simulation = scene_.simulation;
  settle();
  start();
  const auto steps =
      static_cast<std::uint64_t>(std::ceil(simulation.duration / simulation.step - 1e-9));
  std::vector<double> milliseconds;
  for (std::uint64_t i = 1; i <= steps; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    step_once(std::min(static_cast<double>(i) * simulation.step, simulation.duration));
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
  const SimulationParams& simulation = scene_.simulation;
  const auto steps =
      static_cast<std::uint64_t>(std::ceil(simulation.settle / simulation.step - 1e-9));
  const int iterations = static_cast<int>(simulation.iterations);
  for (std::uint64_t i = 0; i < steps; ++i) {
    const bool is_first = simulation.warm_start && i < kFirstSteps;
    world_.set_iterations(is_first ? kFirstIterations * iterations : iterations);
    world_.step(simulation.step);
    if (2 * i >= steps) note_reactions();
    if (params_.progress)
      params_.progress(static_cast<double>(i) * simulation.step /
                       (simulation.settle + simulation.duration));
  }
  Vec3 sum;
  for (SupportReaction& support : result_.supports) {
    const double share = reaction_steps_ > 0 ? 1.0 / static_cast<double>(reaction_steps_) : 0;
    support.force = share * support.force;
    support.torque = share * support.torque;
    sum = sum + support.force;
  }
  result_.reaction_error = length(sum - Vec3{0, result_.weight, 0}) / result_.weight;
  note_sag();
}

void CollapseRun::note_reactions() {
  ++reaction_steps_;
  auto support = result_.supports.begin();
  for (std::uint32_t j = 0; j < joints_.size(); ++j) {
    const FrameJoint& joint = frame_.joints[j];
    if (joint.b != kNoPart) continue;
    const JointReaction reaction = world_.joint_reaction(joints_[j].id);
    support->force = support->force + joint.axes * reaction.force;
    support->torque = support->torque + joint.axes * reaction.torque;
    ++support;
  }
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

/// How far the end of a member has come down, m.
double CollapseRun::sag_of(std::uint32_t member) const {
  const PartSolid& solid = parts_[member].solid;
  const Vec3 end{0, 0, frame_.length(frame_.members[member]) / 2};
  const Vec3 stood = frame_.nodes[frame_.members[member].to].position;
  const Vec3 middle = 0.5 * (stood + frame_.nodes[frame_.members[member].from].position);
  const Vec3 local = end + into(solid.axes, middle - solid.centre);
  return stood.y - (world_.pose(parts_[member].body) * local).y;
}

void CollapseRun::note_sag() {
  const std::vector<std::uint32_t> ends = tops();
  double sum = 0, largest = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t member : ends) {
    const double sag = sag_of(member);
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
  for (std::uint32_t j = 0; j < joints_.size(); ++j) joints_[j].load = load_of(j);
  std::vector<Failure> overloaded;
  read_loads(overloaded);
  for (const Joint& joint : joints_) {
    result_.utilisation_at_rest = std::max(result_.utilisation_at_rest, joint.utilisation);
    result_.joint_gap = std::max(result_.joint_gap, world_.joint_reaction(joint.id).gap);
  }
  const double mass = result_.weight / std::max(scene_.simulation.gravity, 1e-9);
  const double speed = std::sqrt(2 * world_.kinetic_energy() / mass);
  if (speed > kStillMoving)
    result_.warnings.push_back("the building still moves at " + std::to_string(speed) +
                               " m/s when it should have settled; give a longer \"settle\", more "
                               "\"iterations\" or a shorter \"step\"");
  breaks_ = scene_.rules.breaking;
  baseline_ = world_.potential_energy();
  result_.energy_in = world_.kinetic_energy();
  disturbed_ = !scene_.scenario.remove.empty() || scene_.scenario.load_rate > 0 ||
               !scene_.scenario.ground_motion.times.empty();
  sample(0);
  if (!disturbed_) break_overloaded();
  remove_parts();
  launch_due();
}

void CollapseRun::remove_parts() {
  for (const std::string& name : scene_.scenario.remove) {
    std::uint32_t part = 0;
    while (part < frame_.part_count() && frame_.part_name(part) != name) ++part;
    if (part == frame_.part_count())
      throw Error(ErrorCode::input, "no part \"" + name + "\" to remove");
    if (parts_[part].body == kNoBody) continue;
    std::vector<Failure> all;
    for (const std::uint32_t j : joints_of_[part])
      if (joints_[j].intact) all.push_back({j, joints_[j].utilisation, "removed", name, {}, true});
    break_joints(std::move(all));
    const BodyId body = parts_[part].body;
    baseline_ -= parts_[part].solid.mass * scene_.simulation.gravity * world_.centre(body).y;
    const double before = world_.kinetic_energy();
    world_.remove(body);
    result_.energy_in += world_.kinetic_energy() - before;
    parts_of_body_[body] = kNoPart;
    parts_[part].body = kNoBody;
    parts_[part].removed = now_;
  }
}

void CollapseRun::step_once(double end) {
  while (now_ < end - 1e-12 * end) {
    const double dt = std::min(end - now_, next_substep(end - now_));
    raise_load(dt);
    advance(dt);
    break_overloaded();
    launch_due();
  }
  now_ = end;
}

double CollapseRun::next_substep(double left) const {
  double dt = left;
  for (std::size_t i = 0; i < shots_.size(); ++i) {
    const Projectile& p = scene_.projectiles[i];
    if (shots_[i].body == kNoBody) {
      if (p.time > now_) dt = std::min(dt, p.time - now_);
    } else if (const double speed = length(world_.velocity(shots_[i].body)); speed > 0) {
      dt = std::min(dt, std::max(p.radius / speed, scene_.simulation.step / kMostSubsteps));
    }
  }
  return dt;
}

void CollapseRun::advance(double dt) {
  const GroundMotion& motion = scene_.scenario.ground_motion;
  const Vec3 gravity{0, -scene_.simulation.gravity, 0};
  if (!motion.times.empty()) world_.set_gravity(gravity - motion.at(now_ + dt / 2));
  for (Shot& shot : shots_)
    if (shot.body != kNoBody) shot.velocity = world_.velocity(shot.body);
  const Vec3 before = world_.momentum();
  world_.step(dt);
  now_ += dt;
  last_dt_ = dt;
  ++result_.substeps;
  const Vec3 after = world_.momentum();
  impulse_ = impulse_ + world_.reaction();
  largest_momentum_ = std::max({largest_momentum_, length(before), length(after)});
  largest_momentum_error_ =
      std::max(largest_momentum_error_,
               length(after - before - world_.reaction() - world_.weight()));
  result_.penetration_max = std::max(result_.penetration_max, world_.overlap());
  const StepWork work = world_.work();
  result_.energy.contact += work.contact;
  result_.energy.friction += work.friction;
  result_.joint_work += work.joint;
  result_.energy_in += work.driven;
}

/// People come in: mass that stands on the slabs.
void CollapseRun::raise_load(double dt) {
  const double gravity = scene_.simulation.gravity;
  if (!(scene_.scenario.load_rate > 0) || !(gravity > 0)) return;
  if (result_.first_failure_load > 0) return;
  added_load_ += scene_.scenario.load_rate * dt;
  for (std::uint32_t s = 0; s < frame_.slabs.size(); ++s) {
    Part& part = parts_[frame_.slab_part(s)];
    if (part.body == kNoBody) continue;
    const double more = scene_.scenario.load_rate * dt * slab_area(frame_, s) / gravity;
    const double before = world_.kinetic_energy();
    part.solid.mass += more;
    world_.set_mass(part.body, part.solid.mass);
    result_.energy_in += world_.kinetic_energy() - before;
    baseline_ += more * gravity * world_.centre(part.body).y;
  }
}

void CollapseRun::launch_due() {
  for (std::uint32_t i = 0; i < shots_.size(); ++i)
    if (shots_[i].body == kNoBody && scene_.projectiles[i].time <= now_) launch(i);
}

void CollapseRun::launch(std::uint32_t index) {
  const Projectile& p = scene_.projectiles[index];
  Shot& shot = shots_[index];
  BodyParams body;
  body.mass = p.mass;
  const double inertia = 0.4 * p.mass * p.radius * p.radius;
  body.inertia = {inertia, inertia, inertia, 0, 0, 0};
  body.pose.position = p.position;
  body.velocity = p.velocity;
  body.surface = {p.friction, p.restitution};
  body.order = kShotOrder + index;
  shot.body = world_.add_sphere(body, p.radius);
  parts_of_body_.resize(shot.body + 1, kNoPart);
  shot.track = recorder_.add_track(kNoTrack);
  recorder_.add_pose(shot.track, body.pose);
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
  for (std::uint32_t i = 0; i < parts_.size(); ++i)
    if (distance_to(parts_[i].solid, p.position) < p.radius)
      fail("inside \"" + frame_.part_name(i) + "\"");
}

void CollapseRun::record(double time) {
  recorder_.add_time(time);
  const auto note = [&](BodyId body, std::uint32_t& track) {
    if (!world_.is_awake(body)) {
      ++result_.body_steps_asleep;
      ++result_.poses_not_recorded;
      return;
    }
    if (track == kNoTrack) track = recorder_.add_track(kNoTrack);
    recorder_.add_pose(track, world_.pose(body));
  };
  for (Part& part : parts_)
    if (part.body != kNoBody) note(part.body, part.track);
  for (Shot& shot : shots_)
    if (shot.body != kNoBody) note(shot.body, shot.track);
  if (time + 1e-9 >= next_sample_) sample(time);
}

void CollapseRun::sample(double time) {
  next_sample_ = time + scene_.simulation.history_step;
  if (!params_.keep_history) return;
  const double last = sample_times_.empty() ? -1 : sample_times_.back();
  sample_times_.push_back(time);
  for (Joint& joint : joints_) {
    samples_.push_back(joint.broken > last ? joint.peak : JointSample{});
    joint.peak.utilisation = 0;  // the next reading takes its place
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
  r.energy.kinetic = world_.kinetic_energy();
  r.energy.potential = world_.potential_energy() - baseline_;
  r.energy.numerical = r.energy_in - r.energy.kinetic - r.energy.potential - r.energy.friction -
                       r.energy.contact - r.joint_work;
  r.momentum_error = largest_momentum_ > 0 ? largest_momentum_error_ / largest_momentum_ : 0;
  r.reactions[0] = impulse_.x, r.reactions[1] = impulse_.y, r.reactions[2] = impulse_.z;
  r.solver_fallbacks = world_.solver_fallbacks();
  const std::vector<std::uint8_t> stands = grounded();
  r.parts_freed = static_cast<std::uint64_t>(std::ranges::count(stands, 0));
  for (const std::uint32_t member : tops())
    if (stands[member] != 0) r.sag_end = std::max(r.sag_end, sag_of(member));
  if (r.broken_at_rest > 0)
    r.warnings.push_back(
        std::to_string(r.broken_at_rest) +
        " joints were over their strength at rest and broke before anything happened; look at "
        "utilisation_at_rest: more \"iterations\", a shorter \"step\" or a longer \"settle\" make "
        "the solver's forces truer, stronger sections or joints the building");
  r.hash = recorder_.hash();
  r.recording = recording();
  return std::move(r);
}

Recording CollapseRun::recording() {
  Recording recording = recorder_.take();
  for (std::uint32_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    recording.parts.push_back({frame_.part_name(i), part.solid.outline, part.solid.half_length,
                               part.solid.material, part.solid.mass,
                               {part.solid.centre, rotation_of(part.solid.axes)}, part.track,
                               i < frame_.members.size(), part.removed});
  }
  for (std::uint32_t j = 0; j < joints_.size(); ++j) {
    const FrameJoint& joint = frame_.joints[j];
    recording.joints.push_back({joint.name, joint.a, joint.b == kNoPart ? kNoTrack : joint.b,
                                joint.end_a, joint.end_b, joint.point, joints_[j].broken});
  }
  recording.sample_times = std::move(sample_times_);
  recording.samples = std::move(samples_);
  for (std::size_t i = 0; i < shots_.size(); ++i)
    recording.projectiles.push_back({scene_.projectiles[i], shots_[i].track});
  return recording;
}

CollapseResult simulate_collapse(const CollapseScene& scene, const CollapseParams& params) {
  return CollapseRun(scene, params).run();
}

}  // namespace sunder
