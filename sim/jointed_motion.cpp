// SPDX-License-Identifier: GPL-3.0-or-later
// A building as rigid bodies: one per part, six equations per joint (three for one that turns).
#include <algorithm>
#include <cmath>
#include <string>

#include "meshing/error.hpp"
#include "sim/frame_motion.hpp"
#include "sim/part_pose.hpp"

namespace sunder {
namespace {

/// The first steps of settling iterate so many times more: from then on the joints' impulses start
/// from what carries the building.
constexpr std::uint64_t kFirstSteps = 4;
constexpr int kFirstIterations = 100, kMostIterations = 10000;

/// Of a direct solver: minutes a step beyond.
constexpr std::size_t kMostDirectRows = 4000;

class JointedMotion final : public FrameMotion {
 public:
  JointedMotion(const CollapseScene& scene, RigidWorld& world,
                const std::vector<PartSolid>& solids);
  void settle(const Progress& progress) override;
  void follow(double now, double dt, bool ends_step) override;
  JointLoad load(std::uint32_t joint) const override { return joints_[joint].load; }
  bool is_live(std::uint32_t joint) const override { return is_moving(frame_.joints[joint].a); }
  void break_joint(std::uint32_t joint, bool bears_on) override;
  bool redistributes() const override { return false; }
  bool settle_breaks() override { return false; }
  std::vector<std::uint32_t> unheld_joints() const override { return {}; }
  void rejoin(std::span<const std::uint32_t> joints) override;
  void remove_part(std::uint32_t part) override;
  void add_load(double more) override;
  bool stands(std::uint32_t) const override { return false; }
  BodyId give_up_shape(std::uint32_t) override { return kNoBody; }
  void take_shape(std::uint32_t, BodyId) override {}
  void set_mass(std::uint32_t, double) override {}
  Leaving release(std::uint32_t part) override;
  Pose pose(std::uint32_t part) const override { return world_.pose(parts_[part].body); }
  bool is_moving(std::uint32_t part) const override {
    return parts_[part].body != kNoBody && world_.is_awake(parts_[part].body);
  }
  std::uint32_t part_of(BodyId body, std::uint32_t) const override {
    return body < part_of_body_.size() ? part_of_body_[body] : kNoPart;
  }
  double sag(std::uint32_t member) const override;
  std::vector<SupportReaction> supports() const override { return supports_; }
  double joint_gap(std::uint32_t joint) const override {
    return world_.joint_reaction(joints_[joint].id).gap;
  }
  std::uint64_t bodies() const override { return standing_; }
  double kinetic() const override { return 0; }
  double strain() const override { return 0; }
  double potential() const override { return 0; }
  double baseline() const override { return baseline_; }
  MotionLosses losses() const override { return losses_; }
  double given() const override { return given_; }
  SolveCounts solves() const override { return {}; }
  double residual() const override { return 0; }

 private:
  struct Part {
    BodyId body = kNoBody;
    double mass = 0;
  };
  struct Joint {
    JointId id = 0;
    bool intact = true;
    JointLoad load;  ///< mean over the load time
  };
  JointLoad raw_load(std::uint32_t joint) const;
  void note_reactions();
  void part_feet();
  void refuse_large_direct() const;

