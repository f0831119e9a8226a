// SPDX-License-Identifier: GPL-3.0-or-later
#include <BulletDynamics/ConstraintSolver/btNNCGConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btLemkeSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "sim/impulse_solver.hpp"
#include "sim/rigid_joint.hpp"

namespace sunder {
namespace {

constexpr double kSlop = 1e-4;          // m of overlap that is left alone: contacts stay
constexpr double kPushShare = 0.2;      // of the rest that one step removes
constexpr double kPushSpeed = 1;        // m/s, at most
constexpr double kSettledPush = 1e-13;  // m; the same for displacements
constexpr double kSettled = 1e-11;      // m/s; the solver stops when no row changes by more

Vec3 ours(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

/// What each of Bullet's solvers has beside sequential impulses.
template <class Method>
struct DirectSolver : btMLCPSolver {
  DirectSolver() : btMLCPSolver(&method) {}
  Method method;
};

template <class Base>
class Solver final : public Base {
 public:
  explicit Solver(SolverTask& task) : task_(task) {
    this->setConstraintRowSolverGeneric(this->getScalarConstraintRowSolverGeneric());
    this->setConstraintRowSolverLowerLimit(this->getScalarConstraintRowSolverLowerLimit());
    if constexpr (kIsConjugate) this->m_onlyForNoneContact = true;
  }

 protected:
  using Base::m_tmpSolverBodyPool;
  using Base::m_tmpSolverContactConstraintPool;
  using Base::m_tmpSolverContactFrictionConstraintPool;
  using Base::m_tmpSolverNonContactConstraintPool;
  static constexpr bool kIsConjugate = std::is_same_v<Base, btNNCGConstraintSolver>;
  static constexpr bool kIsDirect = std::is_base_of_v<btMLCPSolver, Base>;

  void convertJoints(btTypedConstraint** joints, int count,
                     const btContactSolverInfo& info) override {
    Base::convertJoints(joints, count, info);
    if (!task_.warm_joints) return;
    int row = 0;
    for (int i = 0; i < count; ++i) {
      const RigidJoint& joint = joint_of(*joints[i]);
      const double ratio = joint.dt > 0 ? task_.dt / joint.dt : 0;
      const double last[] = {joint.force.x,  joint.force.y,  joint.force.z,
                             joint.torque.x, joint.torque.y, joint.torque.z};
      for (int k = 0; k < joint.rows; ++k)
        start(m_tmpSolverNonContactConstraintPool[row++], ratio * last[k], 0);
    }
  }

  void convertContacts(btPersistentManifold** manifolds, int count,
                       const btContactSolverInfo& info) override {
    Base::convertContacts(manifolds, count, info);
    for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); ++i) {
      btSolverConstraint& row = m_tmpSolverContactConstraintPool[i];
      const Meeting& m = meeting_of(row);
      const btManifoldPoint& point = *m.solved;
      start(row, point.m_appliedImpulse, m.given);
      start(friction_of(row, 0), point.m_appliedImpulseLateral1, m.given_along);
      start(friction_of(row, 1), point.m_appliedImpulseLateral2, m.given_across);
    }
  }

