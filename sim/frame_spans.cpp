// SPDX-License-Identifier: GPL-3.0-or-later
// Members between their ends: what they carry, and how a place on them moves.
#include <algorithm>
#include <cmath>

#include "sim/frame_solver_impl.hpp"

namespace sunder {
namespace {

Vec3 three(const Twelve& v, std::size_t first) {
  return {v[first], v[first + 1], v[first + 2]};
}

/// Of a 6 × 6 system; Gauss's elimination with the largest pivot of each column. What nothing
/// resists, the twist of a member between hinges, does not move.
Six solution_of(std::array<Six, 6> matrix, Six right) {
  constexpr double kNoResistance = 1e-12;  // of the largest entry
  double largest = 0;
  for (const Six& row : matrix)
    for (const double entry : row) largest = std::max(largest, std::fabs(entry));
  const auto vanishes = [&](double pivot) { return std::fabs(pivot) <= kNoResistance * largest; };
  for (std::size_t c = 0; c < 6; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < 6; ++r)
      if (std::fabs(matrix[r][c]) > std::fabs(matrix[pivot][c])) pivot = r;
    std::swap(matrix[c], matrix[pivot]);
    std::swap(right[c], right[pivot]);
    if (vanishes(matrix[c][c])) continue;
    for (std::size_t r = c + 1; r < 6; ++r) {
      const double factor = matrix[r][c] / matrix[c][c];
      for (std::size_t k = c; k < 6; ++k) matrix[r][k] -= factor * matrix[c][k];
      right[r] -= factor * right[c];
    }
  }
  for (std::size_t c = 6; c-- > 0;) {
    for (std::size_t k = c + 1; k < 6; ++k) right[c] -= matrix[c][k] * right[k];
    right[c] = vanishes(matrix[c][c]) ? 0 : right[c] / matrix[c][c];
  }
  return right;
}

}  // namespace

/// Contacts of the last loads on members, by member.
void FrameSolver::Impl::list_points() {
  if (points_known) return;
  points_known = true;
  points.clear();
  for (const FrameLoads::OnPart& contact : laid.loads.contacts) {
    if (contact.part < frame.slab_part(0)) {
      points.push_back(
          {contact.part, point_on(contact.part, contact.point, contact.force, {}), false});
      continue;
    }
    for (const auto& [j, load] : shares_of(contact.part - frame.slab_part(0), contact)) {
      const std::uint32_t m = frame.joints[j].b;
      points.push_back({m, point_on(m, frame.joints[j].point, load.force, load.torque), true});
    }
  }
  std::ranges::stable_sort(points, {}, &PointLoad::member);
}

/// What the model puts on a member at single places, ascending.
std::vector<FrameSolver::Impl::PointLoad> FrameSolver::Impl::points_of(std::uint32_t m,
                                                                       bool with_contacts) {
  list_points();
  const auto range = std::ranges::equal_range(points, m, {}, &PointLoad::member);
  std::vector<PointLoad> result;
  if (with_contacts) result.assign(range.begin(), range.end());
  for (const PointMass& mass : point_masses[m]) {
    const Vec3 at = frame.joints[mass.joint].point;
    result.push_back({m, point_on(m, at, mass.mass * pull_at(m, at), {}), true});
  }
  std::ranges::stable_sort(result, {}, [](const PointLoad& load) { return load.point.at; });
  return result;
}

/// Acceleration that loads a member's masses there.
Vec3 FrameSolver::Impl::pull_at(std::uint32_t m, Vec3 point) const {
  if (pieces.empty()) return laid.loads.gravity;
  const std::uint32_t piece = piece_of(members[m]);
  return (piece == kNone ? fields.back() : fields[piece]).at(point);
}

/// What slabs and walls pass on by their joints lies along their edges: here it is spread over the
/// member, with the same resultant.
bool FrameSolver::Impl::find_span(std::uint32_t m, MemberSpan& span) {
  const Member& member = members[m];
  if (member.role != Role::elastic || member.tip) return false;
  const Axes& axes = member.response.axes;
  const Vec3 force = three(forces[m], 0), moment = three(forces[m], 3);
  span.length = member.response.length;
  span.start = {-1 * into(axes, force), -1 * into(axes, moment)};
  span.load_a = line_mass(m) * into(axes, pull_at(m, member.at(0)));
  span.load_b = line_mass(m) * into(axes, pull_at(m, member.at(span.length)));
  span.turn = {};
  span.points.clear();
  if (laid.loads.contacts.empty() && point_masses[m].empty()) return true;
  for (const PointLoad& load : points_of(m, true)) {
    const Vec3 push = into(axes, load.point.force), turn = into(axes, load.point.moment);
    if (load.by_plate) {
      span.load_a = span.load_a + 1 / span.length * push;
      span.load_b = span.load_b + 1 / span.length * push;
      span.turn = span.turn + 1 / span.length * turn;
    } else {
      span.points.push_back({load.point.at, push, turn});
    }
  }
  return true;
}

/// The node that the two parts of the element would share, in balance.
Six FrameSolver::Impl::motion_within(std::uint32_t m, double along, std::span<const double> motion,
                                     OnMember loads) {
  const Member& member = members[m];
  Twelve ends = displacements_of(member, motion);
  if (loads != OnMember::nothing && bent_of[m] != kNone) {
    const Bent& b = bent[bent_of[m]];
    const Twelve turned = plastic_motion(b, b.rotation);
    for (std::size_t i = 0; i < 12; ++i) ends[i] -= turned[i];
  }
  std::array<BeamElement, 2> half{unbent(m), unbent(m)};
  const Vec3 rigid{BeamElement::kRigid, BeamElement::kRigid, BeamElement::kRigid};
  half[0].spring_b = half[1].spring_a = rigid;
  half[0].length = along;
  half[1].length = member.response.length - along;
  std::array<BeamLoad, 2> load;
  if (loads != OnMember::nothing) {
    load[0].uniform = load[1].uniform = line_mass(m) * pull_at(m, member.at(along));
    for (const PointLoad& each : points_of(m, loads == OnMember::all)) {
      const std::size_t i = each.point.at <= along ? 0 : 1;
      load[i].points.push_back(each.point);
      if (i == 1) load[i].points.back().at -= along;
    }
  }
  std::array<Six, 6> matrix{};
  Six right{};
  for (std::size_t i = 0; i < 2; ++i) {
    const Matrix12 stiffness = stiffness_of(half[i]);
    const Twelve by_nodes = fixed_end_of(half[i], load[i]);
    const std::size_t own = i == 0 ? 6 : 0, other = 6 - own;
    for (std::size_t r = 0; r < 6; ++r) {
      right[r] -= by_nodes[own + r];
      for (std::size_t c = 0; c < 6; ++c) {
        matrix[r][c] += stiffness.at[12 * (own + r) + own + c];
        right[r] -= stiffness.at[12 * (own + r) + other + c] * ends[other + c];
      }
    }
  }
  return solution_of(matrix, right);
}

bool FrameSolver::find_span(std::uint32_t member, MemberSpan& span) const {
  return impl_->find_span(member, span);
}

Six FrameSolver::motion_within(std::uint32_t member, double along, std::span<const double> motion,
                               OnMember loads) const {
  return impl_->motion_within(member, along, motion, loads);
}

}  // namespace sunder
