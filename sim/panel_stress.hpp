// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/panel_element.hpp"
#include "sim/wall_state.hpp"

namespace sunder {

/// The forces inside a panel that stands as a wall of chunks: its elastic network, hung in the
/// corners of the frame. What touches its chunks loads them by the mean force over the load time.
class PanelStress {
 public:
  PanelStress(const WallAsset& asset, const Material& material, const PanelHold& hold,
              Vec3 gravity);

  void touch(std::uint32_t chunk, Vec3 point, Vec3 impulse);  ///< wall frame, N s
  /// A step ends.
  void end_step(double dt, double load_time, double max_error);
  /// What else broke: bonds of the island are those of the asset, in the same order.
  void follow(const Island& island);
  /// Whether anything has changed by more than the error asked for since the last time.
  bool is_stale(const PanelFreedoms& corners, double max_error) const;
  /// Breaks what is over its strength, most utilised first, until what is left carries.
  std::vector<BrokenBond> settle(const PanelFreedoms& corners);
  double utilisation() const { return utilisation_; }     ///< largest after that
  const PanelFreedoms& settled() const { return last_; }  ///< corners at that time
  /// Nothing of it is broken, and what touches it is what did when it settled last.
  bool is_whole() const { return !is_stale_ && !is_broken_; }
  /// If it has become softer since this was asked for last: its stiffness, axes as `to_world`.
  std::optional<Matrix12> softened(const Quaternion& to_world);

 private:
  struct Touch {
    std::uint32_t chunk = 0;
    Vec3 impulse{}, weighted{};
    double size = 0;
    Vec3 force{}, point{};
    Vec3 settled{};  ///< the force at the last settle()
  };
  void note_broken();

  ChunkNetwork network_;
  PanelFreedoms last_{};
  std::vector<std::uint8_t> intact_;   ///< by bond
  std::vector<std::uint8_t> present_;  ///< by chunk
  std::vector<Touch> touches_;         ///< by chunk, ascending
  double give_ = 0;                    ///< displacement that a bond at its strength has, m
  bool is_stale_ = true;
  bool is_broken_ = false, is_softer_ = false;
  double utilisation_ = 0;
};

}  // namespace sunder
