// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/rigid_world.hpp"

#include <algorithm>
#include <cassert>

#include "sim/rigid_step.hpp"

namespace sunder {
namespace {

constexpr double kNeighbour = 2e-3;  // m; removing a body wakes what is nearer

double kinetic_energy_of(const RigidBody& b) {
  const Vec3 l = b.angular_momentum(b.axes, b.spin);
  return (b.mass * dot(b.velocity, b.velocity) + dot(b.spin, l)) / 2;
}

std::unique_ptr<RigidBody> moving_body(const BodyParams& params) {
  auto body = std::make_unique<RigidBody>();
  body->moves = body->awake = true;
  body->order = params.order;
  body->mass = params.mass;
  body->inverse_mass = 1 / params.mass;
  body->inertia = params.inertia;
  body->inverse_inertia = inverse(params.inertia);
  body->centroid = params.centroid;
  body->surface = params.surface;
  body->rotation = normalised(params.pose.rotation);
  body->axes = axes_of(body->rotation);
  body->centre = body->axes * params.centroid + params.pose.position;
  body->velocity = params.velocity;
  body->spin = params.angular_velocity;
  return body;
}

}  // namespace

RigidWorld::Impl::Impl(const WorldParams& params)
    : world(params), gravity{0, -params.gravity, 0}, last_dt(1) {
  auto ground = std::make_unique<RigidBody>();
  ground->id = kGround;
  ground->shape.is_ground = true;
  ground->surface = params.ground;
  ground->centre = {0, params.ground_height, 0};
  bodies.push_back(std::move(ground));
}

RigidBody& RigidWorld::Impl::body(BodyId id) const {
  assert(id < bodies.size() && bodies[id] && "the body exists");
  return *bodies[id];
}

BodyId RigidWorld::Impl::insert(std::unique_ptr<RigidBody> body) {
  const auto id = static_cast<BodyId>(bodies.size());
  body->id = id;
  hulls_built += std::max<std::size_t>(1, body->shape.hulls.size());
  body->swept = world_box(body->shape, body->place({}));
  if (body->moves) {
    body->leaf = awake_tree.insert(body->swept, id);
    awake.push_back(body.get());
    rank_last();
    ++moving_count;
  } else {
    body->leaf = still_tree.insert(body->swept, id);
  }
  bodies.push_back(std::move(body));
  return id;
}

/// Moves the last of the awake bodies to where it ranks, so that sums do not depend on history.
void RigidWorld::Impl::rank_last() {
  const auto by_rank = [](const RigidBody* a, const RigidBody* b) { return ranks_before(*a, *b); };
  const auto at = std::upper_bound(awake.begin(), awake.end() - 1, awake.back(), by_rank);
  std::rotate(at, awake.end() - 1, awake.end());
}

void RigidWorld::Impl::wake(RigidBody& body) {
  if (!body.moves) return;
  body.still_for = 0;
  if (body.awake) return;
  body.awake = true;
  still_tree.remove(body.leaf);
  body.leaf = awake_tree.insert(body.swept, body.id);
  awake.push_back(&body);
}

void RigidWorld::Impl::wake_around(const RigidBody& body) {
  found.clear();
  const Box3 box = grown(world_box(body.shape, body.place({})), kNeighbour);
  still_tree.find(box, found);
  for (const std::uint32_t id : found) {
    RigidBody& other = *bodies[id];
    if (!other.moves || !overlap(box, other.swept)) continue;
    touches.clear();
    touch_shapes(body.shape, body.place(other.centre), other.shape, other.place(other.centre),
                 kNeighbour, scratch, touches);
    if (touches.empty() || other.awake) continue;
    wake(other);
    rank_last();
  }
}

/// What little it moved is lost to its support.
void RigidWorld::Impl::put_to_sleep(RigidBody& body) {
  work.contact += kinetic_energy_of(body);
  reaction = reaction - body.mass * body.velocity;
  body.velocity = body.spin = {};
  body.awake = false;
  body.swept = world_box(body.shape, body.place({}));
  awake_tree.remove(body.leaf);
  body.leaf = still_tree.insert(body.swept, body.id);
}

RigidWorld::RigidWorld(const WorldParams& params) : impl_(std::make_unique<Impl>(params)) {}
RigidWorld::~RigidWorld() = default;

BodyId RigidWorld::add_body(const BodyParams& params, std::span<const Prism> parts) {
  auto body = moving_body(params);
  body->shape = shape_of(parts, params.centroid);
  return impl_->insert(std::move(body));
}

BodyId RigidWorld::add_sphere(const BodyParams& params, double radius) {
  auto body = moving_body(params);
  body->shape.radius = body->shape.reach = radius;
  return impl_->insert(std::move(body));
}

BodyId RigidWorld::add_static(const Pose& pose, std::span<const Prism> parts,
                              const Surface& surface, std::uint64_t order) {
  auto body = std::make_unique<RigidBody>();
  body->order = order;
  body->surface = surface;
  body->rotation = normalised(pose.rotation);
  body->axes = axes_of(body->rotation);
  body->centre = pose.position;
  body->shape = shape_of(parts, {});
  return impl_->insert(std::move(body));
}

void RigidWorld::remove(BodyId id) {
  RigidBody& body = impl_->body(id);
  assert(id != kGround && "the ground stays");
  impl_->wake_around(body);
  (body.awake ? impl_->awake_tree : impl_->still_tree).remove(body.leaf);
  if (body.awake) std::erase(impl_->awake, &body);
  if (body.moves) --impl_->moving_count;
  impl_->bodies[id].reset();
}

Pose RigidWorld::pose(BodyId id) const {
  const RigidBody& body = impl_->body(id);
  return {body.centre - body.axes * body.centroid, body.rotation};
}

Vec3 RigidWorld::centre(BodyId id) const {
  return impl_->body(id).centre;
}
Vec3 RigidWorld::velocity(BodyId id) const {
  return impl_->body(id).velocity;
}
Vec3 RigidWorld::angular_velocity(BodyId id) const {
  return impl_->body(id).spin;
}

Vec3 RigidWorld::velocity_at(BodyId id, Vec3 point) const {
  const RigidBody& body = impl_->body(id);
  return body.velocity + cross(body.spin, point - body.centre);
}

void RigidWorld::set_velocity(BodyId id, Vec3 linear, Vec3 angular) {
  RigidBody& body = impl_->body(id);
  assert(body.moves && "only bodies have a velocity");
  wake(id);
  body.velocity = linear;
  body.spin = angular;
}

void RigidWorld::apply_impulse(BodyId id, Vec3 impulse, Vec3 point) {
  RigidBody& body = impl_->body(id);
  assert(body.moves && "only bodies take impulses");
  const Vec3 turn = into(body.axes, cross(point - body.centre, impulse));
  set_velocity(id, body.velocity + body.inverse_mass * impulse,
               body.spin + body.axes * (body.inverse_inertia * turn));
}

double RigidWorld::inverse_mass_at(BodyId id, Vec3 point, Vec3 direction) const {
  const RigidBody& body = impl_->body(id);
  const Vec3 turn = into(body.axes, cross(point - body.centre, direction));
  return body.inverse_mass + dot(turn, body.inverse_inertia * turn);
}

bool RigidWorld::is_awake(BodyId id) const {
  return impl_->body(id).awake;
}
void RigidWorld::exempt(BodyId id, double seconds) { impl_->body(id).exempt_for = seconds; }

void RigidWorld::wake(BodyId id) {
  RigidBody& body = impl_->body(id);
  const bool slept = body.moves && !body.awake;
  impl_->wake(body);
  if (slept) impl_->rank_last();
}

RigidWorld::Bounds RigidWorld::bounds(BodyId id) const {
  const RigidBody& body = impl_->body(id);
  assert(id != kGround && "the ground has no bounds");
  const Box3 box = tight_box(body.shape, body.place({}));
  return {box.low, box.high};
}

std::vector<BodyId> RigidWorld::awake() const {
  std::vector<BodyId> ids;
  ids.reserve(impl_->awake.size());
  for (const RigidBody* body : impl_->awake) ids.push_back(body->id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

void RigidWorld::step(double dt) {
  assert(dt > 0 && "time goes forward");
  impl_->step(dt);
}

std::span<const Contact> RigidWorld::contacts() const {
  return impl_->contacts;
}
Vec3 RigidWorld::reaction() const {
  return impl_->reaction;
}
StepWork RigidWorld::work() const {
  return impl_->work;
}

double RigidWorld::kinetic_energy() const {
  double sum = 0;
  for (const RigidBody* body : impl_->awake) sum += kinetic_energy_of(*body);
  return sum;
}

double RigidWorld::potential_energy() const {
  double sum = 0;
  for (const auto& body : impl_->bodies) {
    if (body && body->moves) sum += body->mass * impl_->world.gravity * body->centre.y;
  }
  return sum;
}

Vec3 RigidWorld::momentum() const {
  Vec3 sum;
  for (const RigidBody* body : impl_->awake) sum = sum + body->mass * body->velocity;
  return sum;
}

Vec3 RigidWorld::angular_momentum(Vec3 about) const {
  Vec3 sum;
  for (const RigidBody* b : impl_->awake) {
    sum = sum + b->angular_momentum(b->axes, b->spin) +
          b->mass * cross(b->centre - about, b->velocity);
  }
  return sum;
}

std::uint32_t RigidWorld::body_count() const {
  return impl_->moving_count;
}
std::uint64_t RigidWorld::hulls_built() const {
  return impl_->hulls_built;
}

}  // namespace sunder
