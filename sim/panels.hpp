// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "sim/collapse.hpp"
#include "sim/frame_motion.hpp"
#include "sim/panel_sense.hpp"
#include "sim/panel_stress.hpp"
#include "sim/recorder.hpp"
#include "sim/rigid_world.hpp"
#include "sim/wall_run.hpp"

namespace sunder {

/// Slabs and walls of a building that can break. Until something happens near one, it is a part of
/// the frame like others: a load and one collision shape. Then it is a wall of chunks that stands
/// where the part stood, and still loads the frame with what is left of it; or, where it came loose
/// before, a body of chunks.
class Panels {
 public:
  struct Host {
    RigidWorld& world;
    Recorder& recorder;
    FrameMotion& motion;
    const std::vector<PartSolid>& solids;
    /// Breaks what joints a part still has, so that it is a body of its own.
    std::function<void(std::uint32_t part)> break_off;
    std::function<bool(std::uint32_t joint)> is_intact;
    std::function<std::size_t()> broken_joints;  ///< how many so far
    /// The track of a part that leaves the frame.
    std::function<std::uint32_t(std::uint32_t part)> track_of;
  };
  /// All that is given outlives it.
  Panels(const CollapseScene& scene, bool skip, Host host);

  bool none() const { return panels_.empty(); }
  /// One that is in the world.
  void follow_shot(std::uint32_t shot, BodyId body, std::uint32_t track) {
    walls_.follow_shot(shot, body, track);
  }
  /// Parts from `first` on have numbers higher by `count` now; the frame has more joints.
  void make_room(std::uint32_t first, std::uint32_t count);
  /// Time 0: from now on they are elastic, without stress but that of their weight.
  void start();
  /// A body comes in: chunks that stand around it are there.
  void stand_before(BodyId body) { walls_.raise_colliders_around(body); }
  // A substep: prepare, next_arrival, the world's step, after_step, arrive.
  /// The longest substep in which nothing passes through a panel.
  double prepare(double dt);
  std::optional<WallRun::Arrival> next_arrival(double dt) const { return walls_.next_arrival(dt); }
  void after_step(double now, double dt);
  void arrive(const WallRun::Arrival& arrival) { walls_.arrive(arrival); }
  /// After the frame has changed: what hangs on nothing any more goes, what is left loads it.
  void follow_frame();
  /// Panels crack where their own weight, what lies on them and the frame's motion ask too much.
  /// Whether one has become softer: the frame knows.
  bool crack();

  void record() { walls_.record_islands(); }
  /// Whether a part is a wall of chunks now, which takes note of its hits itself.
  bool is_wall(std::uint32_t part) const {
    return panel_of_part_[part] != kNoPart && panels_[panel_of_part_[part]].stands;
  }
  bool any_awake() const { return any_awake_; }
  double baseline() const { return walls_.baseline() + shift_; }
  Vec3 impulse() const { return walls_.impulse(); }
  const EnergyLedger& energy() const { return result_.energy; }
  std::uint64_t broken_bonds() const { return result_.broken_bonds; }
  std::uint64_t solves() const { return solves_; }                  ///< of panels' networks
  std::uint64_t solves_skipped() const { return solves_skipped_; }  ///< panels × steps
  std::uint64_t count() const { return panels_.size(); }
  std::uint64_t meshed() const {  ///< of which the chunks were made
    return static_cast<std::uint64_t>(
        std::ranges::count_if(panels_, [](const Panel& panel) { return panel.made.has_value(); }));
  }
  /// What became of them. Their walls join the recording, whose parts say which of these they are.
  ImpactResult finish(Recording& recording);

