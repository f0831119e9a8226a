// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/collapse.hpp"
#include "sim/frame_motion.hpp"
#include "sim/rigid_world.hpp"

namespace sunder {

/// Posts along x and z, storeys; HEB300 and IPE300, 6 m bays, slabs, no walls.
struct Size {
  std::size_t x = 3, z = 3, storeys = 12;
};
std::string name_of(const Size& size);  ///< "3 × 3 × 12"
Frame building_of(const Size& size);

double cost_ms(const std::function<void()>& work);  ///< processor time of all threads, ms
void wait_for_threads();                            ///< returns when no other thread is at work

/// `count` beams' beginnings, nearest to a point of the facade first, or drawn all over.
std::vector<std::uint32_t> beam_joints(const Frame& frame, std::size_t count, bool scattered);

/// A building that "hybrid" carries, without a run around it.
class Standing {
 public:
  /// `ahead`: as if a projectile were on its way, what rings is factored in the background.
  Standing(const Frame& frame, double step, bool damped = true, bool ahead = false);
  Standing(const Standing&) = delete;
  Standing& operator=(const Standing&) = delete;

  void step();   ///< world, pieces, ringing frame
  void judge();  ///< reads the loads that changed, against the joints' strengths
  void break_joints(const std::vector<std::uint32_t>& joints);  ///< and what they held goes too
  void remove(std::uint32_t member);                            ///< suddenly, the others still meet
  FrameMotion& motion() { return *motion_; }
  const Frame& frame() const { return scene_.frame; }
  double largest() const { return largest_; }  ///< utilisation that was ever read

 private:
  CollapseScene scene_;
  std::vector<PartSolid> solids_;
  RigidWorld world_;
  std::vector<std::uint8_t> intact_;
  double now_ = 0, largest_ = 0;
  std::unique_ptr<FrameMotion> motion_;
};

void measure_statics();
void measure_steps();
void measure_updates();
void measure_splits();
void measure_precision();
void measure_dynamics();
void measure_work();

}  // namespace sunder
