// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/peers_bullet.hpp"

#include <btBulletDynamicsCommon.h>

#include <ctime>
#include <memory>

#include "fracture/chunk_mesh.hpp"

namespace sunder {
namespace {

btVector3 as_bullet(Vec3 v) {
  return {v.x, v.y, v.z};
}

// Bullet as its users take it: default settings, one hull per convex part.
class ChunkWorld {
 public:
  explicit ChunkWorld(int iterations)
      : dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
    world_.setGravity({0, -9.81, 0});
    world_.getSolverInfo().m_numIterations = iterations;
    add_static(new btStaticPlaneShape({0, 1, 0}, 0));
  }
  /// Chunks where the wall stands.
  void add_chunks(const WallAsset& wall) {
    for (std::uint32_t c = 0; c < wall.chunks.size(); ++c) add_chunk(wall, c);
  }
  /// Of the only wall, which stands at the origin.
  void add_joints(const WallAsset& wall, double strength, double dt) {
    for (const Bond& bond : wall.bonds) add_joint(bond, strength * bond.area * dt);
  }
  ~ChunkWorld() {
    for (auto& joint : joints_) world_.removeConstraint(joint.get());
    for (auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  void add_ball(const Projectile& p) {
    auto* shape = new btSphereShape(p.radius);
    shapes_.emplace_back(shape);
    btVector3 inertia;
    shape->calculateLocalInertia(p.mass, inertia);
    bodies_.push_back(std::make_unique<btRigidBody>(p.mass, nullptr, shape, inertia));
    bodies_.back()->setWorldTransform(btTransform({0, 0, 0, 1}, as_bullet(p.position)));
    bodies_.back()->setLinearVelocity(as_bullet(p.velocity));
    world_.addRigidBody(bodies_.back().get());
  }
  void step(double dt) { world_.stepSimulation(dt, 0); }

 private:
  void add_static(btCollisionShape* shape) {
    shapes_.emplace_back(shape);
    bodies_.push_back(std::make_unique<btRigidBody>(0, nullptr, shape));
    world_.addRigidBody(bodies_.back().get());
  }

  void add_chunk(const WallAsset& wall, std::uint32_t c) {
    const MassProperties& m = wall.chunks[c];
    auto* compound = new btCompoundShape;
    shapes_.emplace_back(compound);
    for (const auto& part : convex_parts(wall, c)) {
      auto* hull = new btConvexHullShape;
      shapes_.emplace_back(hull);
      for (const std::uint32_t v : part)
        for (const double z : {-wall.wall.thickness / 2, wall.wall.thickness / 2}) {
          const Vec2 p = wall.pattern.vertices[v];
          hull->addPoint(as_bullet(Vec3{p.x, p.y, z} - m.centroid), false);
        }
      hull->recalcLocalAabb();
      hull->setMargin(0.001);
      compound->addChildShape(btTransform::getIdentity(), hull);
    }
    const btVector3 inertia(m.inertia.xx * wall.density, m.inertia.yy * wall.density,
                            m.inertia.zz * wall.density);
    bodies_.push_back(
        std::make_unique<btRigidBody>(m.volume * wall.density, nullptr, compound, inertia));
    const Quaternion& q = wall.wall.rotation;
    bodies_.back()->setWorldTransform(
        btTransform({q.x, q.y, q.z, q.w}, as_bullet(wall.wall.position + rotate(q, m.centroid))));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    chunks_.push_back(bodies_.back().get());
    world_.addRigidBody(bodies_.back().get());
  }

  void add_joint(const Bond& bond, double impulse) {
    btRigidBody& a = *chunks_[bond.a];
    btRigidBody& b = bond.b == kWorld ? *bodies_.front() : *chunks_[bond.b];
    const auto frame = [&](const btRigidBody& body) {
      btTransform t = btTransform::getIdentity();
      t.setOrigin(as_bullet(bond.centroid) - body.getWorldTransform().getOrigin());
      return t;
    };
    joints_.push_back(std::make_unique<btFixedConstraint>(a, b, frame(a), frame(b)));
    joints_.back()->setBreakingImpulseThreshold(impulse);
    world_.addConstraint(joints_.back().get(), true);
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<btRigidBody*> chunks_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
};

std::vector<double> timed_steps(ChunkWorld& world, double dt, int steps, double seconds) {
  std::vector<double> result;
  double used = 0;
  for (int i = 0; i < steps && used < 1e3 * seconds; ++i) {
    const std::clock_t start = std::clock();
    world.step(dt);
    result.push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    used += result.back();
  }
  return result;
}

}  // namespace

std::vector<double> step_jointed_wall(const WallAsset& wall, double tensile_strength,
                                      const Projectile& projectile, double dt, int iterations,
                                      int steps, double seconds) {
  ChunkWorld world(iterations);
  world.add_chunks(wall);
  world.add_joints(wall, tensile_strength, dt);
  world.add_ball(projectile);
  return timed_steps(world, dt, steps, seconds);
}

std::vector<double> step_chunks(std::span<const WallAsset> walls, double dt, int iterations,
                                int steps, double seconds) {
  ChunkWorld world(iterations);
  for (const WallAsset& wall : walls) world.add_chunks(wall);
  return timed_steps(world, dt, steps, seconds);
}

}  // namespace sunder
