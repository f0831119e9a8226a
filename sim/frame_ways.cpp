// SPDX-License-Identifier: GPL-3.0-or-later
// How far the masses of parts move with the nodes: as the weight on them says, so that mass times
// way times gravity is the weight's work.
#include <algorithm>
#include <cmath>

#include "sim/frame_solver_impl.hpp"

namespace sunder {
namespace {

const double kGauss = std::sqrt(0.6);  // outer points of Gauss's rule of three, weight 5/9
constexpr std::array<Vec3, 3> kAxes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

double minus_product(const Twelve& held_nodes, const Twelve& motion) {
  double sum = 0;
  for (std::size_t i = 0; i < 12; ++i) sum -= held_nodes[i] * motion[i];
  return sum;
}

Vec3 minus_product(std::span<const Twelve, 3> held_nodes, const Twelve& motion) {
  return {minus_product(held_nodes[0], motion), minus_product(held_nodes[1], motion),
          minus_product(held_nodes[2], motion)};
}

/// Sums about the origin first; a line of mass reaches `half` to both sides.
void add_mass(FrameSolver::MassWay& way, double mass, Vec3 at, Vec3 half, Vec3 moved, Vec3 turned) {
  add_moment(way.inertia, mass, at);
  add_moment(way.inertia, mass / 3, half);
  way.mass += mass;
  way.moved = way.moved + moved;
  way.centre = way.centre + mass * at;
  way.turned = way.turned + turned + cross(at, moved);
}

void move_to_centre(FrameSolver::MassWay& way) {
  if (!(way.mass > 0)) return;
  way.centre = (1 / way.mass) * way.centre;
  way.turned = way.turned - cross(way.centre, way.moved);
  add_moment(way.inertia, -way.mass, way.centre);
}

}  // namespace

/// What holds a member's nodes under each of these loads alone.
void FrameSolver::Impl::held_under_each(std::uint32_t m, std::span<const BeamLoad> loads,
                                        std::span<Twelve> held_nodes) const {
  if (members[m].role == Role::elastic) return fixed_ends_of(unbent(m), loads, held_nodes);
  for (std::size_t i = 0; i < loads.size(); ++i) held_nodes[i] = held_under(m, loads[i]);
}

/// Without what plastic hinges turn, if the motion `bends`.
Twelve FrameSolver::Impl::elastic_motion(std::uint32_t m, std::span<const double> motion,
                                         bool bends) const {
  Twelve result = displacements_of(members[m], motion);
  if (bends && members[m].role == Role::elastic && bent_of[m] != kNone) {
    const Twelve plastic = plastic_motion(bent[bent_of[m]], bent[bent_of[m]].rotation);
    for (std::size_t i = 0; i < 12; ++i) result[i] -= plastic[i];
  }
  return result;
}

/// Of a metre's mass on a member, summed up over it; moments about its middle.
FrameSolver::Impl::LineWay FrameSolver::Impl::line_way(std::uint32_t m,
                                                       const Twelve& motion) const {
  const double length = members[m].response.length, out = kGauss * length / 2;
  std::array<BeamLoad, 6> loads;
  for (std::size_t i = 0; i < 3; ++i) {
    loads[i].uniform = kAxes[i];
    // Gauss's rule of three: the outer points see what is linear.
    const Vec3 force = 5.0 / 18 * length * cross(kAxes[i], out * members[m].response.axes.x);
    loads[3 + i].points = {{length / 2 - out, -1 * force, {}}, {length / 2 + out, force, {}}};
  }
  std::array<Twelve, 6> held_nodes;
  held_under_each(m, loads, held_nodes);
  const std::span<const Twelve, 6> all(held_nodes);
  return {minus_product(all.first<3>(), motion), minus_product(all.last<3>(), motion)};
}

/// Of a mass of 1 kg at a point of a member.
Vec3 FrameSolver::Impl::point_way(std::uint32_t m, Vec3 point, const Twelve& motion) const {
  std::array<BeamLoad, 3> loads;
  for (std::size_t i = 0; i < 3; ++i) loads[i].points = {point_on(m, point, kAxes[i], {})};
  std::array<Twelve, 3> held_nodes;
  held_under_each(m, loads, held_nodes);
  return minus_product(held_nodes, motion);
}

/// The part itself, or what carries of a slab or wall; each once, ascending.
std::vector<std::uint32_t> FrameSolver::Impl::members_under(
    std::span<const std::uint32_t> parts) const {
  std::vector<std::uint32_t> result;
  for (const std::uint32_t part : parts) {
    if (part < members.size()) {
      result.push_back(part);
      continue;
    }
    const PlateSupport& plate = plates[part - frame.slab_part(0)];
    for (std::uint32_t i = 0; i < plate.joint_count; ++i)
      if (plate.share[i] != 0) result.push_back(frame.joints[plate.joints[i]].b);
  }
  std::ranges::sort(result);
  result.erase(std::ranges::unique(result).begin(), result.end());
  std::erase_if(result, [&](std::uint32_t m) { return !members[m].present(); });
  return result;
}

/// What a slab or wall puts on its carriers: visit(member, mass spread over it, mass at the joint's
/// point, that point), kg.
template <class Visit>
void FrameSolver::Impl::each_share(const PlateSupport& plate, const std::vector<double>& live,
                                   const Visit& visit) const {
  const std::size_t p = plate.part - frame.slab_part(0);
  const double added = p < live.size() ? live[p] * plate.area / kLoadGravity : 0;
  const bool on_lines = plate.rest == PlateSupport::Rest::lines;
  for (std::uint32_t i = 0; i < plate.joint_count; ++i) {
    const FrameJoint& joint = frame.joints[plate.joints[i]];
    if (plate.share[i] == 0 || !members[joint.b].present()) continue;
    visit(joint.b, plate.share[i] * (added + (on_lines ? plate.mass : 0)),
          on_lines ? 0 : plate.share[i] * plate.mass, joint.point);
  }
}

/// Only what loads these parts' places is looked at. O(their joints, times a logarithm).
std::vector<FrameSolver::MassWay> FrameSolver::Impl::mass_ways(
    std::span<const double> motion, const std::vector<double>& live, bool bends,
    std::span<const std::uint32_t> parts) const {
  const std::vector<std::uint32_t> under = members_under(parts);
  std::vector<std::pair<Twelve, LineWay>> lines;
  for (const std::uint32_t m : under) {
    const Twelve own = elastic_motion(m, motion, bends);
    lines.emplace_back(own, line_way(m, own));
  }
  const auto line_of = [&](std::uint32_t m) -> const auto& {
    return lines[static_cast<std::size_t>(std::ranges::lower_bound(under, m) - under.begin())];
  };
  const auto add_line = [&](MassWay& way, std::uint32_t m, double mass, double by_metre) {
    const double half = members[m].response.length / 2;
    const LineWay& line = line_of(m).second;
    add_mass(way, mass, members[m].at(half), half * members[m].response.axes.x,
             by_metre * line.moved, by_metre * line.turned);
  };
  std::vector<MassWay> ways(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::uint32_t part = parts[k];
    if (part >= members.size()) {
      const auto add_share = [&](std::uint32_t m, double on_line, double at_point, Vec3 point) {
        add_line(ways[k], m, on_line, on_line / members[m].response.length);
        if (at_point != 0)
          add_mass(ways[k], at_point, point, {}, at_point * point_way(m, point, line_of(m).first),
                   {});
      };
      each_share(plates[part - frame.slab_part(0)], live, add_share);
    } else if (members[part].present()) {
      add_line(ways[k], part, members[part].mass * members[part].response.length,
               members[part].mass);
    }
    move_to_centre(ways[k]);
  }
  return ways;
}

/// Upwards, of a metre's mass on a member, in numbers that last until it is renewed.
double FrameSolver::Impl::line_height(std::uint32_t m, const Twelve& motion) {
  if (!height_known[m]) {
    height_known[m] = 1;
    const BeamLoad load{.uniform = {0, 1, 0}, .points = {}};
    held_under_each(m, {&load, 1}, {&height_rows[m], 1});
  }
  return minus_product(height_rows[m], motion);
}

/// Σ moved.y of all parts by the displacements, with the same bits: by the parts, in their order.
double FrameSolver::Impl::height(const std::vector<double>& live) {
  std::vector<double> lines(members.size());
  double sum = 0;
  for (std::uint32_t m = 0; m < members.size(); ++m) {
    if (!members[m].present()) continue;
    lines[m] = line_height(m, elastic_motion(m, u, true));
    sum += members[m].mass * lines[m];
  }
  for (const PlateSupport& plate : plates) {
    double of_plate = 0;
    each_share(plate, live, [&](std::uint32_t m, double on_line, double at_point, Vec3 point) {
      of_plate += on_line / members[m].response.length * lines[m];
      if (at_point == 0) return;
      const BeamLoad load{.uniform = {}, .points = {point_on(m, point, {0, 1, 0}, {})}};
      Twelve held_nodes;
      held_under_each(m, {&load, 1}, {&held_nodes, 1});
      of_plate += at_point * minus_product(held_nodes, elastic_motion(m, u, true));
    });
    sum += of_plate;
  }
  return sum;
}

/// What joints that break, and parts that go with all theirs, may bear otherwise.
std::vector<std::uint32_t> FrameSolver::Impl::parts_at(std::span<const std::uint32_t> joints,
                                                       std::span<const std::uint32_t> going) const {
  std::vector<std::uint32_t> parts(going.begin(), going.end());
  const auto add_member = [&](std::uint32_t m) {
    parts.push_back(m);
    for (const std::uint32_t p : plates_on[m]) parts.push_back(plates[p].part);
  };
  for (const std::uint32_t j : joints) {
    const FrameJoint& joint = frame.joints[j];
    if (joint.node == kNoPart) {
      parts.push_back(joint.a);
      continue;
    }
    for (const std::uint32_t end : links.ends_at(joint.node)) add_member(end / 2);
  }
  std::ranges::sort(parts);
  parts.erase(std::ranges::unique(parts).begin(), parts.end());
  return parts;
}

std::vector<FrameSolver::MassWay> FrameSolver::ways_of_displacements(
    const std::vector<double>& live, std::span<const std::uint32_t> parts) const {
  return impl_->mass_ways(impl_->u, live, true, parts);
}

std::vector<FrameSolver::MassWay> FrameSolver::ways_of(std::span<const double> velocities,
                                                       std::span<const std::uint32_t> parts) const {
  return impl_->mass_ways(velocities, {}, false, parts);
}

double FrameSolver::height_of_masses(const std::vector<double>& live) const {
  return impl_->height(live);
}

std::vector<std::uint32_t> FrameSolver::parts_at(std::span<const std::uint32_t> joints,
                                                 std::span<const std::uint32_t> parts) const {
  return impl_->parts_at(joints, parts);
}

}  // namespace sunder
