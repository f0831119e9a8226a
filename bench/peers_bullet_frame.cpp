// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/peers_bullet_frame.hpp"

#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btLemkeSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>

namespace sunder {
namespace {

constexpr int kGroundGroup = 1, kPartGroup = 2, kBallGroup = 4;

btVector3 as_bullet(Vec3 v) {
  return {v.x, v.y, v.z};
}
Vec3 ours(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}
btMatrix3x3 as_bullet(const Axes& r) {
  return {r.x.x, r.y.x, r.z.x, r.x.y, r.y.y, r.z.y, r.x.z, r.y.z, r.z.z};
}

struct Solvers {
  btDantzigSolver dantzig;
  btLemkeSolver lemke;
};

class BulletFrame final : public FrameWorld {
 public:
  BulletFrame(const Assembly& assembly, const BulletParams& params)
      : assembly_(assembly),
        solver_(make_solver(params.solver)),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, solver_.get(), &configuration_) {
    world_.setGravity({0, -9.81, 0});
    world_.getSolverInfo().m_numIterations = params.iterations;
    world_.getSolverInfo().m_globalCfm = params.compliance;
    add_ground();
    for (const PartSolid& part : assembly.parts) add_part(part, params.sleep);
    feedback_.resize(assembly.joints.size());
    for (std::uint32_t j = 0; j < assembly.joints.size(); ++j) add_joint(j);
  }
  ~BulletFrame() override {
    for (auto& joint : joints_) world_.removeConstraint(joint.get());
    for (auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  void step(double dt) override { world_.stepSimulation(dt, 0); }
  void set_iterations(int count) override { world_.getSolverInfo().m_numIterations = count; }
  void add_ball(const Projectile& ball) override {
    auto* shape = new btSphereShape(ball.radius);
    shapes_.emplace_back(shape);
    btVector3 inertia;
    shape->calculateLocalInertia(ball.mass, inertia);
    bodies_.push_back(std::make_unique<btRigidBody>(ball.mass, nullptr, shape, inertia));
    bodies_.back()->setWorldTransform(
        btTransform(btMatrix3x3::getIdentity(), as_bullet(ball.position)));
    bodies_.back()->setLinearVelocity(as_bullet(ball.velocity));
    world_.addRigidBody(bodies_.back().get(), kBallGroup, kGroundGroup | kPartGroup | kBallGroup);
  }

  Vec3 place(std::uint32_t part, Vec3 stood) const override {
    const PartSolid& solid = assembly_.parts[part];
    return ours(body(part).getWorldTransform() * as_bullet(into(solid.axes, stood - solid.centre)));
  }
  PartReaction reaction(std::uint32_t joint) const override {
    const Assembly::Joint& j = assembly_.joints[joint];
    // The joint's axes turn with part a; feedback is in the world's.
    const btMatrix3x3 turn =
        body(j.a).getWorldTransform().getBasis() * as_bullet(assembly_.parts[j.a].axes).transpose();
    const auto told = [&](const btVector3& v) { return into(j.axes, ours(turn.transpose() * v)); };
    const Vec3 force = told(feedback_[joint].m_appliedForceBodyA);
    const Vec3 torque = told(feedback_[joint].m_appliedTorqueBodyA);
    const Vec3 arm = into(j.axes, j.point - assembly_.parts[j.a].centre);
    return {force, torque - cross(arm, force), torque};
  }
  double gap(std::uint32_t joint) const override {
    const Assembly::Joint& j = assembly_.joints[joint];
    return length(place(j.a, j.point) - (j.b == kNoPart ? j.point : place(j.b, j.point)));
  }
  std::uint64_t fallbacks() const override {
    const auto* direct = dynamic_cast<const btMLCPSolver*>(solver_.get());
    return direct == nullptr ? 0 : static_cast<std::uint64_t>(direct->getNumFallbacks());
  }

 private:
  std::unique_ptr<btConstraintSolver> make_solver(JointSolver solver) {
    switch (solver) {
      case JointSolver::nncg: return std::make_unique<btNNCGConstraintSolver>();
      case JointSolver::dantzig: return std::make_unique<btMLCPSolver>(&methods_.dantzig);
      case JointSolver::lemke: return std::make_unique<btMLCPSolver>(&methods_.lemke);
      case JointSolver::sequential_impulse: break;
    }
    return std::make_unique<btSequentialImpulseConstraintSolver>();
  }

  btRigidBody& body(std::uint32_t part) const { return *bodies_[part + 1]; }

  void add_ground() {
    shapes_.push_back(std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), 0));
    bodies_.push_back(std::make_unique<btRigidBody>(0, nullptr, shapes_.back().get()));
    world_.addRigidBody(bodies_.back().get(), kGroundGroup, kPartGroup | kBallGroup);
  }

  void add_part(const PartSolid& part, bool sleep) {
    auto* hull = new btConvexHullShape;
    shapes_.emplace_back(hull);
    for (const Vec2 p : part.hull)
      for (const double z : {-part.half_length, part.half_length})
        hull->addPoint({p.x, p.y, z}, false);
    hull->recalcLocalAabb();
    hull->setMargin(0.001);
    const btVector3 inertia(part.inertia.xx, part.inertia.yy, part.inertia.zz);
    bodies_.push_back(std::make_unique<btRigidBody>(part.mass, nullptr, hull, inertia));
    bodies_.back()->setWorldTransform(btTransform(as_bullet(part.axes), as_bullet(part.centre)));
    if (!sleep) bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(bodies_.back().get(), kPartGroup, kGroundGroup | kBallGroup);
  }

  void add_joint(std::uint32_t joint) {
    const Assembly::Joint& j = assembly_.joints[joint];
    btRigidBody& a = body(j.a);
    btRigidBody& b = j.b == kNoPart ? *bodies_.front() : body(j.b);
    const btTransform at(as_bullet(j.axes), as_bullet(j.point));
    joints_.push_back(std::make_unique<btFixedConstraint>(
        a, b, a.getWorldTransform().inverse() * at, b.getWorldTransform().inverse() * at));
    joints_.back()->setJointFeedback(&feedback_[joint]);
    world_.addConstraint(joints_.back().get(), true);
  }

  const Assembly& assembly_;
  Solvers methods_;
  std::unique_ptr<btConstraintSolver> solver_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;  ///< the ground, parts, balls
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<btJointFeedback> feedback_;
};

}  // namespace

std::unique_ptr<FrameWorld> bullet_frame(const Assembly& assembly, const BulletParams& params) {
  return std::make_unique<BulletFrame>(assembly, params);
}

}  // namespace sunder
