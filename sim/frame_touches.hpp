// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/frame_solver.hpp"
#include "sim/rigid_world.hpp"

namespace sunder {

/// Force of what touches a part, and where; the part's own undeformed place.
struct FrameTouch {
  Vec3 impulse;         ///< since the last step ended
  double size = 0;      ///< sum of the impulses' sizes
  Vec3 weighted;        ///< their places, by size
  Vec3 force, point;    ///< mean over the load time
  double approach = 0;  ///< of what struck it, fastest since it is active, m/s
  Vec3 before;          ///< the force at the end of the step before
  Vec3 owed;            ///< impulse that was taken and is not yet passed on, before the last step
  double borne = 1;     ///< share of the blow that the frame could take
  Vec3 held_back;       ///< force that has not reached what is left of a piece, see hold_back()
  BodyId striker = kNoBody;  ///< a projectile
  bool is_active = false;
};

/// What touches a building's parts. Forces follow the impulses by a first-order lag. Costs depend
/// on the parts that are touched alone.
class FrameTouches {
 public:
  explicit FrameTouches(std::uint32_t parts) : of_(parts), listed_(parts, 0) {}

  void add(std::uint32_t part, Vec3 point, Vec3 impulse, double approach);
  void struck_by(std::uint32_t part, BodyId projectile) { of_[part].striker = projectile; }
  /// A step ends: forces. Parts whose force changed by more than `max_error` of itself, ascending.
  std::vector<std::uint32_t> end_step(double dt, double load_time, double max_error);
  const FrameTouch& operator[](std::uint32_t part) const { return of_[part]; }
  /// Parts that forces are on, ascending.
  std::span<const std::uint32_t> active() const { return active_; }
  FrameLoads::OnPart load_on(std::uint32_t part) const {
    return {part, of_[part].point, of_[part].force};
  }

  /// Impulse that is not yet passed on were this the share of the force now, N s.
  Vec3 owed(std::uint32_t part, double share) const {
    return of_[part].owed - (last_dt_ / 2) * (of_[part].before + share * of_[part].force);
  }
  /// Of what struck the part in the last step it took but this share.
  void limit(std::uint32_t part, double share);
  /// Something parted in the piece that the part is in, and bore this share of the force: the rest
  /// comes on what is left of it by a lag of a quarter of the load time.
  void hold_back(std::uint32_t part, double share);
  /// Nothing touches it any more. Returns the impulse that was not passed on.
  Vec3 end(std::uint32_t part);
  void forget(std::uint32_t part);
  /// Parts from `first` on have numbers higher by `count` now.
  void make_room(std::uint32_t first, std::uint32_t count);
  /// The new part takes this share of what touches the other one.
  void divide(std::uint32_t part, std::uint32_t new_part, double share);

 private:
  void list_active();

  std::vector<FrameTouch> of_;                ///< by part
  std::vector<std::uint8_t> listed_;          ///< by part
  std::vector<std::uint32_t> list_, active_;  ///< parts with a force or an impulse; with a force
  double last_dt_ = 0;
};

}  // namespace sunder
