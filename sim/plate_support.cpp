// SPDX-License-Identifier: GPL-3.0-or-later
// A rigid body on points: f_i = F/n + b × r_i about the points' centroid with J b = M, J = Σ r² 1 −
// r rᵀ, is the least of Σ |f_i|² under the two balances (Lagrange's multipliers are F/n and b).
#include "sim/plate_support.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/spin.hpp"

namespace sunder {
namespace {

constexpr double kInLine = 1e-9;  // least second moment of points across their line, by the whole
constexpr double kNoShare = 1e-9;  // of a weight, that is rounding
constexpr double kLoadGravity = 9.81;  // m/s² by which a live load becomes mass

/// Σ w (r² 1 − r rᵀ).
SymMat3 second_moments(std::span<const Vec3> arms, std::span<const double> weights) {
  SymMat3 sum;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const Vec3 r = arms[i];
    const double w = weights[i];
    sum.xx += w * (r.y * r.y + r.z * r.z);
    sum.yy += w * (r.x * r.x + r.z * r.z);
    sum.zz += w * (r.x * r.x + r.y * r.y);
    sum.xy -= w * (r.x * r.y);
    sum.xz -= w * (r.x * r.z);
    sum.yz -= w * (r.y * r.z);
  }
  return sum;
}

Vec3 longest(std::span<const Vec3> arms) {
  return *std::ranges::max_element(arms, {}, [](Vec3 r) { return dot(r, r); });
}

/// All along the longest of them (or all of them zero).
bool in_line(std::span<const Vec3> arms) {
  const Vec3 along = longest(arms);
  const double whole = dot(along, along);
  return std::ranges::all_of(arms, [&](Vec3 r) {
    const Vec3 across = cross(along, r);
    return dot(across, across) <= kInLine * whole * whole;
  });
}

/// The moment that forces at the arms can balance, as b of b × r.
Vec3 turn_for(std::span<const Vec3> arms, std::span<const double> weights, Vec3 moment) {
  if (!in_line(arms)) return inverse(second_moments(arms, weights)) * moment;
  double whole = 0;
  for (std::size_t i = 0; i < arms.size(); ++i) whole += weights[i] * dot(arms[i], arms[i]);
  const Vec3 along = longest(arms);
  if (whole == 0) return {};
  return 1 / whole * (moment - dot(moment, along) / dot(along, along) * along);
}

Vec3 centroid_of(std::span<const Vec3> points, std::span<const double> weights) {
  Vec3 sum;
  double whole = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum = sum + weights[i] * points[i];
    whole += weights[i];
  }
  return 1 / whole * sum;
}

/// Of the bay in plan.
Vec3 bay_centre(const Frame& frame, const FrameSlab& slab) {
  const Vec3 origin = frame.nodes[slab.nodes[0]].position;
  Vec3 sum;
  double twice = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    const Vec3 a = frame.nodes[slab.nodes[i]].position - origin;
    const Vec3 b = frame.nodes[slab.nodes[i + 1]].position - origin;
    const double area = cross(Vec2{a.x, a.z}, Vec2{b.x, b.z});
    twice += area;
    sum = sum + area / 3 * (a + b);
  }
  return origin + 1 / twice * sum;
}

/// What is left of edges whose members divided must not be pulled down: there a slab tips over.
void settle_slab(const Frame& frame, PlateSupport& plate) {
  std::vector<Vec3> points, arms;
  std::vector<double> weights;
  std::vector<std::uint32_t> which;
  std::uint32_t edges = 0;
  bool is_whole = true;
  for (std::uint32_t i = 0; i < plate.joint_count; ++i) {
    const FrameJoint& joint = frame.joints[plate.joints[i]];
    is_whole &= joint.share == 1;
    if (plate.carries[i] == 0) continue;
    edges |= 1u << joint.edge;
    which.push_back(i);
    points.push_back(joint.point);
    weights.push_back(joint.share);
  }
  if (std::popcount(edges) < 3) return;
  const Vec3 middle = centroid_of(points, weights);
  for (const Vec3 point : points) arms.push_back(point - middle);
  if (in_line(arms)) return;
  const SharedForce shared = share_force(points, plate.centre, {0, 1, 0}, weights);
  const auto pulls = [](Vec3 force) { return force.y < -kNoShare; };
  if (!is_whole && std::ranges::any_of(shared.force, pulls)) return;
  for (std::size_t i = 0; i < which.size(); ++i) plate.share[which[i]] = shared.force[i].y;
  plate.rest = PlateSupport::Rest::lines;
}

