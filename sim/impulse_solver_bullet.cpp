// SPDX-License-Identifier: GPL-3.0-or-later
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>

#include "sim/impulse_solver.hpp"

namespace sunder {
namespace {

constexpr double kSlop = 1e-4;      // m of overlap that is left alone: contacts stay
constexpr double kPushShare = 0.2;  // of the rest that one step removes
constexpr double kPushSpeed = 1;    // m/s, at most
constexpr double kSettled = 1e-11;  // m/s; the solver stops when no row changes by more

Vec3 ours(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

class Solver final : public btSequentialImpulseConstraintSolver {
 public:
  explicit Solver(SolverTask& task) : task_(task) {
    setConstraintRowSolverGeneric(getScalarConstraintRowSolverGeneric());
    setConstraintRowSolverLowerLimit(getScalarConstraintRowSolverLowerLimit());
  }

 protected:
  void convertContacts(btPersistentManifold** manifolds, int count,
                       const btContactSolverInfo& info) override {
    btSequentialImpulseConstraintSolver::convertContacts(manifolds, count, info);
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
    solve();
    if (raise_bounces()) solve();
    if (set_pushes()) {
      solveGroupCacheFriendlySplitImpulseIterations(bodies, body_count, manifolds, manifold_count,
                                                    constraints, constraint_count, info, draw);
    }
    return 0;
  }

  btScalar solveSingleIteration(int iteration, btCollisionObject**, int, btPersistentManifold**,
                                int, btTypedConstraint**, int, const btContactSolverInfo&,
                                btIDebugDraw*) override {
    const int count = m_tmpSolverContactConstraintPool.size();
    double most = 0;
    for (int k = 0; k < count; ++k) {
      btSolverConstraint& row =
          m_tmpSolverContactConstraintPool[iteration % 2 == 0 ? k : count - 1 - k];
      most = std::max(most, solve_friction(row));
      const double change = resolveSingleConstraintRowLowerLimit(body_a(row), body_b(row), row);
      most = std::max(most, change * change);
    }
    return most;
  }

  btScalar solveGroupCacheFriendlyFinish(btCollisionObject**, int,
                                         const btContactSolverInfo& info) override {
    writeBackContacts(0, m_tmpSolverContactConstraintPool.size(), info);
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
    m_tmpSolverContactFrictionConstraintPool.resizeNoInitialize(0);
    m_tmpSolverBodyPool.resizeNoInitialize(0);
    return 0;
  }

 private:
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

std::unique_ptr<btSequentialImpulseConstraintSolver> impulse_solver(SolverTask& task) {
  return std::make_unique<Solver>(task);
}

}  // namespace sunder
