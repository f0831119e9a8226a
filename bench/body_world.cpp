// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/body_world.hpp"

#include <cmath>
#include <vector>

#include "tests/sim/bodies.hpp"

namespace sunder {
namespace {

Quaternion about_z(double angle) {
  return {0, 0, std::sin(angle / 2), std::cos(angle / 2)};
}

class OurWorld final : public BodyWorld {
 public:
  explicit OurWorld(const BodyWorldParams& params)
      : surface_(params.surface),
        world_({.gravity = params.gravity,
                .iterations = params.iterations,
                .has_ground = params.has_ground,
                .ground = params.surface,
                .sleep = false}) {}

  void add(const LooseBody& body) override {
    const Vec3 moments = moments_of(body);
    BodyParams params;
    params.mass = body.mass;
    params.inertia = {.xx = moments.x, .yy = moments.y, .zz = moments.z};
    params.pose = {body.centre, about_z(body.turn)};
    params.velocity = body.velocity;
    params.angular_velocity = body.spin;
    params.surface = surface_;
    params.order = ids_.size() + 2;
    ids_.push_back(body.radius > 0 ? world_.add_sphere(params, body.radius)
                                   : add_block(world_, params, body.half));
  }
  void add_slope(double angle) override {
    const Prism slab{{{-50, -0.5}, {50, -0.5}, {50, 0.5}, {-50, 0.5}}, 5};
    const Pose pose{{0.5 * std::sin(angle), -0.5 * std::cos(angle), 0}, about_z(angle)};
    world_.add_static(pose, {&slab, 1}, surface_, 1);
  }
  void step(double dt) override { world_.step(dt); }
  Vec3 centre(std::size_t body) const override { return world_.centre(ids_[body]); }
  Vec3 velocity(std::size_t body) const override { return world_.velocity(ids_[body]); }
  Vec3 spin(std::size_t body) const override { return world_.angular_velocity(ids_[body]); }
  Quaternion rotation(std::size_t body) const override { return world_.pose(ids_[body]).rotation; }

 private:
  Surface surface_;
  RigidWorld world_;
  std::vector<BodyId> ids_;
};

}  // namespace

Vec3 moments_of(const LooseBody& body) {
  const double ball = 0.4 * body.mass * body.radius * body.radius, third = body.mass / 3;
  if (ball > 0) return {ball, ball, ball};
  const Vec3 h = body.half;
  return {third * (h.y * h.y + h.z * h.z), third * (h.x * h.x + h.z * h.z),
          third * (h.x * h.x + h.y * h.y)};
}

Engine our_engine() {
  return {"sunder",
          [](const BodyWorldParams& params) { return std::make_unique<OurWorld>(params); }};
}

}  // namespace sunder