void settle_wall(const Frame& frame, PlateSupport& plate) {
  const auto joint = [&](std::uint32_t i) -> const FrameJoint& {
    return frame.joints[plate.joints[i]];
  };
  double whole = 0, lower = 0;
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < plate.joint_count; ++i) {
    if (plate.carries[i] == 0) continue;
    ++count;
    whole += joint(i).share;
    if (joint(i).edge == 0) lower += joint(i).share;
  }
  if (plate.on_ground) {
    if (count > 0) plate.rest = PlateSupport::Rest::ground;
    return;
  }
  if (count < 2) return;
  for (std::uint32_t i = 0; i < plate.joint_count; ++i) {
    if (plate.carries[i] == 0) continue;
    if (lower > 0) {
      plate.share[i] = joint(i).edge == 0 ? joint(i).share / lower : 0;
    } else {
      plate.share[i] = joint(i).share / whole;
    }
  }
  plate.rest = lower > 0 ? PlateSupport::Rest::lines : PlateSupport::Rest::points;
}

}  // namespace

void PlateSupport::add_joint(std::uint32_t joint, bool does_carry) {
  joints.push_back(joint);
  carries.push_back(does_carry ? 1 : 0);
  share.push_back(0);
  ++joint_count;
}

SharedForce share_force(std::span<const Vec3> points, Vec3 at, Vec3 force,
                        std::span<const double> weights) {
  const std::vector<double> ones(weights.empty() ? points.size() : 0, 1.0);
  if (weights.empty()) weights = ones;
  const Vec3 middle = centroid_of(points, weights);
  double whole = 0;
  std::vector<Vec3> arms;
  for (std::size_t i = 0; i < points.size(); ++i) {
    arms.push_back(points[i] - middle);
    whole += weights[i];
  }
  const Vec3 moment = cross(at - middle, force);
  const Vec3 turn = turn_for(arms, weights, moment);
  SharedForce result;
  Vec3 rest = moment;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 couple = weights[i] * cross(turn, arms[i]);
    result.force.push_back(weights[i] / whole * force + couple);
    rest = rest - cross(arms[i], couple);
  }
  result.torque = 1 / whole * rest;
  return result;
}

std::vector<PlateSupport> plates_of(const Frame& frame, std::span<const double> wall_mass) {
  std::vector<PlateSupport> plates(frame.slabs.size() + frame.walls.size());
  const std::uint32_t first = frame.slab_part(0);
  for (std::uint32_t i = 0; i < plates.size(); ++i) plates[i].part = first + i;
  for (std::uint32_t s = 0; s < frame.slabs.size(); ++s) {
    const FrameSlab& slab = frame.slabs[s];
    PlateSupport& plate = plates[s];
    plate.area = slab_area(frame, s);
    plate.mass = plate.area * (frame.materials[slab.material].density * slab.thickness +
                               slab.live_load / kLoadGravity);
    plate.centre = bay_centre(frame, slab);
  }
  std::vector<PartSolid> solids;
  if (!frame.walls.empty() && wall_mass.empty()) solids = solids_of(frame);
  for (std::uint32_t w = 0; w < frame.walls.size(); ++w) {
    PlateSupport& plate = plates[frame.slabs.size() + w];
    plate.mass = solids.empty() ? wall_mass[w] : solids[plate.part].mass;
    plate.on_ground = frame.walls[w].edges[0] == kNoPart;
  }
  for (std::uint32_t j = 0; j < frame.joints.size(); ++j) {
    if (frame.joints[j].a < first) continue;
    plates[frame.joints[j].a - first].add_joint(j, false);
  }
  return plates;
}

void settle(const Frame& frame, PlateSupport& plate) {
  std::ranges::fill(plate.share, 0.0);
  plate.rest = PlateSupport::Rest::none;
  if (plate.part < frame.wall_part(0)) {
    settle_slab(frame, plate);
  } else {
    settle_wall(frame, plate);
  }
}

}  // namespace sunder
