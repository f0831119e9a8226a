// SPDX-License-Identifier: GPL-3.0-or-later
// A rigid body on points: f_i = F/n + b × r_i about the points' centroid with J b = M, J = Σ r² 1 −
// r rᵀ, is the least of Σ |f_i|² under the two balances (Lagrange's multipliers are F/n and b).
#include "sim/plate_support.hpp"

#include <algorithm>
#include <cmath>

#include "sim/spin.hpp"

namespace sunder {
namespace {

constexpr double kInLine = 1e-9;  // least second moment of points across their line, by the whole
constexpr double kLoadGravity = 9.81;  // m/s² by which a live load becomes mass

/// Σ r² 1 − r rᵀ.
SymMat3 second_moments(std::span<const Vec3> arms) {
  SymMat3 sum;
  for (const Vec3 r : arms) {
    sum.xx += r.y * r.y + r.z * r.z;
    sum.yy += r.x * r.x + r.z * r.z;
    sum.zz += r.x * r.x + r.y * r.y;
    sum.xy -= r.x * r.y;
    sum.xz -= r.x * r.z;
    sum.yz -= r.y * r.z;
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
Vec3 turn_for(std::span<const Vec3> arms, Vec3 moment) {
  if (!in_line(arms)) return inverse(second_moments(arms)) * moment;
  double whole = 0;
  for (const Vec3 r : arms) whole += dot(r, r);
  const Vec3 along = longest(arms);
  if (whole == 0) return {};
  return 1 / whole * (moment - dot(moment, along) / dot(along, along) * along);
}

Vec3 centroid_of(std::span<const Vec3> points) {
  Vec3 sum;
  for (const Vec3 p : points) sum = sum + p;
  return 1 / static_cast<double>(points.size()) * sum;
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

std::size_t carrying(const PlateSupport& plate) {
  return static_cast<std::size_t>(std::ranges::count(plate.carries, true));
}

void settle_slab(const Frame& frame, PlateSupport& plate) {
  std::array<Vec3, 4> points, arms;
  std::array<std::uint32_t, 4> which{};
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < plate.joint_count; ++i) {
    if (!plate.carries[i]) continue;
    which[count] = i;
    points[count++] = frame.joints[plate.joints[i]].point;
  }
  if (count < 3) return;
  const Vec3 middle = centroid_of({points.data(), count});
  for (std::size_t i = 0; i < count; ++i) arms[i] = points[i] - middle;
  if (in_line({arms.data(), count})) return;
  const SharedForce shared = share_force({points.data(), count}, plate.centre, {0, 1, 0});
  for (std::size_t i = 0; i < count; ++i) plate.share[which[i]] = shared.force[i].y;
  plate.rest = PlateSupport::Rest::lines;
}

void settle_wall(const Frame& frame, PlateSupport& plate) {
  const FrameWall& wall = frame.walls[plate.part - frame.wall_part(0)];
  const std::size_t count = carrying(plate);
  if (plate.on_ground) {
    if (count > 0) plate.rest = PlateSupport::Rest::ground;
    return;
  }
  if (count < 2) return;
  for (std::uint32_t i = 0; i < plate.joint_count; ++i) {
    if (!plate.carries[i] || frame.joints[plate.joints[i]].b != wall.edges[0]) continue;
    plate.share[i] = 1;
    plate.rest = PlateSupport::Rest::lines;
    return;
  }
  for (std::uint32_t i = 0; i < plate.joint_count; ++i)
    plate.share[i] = plate.carries[i] ? 1 / static_cast<double>(count) : 0;
  plate.rest = PlateSupport::Rest::points;
}

}  // namespace

SharedForce share_force(std::span<const Vec3> points, Vec3 at, Vec3 force) {
  const double share = 1 / static_cast<double>(points.size());
  const Vec3 middle = centroid_of(points);
  std::array<Vec3, 4> arms;
  for (std::size_t i = 0; i < points.size(); ++i) arms[i] = points[i] - middle;
  const std::span<const Vec3> all(arms.data(), points.size());
  const Vec3 moment = cross(at - middle, force);
  const Vec3 turn = turn_for(all, moment);
  SharedForce result;
  Vec3 rest = moment;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 couple = cross(turn, arms[i]);
    result.force[i] = share * force + couple;
    rest = rest - cross(arms[i], couple);
  }
  result.torque = share * rest;
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
    PlateSupport& plate = plates[frame.joints[j].a - first];
    plate.joints[plate.joint_count++] = j;
  }
  return plates;
}

void settle(const Frame& frame, PlateSupport& plate) {
  plate.share = {};
  plate.rest = PlateSupport::Rest::none;
  if (plate.part < frame.wall_part(0)) {
    settle_slab(frame, plate);
  } else {
    settle_wall(frame, plate);
  }
}

}  // namespace sunder