 private:
  struct Panel {
    std::uint32_t part = 0;
    std::uint32_t pattern = 0;
    std::uint32_t number = 0;              ///< its part's when the run began
    bool stands = false;                   ///< as a wall of chunks
    std::uint32_t present = 0;             ///< chunks that stood when the frame was last told
    std::array<std::uint32_t, 4> nodes{};  ///< of the frame, in the order of PanelCorners
    PanelHold hold{};
    Quaternion to_wall{};                    ///< from the world
    std::optional<ImpactWall> made{};        ///< its chunks, once they were needed
    std::uint32_t shape = kNoPart;           ///< of shapes_; kNoPart: not yet known
    PanelFreedoms seen{};                    ///< corners for which `used` is known
    double used = 0;                         ///< largest utilisation there, in one piece
    std::optional<PanelStress> stress{};     ///< of one that stands as chunks
    std::vector<std::uint32_t> joints = {};  ///< that held it when it was looked at last
    Vec3 low{}, high{};                      ///< bounds of the part where it stood, world
  };
  /// What panels of the same size, pattern, material and hold have in common while they are whole.
  struct Shape {
    std::uint32_t first = 0;  ///< panel
    ImpactWall made;          ///< of the first
    std::optional<ChunkNetwork> network{};
    std::optional<PanelSense> sense{};
    double at_rest = 0;  ///< utilisation by weight alone
  };
  std::uint64_t variant_of(const Panel& panel) const;
  bool are_alike(const Panel& a, const Panel& b) const;
  Shape& shape_of(std::uint32_t w);
  const ImpactWall& made(std::uint32_t w);
  const WallAsset* given_asset(const Panel& panel) const;
  void check_size(const Panel& panel) const;
  static std::vector<Panel> panels_of(const Frame& frame, const std::vector<PartSolid>& solids);
  WallRun::Params wall_params();
  WallRun::Foreign foreign(BodyId body) const;
  Pose standing_of(const Panel& panel) const;
  Vec3 origin_of(const Panel& panel) const;
  ImpactWall wall_of(const Panel& panel) const;
  std::vector<std::string> anchors_of(const Panel& panel) const;
  bool is_near(const Panel& panel, const RigidWorld::Bounds& bounds) const;
  bool is_hard(const Contact& contact, const Panel& panel) const;
  void stand_up(std::uint32_t w);
  void place_corners(Panel& panel) const;
  PanelFreedoms corners_of(const Panel& panel) const;
  Vec3 gravity_in(const Pose& pose) const;
  const Material& material_of(const Panel& panel) const;
  void make_stress(std::uint32_t w);
  void note_touches(double dt);
  double added_use(const Panel& panel, const PanelFreedoms& corners,
                   const PanelFreedoms& before) const;
  bool may_crack(std::uint32_t w);
  bool is_settled(const Panel& panel, const PanelFreedoms& corners) const;
  void settle(std::uint32_t w);
  void break_bonds(std::uint32_t w, std::span<const BrokenBond> broken);
  bool has_lost_joint(const Panel& panel) const;
  std::size_t side_near(const Panel& panel, Vec2 point) const;
  void cut_anchors(std::uint32_t w);
  void come_loose(std::uint32_t w, BodyId struck, std::uint32_t prism = 0);
  void meet_contacts();
  std::uint32_t present(std::uint32_t w) const;
  double standing_mass(std::uint32_t w) const;

  const CollapseScene& scene_;
  const Host host_;
  const ImpactScene impact_;
  const ImpactParams params_;
  ImpactResult result_;
  std::vector<Panel> panels_;  ///< by wall
  std::vector<Shape> shapes_;
  std::uint64_t solves_ = 0, solves_skipped_ = 0;
  std::vector<PanelStiffness> softer_;        ///< that the frame does not know yet
  std::size_t joints_followed_ = 0;           ///< broken ones that follow_frame() knows of
  double shift_ = 0;                          ///< of the baseline, J
  bool any_awake_ = false;                    ///< something was near a panel
  std::vector<std::uint32_t> panel_of_part_;  ///< kNoPart: it does not break
  WallRun walls_;
};

}  // namespace sunder