  btScalar solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int body_count,
                                             btPersistentManifold** manifolds, int manifold_count,
                                             btTypedConstraint** constraints, int constraint_count,
                                             const btContactSolverInfo& info,
                                             btIDebugDraw* draw) override {
    const auto solve = [&] {
      for (int i = 0; i < info.m_numIterations; ++i) {
        const double change = solveSingleIteration(i, bodies, body_count, manifolds, manifold_count,
                                                   constraints, constraint_count, info, draw);
        if (change < kSettled * kSettled) return;
      }
    };
    if constexpr (kIsDirect) {
      const int before = this->getNumFallbacks();
      Base::solveGroupCacheFriendlyIterations(bodies, body_count, manifolds, manifold_count,
                                              constraints, constraint_count, info, draw);
      task_.fallbacks += static_cast<std::uint64_t>(this->getNumFallbacks() - before);
    } else {
      solve();
    }
    if (raise_bounces()) solve();
    const bool joints_drift = set_joint_pushes();
    const bool contacts_overlap = set_pushes();
    for (int i = 0; i < info.m_numIterations && (joints_drift || contacts_overlap); ++i) {
      double most = joints_drift ? push_joints() : 0;
      if (contacts_overlap) most = std::max(most, push_contacts());
      if (most <= (joints_drift ? kSettledPush * kSettledPush : 0)) break;
    }
    return 0;
  }

  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count,
                                btTypedConstraint** constraints, int constraint_count,
                                const btContactSolverInfo& info, btIDebugDraw* draw) override {
    if constexpr (kIsConjugate) {
      if (m_tmpSolverNonContactConstraintPool.size() > 0) {
        Base::solveSingleIteration(iteration, bodies, body_count, manifolds, manifold_count,
                                   constraints, constraint_count, info, draw);
        return std::max(sweep_contacts(iteration), 1.0);  // its own residual says little
      }
    }
    return std::max(sweep_joints(iteration), sweep_contacts(iteration));
  }

  /// Displacements of joints that correct drift apart from velocities.
  bool set_joint_pushes() {
    bool any = false;
    for_each_joint([&](const RigidJoint& joint, int first) {
      for (int k = 0; joint.corrects_apart && k < joint.rows; ++k) {
        btSolverConstraint& row = m_tmpSolverNonContactConstraintPool[first + k];
        row.m_rhsPenetration = kPushShare * joint.drift[k] * row.m_jacDiagABInv;
        any |= row.m_rhsPenetration != 0;
      }
    });
    return any;
  }

  /// Each returns the square of the largest change in displacement.
  double push_joints() {
    double most = 0;
    for (int i = 0; i < m_tmpSolverNonContactConstraintPool.size(); ++i) {
      btSolverConstraint& row = m_tmpSolverNonContactConstraintPool[i];
      btSolverBody& a = body_a(row);
      btSolverBody& b = body_b(row);
      const double done = row.m_contactNormal1.dot(a.internalGetPushVelocity()) +
                          row.m_relpos1CrossNormal.dot(a.internalGetTurnVelocity()) +
                          row.m_contactNormal2.dot(b.internalGetPushVelocity()) +
                          row.m_relpos2CrossNormal.dot(b.internalGetTurnVelocity());
      const double impulse = row.m_rhsPenetration - done * row.m_jacDiagABInv;
      a.internalApplyPushImpulse(row.m_contactNormal1 * a.internalGetInvMass(),
                                 row.m_angularComponentA, impulse);
      b.internalApplyPushImpulse(row.m_contactNormal2 * b.internalGetInvMass(),
                                 row.m_angularComponentB, impulse);
      const double change = impulse / row.m_jacDiagABInv;
      most = std::max(most, change * change);
    }
    return most;
  }
  double push_contacts() {
    double most = 0;
    for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); ++i) {
      const btSolverConstraint& row = m_tmpSolverContactConstraintPool[i];
      const double change = this->m_resolveSplitPenetrationImpulse(body_a(row), body_b(row), row);
      most = std::max(most, change * change);
    }
    return most;
  }

  /// Each returns the square of the largest change in speed.
  double sweep_joints(int iteration) {
    const int count = m_tmpSolverNonContactConstraintPool.size();
    double most = 0;
    for (int k = 0; k < count; ++k) {
      btSolverConstraint& row =
          m_tmpSolverNonContactConstraintPool[iteration % 2 == 0 ? k : count - 1 - k];
      const double change = this->resolveSingleConstraintRowGeneric(body_a(row), body_b(row), row);
      most = std::max(most, change * change);
    }
    return most;
  }

  double sweep_contacts(int iteration) {
    const int count = m_tmpSolverContactConstraintPool.size();
    double most = 0;
    for (int k = 0; k < count; ++k) {
      btSolverConstraint& row =
          m_tmpSolverContactConstraintPool[iteration % 2 == 0 ? k : count - 1 - k];
      most = std::max(most, solve_friction(row));
      const double change = solve_normal(row);
      most = std::max(most, change * change);
    }
    return most;
  }

  btScalar solveGroupCacheFriendlyFinish(btCollisionObject**, int,
                                         const btContactSolverInfo& info) override {
    this->writeBackContacts(0, m_tmpSolverContactConstraintPool.size(), info);
    write_back_joints();
    for (int i = 0; i < m_tmpSolverBodyPool.size(); ++i) {
      const btSolverBody& solved = m_tmpSolverBodyPool[i];
      if (solved.m_originalBody == nullptr) continue;
      Body& body = *static_cast<Body*>(solved.m_originalBody->getUserPointer());
      body.velocity_after = ours(solved.m_linearVelocity + solved.m_deltaLinearVelocity);
      body.spin_after = ours(solved.m_angularVelocity + solved.m_deltaAngularVelocity);
      body.push = ours(solved.m_pushVelocity);
      body.turn = ours(solved.m_turnVelocity);
      solved.m_originalBody->setCompanionId(-1);
    }
    m_tmpSolverContactConstraintPool.resizeNoInitialize(0);
    m_tmpSolverNonContactConstraintPool.resizeNoInitialize(0);
    m_tmpSolverContactFrictionConstraintPool.resizeNoInitialize(0);
    m_tmpSolverBodyPool.resizeNoInitialize(0);
    return 0;
  }

 private:
  void write_back_joints() {
    const auto impulse = [&](int row) {
      return m_tmpSolverNonContactConstraintPool[row].m_appliedImpulse;
    };
    for_each_joint([&](RigidJoint& joint, int i) {
      joint.force = {impulse(i), impulse(i + 1), impulse(i + 2)};
      if (joint.rows == 6) joint.torque = {impulse(i + 3), impulse(i + 4), impulse(i + 5)};
      joint.dt = task_.dt;
    });
  }

  /// Calls with each joint and its first row.
  template <class Call>
  void for_each_joint(const Call& call) {
    for (int i = 0; i < m_tmpSolverNonContactConstraintPool.size();) {
      const btSolverConstraint& row = m_tmpSolverNonContactConstraintPool[i];
      RigidJoint& joint = joint_of(*static_cast<btTypedConstraint*>(row.m_originalContactPoint));
      call(joint, i);
      i += joint.rows;
    }
  }

  Meeting& meeting_of(const btSolverConstraint& row) const {
    return task_.meetings[static_cast<btManifoldPoint*>(row.m_originalContactPoint)->m_index0];
  }
  btSolverBody& body_a(const btSolverConstraint& row) {
    return m_tmpSolverBodyPool[row.m_solverBodyIdA];
  }
  btSolverBody& body_b(const btSolverConstraint& row) {
    return m_tmpSolverBodyPool[row.m_solverBodyIdB];
  }
  btSolverConstraint& friction_of(const btSolverConstraint& row, int which) {
    return m_tmpSolverContactFrictionConstraintPool[row.m_frictionIndex + which];
  }

  void start(btSolverConstraint& row, double guess, double given) {
    row.m_appliedImpulse = guess;
    apply(row, guess + given);
  }
  void apply(const btSolverConstraint& row, double impulse) {
    if (impulse == 0) return;
    btSolverBody& a = body_a(row);
    btSolverBody& b = body_b(row);
    a.internalApplyImpulse(row.m_contactNormal1 * a.internalGetInvMass(), row.m_angularComponentA,
                           impulse);
    b.internalApplyImpulse(row.m_contactNormal2 * b.internalGetInvMass(), row.m_angularComponentB,
                           impulse);
  }

  /// Change of speed that `row` still lacks, times its mass: N s.
  double lack(const btSolverConstraint& row) {
    const btSolverBody& a = body_a(row);
    const btSolverBody& b = body_b(row);
    const double speed = row.m_contactNormal1.dot(a.m_deltaLinearVelocity) +
                         row.m_relpos1CrossNormal.dot(a.m_deltaAngularVelocity) +
                         row.m_contactNormal2.dot(b.m_deltaLinearVelocity) +
                         row.m_relpos2CrossNormal.dot(b.m_deltaAngularVelocity);
    return row.m_rhs - speed * row.m_jacDiagABInv;
  }

  /// A contact pushes or lets go. Returns the change in speed. The sums are in the order of Bullet's
  /// function for such rows, which cannot be inlined.
  double solve_normal(btSolverConstraint& row) {
    const btSolverBody& a = body_a(row);
    const btSolverBody& b = body_b(row);
    const double of_a = row.m_contactNormal1.dot(a.m_deltaLinearVelocity) +
                        row.m_relpos1CrossNormal.dot(a.m_deltaAngularVelocity);
    const double of_b = row.m_contactNormal2.dot(b.m_deltaLinearVelocity) +
                        row.m_relpos2CrossNormal.dot(b.m_deltaAngularVelocity);
    double change = row.m_rhs - row.m_appliedImpulse * row.m_cfm;
    change -= of_a * row.m_jacDiagABInv;
    change -= of_b * row.m_jacDiagABInv;
    const double sum = row.m_appliedImpulse + change;
    if (sum < row.m_lowerLimit) change = row.m_lowerLimit - row.m_appliedImpulse;
    row.m_appliedImpulse = std::max(sum, static_cast<double>(row.m_lowerLimit));
    apply(row, change);
    return change * (1 / row.m_jacDiagABInv);
  }

  /// Returns the square of the change in speed.
  double solve_friction(const btSolverConstraint& row) {
    btSolverConstraint& along = friction_of(row, 0);
    btSolverConstraint& across = friction_of(row, 1);
    const double limit = row.m_friction * row.m_appliedImpulse;
    if (!(limit > 0) && along.m_appliedImpulse == 0 && across.m_appliedImpulse == 0) return 0;
    const double lack_along = lack(along), lack_across = lack(across);
    double u = along.m_appliedImpulse + lack_along;
    double v = across.m_appliedImpulse + lack_across;
    if (u * u + v * v > limit * limit) {
      // It slides. An isotropic step, so that the fixed point is friction against the velocity.
      const double mass = std::min(along.m_jacDiagABInv, across.m_jacDiagABInv);
      u = along.m_appliedImpulse + lack_along * (mass / along.m_jacDiagABInv);
      v = across.m_appliedImpulse + lack_across * (mass / across.m_jacDiagABInv);
      const double size = std::sqrt(u * u + v * v);
      const double s = size > limit ? limit / size : 1;
      u *= s;
      v *= s;
    }
    const double first = set(along, u), second = set(across, v);
    return std::max(first * first, second * second);
  }
  double set(btSolverConstraint& row, double impulse) {
    const double change = impulse - row.m_appliedImpulse;
    row.m_appliedImpulse = impulse;
    apply(row, change);
    return change / row.m_jacDiagABInv;
  }

  /// What arrived and got an impulse shall leave with e times its arrival speed, less what gravity
  /// takes away until the end of the step.
  bool raise_bounces() {
    bool any = false;
    for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); ++i) {
      btSolverConstraint& row = m_tmpSolverContactConstraintPool[i];
      Meeting& m = meeting_of(row);
      if (!m.arrives || !(row.m_appliedImpulse > 0)) continue;
      const double e = std::sqrt(m.a->surface.restitution * m.b->surface.restitution);
      const double speed = e * m.arrival_speed - m.pull * (task_.dt - m.arrival_time);
      if (speed <= m.bound) continue;
      row.m_rhs += (speed - m.bound) * row.m_jacDiagABInv;
      m.bound = speed;
      any = true;
    }
    return any;
  }

  bool set_pushes() {
    const btVector3 gravity(task_.gravity.x, task_.gravity.y, task_.gravity.z);
    const auto drift = [&](const Body& body, const btSolverBody& now, const btVector3& normal,
                           const btVector3& turn) {
      if (now.m_originalBody == nullptr) return 0.0;
      const double rest = task_.dt - body.contact_time;
      const btVector3 v = now.m_linearVelocity + now.m_deltaLinearVelocity;
      const btVector3 w = now.m_angularVelocity + now.m_deltaAngularVelocity;
      return rest * (normal.dot(v) + turn.dot(w)) - rest * rest / 2 * normal.dot(gravity);
    };
    bool any = false;
    for (int i = 0; i < m_tmpSolverContactConstraintPool.size(); ++i) {
      btSolverConstraint& row = m_tmpSolverContactConstraintPool[i];
      const Meeting& m = meeting_of(row);
      const double gap = m.gap_then +
                         drift(*m.a, body_a(row), row.m_contactNormal1, row.m_relpos1CrossNormal) +
                         drift(*m.b, body_b(row), row.m_contactNormal2, row.m_relpos2CrossNormal);
      const double out = std::min(kPushShare * std::max(0.0, -gap - kSlop), kPushSpeed * task_.dt);
      row.m_rhsPenetration = out * row.m_jacDiagABInv;
      any |= out > 0;
    }
    return any;
  }

  SolverTask& task_;
};

}  // namespace

std::unique_ptr<btSequentialImpulseConstraintSolver> impulse_solver(SolverTask& task,
                                                                    JointSolver method) {
  switch (method) {
    case JointSolver::nncg: return std::make_unique<Solver<btNNCGConstraintSolver>>(task);
    case JointSolver::dantzig: return std::make_unique<Solver<DirectSolver<btDantzigSolver>>>(task);
    case JointSolver::lemke: return std::make_unique<Solver<DirectSolver<btLemkeSolver>>>(task);
    case JointSolver::sequential_impulse: break;
  }
  return std::make_unique<Solver<btSequentialImpulseConstraintSolver>>(task);
}

}  // namespace sunder
