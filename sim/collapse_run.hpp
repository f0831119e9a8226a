// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "sim/collapse.hpp"
#include "sim/post_stability.hpp"
#include "sim/recorder.hpp"
#include "sim/rigid_world.hpp"

namespace sunder {

/// One run of a building as rigid bodies. Poses and velocities are in RigidWorld; this class moves
/// time on, reads the joints' loads and lets joints break.
class CollapseRun {
 public:
  CollapseRun(const CollapseScene& scene, const CollapseParams& params);
  CollapseResult run();

 private:
  struct Part {
    PartSolid solid;
    BodyId body = kNoBody;
    std::uint32_t track = kNoTrack;
    double removed = std::numeric_limits<double>::infinity();
  };
  struct Joint {
    JointId id = 0;
    bool intact = true;
    double broken = std::numeric_limits<double>::infinity();
    JointLoad load;          ///< mean over the load time
    double utilisation = 0;  ///< of it
    JointSample peak;        ///< since the last sample
  };
  struct Shot {
    BodyId body = kNoBody;
    std::uint32_t track = kNoTrack;
    Vec3 velocity;  ///< when the step began
  };
  /// What breaks in a step: collected first, then done in the order of joints.
  struct Failure {
    std::uint32_t joint = 0;
    double utilisation = 0;
    std::string_view mode;
    std::string rule;
    std::string component;
    bool bears_on = true;  ///< afterwards the two parts still touch
  };

  // collapse.cpp: set-up, time, outcome.
  void add_parts();
  void add_joints();
  void settle();
  void start();
  void step_once(double end);
  double next_substep(double left) const;
  void advance(double dt);
  void launch_due();
  void launch(std::uint32_t shot);
  void refuse_overlap(const Projectile& projectile) const;
  void remove_parts();
  void raise_load(double dt);
  void record(double time);
  void sample(double time);
  void note_reactions();
  void note_sag();
  CollapseResult outcome();
  Recording recording();
  std::uint32_t body_part(BodyId body) const;
  std::vector<std::uint32_t> tops() const;
  double sag_of(std::uint32_t post) const;
  std::vector<std::uint8_t> grounded() const;

  // joint_failure.cpp: loads, and what breaks.
  void break_overloaded();
  bool is_awake(const FrameJoint& joint) const;
  JointLoad load_of(std::uint32_t joint) const;
  void follow(Joint& state, const JointLoad& load) const;
  void read_loads(std::vector<Failure>& failures);
  void check_posts(std::vector<Failure>& failures);
  void check_hits(std::vector<Failure>& failures);
  void note_hit(const Contact& contact, std::uint32_t shot, double dt);
  Vec3 place_of(std::uint32_t joint) const;
  void break_joints(std::vector<Failure> failures);
  void break_joint(const Failure& failure);

  const CollapseScene& scene_;
  const CollapseParams& params_;
  const Frame& frame_;
  RigidWorld world_;
  PostStability posts_;
  std::vector<Part> parts_;
  std::vector<Joint> joints_;
  std::vector<std::vector<std::uint32_t>> joints_of_;  ///< by part
  std::vector<Shot> shots_;
  std::vector<std::uint32_t> parts_of_body_;  ///< by BodyId; kNoPart: a projectile, the ground
  Recorder recorder_;
  std::vector<double> sample_times_;
  std::vector<JointSample> samples_;
  CollapseResult result_;
  double now_ = 0, last_dt_ = 0, next_sample_ = 0;
  bool breaks_ = false;      ///< settled: joints can break
  bool disturbed_ = false;   ///< something has happened to the building
  double added_load_ = 0;    ///< N/m²
  double baseline_ = 0;      ///< potential energy where everything started, J
  std::uint64_t reaction_steps_ = 0;
  Vec3 impulse_;
  double largest_momentum_ = 0, largest_momentum_error_ = 0;
};

}  // namespace sunder
