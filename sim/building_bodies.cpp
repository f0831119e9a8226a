// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/building_bodies.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "sim/contact_order.hpp"
#include "sim/divided_members.hpp"
#include "sim/part_pose.hpp"

namespace sunder {
namespace {

constexpr double kFollow = 1e-3;  // m: colliders are no farther from their parts

}  // namespace

BuildingBodies::BuildingBodies(const CollapseScene& scene, RigidWorld& world,
                               const std::vector<PartSolid>& solids)
    : scene_(scene),
      frame_(scene.frame),
      world_(world),
      solids_(solids),
      piece_of_(scene.frame.part_count(), kStanding),
      collider_of_(scene.frame.part_count(), kNoBody),
      shifted_(scene.frame.part_count()) {
  for (const PartSolid& solid : solids) mass_.push_back(solid.mass);
  for (std::uint32_t part = 0; part < frame_.part_count(); ++part) add_collider(part);
}

void BuildingBodies::add_collider(std::uint32_t part) {
  const Prism prism{solids_[part].hull, solids_[part].half_length};
  const BodyId body =
      world_.add_static(pose_of(solids_[part]), {&prism, 1}, surface_of(frame_, part),
                        kStandingOrder + next_order_++);
  collider_of_[part] = body;
  take_shape(part, body);
}

void BuildingBodies::move_collider(std::uint32_t part, const Pose& displacement) {
  if (!stands(part) || collider_of_[part] == kNoBody) return;
  const PartSolid& solid = solids_[part];
  double farthest = 0;
  for (const double end : {-solid.half_length, solid.half_length})
    for (const Vec2 corner : solid.hull) {
      const Vec3 point = solid.centre + solid.axes * Vec3{corner.x, corner.y, end};
      farthest = std::max(farthest, length(displacement * point - shifted_[part] * point));
    }
  if (farthest < kFollow) return;
  shifted_[part] = displacement;
  world_.move_static(collider_of_[part], displacement * pose_of(solid));
}

void BuildingBodies::take_shape(std::uint32_t part, BodyId body) {
  if (parts_of_body_.size() <= body) parts_of_body_.resize(body + 1);
  parts_of_body_[body] = {part};
}

BodyId BuildingBodies::give_up_shape(std::uint32_t part) {
  const BodyId body = std::exchange(collider_of_[part], kNoBody);
  parts_of_body_[body].clear();
  world_.remove(body);
  return body;
}

BodyId BuildingBodies::body(std::uint32_t part) const {
  return is_loose(part) ? pieces_[piece_of_[part]].body : collider_of_[part];
}

Pose BuildingBodies::pose(std::uint32_t part) const {
  const Pose standing = pose_of(solids_[part]);
  return is_loose(part) ? world_.pose(pieces_[piece_of_[part]].body) * standing : standing;
}

std::uint32_t BuildingBodies::part_of(BodyId body, std::uint32_t prism) const {
  if (body >= parts_of_body_.size() || parts_of_body_[body].empty()) return kNoPart;
  const std::vector<std::uint32_t>& parts = parts_of_body_[body];
  return parts.size() == 1 ? parts.front() : parts[prism];
}

std::vector<std::uint32_t> BuildingBodies::not_standing() const {
  std::vector<std::uint32_t> parts;
  for (std::uint32_t part = 0; part < piece_of_.size(); ++part)
    if (!stands(part)) parts.push_back(part);
  return parts;
}

double BuildingBodies::mass_of(std::uint32_t part) const {
  const std::uint32_t first = frame_.slab_part(0), end = frame_.wall_part(0);
  const bool is_slab = part >= first && part < end;
  const double gravity = scene_.simulation.gravity;
  const double added = is_slab && live_ > 0 ? live_ * slab_area(frame_, part - first) / gravity : 0;
  return mass_[part] + added;
}

BodyParams BuildingBodies::body_of(const std::vector<std::uint32_t>& parts) const {
  BodyParams body;
  body.mass = 0;
  std::uint32_t heaviest = parts[0];
  for (const std::uint32_t part : parts) {
    const double mass = mass_of(part);
    body.mass += mass;
    body.centroid = body.centroid + mass * solids_[part].centre;
    if (mass > mass_of(heaviest)) heaviest = part;
  }
  body.centroid = (1 / body.mass) * body.centroid;
  for (const std::uint32_t part : parts) {
    const double mass = mass_of(part), share = mass / solids_[part].mass;
    const SymMat3 own = rotated(solids_[part].axes, solids_[part].inertia);
    const Vec3 r = solids_[part].centre - body.centroid;
    SymMat3& sum = body.inertia;
    sum.xx += share * own.xx + mass * (r.y * r.y + r.z * r.z);
    sum.yy += share * own.yy + mass * (r.x * r.x + r.z * r.z);
    sum.zz += share * own.zz + mass * (r.x * r.x + r.y * r.y);
    sum.xy += share * own.xy - mass * r.x * r.y;
    sum.xz += share * own.xz - mass * r.x * r.z;
    sum.yz += share * own.yz - mass * r.y * r.z;
  }
  body.surface = surface_of(frame_, heaviest);
  return body;
}

void BuildingBodies::add_piece(std::vector<std::uint32_t> parts, BodyParams body) {
  std::vector<Prism> prisms;
  Piece piece;
  for (const std::uint32_t part : parts) {
    const PartSolid& solid = solids_[part];
    prisms.push_back({solid.hull, solid.half_length, solid.centre, solid.axes});
    piece.radius = std::max(piece.radius, length(solid.centre - body.centroid));
  }
  body.order = kMovingOrder + serial_++;
  const auto index = static_cast<std::uint32_t>(pieces_.size());
  piece.body = world_.add_body(body, prisms);
  if (tell_) tell_(piece.body);
  world_.accept_overlaps(piece.body);
  for (const std::uint32_t part : parts) piece_of_[part] = index;
  if (parts_of_body_.size() <= piece.body) parts_of_body_.resize(piece.body + 1);
  parts_of_body_[piece.body] = parts;
  piece.parts = std::move(parts);
  pieces_.push_back(std::move(piece));
  ++piece_count_;
}

void BuildingBodies::release(std::vector<std::uint32_t> parts, const BodyParams& body) {
  baseline_ += body.mass * scene_.simulation.gravity * body.centroid.y;
  for (const std::uint32_t part : parts)
    if (collider_of_[part] != kNoBody) give_up_shape(part);
  add_piece(std::move(parts), body);
}

void BuildingBodies::drop(std::uint32_t index) {
  Piece& piece = pieces_[index];
  parts_of_body_[piece.body].clear();
  world_.remove(piece.body);
  piece.body = kNoBody;
  piece.parts.clear();
  --piece_count_;
}

void BuildingBodies::split(std::uint32_t index, std::vector<std::vector<std::uint32_t>> groups) {
  const BodyId old = pieces_[index].body;
  const Pose pose = world_.pose(old);
  const Vec3 centre = world_.centre(old), velocity = world_.velocity(old),
             spin = world_.angular_velocity(old);
  drop(index);
  for (std::vector<std::uint32_t>& group : groups) {
    BodyParams body = body_of(group);
    body.pose = pose;
    body.angular_velocity = spin;
    body.velocity = velocity + cross(spin, pose * body.centroid - centre);
    add_piece(std::move(group), body);
  }
}

void BuildingBodies::make_room(std::uint32_t first, std::uint32_t count) {
  piece_of_.insert(piece_of_.begin() + first, count, kGone);
  collider_of_.insert(collider_of_.begin() + first, count, kNoBody);
  mass_.insert(mass_.begin() + first, count, 0);
  shifted_.insert(shifted_.begin() + first, count, {});
  for (std::vector<std::uint32_t>& parts : parts_of_body_)
    for (std::uint32_t& part : parts) part = moved_up(part, first, count);
  for (Piece& piece : pieces_)
    for (std::uint32_t& part : piece.parts) part = moved_up(part, first, count);
}

std::uint32_t BuildingBodies::divide(std::uint32_t member, std::uint32_t part) {
  piece_of_[part] = piece_of_[member];
  mass_[member] = solids_[member].mass;
  mass_[part] = solids_[part].mass;
  if (stands(member)) {
    give_up_shape(member);
    shifted_[member] = {};
    add_collider(member);
    add_collider(part);
    return kNoPart;
  }
  const std::uint32_t piece = piece_of_[member];
  std::vector<std::uint32_t> parts = pieces_[piece].parts;
  parts.push_back(part);
  std::ranges::sort(parts);
  split(piece, {std::move(parts)});
  return piece;
}

void BuildingBodies::remove(std::uint32_t part) {
  assert(is_loose(part) && pieces_[piece_of_[part]].parts.size() == 1 && "its joints are broken");
  baseline_ -= mass_of(part) * scene_.simulation.gravity * solids_[part].centre.y;
  drop(piece_of_[part]);
  piece_of_[part] = kGone;
}

FrameMotion::Leaving BuildingBodies::hand_over(std::uint32_t part) {
  assert(is_loose(part) && pieces_[piece_of_[part]].parts.size() == 1 && "its joints are broken");
  const BodyId body = pieces_[piece_of_[part]].body;
  const FrameMotion::Leaving leaving{pose(part), world_.centre(body), world_.velocity(body),
                                     world_.angular_velocity(body)};
  drop(piece_of_[part]);
  piece_of_[part] = kGone;
  return leaving;
}

void BuildingBodies::add_live(double more) {
  live_ += more;
  for (const Piece& piece : pieces_) {
    double area = 0, mass = 0;
    for (const std::uint32_t part : piece.parts) {
      mass += mass_of(part);
      if (part >= frame_.slab_part(0) && part < frame_.wall_part(0))
        area += slab_area(frame_, part - frame_.slab_part(0));
    }
    if (area == 0) continue;
    baseline_ += more * area * world_.centre(piece.body).y;
    world_.set_mass(piece.body, mass);
  }
}

}  // namespace sunder
