// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "sim/frame.hpp"

namespace sunder {

/// Which member ends move together as joints break. The ends at a frame node fall into clusters
/// that intact joints hold together. Each end that carries others owns a solver node; a cluster
/// moves as the lowest solver node of its ends. So a star of joints around one carrier has one
/// solver node, and a chain of given joints has spare ones for when it parts.
class FrameLinks {
 public:
  static constexpr std::uint32_t kFixed = 0xFFFFFFFEu;  ///< on the ground
  static constexpr std::uint32_t kFree = 0xFFFFFFFFu;   ///< hangs in the air

  struct End {
    std::uint32_t node = kFree;  ///< solver node, kFixed or kFree
    bool held = false;           ///< some intact joint is there
    bool hinged = false;         ///< its own joint passes no torque
  };

  /// Throws Error{input} if joints of members close a ring at a node: their loads have no one
  /// answer.
  explicit FrameLinks(const Frame& frame);

  std::uint32_t node_count() const { return static_cast<std::uint32_t>(frame_node_.size()); }
  std::uint32_t frame_node(std::uint32_t node) const { return frame_node_[node]; }
  /// That of the ends there that intact joints hold, the first; without any that one.
  std::uint32_t moving_node(std::uint32_t frame_node) const;
  const End& end(std::uint32_t member, int end) const { return ends_[2 * member + end]; }
  bool intact(std::uint32_t joint) const { return intact_[joint] != 0; }
  using Edges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  Edges edges() const;  ///< pairs of solver nodes that a member may ever join
  /// Those of two frame nodes, besides.
  void add_edges(std::uint32_t frame_node_a, std::uint32_t frame_node_b, Edges& edges) const;

  /// Takes a joint away; of a joint of members the ends at its node are linked anew.
  void cut(std::uint32_t joint);
  /// Member ends at a frame node: 2 member + end.
  std::span<const std::uint32_t> ends_at(std::uint32_t frame_node) const {
    return {ends_by_node_.data() + first_end_[frame_node],
            ends_by_node_.data() + first_end_[frame_node + 1]};
  }
  /// Ends whose forces pass through an intact joint of members: those on the side of its part a.
  void ends_beyond(std::uint32_t joint, std::vector<std::uint32_t>& ends) const;

 private:
  void number_nodes();
  void link(std::uint32_t frame_node);
  std::span<const std::uint32_t> joints_at(std::uint32_t frame_node) const {
    return {joints_by_node_.data() + first_joint_[frame_node],
            joints_by_node_.data() + first_joint_[frame_node + 1]};
  }

  const Frame& frame_;
  std::vector<std::uint8_t> intact_;
  std::vector<std::uint32_t> first_end_, ends_by_node_, first_joint_, joints_by_node_;
  std::vector<std::uint32_t> own_node_;  ///< per end: the solver node it owns, kFree: none
  std::vector<std::uint32_t> frame_node_, main_node_;
  std::vector<std::uint32_t> first_owned_;  ///< per frame node: its first solver node; one more
  std::vector<End> ends_;
};

}  // namespace sunder
