// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/building_bodies.hpp"
#include "sim/frame_touches.hpp"
#include "sim/part_links.hpp"
#include "sim/sub_frame.hpp"

namespace sunder {

/// What the joints inside the pieces that have come loose carry. Each piece is an elastic frame of
/// its own, made when it is loaded first, balanced by its inertia; solved when what touches it, or
/// what its spin pulls, has changed by more than the error asked for. Keeps references.
class InnerForces {
 public:
  InnerForces(const CollapseScene& scene, RigidWorld& world, const std::vector<PartSolid>& solids,
              const BuildingBodies& bodies, const PartLinks& links);

  void forget_changes();  ///< before a step: all loads are as they were read
  /// Of pieces with these parts, whose contacts changed, or that spin in another way.
  void follow(std::span<const std::uint32_t> touched, const FrameTouches& touches);
  /// Pieces from this number on are new; `old` and `broken`, the joints that broke, tell of what.
  void start(std::size_t first_new, std::span<const std::uint32_t> old,
             std::span<const std::uint32_t> broken, const FrameTouches& touches);
  JointLoad load(std::uint32_t joint) const;  ///< of an intact one inside a piece
  bool find_span(std::uint32_t member, MemberSpan& span) const;  ///< of a loose one
  /// Parts from `first` on have numbers higher by `count` now.
  void make_room(std::uint32_t first, std::uint32_t count);
  /// A piece, if it is known yet, has other parts now.
  void forget(std::uint32_t piece) {
    if (piece < state_.size()) drop_model(state_[piece]);
  }
  bool is_live(std::uint32_t piece) const { return state_[piece].is_live; }
  bool any_live() const { return !live_.empty(); }
  /// Parts of the pieces made last that their joints cannot hold.
  const std::vector<std::uint32_t>& unheld() const { return unheld_; }

  std::uint64_t skipped() const { return skipped_; }  ///< pieces and steps
  SolveCounts solves() const;
  double residual() const { return residual_; }  ///< largest so far, relative

 private:
  /// A piece as a frame of its own.
  struct Model {
    SubFrame sub;
    std::unique_ptr<FrameSolver> solver;
    std::size_t part_count = 0;  ///< of those, still in it
  };
  struct State {
    std::unique_ptr<Model> model;  ///< none: not loaded yet, or one part
    bool is_loaded = false;        ///< else its joints carry nothing
    bool is_live = false;          ///< solved since the step began
    Vec3 spin;                     ///< at the last solve, rad/s, axes of the piece
  };
  bool spins_anew(std::uint32_t piece) const;
  Vec3 spin_of(std::uint32_t piece) const;
  void make_model(std::uint32_t piece);
  void inherit(std::uint32_t heir, std::uint32_t old, std::span<const std::uint32_t> broken);
  void drop_model(State& state);
  void solve(std::uint32_t piece, const FrameTouches& touches);
  void mark_live(std::uint32_t piece);

  const CollapseScene& scene_;
  const RigidWorld& world_;
  const std::vector<PartSolid>& solids_;
  const BuildingBodies& bodies_;
  const PartLinks& links_;
  std::vector<State> state_;            ///< by piece
  std::vector<std::uint32_t> jointed_;  ///< pieces of several parts, ascending
  std::vector<std::uint32_t> live_, unheld_;
  std::uint64_t skipped_ = 0;
  SolveCounts past_;  ///< of models that are no more
  double residual_ = 0;
};

}  // namespace sunder
