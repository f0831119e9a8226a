// SPDX-License-Identifier: GPL-3.0-or-later
// What the files of the solver "hybrid" share.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "fracture/support_graph.hpp"
#include "sim/building_bodies.hpp"
#include "sim/frame_motion.hpp"
#include "sim/frame_touches.hpp"
#include "sim/inner_forces.hpp"
#include "sim/part_links.hpp"
#include "sim/standing_frame.hpp"

namespace sunder {

/// A building as what it is: pieces that hang together, elastic inside. The piece on the ground
/// stands still in the world and rings, when something happens to it, in the frame solver alone
/// (StandingFrame). What comes loose is one rigid body each (BuildingBodies), whose inner forces
/// follow from its contacts by inertia relief (InnerForces).
class ElasticMotion final : public FrameMotion {
 public:
  ElasticMotion(const CollapseScene& scene, RigidWorld& world,
                const std::vector<PartSolid>& solids);
  void settle(const Progress& progress) override;
  void follow(double now, double dt, bool ends_step) override;
  JointLoad load(std::uint32_t joint) const override;
  bool is_live(std::uint32_t joint) const override;
  bool any_live() const override { return standing_.is_live() || inner_.any_live(); }
  bool any_moving() const override { return bodies_.piece_count() > 0; }
  void break_joint(std::uint32_t joint, bool bears_on) override;
  HingeState hinge(std::uint32_t joint) const override;
  bool yield(std::uint32_t joint, Vec3 moment) override;
  bool redistributes() const override { return true; }
  bool settle_breaks() override;
  std::vector<std::uint32_t> unheld_joints() const override;
  std::vector<std::uint32_t> mechanism_joints() const override;
  void add_projectile(BodyId body, double mass) override { projectiles_.push_back({body, mass}); }
  double borne(std::uint32_t part) const override { return touches_[part].borne; }
  Vec3 give_back(std::uint32_t part, double share) override;
  void rejoin(std::span<const std::uint32_t> joints) override;
  bool finds_spans() const override { return true; }
  bool find_span(std::uint32_t member, MemberSpan& span) const override;
  void begin_divisions(std::span<const MemberCut> cuts) override;
  void end_divisions(std::span<const MemberDivision> divisions) override;
  void remove_part(std::uint32_t part) override;
  void add_load(double more) override;
  void when_released(std::function<void(BodyId)> tell) override {
    bodies_.when_released(std::move(tell));
  }
  bool stands(std::uint32_t part) const override { return bodies_.stands(part); }
  BodyId give_up_shape(std::uint32_t part) override;
  void take_shape(std::uint32_t part, BodyId body) override { bodies_.take_shape(part, body); }
  void set_mass(std::uint32_t part, double mass) override;
  void set_panels(std::vector<PanelElement> elements) override {
    standing_.set_panels(std::move(elements));
  }
  void change_panels(std::span<const PanelStiffness> changed) override;
  Vec3 displacement(std::uint32_t node) const override { return standing_.displacement(node); }
  std::optional<Twelve> panel_motion(std::uint32_t part) const override {
    return standing_.panel_motion(part);
  }
  Leaving release(std::uint32_t part) override { return bodies_.hand_over(part); }
  Pose pose(std::uint32_t part) const override { return bodies_.pose(part); }
  bool is_moving(std::uint32_t part) const override;
  std::uint32_t part_of(BodyId body, std::uint32_t prism) const override {
    return bodies_.part_of(body, prism);
  }
  double sag(std::uint32_t member) const override;
  std::vector<SupportReaction> supports() const override { return supports_; }
  double unsupported() const override;
  double joint_gap(std::uint32_t) const override { return 0; }
  std::uint64_t bodies() const override { return bodies_.piece_count(); }
  double kinetic() const override { return standing_.kinetic(); }
  double strain() const override { return standing_.strain(); }
  double potential() const override;
  double baseline() const override { return bodies_.baseline(); }
  MotionLosses losses() const override;
  double given() const override { return given_ + standing_.given(); }
  SolveCounts solves() const override;
  double residual() const override;
  std::optional<Buckling> buckling() const override { return standing_.buckling(); }

