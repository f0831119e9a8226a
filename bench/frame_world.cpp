// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/frame_world.hpp"

#include "sim/part_pose.hpp"

namespace sunder {
namespace {

constexpr double kGravity = 9.81;
constexpr Surface kSteel{0.3, 0.2};

class RigidFrame final : public FrameWorld {
 public:
  RigidFrame(const Assembly& assembly, const WorldParams& params)
      : assembly_(assembly), world_(params) {
    for (const PartSolid& part : assembly.parts) {
      BodyParams body;
      body.mass = part.mass;
      body.inertia = part.inertia;
      body.pose = pose_of(part);
      body.surface = kSteel;
      body.order = bodies_.size() + 1;
      const Prism prism{part.hull, part.half_length};
      bodies_.push_back(world_.add_body(body, {&prism, 1}));
    }
    for (const Assembly::Joint& j : assembly.joints)
      joints_.push_back(world_.add_joint(
          {bodies_[j.a], j.b == kNoPart ? kGround : bodies_[j.b], j.point, j.axes}));
  }

  void step(double dt) override { world_.step(dt); }
  void set_iterations(int iterations) override { world_.set_iterations(iterations); }
  void add_ball(const Projectile& ball) override {
    BodyParams body;
    body.mass = ball.mass;
    const double inertia = 0.4 * ball.mass * ball.radius * ball.radius;
    body.inertia = {inertia, inertia, inertia, 0, 0, 0};
    body.pose.position = ball.position;
    body.velocity = ball.velocity;
    body.order = bodies_.size() + 1;
    world_.add_sphere(body, ball.radius);
  }
  Vec3 place(std::uint32_t part, Vec3 stood) const override {
    const PartSolid& solid = assembly_.parts[part];
    return world_.pose(bodies_[part]) * into(solid.axes, stood - solid.centre);
  }
  PartReaction reaction(std::uint32_t joint) const override {
    const JointReaction found = world_.joint_reaction(joints_[joint]);
    const Assembly::Joint& j = assembly_.joints[joint];
    const Vec3 arm = into(j.axes, j.point - assembly_.parts[j.a].centre);
    return {found.force, found.torque, found.torque + cross(arm, found.force)};
  }
  double gap(std::uint32_t joint) const override {
    return world_.joint_reaction(joints_[joint]).gap;
  }
  std::uint64_t fallbacks() const override { return world_.solver_fallbacks(); }

 private:
  const Assembly& assembly_;
  RigidWorld world_;
  std::vector<BodyId> bodies_;
  std::vector<JointId> joints_;
};

/// A box that fills `half` to both sides, z of its outline along `axes.z`.
PartSolid box(Vec3 half, double mass, Vec3 centre, const Axes& axes) {
  PartSolid part;
  part.hull = {{-half.x, -half.y}, {half.x, -half.y}, {half.x, half.y}, {-half.x, half.y}};
  part.half_length = half.z;
  part.centre = centre;
  part.axes = axes;
  part.mass = mass;
  part.inertia.xx = mass / 3 * (half.y * half.y + half.z * half.z);
  part.inertia.yy = mass / 3 * (half.x * half.x + half.z * half.z);
  part.inertia.zz = mass / 3 * (half.x * half.x + half.y * half.y);
  return part;
}

constexpr double kHalfWidth = 0.1;  // of the boxes, m
constexpr double kHeight = 2;       // of the cantilever, m

}  // namespace

double Assembly::weight() const {
  double mass = 0;
  for (const PartSolid& part : parts) mass += part.mass;
  return mass * kGravity;
}

Assembly assembly_of(const Frame& frame) {
  Assembly assembly;
  assembly.parts = solids_of(frame);
  for (const FrameJoint& j : frame.joints) assembly.joints.push_back({j.a, j.b, j.point, j.axes});
  std::vector<std::uint8_t> goes_on(frame.nodes.size(), 0);
  const auto is_post = [](const FrameMember& m) { return m.kind == FrameMember::Kind::post; };
  for (const FrameMember& member : frame.members)
    if (is_post(member)) goes_on[member.from] = 1;
  for (std::uint32_t m = 0; m < frame.members.size(); ++m)
    if (is_post(frame.members[m]) && goes_on[frame.members[m].to] == 0)
      assembly.tops.push_back({m, frame.nodes[frame.members[m].to].position});
  return assembly;
}

Assembly column_of(int count, double mass, double height) {
  Assembly assembly;
  const Axes upright{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, up{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
    const Vec3 foot{0, i * height, 0}, half{0, height / 2, 0};
    assembly.parts.push_back(box({kHalfWidth, kHalfWidth, height / 2}, mass, foot + half, upright));
    assembly.joints.push_back({i, i == 0 ? kNoPart : i - 1, foot, up});
    assembly.tops = {{i, foot + 2 * half}};
  }
  return assembly;
}

Assembly cantilever_of(int count, double mass, double length) {
  Assembly assembly;
  const double l = length / count;
  const Axes along{{0, 0, 1}, {0, -1, 0}, {1, 0, 0}};
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
    const Vec3 start{i * l, kHeight, 0}, half{l / 2, 0, 0};
    assembly.parts.push_back(box({kHalfWidth, kHalfWidth, l / 2}, mass, start + half, along));
    assembly.joints.push_back({i, i == 0 ? kNoPart : i - 1, start, {}});
    assembly.tops = {{i, start + 2 * half}};
  }
  return assembly;
}

std::unique_ptr<FrameWorld> rigid_frame(const Assembly& assembly, const WorldParams& params) {
  return std::make_unique<RigidFrame>(assembly, params);
}

}  // namespace sunder
