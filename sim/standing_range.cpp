// SPDX-License-Identifier: GPL-3.0-or-later
// Where small displacements end. In time what turns too far is seen as it goes; in balance at any
// time the frame goes no farther than it can be said to, and what has no balance stays as it was:
// it is for others to let go of it.
#include <algorithm>
#include <cmath>

#include "sim/standing_frame.hpp"

namespace sunder {
namespace {

constexpr double kRange = 0.5;        // rad that a member turns between its nodes, at most
constexpr double kBeyond = 1 + 1e-9;  // of a limit that is reached

}  // namespace

std::vector<std::uint32_t> StandingFrame::overturned() const {
  if (!unresisted_.empty()) return unresisted_;
  return in_use().turned_members(kRange);
}

/// Share of the way at whose end the first hinge has turned by its capacity.
double StandingFrame::share_for_hinges(const std::vector<double>& from) {
  const auto capacity = [&](const Hinge& hinge) {
    return kBeyond * frame_.classes[frame_.joints[hinge.joint].joint_class].rotation_capacity;
  };
  const std::vector<Hinge> to = static_.frame->hinges();
  for (const Hinge& hinge : to)
    if (hinge.flows && length(hinge.rotation) > capacity(hinge)) beyond_.push_back(hinge.joint);
  if (beyond_.empty()) return 1;
  static_.frame->set_displacements(from, loads());
  const std::vector<Hinge> before = static_.frame->hinges();
  double share = 1;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const double most = capacity(to[i]);
    const Vec3 start = before[i].rotation, way = to[i].rotation - start;
    if (!to[i].flows || length(to[i].rotation) <= most) continue;
    const double room = most * most - dot(start, start), along = dot(start, way),
                 square = dot(way, way);
    if (room <= 0) return 0;
    share = std::min(share, (std::sqrt(along * along + square * room) - along) / square);
  }
  return share;
}

void StandingFrame::keep_in_range(const std::vector<double>& from) {
  FrameSolver& solver = *static_.frame;
  beyond_.clear();
  unresisted_ = solver.unresisted_members();
  const std::vector<double> to(solver.displacements().begin(), solver.displacements().end());
  double share = unresisted_.empty() ? solver.share_within(from, kBeyond * kRange) : 0;
  if (unresisted_.empty()) share = std::min(share, share_for_hinges(from));
  is_short_ = share < 1;
  std::vector<double> u(to);
  for (std::size_t i = 0; is_short_ && i < u.size(); ++i)
    u[i] = from[i] + share * (to[i] - from[i]);
  solver.set_displacements(u, loads());
}

}  // namespace sunder