 private:
  // elastic_motion.cpp
  double energy() const;  ///< of frame and bodies, J
  double unspent() const;
  void link_again();
  void hold_back_forces(std::uint32_t piece);
  void part_bodies();
  bool settle_hinges();
  std::vector<SupportGraph::Island> loose_from_standing();
  std::vector<std::uint32_t> release_loose(std::vector<SupportGraph::Island> islands,
                                           double& lowered);

  // elastic_division.cpp: members in two parts.
  void divide_touch(const MemberDivision& division);

  // elastic_contacts.cpp: what touches the parts.
  void note_contacts(double dt);
  void touch(const Contact& contact, std::uint32_t part, Vec3 impulse);
  double mass_of(BodyId projectile) const;
  double speed_ahead(std::uint32_t part, double share) const;
  struct Blow {
    std::uint32_t part = 0;
    double ahead = 0, share = 0;  ///< m/s; of the force, that can be borne
  };
  std::vector<Blow> blows_ahead() const;
  void limit_blows();
  std::vector<FrameLoads::OnPart> standing_contacts() const;
  void press();
  Pose displacement_of(std::uint32_t part) const;
  void move_colliders();

  // elastic_release.cpp: how parts of a ringing frame move.
  std::vector<std::uint32_t> nodes_of(std::uint32_t part) const;
  std::uint32_t held_node(std::uint32_t part, std::uint32_t node) const;
  Vec3 velocity_of_end(std::uint32_t part, std::uint32_t node) const;
  Vec3 way_of_end(std::uint32_t part, std::uint32_t node) const;
  Vec3 velocity_at(std::uint32_t part, Vec3 point) const;
  Vec3 of_solid(std::uint32_t part, const FrameSolver::MassWay& way) const;
  void take_frames_place(BodyParams& body, const std::vector<std::uint32_t>& parts) const;
  void take_frames_motion(BodyParams& body, const std::vector<std::uint32_t>& parts) const;
  struct Ways {
    std::vector<std::uint32_t> parts;  ///< that a break may change
    std::vector<FrameSolver::MassWay> ways;
  };
  void note_places(std::span<const std::uint32_t> parts,
                   std::span<const FrameSolver::MassWay> ways);
  Ways note_ways(std::vector<std::uint32_t> joints, std::span<const SupportGraph::Island> leaving);
  void keep_places(const Ways& before);

  const CollapseScene& scene_;
  const Frame& frame_;
  RigidWorld& world_;
  const std::vector<PartSolid>& solids_;
  SupportGraph graph_;
  PartLinks links_;
  BuildingBodies bodies_;
  FrameTouches touches_;
  std::vector<std::pair<BodyId, double>> projectiles_;  ///< and masses, kg
  StandingFrame standing_;
  InnerForces inner_;
  std::vector<std::uint32_t> broken_;                ///< since breaks were settled
  std::vector<std::array<std::uint32_t, 2>> apart_;  ///< parts that bear on each other no more
  std::vector<StandingFrame::Hinge> yielding_;       ///< since breaks were settled
  std::vector<SupportReaction> supports_;
  /// Where a part's centre of mass is by its own weight's work, and how it moves; of what the frame
  /// does not carry at the moment, where it was when it did.
  struct Place {
    Vec3 way, velocity;    ///< from where it stood unbent, m; m/s
    Vec3 turned, turning;  ///< first moments about the centre, kg m² and kg m²/s
  };
  std::vector<Place> places_;  ///< by part, when a break last changed what bears it
  /// By part: what its place is beyond what the frame says. A part that is borne in another way
  /// after a break has not moved.
  std::vector<Vec3> offsets_;
  double now_ = 0, noted_ = -1;  ///< places_, s
  double since_step_ = 0, given_ = 0, fracture_ = 0;
  double undivided_ = 0;  ///< energy of the standing frame when divisions began, J
  std::uint64_t skipped_ = 0;
};

}  // namespace sunder
