// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "sim/collapse.hpp"
#include "sim/frame_motion.hpp"
#include "sim/rigid_world.hpp"

namespace sunder {

/// A building in the world of rigid bodies: what stands is a collider for every part, at its
/// undeformed place; what has come loose is a body for every piece. Keeps references.
class BuildingBodies {
 public:
  /// What hangs together and moves.
  struct Piece {
    BodyId body = kNoBody;  ///< kNoBody: it is no more
    std::vector<std::uint32_t> parts;
    double radius = 0;  ///< of the parts' centres about the piece's, m
  };
  BuildingBodies(const CollapseScene& scene, RigidWorld& world,
                 const std::vector<PartSolid>& solids);

  /// Told of every body that is made, before what it overlaps then is noted.
  void when_released(std::function<void(BodyId)> tell) { tell_ = std::move(tell); }
  bool stands(std::uint32_t part) const { return piece_of_[part] == kStanding; }
  bool is_loose(std::uint32_t part) const { return piece_of_[part] < pieces_.size(); }
  std::uint32_t piece_of(std::uint32_t part) const { return piece_of_[part]; }  ///< of a loose one
  std::span<const Piece> pieces() const { return pieces_; }  ///< those that are no more too
  std::uint64_t piece_count() const { return piece_count_; }
  BodyId body(std::uint32_t part) const;  ///< the collider or the piece's; kNoBody: gone
  Pose pose(std::uint32_t part) const;    ///< of the part's own frame
  /// kNoPart: the body is none of the building's.
  std::uint32_t part_of(BodyId body, std::uint32_t prism) const;
  std::vector<std::uint32_t> not_standing() const;  ///< parts, ascending

  double mass_of(std::uint32_t part) const;                             ///< with what was added, kg
  double own_mass_of(std::uint32_t part) const { return mass_[part]; }  ///< without that
  /// Mass, centroid and inertia of parts where they stood.
  BodyParams body_of(const std::vector<std::uint32_t>& parts) const;
  /// Parts that stood move from now on.
  void release(std::vector<std::uint32_t> parts, const BodyParams& body);
  /// A piece falls into these groups of its parts, which go on with the motion it had.
  void split(std::uint32_t piece, std::vector<std::vector<std::uint32_t>> groups);
  /// Parts from `first` on have numbers higher by `count` now.
  void make_room(std::uint32_t first, std::uint32_t count);
  /// A member is two parts now, that stand, or move as one still. Returns the piece that it was in,
  /// which is another one now; kNoPart: it stood.
  std::uint32_t divide(std::uint32_t member, std::uint32_t part);
  void remove(std::uint32_t part);  ///< a piece of its own
  /// A piece of its own goes to someone else, with its share of the baseline.
  FrameMotion::Leaving hand_over(std::uint32_t part);
  /// A part that stands has no collider any more; returns what it was.
  BodyId give_up_shape(std::uint32_t part);
  void take_shape(std::uint32_t part, BodyId body);  ///< a fixed body stands for the part
  /// The collider of a part that stands follows it, if it has one and this is a millimetre away
  /// from where that is. `displacement` is of the design frame.
  void move_collider(std::uint32_t part, const Pose& displacement);
  void set_mass(std::uint32_t part, double mass) { mass_[part] = mass; }  ///< of one that stands
  void add_live(double more);  ///< pieces grow heavier, N/m² on slabs

  double live() const { return live_; }          ///< added, N/m²
  double baseline() const { return baseline_; }  ///< potential of the pieces where they started, J

 private:
  static constexpr std::uint32_t kStanding = 0xFFFFFFFEu, kGone = 0xFFFFFFFFu;
  void add_collider(std::uint32_t part);
  void add_piece(std::vector<std::uint32_t> parts, BodyParams body);
  void drop(std::uint32_t piece);

  const CollapseScene& scene_;
  const Frame& frame_;
  RigidWorld& world_;
  const std::vector<PartSolid>& solids_;
  std::function<void(BodyId)> tell_;
  std::vector<std::uint32_t> piece_of_;                    ///< by part
  std::vector<BodyId> collider_of_;                        ///< by part
  std::vector<Pose> shifted_;                              ///< by part: where its collider is
  std::vector<double> mass_;                               ///< by part, kg
  std::vector<std::vector<std::uint32_t>> parts_of_body_;  ///< by BodyId: prism → part
  std::vector<Piece> pieces_;
  std::uint64_t piece_count_ = 0, serial_ = 0;
  std::uint64_t next_order_ = 0;  ///< of colliders
  double live_ = 0, baseline_ = 0;
};

}  // namespace sunder
