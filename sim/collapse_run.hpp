// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "sim/collapse.hpp"
#include "sim/divided_members.hpp"
#include "sim/frame_motion.hpp"
#include "sim/panels.hpp"
#include "sim/post_stability.hpp"
#include "sim/recorder.hpp"
#include "sim/rigid_world.hpp"

namespace sunder {

/// One run of a building. How parts move and what joints carry is in FrameMotion, projectiles are
/// in RigidWorld; this class moves time on, reads the joints' loads and lets joints break.
class CollapseRun {
 public:
  CollapseRun(const CollapseScene& scene, const CollapseParams& params);
  CollapseResult run();

 private:
  struct Part {
    std::uint32_t track = kNoTrack;
    double removed = std::numeric_limits<double>::infinity();
  };
  /// What a member bears between its ends.
  struct Member {
    std::uint32_t joint_class = 0;
    JointStrength strength;
    double margin = 0;     ///< of its ends, that are their joints' business, m
    bool is_part = false;  ///< of one that divided: that does not divide again
  };
  struct Weak {
    std::uint32_t member = 0;
    WeakPlace place;
  };
  struct Joint {
    bool intact = true;
    double broken = std::numeric_limits<double>::infinity();
    bool is_read = false;           ///< since the last sample
    double utilisation = 0;         ///< at the last reading
    JointSample peak;               ///< since the last sample
    std::uint32_t yield = kNoPart;  ///< of the result's yielded joints
  };
  struct Shot {
    BodyId body = kNoBody;
    std::uint32_t track = kNoTrack;
    Vec3 velocity;  ///< when the step began
    Vec3 given;     ///< momentum, to what stands, since they touch
    double brought = 0;  ///< kinetic energy before they touched, J
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
  void settle();
  void start();
  void step_once(double end);
  double next_substep(double left) const;
  void advance(double dt, bool ends_step);
  void launch_due();
  void launch(std::uint32_t shot);
  void refuse_overlap(const Projectile& projectile) const;
  void remove_parts();
  void hand_over(std::uint32_t member);
  void add_panels();
  void break_off(std::uint32_t part);
  void raise_load(double dt);
  void record(double time);
  void sample(double time);
  void note_sag();
  CollapseResult outcome();
  void add_outcome(const ImpactResult& panels);
  Recording recording();
  std::vector<std::uint32_t> tops() const;
  std::vector<std::uint8_t> grounded() const;

  // run_balance.cpp: where the energy is.
  RunSample balance() const;
  double energy_in() const { return result_.energy_in + motion_->given(); }
  void note_use(double utilisation);
  double most_used_now() const;
  void sample_run();
  void take_balance();

  // joint_failure.cpp: loads, and what breaks.
  void break_overloaded();
  void cascade();
  void crack_panels();
  void add_mechanisms(std::vector<Failure>& failures) const;
  void keep_most_utilised(std::vector<Failure>& failures, std::vector<Weak>& weak) const;
  double kinetic_energy(std::size_t shot) const;
  void give_way(std::size_t broken_before, const std::vector<Weak>& weak);
  std::map<std::uint32_t, Vec3> pressed_by(BodyId ball, Vec3& lost) const;
  double borne_share(std::uint32_t part, std::size_t broken_before,
                     const std::vector<Weak>& weak) const;
  std::uint32_t struck_part(const Contact& contact, BodyId ball) const;
  void read_loads(std::vector<Failure>& failures);
  Utilisation demand_on(std::uint32_t joint, const JointLoad& load);
  bool yields(const Failure& failure);
  void check_posts(std::vector<Failure>& failures);
  void check_hits(std::vector<Failure>& failures);
  void note_hit(const Contact& contact, std::uint32_t shot, double dt);
  // member_failure.cpp: members that fail between their ends.
  void add_members();
  std::vector<Weak> weak_members();
  bool is_brittle(const Weak& weak) const;
  bool is_inside(std::uint32_t joint) const;
  void divide_members(const std::vector<Weak>& weak);
  std::array<PartSolid, 2> divide_part(const MemberDivision& division);
  Kinks::Poses follow_kinks();

  Vec3 place_of(std::uint32_t joint) const;
  void break_joints(std::vector<Failure> failures);
  void break_joint(const Failure& failure);

  CollapseScene scene_;  ///< its frame changes when parts are taken away
  const CollapseParams& params_;
  Frame& frame_;
  std::vector<PartSolid> solids_;
  RigidWorld world_;
  std::unique_ptr<FrameMotion> motion_;
  std::unique_ptr<Panels> panels_;  ///< none: nothing in the building breaks but joints
  PostStability posts_;
  std::vector<Part> parts_;
  std::vector<Joint> joints_;
  std::vector<std::vector<std::uint32_t>> joints_of_;  ///< by part
  std::vector<Member> members_;                        ///< none: they do not divide
  std::uint32_t drawn_nodes_ = kNoPart;                ///< nodes that are no place of a division
  Kinks kinks_;
  std::vector<Shot> shots_;
  Recorder recorder_;
  std::vector<double> sample_times_;
  std::vector<JointSample> samples_;
  std::vector<RunSample> series_;
  std::vector<std::size_t> sample_starts_;  ///< of each time
  CollapseResult result_;
  double posts_use_ = 0;     ///< largest of all posts at the last look
  double used_ = 0;          ///< largest utilisation since the last sample
  double now_ = 0, last_dt_ = 0, next_sample_ = 0;
  std::uint64_t intact_joints_ = 0, present_parts_ = 0;
  bool all_known_ = false;    ///< no joint has to be read until a load changes or a sample is taken
  bool posts_known_ = false;  ///< nor a post
  bool members_known_ = false;  ///< nor a member between its ends
  bool breaks_ = false;       ///< settled: joints can break
  bool disturbed_ = false;    ///< something has happened to the building
  std::uint64_t unsettled_steps_ =
      0;                   ///< panels and joints still broke each other after all rounds
  double added_load_ = 0;  ///< N/m²
  double baseline_ = 0;    ///< potential energy of the projectiles where they started, J
  double start_ = 0;       ///< energy of the standing frame at time 0, J
  Vec3 impulse_;
  double largest_momentum_ = 0, largest_momentum_error_ = 0;
};

}  // namespace sunder