  const CollapseScene& scene_;
  const Frame& frame_;
  RigidWorld& world_;
  const std::vector<PartSolid>& solids_;
  std::vector<Part> parts_;
  std::vector<Joint> joints_;
  std::vector<std::uint32_t> part_of_body_;  ///< by BodyId
  std::vector<SupportReaction> supports_;
  std::uint64_t reaction_steps_ = 0, standing_ = 0;
  double baseline_ = 0, given_ = 0;
  MotionLosses losses_;
};

JointedMotion::JointedMotion(const CollapseScene& scene, RigidWorld& world,
                             const std::vector<PartSolid>& solids)
    : scene_(scene), frame_(scene.frame), world_(world), solids_(solids) {
  for (std::uint32_t i = 0; i < solids.size(); ++i) {
    BodyParams body;
    body.mass = solids[i].mass;
    body.inertia = solids[i].inertia;
    body.pose = pose_of(solids[i]);
    body.order = kMovingOrder + i;
    body.surface = surface_of(frame_, i);
    const Prism prism{solids[i].hull, solids[i].half_length};
    parts_.push_back({world_.add_body(body, {&prism, 1}), body.mass});
    part_of_body_.resize(parts_.back().body + 1, kNoPart);
    part_of_body_[parts_.back().body] = i;
  }
  standing_ = parts_.size();
  for (const FrameJoint& joint : frame_.joints) {
    const BodyId carrier = joint.b == kNoPart ? kGround : parts_[joint.b].body;
    Joint state;
    state.id = world_.add_joint({parts_[joint.a].body, carrier, joint.point, joint.axes,
                                 frame_.classes[joint.joint_class].rigid});
    joints_.push_back(state);
    if (joint.b == kNoPart) supports_.push_back({joint.node, {}, {}});
  }
  part_feet();
  refuse_large_direct();
}

/// Members that stand on the same support overlap there.
void JointedMotion::part_feet() {
  std::vector<std::vector<std::uint32_t>> on(frame_.nodes.size());
  for (const FrameJoint& joint : frame_.joints) {
    if (joint.b != kNoPart || joint.node == kNoPart) continue;
    for (const std::uint32_t other : on[joint.node])
      world_.separate(parts_[joint.a].body, parts_[other].body);
    on[joint.node].push_back(joint.a);
  }
}

void JointedMotion::refuse_large_direct() const {
  const std::string& solver = scene_.simulation.joint_solver;
  if (solver != "dantzig" && solver != "lemke") return;
  const std::size_t rows = 6 * frame_.joints.size();
  if (rows > kMostDirectRows)
    throw Error(ErrorCode::input, "joint_solver = \"" + solver + "\" takes time with the cube of " +
                                      std::to_string(rows) + " equations; at most " +
                                      std::to_string(kMostDirectRows) +
                                      ", use \"sequential-impulse\"");
}

/// Nothing breaks, nothing is recorded.
void JointedMotion::settle(const Progress& progress) {
  const SimulationParams& simulation = scene_.simulation;
  const auto steps =
      static_cast<std::uint64_t>(std::ceil(simulation.settle / simulation.step - 1e-9));
  const int iterations = static_cast<int>(simulation.iterations);
  for (std::uint64_t i = 0; i < steps; ++i) {
    const bool is_first = simulation.warm_start && i < kFirstSteps;
    world_.set_iterations(
        is_first ? std::max(iterations, std::min(kFirstIterations * iterations, kMostIterations))
                 : iterations);
    world_.step(simulation.step);
    if (2 * i >= steps) note_reactions();
    if (progress)
      progress(static_cast<double>(i) * simulation.step /
               (simulation.settle + simulation.duration));
  }
  world_.set_iterations(iterations);
  const double share = reaction_steps_ > 0 ? 1.0 / static_cast<double>(reaction_steps_) : 0;
  for (SupportReaction& support : supports_) {
    support.force = share * support.force;
    support.torque = share * support.torque;
  }
  for (std::uint32_t j = 0; j < joints_.size(); ++j) joints_[j].load = raw_load(j);
  baseline_ = world_.potential_energy();
  given_ = world_.kinetic_energy();
}

void JointedMotion::note_reactions() {
  ++reaction_steps_;
  auto support = supports_.begin();
  for (std::uint32_t j = 0; j < joints_.size(); ++j) {
    const FrameJoint& joint = frame_.joints[j];
    if (joint.b != kNoPart) continue;
    const JointReaction reaction = world_.joint_reaction(joints_[j].id);
    const Quaternion turn = pose(joint.a).rotation * conjugate(rotation_of(solids_[joint.a].axes));
    support->force = support->force + rotate(turn, joint.axes * reaction.force);
    support->torque = support->torque + rotate(turn, joint.axes * reaction.torque);
    ++support;
  }
}

/// Section forces of part a: tension positive. What holds its beginning pulls the other way.
JointLoad JointedMotion::raw_load(std::uint32_t j) const {
  const JointReaction reaction = world_.joint_reaction(joints_[j].id);
  const double side = frame_.joints[j].end_a == 1 ? 1 : -1;
  return {side * reaction.force, side * reaction.torque};
}

/// Loads follow the solver's by a first-order lag, by the implicit rule.
void JointedMotion::follow(double, double dt, bool) {
  const double share = dt / (dt + scene_.rules.load_time);
  for (std::uint32_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    if (!joint.intact || !is_live(j)) continue;
    const JointLoad now = raw_load(j);
    joint.load.force = joint.load.force + share * (now.force - joint.load.force);
    joint.load.torque = joint.load.torque + share * (now.torque - joint.load.torque);
  }
  losses_.joint += world_.work().joint;
}

void JointedMotion::break_joint(std::uint32_t j, bool bears_on) {
  const FrameJoint& joint = frame_.joints[j];
  joints_[j].intact = false;
  world_.remove_joint(joints_[j].id);
  if (!bears_on && joint.b != kNoPart) world_.separate(parts_[joint.a].body, parts_[joint.b].body);
}

void JointedMotion::rejoin(std::span<const std::uint32_t> joints) {
  for (const std::uint32_t j : joints) {
    const FrameJoint& joint = frame_.joints[j];
    if (!joints_[j].intact) continue;
    world_.remove_joint(joints_[j].id);
    const Pose moved = pose(joint.a) * inverse(pose_of(solids_[joint.a]));
    const Axes axes{rotate(moved.rotation, joint.axes.x), rotate(moved.rotation, joint.axes.y),
                    rotate(moved.rotation, joint.axes.z)};
    joints_[j].id =
        world_.add_joint({parts_[joint.a].body, parts_[joint.b].body, moved * joint.point, axes,
                          frame_.classes[joint.joint_class].rigid});
  }
}

void JointedMotion::remove_part(std::uint32_t i) {
  Part& part = parts_[i];
  baseline_ -= part.mass * scene_.simulation.gravity * world_.centre(part.body).y;
  const double before = world_.kinetic_energy();
  world_.remove(part.body);
  given_ += world_.kinetic_energy() - before;
  part_of_body_[part.body] = kNoPart;
  part.body = kNoBody;
  --standing_;
}

FrameMotion::Leaving JointedMotion::release(std::uint32_t i) {
  Part& part = parts_[i];
  const Leaving leaving{pose(i), world_.centre(part.body), world_.velocity(part.body),
                        world_.angular_velocity(part.body)};
  world_.remove(part.body);
  part_of_body_[part.body] = kNoPart;
  part.body = kNoBody;
  --standing_;
  return leaving;
}

/// Mass that stands on the slabs.
void JointedMotion::add_load(double more) {
  const double gravity = scene_.simulation.gravity;
  const double before = world_.kinetic_energy();
  for (std::uint32_t s = 0; s < frame_.slabs.size(); ++s) {
    Part& part = parts_[frame_.slab_part(s)];
    if (part.body == kNoBody) continue;
    const double mass = more * slab_area(frame_, s) / gravity;
    part.mass += mass;
    world_.set_mass(part.body, part.mass);
    baseline_ += mass * gravity * world_.centre(part.body).y;
  }
  given_ += world_.kinetic_energy() - before;
}

double JointedMotion::sag(std::uint32_t member) const {
  const Vec3 stood = frame_.nodes[frame_.members[member].to].position;
  const PartSolid& solid = solids_[member];
  return stood.y - (pose(member) * into(solid.axes, stood - solid.centre)).y;
}

}  // namespace

std::unique_ptr<FrameMotion> jointed_motion(const CollapseScene& scene, RigidWorld& world,
                                            const std::vector<PartSolid>& solids) {
  return std::make_unique<JointedMotion>(scene, world, solids);
}

}  // namespace sunder
