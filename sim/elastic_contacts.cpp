// SPDX-License-Identifier: GPL-3.0-or-later
// What touches a building's parts, and how much of a blow its frame can take.
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
    if (const std::uint32_t part = part_of(contact.a, contact.part_a); part != kNoPart)
      touch(contact, part, on_a);
    if (const std::uint32_t part = part_of(contact.b, contact.part_b); part != kNoPart)
      touch(contact, part, -1.0 * on_a);
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

/// Of the place that is touched, along the force, beyond the speed of what struck it.
double ElasticMotion::speed_ahead(std::uint32_t part) const {
  const FrameTouch& touch = touches_[part];
  const double fall = scene_.simulation.gravity * scene_.rules.load_time;
  const Vec3 along = (1 / length(touch.force)) * touch.force;
  return dot(velocity_at(part, touch.point), along) - touch.approach - fall;
}

/// The world takes what stands for fixed, so that light parts would get more speed than what struck
/// them had: a step in which they would is solved again with as much force as they can take.
void ElasticMotion::limit_blows() {
  if (!standing_.can_step_again()) return;
  std::vector<std::pair<std::uint32_t, double>> ahead;
  for (const std::uint32_t part : touches_.active()) {
    if (!bodies_.stands(part)) continue;
    const double speed = speed_ahead(part);
    if (speed > 0) ahead.emplace_back(part, speed);
  }
  if (ahead.empty()) return;
  standing_.swap_velocities();
  for (auto& [part, speed] : ahead) {
    const double before = speed_ahead(part);
    speed = before < 0 ? before / (before - speed) : 0;
  }
  standing_.swap_velocities();
  for (const auto& [part, share] : ahead) touches_.limit(part, share);
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
    // Hinges that flow turn back at once where nothing presses any more.
    const double before = standing_.bends() ? standing_.energy() : 0;
    standing_.stand_on();
    if (standing_.bends()) fracture_ += before - standing_.energy();
  }
  return back;
}

}  // namespace sunder
