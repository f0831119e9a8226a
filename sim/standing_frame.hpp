// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim/collapse.hpp"
#include "sim/divided_members.hpp"
#include "sim/frame_motion.hpp"
#include "sim/frame_solver.hpp"

namespace sunder {

/// What stands of a building: at rest in one frame solver; in time, when something happens to it,
/// in another one, by the trapezoidal rule (Newmark's method with 1/4, 1/2, here without
/// accelerations, so that it starts right after a break). Only the solver in use is kept up to
/// date; the other one follows when it is needed. Keeps a reference to the scene.
class StandingFrame {
 public:
  using Hinge = FrameSolver::Hinge;
  explicit StandingFrame(const CollapseScene& scene);
  ~StandingFrame();

  /// The elastic state under the weight; nothing moves. Throws Error{input} as FrameSolver does.
  /// If anything of the scene can disturb it, the factor of what rings is begun in a thread of its
  /// own, and waited for when it is needed first.
  void settle(const Progress& progress);
  std::vector<SupportReaction> supports() const;
  /// Slabs and walls that are elastic from now on, without force as the frame is at rest now
  /// (their `at_rest` is set). They cost nothing before the frame is woken first.
  void set_panels(std::vector<PanelElement> elements);

  // Loads, for the next step or carry_on().
  void set_time(double now) { now_ = now; }
  void set_contacts(std::vector<FrameLoads::OnPart> contacts);  ///< by part of the scene's frame
  void add_live(double more);  ///< N/m² on all slabs; energy that it brings is not booked

  // Time.
  bool rings() const { return rings_; }
  bool in_time() const { return rings_ && !scene_.simulation.quasi_static; }
  void wake();  ///< starts from the state at rest
  /// Velocities at the end of the step; with other contacts solve_step() changes them.
  void begin_step();
  void solve_step();
  void end_step();
  /// The last step can be done again with other contacts, from where it began.
  bool can_step_again() const { return can_step_again_; }
  void step_again();
  /// Speed of the place that a contact touches, along its force; in time. What the force does on
  /// the frame is its work on that.
  double speed_along(FrameLoads::OnPart contact) const;
  void follow_step();  ///< after a step; a hinge that would turn back is stiff, as it was before
  void fall_quiet(double dt);

  /// Joints break, parts leave with all their joints; `changed`: parts_at() of them. Then carry_on().
  void take_out(std::span<const std::uint32_t> joints, std::span<const std::uint32_t> parts,
                std::span<const std::uint32_t> changed);
  // Other changes of what there is. Then carry_on().
  void set_plate_mass(std::uint32_t part, double mass);  ///< what is left of a slab or wall, kg
  /// Other stiffnesses of some that were set. Then carry_on().
  void change_panels(std::span<const PanelStiffness> changed);
  /// In time displacements are continuous, else there is a new balance. What hinges turn then is
  /// plastic work.
  void carry_on();
  /// The frame's joints have other parts: solvers are made anew, the state is the same.
  void rejoin();
  // Members divide: standing_division.cpp.
  bool find_span(std::uint32_t member, MemberSpan& span) const {
    return in_use().find_span(member, span);
  }
  void begin_divisions(std::span<const MemberCut> cuts);  ///< the frame is about to change
  /// The frame has so many members more, and what stands these nodes, in the order of the cuts:
  /// then solvers are made anew, the state is the same.
  void end_divisions(std::uint32_t count, std::span<const std::uint32_t> nodes,
                     std::vector<FrameLoads::OnPart> contacts,
                     std::vector<std::uint32_t> not_standing);
  std::vector<std::uint32_t> loose_parts() const;
  /// Members that have turned farther than small displacements mean: nothing that stands holds
  /// them. Ascending.
  std::vector<std::uint32_t> overturned() const;
  std::vector<std::uint32_t> bridging_joints() const { return in_use().bridging_joints(); }

  // Plastic hinges. In time they turn; at rest they are held as they are left.
  const Hinge* hinge(std::uint32_t joint) const;  ///< nullptr: it is none
  bool bends() const { return !hinges_.empty(); }
  bool can_bend(std::uint32_t joint) const { return in_use().can_bend(joint); }
  void set_hinges(const std::vector<Hinge>& hinges);

  JointLoad load(std::uint32_t joint) const { return in_use().joint_load(joint); }
  bool is_live() const { return is_live_; }  ///< loads have changed since forget_changes()
  void forget_changes() { is_live_ = can_step_again_ = false; }
  Vec3 displacement(std::uint32_t node) const { return in_use().displacement(node); }
  Vec3 rotation(std::uint32_t node) const { return in_use().rotation(node); }
  /// Of an elastic panel's corners from where it is without force, m; none: it is none (any more).
  std::optional<Twelve> panel_motion(std::uint32_t part) const;
  /// Velocity and angular velocity of a node; in time.
  struct Motion {
    Vec3 velocity, spin;
  };
  Motion motion(std::uint32_t node) const;
  /// Of the free end of a member that hangs on the other one; in time.
  struct TipMotion {
    Vec3 displacement, velocity;
  };
  std::optional<TipMotion> tip(std::uint32_t member) const;
  /// Of these parts; of displacements with live loads, of velocities (in time) without.
  std::vector<FrameSolver::MassWay> ways(std::span<const std::uint32_t> parts) const;
  std::vector<FrameSolver::MassWay> speeds(std::span<const std::uint32_t> parts) const;
  /// Parts whose ways take_out() of these joints and parts (give their joints too) may change.
  std::vector<std::uint32_t> parts_at(std::span<const std::uint32_t> joints,
                                      std::span<const std::uint32_t> parts) const;

