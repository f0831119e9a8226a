// SPDX-License-Identifier: GPL-3.0-or-later
#include <ode/ode.h>

#include <array>
#include <cmath>
#include <vector>

#include "bench/body_world.hpp"

namespace sunder {
namespace {

Vec3 ours(const dReal* v) {
  return {v[0], v[1], v[2]};
}

/// As its manual has it: collide, a joint per contact point, quick step. ERP and CFM as delivered.
class OdeWorld final : public BodyWorld {
 public:
  explicit OdeWorld(const BodyWorldParams& params) : surface_(params.surface) {
    static const bool is_ready = dInitODE2(0) != 0;
    static_cast<void>(is_ready);
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    contacts_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, 0, -params.gravity, 0);
    dWorldSetQuickStepNumIterations(world_, params.iterations);
    if (params.has_ground) dCreatePlane(space_, 0, 1, 0, 0);
  }
  ~OdeWorld() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }

  void add(const LooseBody& body) override {
    const dBodyID made = dBodyCreate(world_);
    const Vec3 moments = moments_of(body);
    dMass mass;
    dMassSetParameters(&mass, body.mass, 0, 0, 0, moments.x, moments.y, moments.z, 0, 0, 0);
    dBodySetMass(made, &mass);
    const dGeomID shape =
        body.radius > 0 ? dCreateSphere(space_, body.radius)
                        : dCreateBox(space_, 2 * body.half.x, 2 * body.half.y, 2 * body.half.z);
    dGeomSetBody(shape, made);
    dBodySetPosition(made, body.centre.x, body.centre.y, body.centre.z);
    const dQuaternion turn{std::cos(body.turn / 2), 0, 0, std::sin(body.turn / 2)};
    dBodySetQuaternion(made, turn);
    dBodySetLinearVel(made, body.velocity.x, body.velocity.y, body.velocity.z);
    dBodySetAngularVel(made, body.spin.x, body.spin.y, body.spin.z);
    bodies_.push_back(made);
  }
  void add_slope(double angle) override {
    const dGeomID slab = dCreateBox(space_, 100, 1, 10);
    dGeomSetPosition(slab, 0.5 * std::sin(angle), -0.5 * std::cos(angle), 0);
    const dQuaternion turn{std::cos(angle / 2), 0, 0, std::sin(angle / 2)};
    dGeomSetQuaternion(slab, turn);
  }
  void step(double dt) override {
    dSpaceCollide(space_, this, &OdeWorld::touch);
    dWorldQuickStep(world_, dt);
    dJointGroupEmpty(contacts_);
  }
  Vec3 centre(std::size_t body) const override { return ours(dBodyGetPosition(bodies_[body])); }
  Vec3 velocity(std::size_t body) const override { return ours(dBodyGetLinearVel(bodies_[body])); }
  Vec3 spin(std::size_t body) const override { return ours(dBodyGetAngularVel(bodies_[body])); }
  Quaternion rotation(std::size_t body) const override {
    const dReal* q = dBodyGetQuaternion(bodies_[body]);
    return {q[1], q[2], q[3], q[0]};
  }

 private:
  static void touch(void* self, dGeomID a, dGeomID b) {
    auto& world = *static_cast<OdeWorld*>(self);
    if (dGeomGetBody(a) == nullptr && dGeomGetBody(b) == nullptr) return;
    std::array<dContact, 8> found{};
    const int count = dCollide(a, b, static_cast<int>(found.size()), &found[0].geom,
                               static_cast<int>(sizeof(dContact)));
    for (int i = 0; i < count; ++i) {
      dSurfaceParameters& surface = found[static_cast<std::size_t>(i)].surface;
      surface.mode = dContactBounce | dContactApprox1;
      surface.mu = world.surface_.friction;
      surface.bounce = world.surface_.restitution;
      surface.bounce_vel = 0.01;
      dJointAttach(
          dJointCreateContact(world.world_, world.contacts_, &found[static_cast<std::size_t>(i)]),
          dGeomGetBody(a), dGeomGetBody(b));
    }
  }

  Surface surface_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<dBodyID> bodies_;
};

}  // namespace

Engine ode_engine() {
  return {"ODE", [](const BodyWorldParams& params) { return std::make_unique<OdeWorld>(params); }};
}

}  // namespace sunder
