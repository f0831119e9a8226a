// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sim/buckling.hpp"
#include "sim/frame.hpp"

namespace sunder {

/// How posts fail for want of bracing: their free lengths grow as the beams that hold their nodes
/// sideways go. A node is braced in a direction while the joint of a beam that runs more along than
/// across it is intact there and the beam's far end is fixed to a post or the ground; a column goes
/// on through intact splices. Event driven: only posts of the columns that a broken joint's member
/// touches are looked at again.
class PostStability {
 public:
  /// `rule`: see BreakingRules::post_rule. The frame must outlive this.
  PostStability(const Frame& frame, const std::string& rule);

  void break_joint(std::uint32_t joint);
  /// The frame has other parts, nodes and joints now; new joints are intact. O(joints).
  void list_again();

  /// Between what braces it, times the factors of its ends: 1 for two held ends, 2 for one;
  /// infinity for a piece that nothing holds.
  FreeLength free_length(std::uint32_t post) const;
  /// Compression that the post bears about its weaker axis, N; infinity where the rule checks none.
  /// Euler's load is cut at A f_y. Cached.
  double resistance(std::uint32_t post);
  /// The joint at the post's foot, whose force is the post's; kNoPart: none, or broken.
  std::uint32_t foot(std::uint32_t post) const;
  const std::vector<std::uint32_t>& posts() const { return posts_; }

  /// What lets go when a post buckles: the splice at an unbraced node nearest to the middle of its
  /// free length; all joints of a post without such a node.
  std::vector<std::uint32_t> joints_of_buckling(std::uint32_t post) const;
  /// The paper's rule: the splice at the node of a broken beam joint when it was the last beam
  /// joint there; kNoPart: none. Only with the rule "unbraced".
  std::uint32_t unbraced_splice(std::uint32_t broken_joint) const;

 private:
  struct Reach {
    double length = 0;  ///< of the posts beyond the end, m
    bool held = false;
    std::vector<std::pair<std::uint32_t, double>>
        splices;  ///< on the way, and how far from the end
  };
  bool is_held(std::uint32_t beam, std::uint32_t node) const;
  bool is_braced(std::uint32_t node, Vec3 direction) const;
  std::uint32_t next_splice(std::uint32_t post, bool upwards) const;
  Reach reach(std::uint32_t post, bool upwards, Vec3 direction) const;
  double free_length(std::uint32_t post, Vec3 direction) const;
  double resistance_about(std::uint32_t post, bool y) const;
  void forget_column(std::uint32_t node);

  const Frame& frame_;
  std::string rule_;
  std::vector<std::uint32_t> posts_;
  std::vector<std::uint8_t> intact_;                   ///< by joint
  std::vector<std::vector<std::uint32_t>> joints_at_;  ///< by node: those of members
  std::vector<std::vector<std::uint32_t>> joints_of_;  ///< by member
  std::vector<double> resistance_;                     ///< by member; negative: not known
};

}  // namespace sunder
