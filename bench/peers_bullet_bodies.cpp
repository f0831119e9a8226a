// SPDX-License-Identifier: GPL-3.0-or-later
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <vector>

#include "bench/body_world.hpp"

namespace sunder {
namespace {

btVector3 as_bullet(Vec3 v) {
  return {v.x, v.y, v.z};
}
Vec3 ours(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

/// Coefficients of a pair are products of its sides', so each side has the root.
class BulletBodies final : public BodyWorld {
 public:
  explicit BulletBodies(const BodyWorldParams& params)
      : surface_(params.surface),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
    world_.setGravity({0, -params.gravity, 0});
    world_.getSolverInfo().m_numIterations = params.iterations;
    if (params.has_ground)
      add_body(0, new btStaticPlaneShape({0, 1, 0}, 0), btTransform::getIdentity());
  }
  ~BulletBodies() override {
    for (auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  void add(const LooseBody& body) override {
    btCollisionShape* shape = body.radius > 0
                                  ? static_cast<btCollisionShape*>(new btSphereShape(body.radius))
                                  : new btBoxShape(as_bullet(body.half));
    btRigidBody& made =
        add_body(body.mass, shape, btTransform({{0, 0, 1}, body.turn}, as_bullet(body.centre)));
    made.setMassProps(body.mass, as_bullet(moments_of(body)));
    made.updateInertiaTensor();
    made.setLinearVelocity(as_bullet(body.velocity));
    made.setAngularVelocity(as_bullet(body.spin));
    made.setActivationState(DISABLE_DEACTIVATION);
    moving_.push_back(&made);
  }
  void add_slope(double angle) override {
    add_body(0, new btBoxShape({50, 0.5, 5}),
             btTransform({{0, 0, 1}, angle}, {0.5 * std::sin(angle), -0.5 * std::cos(angle), 0}));
  }
  void step(double dt) override { world_.stepSimulation(dt, 0); }
  Vec3 centre(std::size_t body) const override {
    return ours(moving_[body]->getWorldTransform().getOrigin());
  }
  Vec3 velocity(std::size_t body) const override {
    return ours(moving_[body]->getLinearVelocity());
  }
  Vec3 spin(std::size_t body) const override { return ours(moving_[body]->getAngularVelocity()); }
  Quaternion rotation(std::size_t body) const override {
    const btQuaternion q = moving_[body]->getWorldTransform().getRotation();
    return {q.x(), q.y(), q.z(), q.w()};
  }

 private:
  btRigidBody& add_body(double mass, btCollisionShape* shape, const btTransform& at) {
    shapes_.emplace_back(shape);
    bodies_.push_back(std::make_unique<btRigidBody>(mass, nullptr, shape));
    bodies_.back()->setWorldTransform(at);
    bodies_.back()->setFriction(std::sqrt(surface_.friction));
    bodies_.back()->setRestitution(std::sqrt(surface_.restitution));
    world_.addRigidBody(bodies_.back().get());
    return *bodies_.back();
  }

  Surface surface_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<btRigidBody*> moving_;
};

}  // namespace

Engine bullet_engine() {
  return {"Bullet",
          [](const BodyWorldParams& params) { return std::make_unique<BulletBodies>(params); }};
}

}  // namespace sunder
