// SPDX-License-Identifier: GPL-3.0-or-later
#include <btBulletDynamicsCommon.h>

#include <array>
#include <cassert>

#include "sim/rigid_joint.hpp"

namespace sunder {
namespace {

Axes turned_into(const Axes& frame, const Axes& axes) {
  return {into(frame, axes.x), into(frame, axes.y), into(frame, axes.z)};
}
Axes turned_by(const Axes& frame, const Axes& axes) {
  return {frame * axes.x, frame * axes.y, frame * axes.z};
}

/// A body where its impulses act, less what gravity adds to its path until then: the impulses take
/// that back, it is no drift to be corrected.
struct Moment {
  explicit Moment(const Body& body)
      : axes(body.slot != 0 && body.awake ? &body.axes_then : &body.axes),
        shift(body.slot != 0 && body.awake ? body.contact_time * body.velocity_before : Vec3{}) {}
  const Axes* axes;
  Vec3 shift;
};

class Rows final : public btTypedConstraint {
 public:
  Rows(RigidJoint& joint, btRigidBody& a, btRigidBody& b)
      : btTypedConstraint(FIXED_CONSTRAINT_TYPE, a, b), joint_(joint) {}
  RigidJoint& joint() { return joint_; }

  void getInfo1(btConstraintInfo1* info) override {
    info->m_numConstraintRows = joint_.rows;
    info->nub = 0;
  }

  void getInfo2(btConstraintInfo2* info) override {
    const Body& a = *joint_.a;
    const Body& b = *joint_.b;
    const Moment at_a(a), at_b(b);
    const Vec3 arm_a = *at_a.axes * joint_.point_a, arm_b = *at_b.axes * joint_.point_b;
    const Vec3 apart = (b.centre - a.centre) + (at_b.shift - at_a.shift) + (arm_b - arm_a);
    joint_.arm_a = arm_a + 0.5 * apart;
    joint_.arm_b = arm_b - 0.5 * apart;
    joint_.axes = turned_by(*at_a.axes, joint_.axes_a);
    const Axes other = turned_by(*at_b.axes, joint_.axes_b);
    const Vec3 turn = 0.5 * (cross(joint_.axes.x, other.x) + cross(joint_.axes.y, other.y) +
                             cross(joint_.axes.z, other.z));
    const std::array<Vec3, 3> axes{joint_.axes.x, joint_.axes.y, joint_.axes.z};
    const double rate = joint_.corrects_apart ? 0 : info->erp * info->fps;
    for (int i = 0; i < 3; ++i) {
      const int row = i * info->rowskip;
      put(info->m_J1linearAxis + row, axes[i]);
      put(info->m_J2linearAxis + row, -1.0 * axes[i]);
      put(info->m_J1angularAxis + row, cross(joint_.arm_a, axes[i]));
      put(info->m_J2angularAxis + row, -1.0 * cross(joint_.arm_b, axes[i]));
      joint_.drift[i] = dot(axes[i], apart);
      info->m_constraintError[row] = rate * joint_.drift[i];
    }
    for (int i = 3; i < joint_.rows; ++i) {
      const int row = i * info->rowskip;
      put(info->m_J1angularAxis + row, axes[i - 3]);
      put(info->m_J2angularAxis + row, -1.0 * axes[i - 3]);
      joint_.drift[i] = dot(axes[i - 3], turn);
      info->m_constraintError[row] = rate * joint_.drift[i];
    }
  }

  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0; }

 private:
  static void put(btScalar* at, Vec3 v) {
    at[0] = v.x;
    at[1] = v.y;
    at[2] = v.z;
  }
  RigidJoint& joint_;
};

}  // namespace

RigidJoint::RigidJoint(Body& first, Body& second, const JointParams& params)
    : a(&first),
      b(&second),
      point_a(into(first.axes, params.point - first.centre)),
      point_b(into(second.axes, params.point - second.centre)),
      axes_a(turned_into(first.axes, params.axes)),
      axes_b(turned_into(second.axes, params.axes)),
      rows(params.rigid ? 6 : 3),
      in_bullet(std::make_unique<Rows>(*this, *first.in_bullet, *second.in_bullet)),
      axes(params.axes) {}
RigidJoint::~RigidJoint() = default;

double RigidJoint::gap() const {
  return length((b->centre - a->centre) + (b->axes * point_b - a->axes * point_a));
}

RigidJoint& joint_of(btTypedConstraint& constraint) {
  return static_cast<Rows&>(constraint).joint();
}

}  // namespace sunder
