// SPDX-License-Identifier: GPL-3.0-or-later
// How far small displacements go: members that turn too far between their nodes, and those that
// nothing but the springs of a mechanism keeps from turning.
#include <algorithm>
#include <cmath>

#include "sim/frame_solver_impl.hpp"

namespace sunder {
namespace {

/// How an elastic member turns (with its stretch, by its length) and twists between its nodes, rad.
struct Turn {
  Vec3 chord;
  double twist = 0;
  double most() const { return std::max(length(chord), std::abs(twist)); }
};

Turn turn_of(const Axes& axes, double size, const Twelve& motion) {
  const Vec3 way{motion[6] - motion[0], motion[7] - motion[1], motion[8] - motion[2]};
  const Vec3 turned{motion[9] - motion[3], motion[10] - motion[4], motion[11] - motion[5]};
  return {(1 / size) * way, dot(turned, axes.x)};
}

/// The largest share s of the way from a to b with |a + s (b − a)| ≤ limit.
double share_of_way(const Turn& a, const Turn& b, double limit) {
  if (b.most() <= limit) return 1;
  if (a.most() >= limit) return 0;
  const auto root = [&](double aa, double ab, double bb) {  // aa + 2 s ab + s² bb = limit²
    if (aa + 2 * ab + bb <= limit * limit) return 1.0;
    return (std::sqrt(ab * ab + bb * (limit * limit - aa)) - ab) / bb;
  };
  const Vec3 way = b.chord - a.chord;
  const double more = b.twist - a.twist;
  return std::min(root(dot(a.chord, a.chord), dot(a.chord, way), dot(way, way)),
                  root(a.twist * a.twist, a.twist * more, more * more));
}

}  // namespace

double FrameSolver::Impl::turn_at(std::uint32_t m, std::span<const double> motion) const {
  const Member& member = members[m];
  if (member.role != Role::elastic) return 0;
  return turn_of(member.response.axes, member.response.length, displacements_of(member, motion))
      .most();
}

std::vector<std::uint32_t> FrameSolver::turned_members(double limit) const {
  std::vector<std::uint32_t> found;
  for (std::uint32_t m = 0; m < impl_->members.size(); ++m)
    if (impl_->turn_at(m, impl_->u) > limit) found.push_back(m);
  return found;
}

double FrameSolver::share_within(std::span<const double> from, double limit) const {
  double share = 1;
  for (const Impl::Member& member : impl_->members) {
    if (member.role != Impl::Role::elastic) continue;
    const Axes& axes = member.response.axes;
    const double size = member.response.length;
    share = std::min(
        share, share_of_way(turn_of(axes, size, impl_->displacements_of(member, from)),
                            turn_of(axes, size, impl_->displacements_of(member, impl_->u)), limit));
  }
  return share;
}

/// The springs' forces as loads move what they hold as u does, and next to nothing else.
std::vector<std::uint32_t> FrameSolver::unresisted_members() const {
  constexpr double kDriven = 1e-6;  // of the largest load
  constexpr double kTurns = 0.05;   // of the member that turns most: others give way elastically
  std::vector<std::uint32_t> found;
  if (impl_->held.empty()) return found;
  std::vector<double> force(impl_->u.size(), 0), motion(impl_->u.size());
  for (const Impl::Restraint& held : impl_->held) impl_->add_spring(held, force);
  double most = 0, load = 0;
  for (const double f : force) most = std::max(most, std::abs(f));
  for (const double f : impl_->f) load = std::max(load, std::abs(f));
  if (most <= kDriven * load) return found;
  impl_->factor->solve(force, motion);
  double farthest = 0;
  for (std::uint32_t m = 0; m < impl_->members.size(); ++m)
    farthest = std::max(farthest, impl_->turn_at(m, motion));
  for (std::uint32_t m = 0; m < impl_->members.size(); ++m)
    if (impl_->turn_at(m, motion) > kTurns * farthest) found.push_back(m);
  return found;
}

}  // namespace sunder