  double kinetic() const;    ///< J
  double strain() const;     ///< J
  double potential() const;  ///< of the weight on the displacements, J
  double energy() const;     ///< all three
  /// Damping, plastic work, what contacts booked. Fracture is booked by whoever breaks joints.
  const MotionLosses& losses() const { return losses_; }
  double given() const { return given_; }  ///< by the ground's motion, J
  SolveCounts solves() const;
  double residual() const { return residual_; }  ///< largest so far, relative
  const std::optional<Buckling>& buckling() const { return buckling_; }

 private:
  /// A solver and how much of what was taken out it knows.
  struct Solver {
    std::unique_ptr<FrameSolver> frame;
    std::size_t joints = 0, parts = 0, masses = 0;
    std::vector<std::uint32_t> panels = {};  ///< how often each was set; empty: never
  };
  struct Panel {
    PanelElement element;
    std::uint32_t set = 1;  ///< how often
  };
  /// Before a step that may have to be done again.
  struct Moment {
    std::vector<double> u, v, f;
    FrameLoads laid, pushed, shaken;
    MotionLosses losses;
    double given = 0;
  };
  /// Before members divide.
  struct Undivided {
    std::vector<Hinge> hinges;
    bool in_time = false;
    std::vector<Six> u, v;  ///< of the places where they divide
    std::size_t nodes = 0;  ///< freedoms of nodes
  };
  struct TipState {
    std::uint32_t member = 0;
    Six u{}, v{};
  };
  FrameSolver& in_use() const { return in_time() ? *dynamic_.frame : *static_.frame; }
  /// Books are kept in the dynamic solver from the first time that the frame rings.
  FrameSolver& ledger() const { return has_rung_ ? *dynamic_.frame : *static_.frame; }
  FrameLoads loads() const;
  FrameLoads touching() const;
  FrameLoads shaking() const;
  Vec3 gravity() const;
  void bring_up_to_date(Solver& solver) const;
  void tell_all(Solver& solver) const;
  std::vector<double> with_tips(std::span<const double> nodes) const;
  std::vector<TipState> tips_of(const FrameSolver& solver, const std::vector<double>& u,
                                const std::vector<double>& v) const;
  void take_tips(const std::vector<TipState>& tips);
  void solve_static();
  void keep_in_range(const std::vector<double>& from);
  double share_for_hinges(const std::vector<double>& from);
  void solve_anew();
  void balance();
  FrameSolverParams static_params() const;
  struct Factored {
    double stiffness = 1, mass = 0;  ///< so much of K and of M
  };
  Factored factored_in_time() const;
  double solve_pushed();
  FrameSolverParams dynamic_params() const;
  bool may_ring() const;
  void begin_dynamic();
  void take_in_panels();
  void make_dynamic();
  void start_anew(const std::vector<Hinge>& hinges);
  std::uint32_t known_part(std::uint32_t part) const;
  std::vector<std::uint32_t> known_parts(std::span<const std::uint32_t> parts) const;
  void move_on();
  void find_momentum() const;
  void stand_on();
  void account_for_damping();
  void note_residual(const std::vector<double>& mass_way, const std::vector<double>& spring_way);
  void take_state(const FrameSolver& old, const std::vector<double>& u,
                  const std::vector<double>& v);
  void go_back();
  std::vector<Hinge> stiff_hinges() const;
  std::vector<Hinge> turned_back(const std::vector<Hinge>& now) const;
  void follow_hinges();
  double turned_work() const;
  double take_turns();
  void keep_turned();
  bool turn_endlessly(const std::vector<Hinge>& hinges) const;
  void hold_hinges(std::vector<Hinge> hinges);

  const CollapseScene& scene_;
  Frame frame_;                      ///< as the solvers know it
  std::uint32_t members_since_ = 0;  ///< of the scene's frame: they came in where nothing stands
  Solver static_, dynamic_;
  std::atomic<bool> stops_ = false;                  ///< nobody waits for `ahead_` any more
  std::future<std::unique_ptr<FrameSolver>> ahead_;  ///< of the dynamic one; reads the static one
  std::vector<std::uint32_t> broken_, gone_;         ///< all that was taken out
  std::vector<std::pair<std::uint32_t, double>> masses_;  ///< of plates, as they changed
  std::vector<Panel> panels_;                             ///< by part
  bool has_panels_ = false;                               ///< the solvers know of them
  std::vector<FrameLoads::OnPart> contacts_;
  // When it rings; in a step its way, the loads at its end, and what was when it began.
  std::vector<double> u_, v_, f_, way_, f_next_, v_before_, momentum_before_, springs_, right_,
      scratch_;
  mutable std::vector<double> momentum_;  ///< M v_, if it is known
  mutable bool is_momentum_known_ = false;
  std::vector<Hinge> hinges_;  ///< by joint
  std::vector<std::uint32_t> beyond_;      ///< joints whose hinges left their capacity in it
  std::vector<std::uint32_t> unresisted_;  ///< members that nothing held at the last balance
  /// When it rings: the last loads, and of them contacts and motion of the ground.
  FrameLoads laid_, pushed_, shaken_;
  Moment before_step_;
  Undivided undivided_;
  bool rings_ = false, has_rung_ = false, is_live_ = false, can_step_again_ = false;
  bool is_settled_ = false, is_first_order_ = false;
  bool is_short_ = false;  ///< the last balance was out of range: it went a part of the way
  double live_ = 0, now_ = 0, quiet_for_ = 0;
  MotionLosses losses_;
  double given_ = 0, residual_ = 0;
  std::optional<Buckling> buckling_;
};

}  // namespace sunder
