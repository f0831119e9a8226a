// SPDX-License-Identifier: GPL-3.0-or-later
// What touches a building's parts, and how much of a blow its frame can take.
#include <algorithm>

#include "sim/elastic_motion.hpp"

namespace sunder {
namespace {

bool breaks_into_chunks(const Frame& frame, std::uint32_t part) {
  if (part < frame.slab_part(0)) return false;
  if (part < frame.wall_part(0)) return frame.slabs[part - frame.slab_part(0)].pattern != kNoPart;
  return frame.walls[part - frame.wall_part(0)].pattern != kNoPart;
}

}  // namespace

void ElasticMotion::note_contacts(double dt) {
  for (const Contact& contact : world_.contacts()) {
    const Vec3 on_a = contact.impulse * contact.normal + contact.tangential;
    if (const std::uint32_t part = part_of(contact.a, contact.part_a); part != kNoPart) {
      touch(contact, part, on_a);
      if (mass_of(contact.b) > 0) touches_.struck_by(part, contact.b);
    }
    if (const std::uint32_t part = part_of(contact.b, contact.part_b); part != kNoPart) {
      touch(contact, part, -1.0 * on_a);
      if (mass_of(contact.a) > 0) touches_.struck_by(part, contact.a);
    }
  }
  for (const RestingLoad& load : world_.resting())
    if (const std::uint32_t part = part_of(load.on, load.part); part != kNoPart)
      touches_.add(part, load.point, dt * load.force, 0);
}

/// Point and impulse are turned back to where the part stood.
void ElasticMotion::touch(const Contact& contact, std::uint32_t part, Vec3 impulse) {
  Vec3 point = contact.point;
  if (bodies_.is_loose(part)) {
    const Pose back = inverse(world_.pose(bodies_.body(part)));
    point = back * point;
    impulse = rotate(back.rotation, impulse);
  }
  touches_.add(part, point, impulse, contact.approach);
}

/// Forces on what stands.
std::vector<FrameLoads::OnPart> ElasticMotion::standing_contacts() const {
  std::vector<FrameLoads::OnPart> contacts;
  for (const std::uint32_t part : touches_.active())
    if (!bodies_.is_loose(part)) contacts.push_back(touches_.load_on(part));
  return contacts;
}

void ElasticMotion::press() {
  standing_.set_contacts(standing_contacts());
}

/// Rigid and small, by its nodes.
Pose ElasticMotion::displacement_of(std::uint32_t part) const {
  const std::vector<std::uint32_t> nodes = nodes_of(part);
  const double share = 1 / static_cast<double>(nodes.size());
  Vec3 middle, way = offsets_[part], moment;
  for (const std::uint32_t node : nodes) middle = middle + share * frame_.nodes[node].position;
  SymMat3 spread;
  double squares = 0;
  for (const std::uint32_t node : nodes) {
    const Vec3 arm = frame_.nodes[node].position - middle, moved = way_of_end(part, node);
    way = way + share * moved;
    moment = moment + cross(arm, moved);
    squares += dot(arm, arm);
    spread.xx += arm.y * arm.y + arm.z * arm.z;
    spread.yy += arm.x * arm.x + arm.z * arm.z;
    spread.zz += arm.x * arm.x + arm.y * arm.y;
    spread.xy -= arm.x * arm.y;
    spread.xz -= arm.x * arm.z;
    spread.yz -= arm.y * arm.z;
  }
  // A member does not turn about its own axis.
  const Vec3 turn = nodes.size() == 2 ? (1 / squares) * moment : inverse(spread) * moment;
  return small_motion(middle, way, turn);
}

/// What something touches stands for the world where it is in the frame. Not in balance at any
/// time: what is left of a frame there jumps. Not of panels that break: their chunks stand where
/// they were drawn, so the whole does.
void ElasticMotion::move_colliders() {
  if (!standing_.in_time()) return;
  for (const std::uint32_t part : touches_.active())
    if (bodies_.stands(part) && !breaks_into_chunks(frame_, part))
      bodies_.move_collider(part, displacement_of(part));
}

/// kg; 0: it is none.
double ElasticMotion::mass_of(BodyId projectile) const {
  const auto found = std::ranges::find(projectiles_, projectile, &std::pair<BodyId, double>::first);
  return found == projectiles_.end() ? 0 : found->second;
}

/// Of the place that is touched, along the force, beyond the speed of what struck it. A projectile
/// has that which it will have with all that it is owed, were this the share of its forces.
double ElasticMotion::speed_ahead(std::uint32_t part, double share) const {
  const FrameTouch& touch = touches_[part];
  const Vec3 along = (1 / length(touch.force)) * touch.force;
  const double speed = standing_.speed_along(touches_.load_on(part));
  if (touch.striker == kNoBody)
    return speed - touch.approach - scene_.simulation.gravity * scene_.rules.load_time;
  Vec3 owed;
  for (const std::uint32_t other : touches_.active())
    if (touches_[other].striker == touch.striker) owed = owed + touches_.owed(other, share);
  const Vec3 moves = world_.velocity(touch.striker) + (1 / mass_of(touch.striker)) * owed;
  return speed - dot(moves, along);
}

/// Where the frame would run ahead of what struck it, and all that the same projectile touches.
std::vector<ElasticMotion::Blow> ElasticMotion::blows_ahead() const {
  std::vector<Blow> blows;
  std::vector<BodyId> strikers;
  for (const std::uint32_t part : touches_.active()) {
    if (!bodies_.stands(part)) continue;
    blows.push_back({part, speed_ahead(part, 1)});
    if (blows.back().ahead > 0) strikers.push_back(touches_[part].striker);
  }
  std::erase_if(blows, [&](const Blow& blow) {
    const BodyId striker = touches_[blow.part].striker;
    return blow.ahead <= 0 && (striker == kNoBody || std::ranges::count(strikers, striker) == 0);
  });
  return blows;
}

/// The world takes what stands for fixed, so that light parts would get more speed than what struck
/// them has left: a step in which they would is solved again with so much force that they move on
/// together. Speeds are linear in the share.
void ElasticMotion::limit_blows() {
  if (!standing_.in_time()) return;
  std::vector<Blow> blows = blows_ahead();
  if (blows.empty()) return;
  std::vector<FrameLoads::OnPart> others = standing_contacts();
  std::erase_if(others, [&](const FrameLoads::OnPart& load) {
    return std::ranges::count(blows, load.part, &Blow::part) > 0;
  });
  standing_.set_contacts(std::move(others));
  standing_.solve_step();
  for (Blow& blow : blows) {
    const double alone = speed_ahead(blow.part, 0);
    blow.share = blow.ahead <= 0 ? 1 : alone < 0 ? alone / (alone - blow.ahead) : 0;
  }
  for (const Blow& blow : blows) {
    double share = blow.share;
    for (const Blow& other : blows)
      if (const BodyId striker = touches_[blow.part].striker;
          striker != kNoBody && touches_[other.part].striker == striker)
        share = std::min(share, other.share);
    touches_.limit(blow.part, share);
  }
  press();
  standing_.solve_step();
}

Vec3 ElasticMotion::give_back(std::uint32_t part, double share) {
  if (!bodies_.stands(part)) return {};
  touches_.limit(part, share);
  press();
  if (standing_.can_step_again()) standing_.step_again();
  const Vec3 back = touches_.end(part);
  press();
  if (standing_.in_time()) {
    // Hinges that flow turn on where less presses on the way between the ends.
    const double before = standing_.bends() ? unspent() : 0;
    standing_.carry_on();
    if (standing_.bends()) fracture_ += before - unspent();
  }
  return back;
}

}  // namespace sunder
