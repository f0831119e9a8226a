// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "meshing/tri_mesh.hpp"
#include "sim/pose.hpp"
#include "sim/spin.hpp"

namespace sunder {

/// Handle of a body or collider; counts up, never used twice.
using BodyId = std::uint32_t;
constexpr BodyId kGround = 0;  ///< the ground, if the world has one
constexpr BodyId kNoBody = 0xFFFFFFFFu;

/// Rough surfaces: a pair takes the geometric mean of each.
struct Surface {
  double friction = 0.6;
  double restitution = 0.1;
};

/// A joint between bodies: counts up, never used twice.
using JointId = std::uint32_t;

/// How joints are solved; contacts always by sequential impulses where the choice is free.
enum class JointSolver : std::uint8_t { sequential_impulse, nncg, dantzig, lemke };

struct WorldParams {
  double gravity = 9.81;  ///< m/s², along -Y
  int iterations = 20;    ///< of the sequential-impulse solver
  JointSolver joint_solver = JointSolver::sequential_impulse;
  bool warm_start = true;    ///< joints start from the impulses of the last step
  bool has_ground = true;    ///< the half-space y <= ground_height
  double ground_height = 0;  ///< m
  Surface ground = {0.6, 0.1};
  bool sleep = true;  ///< bodies that rest are taken out of the solver
  /// With more bodies than that, those that rest longest are merged with what they lie on: fixed
  /// until that goes or they are pushed by hand. 0: never.
  std::uint32_t max_bodies = 0;
};

/// A convex prism: polygon in the XY plane of its own frame, strictly convex, counter-clockwise,
/// extruded over z = ±half_thickness.
struct Prism {
  std::vector<Vec2> outline;  ///< m
  double half_thickness = 0;  ///< m
  Vec3 origin{};              ///< of its frame, in the design frame, m
  Axes axes{};                ///< of its frame, in the design frame
};

/// A moving body. It is described in a *design frame* (for a wall's chunk: the wall's frame), so
/// that its shape never has to be moved: `pose` says where that frame is in the world.
struct BodyParams {
  double mass = 1;        ///< kg
  Vec3 centroid;          ///< design frame
  SymMat3 inertia;        ///< about the centroid, axes of the design frame, kg m²
  Pose pose;              ///< of the design frame
  Vec3 velocity;          ///< of the centroid, world, m/s
  Vec3 angular_velocity;  ///< world, rad/s
  Surface surface;
  /// Contacts are solved in the order of these keys, whatever order bodies were added in, so that
  /// a run does not depend on what was added only to be skipped. Unique, ground below all.
  std::uint64_t order = 0;
};

/// A joint: the bodies keep their relative pose (six equations).
struct JointParams {
  BodyId a = kNoBody;
  BodyId b = kGround;  ///< kGround: the world, also when there is no ground to fall on
  Vec3 point;          ///< world
  Axes axes;           ///< world; turn with a. Loads are told in them
  bool rigid = true;   ///< false: the point only (three equations); the bodies turn freely about it
};

/// What a joint gave body a in the last step, over the step's length.
struct JointReaction {
  Vec3 force;      ///< on a, in the joint's axes, N
  Vec3 torque;     ///< on a, about the joint's point (not a body's centre), in its axes, N m
  double gap = 0;  ///< between the two bodies' ideas of the point, m
};

/// One contact point of the last step.
struct Contact {
  BodyId a = kNoBody, b = kNoBody;  ///< order(a) < order(b)
  Vec3 point;                       ///< world, between the surfaces
  Vec3 normal;                      ///< from b to a, world, |normal| = 1
  double impulse = 0;               ///< along the normal on a (and its reverse on b), N s, >= 0
  double friction_impulse = 0;      ///< magnitude, N s
  double approach = 0;              ///< speed at which they came together, m/s
  std::uint32_t part_a = 0, part_b = 0;  ///< which of the bodies' prisms
  Vec3 tangential{};                     ///< impulse of friction on a, N s
};

/// Force of a body that sleeps on a collider that never moves: its own weight, and what lies on it
/// asleep. Contacts tell of bodies that are awake alone.
struct RestingLoad {
  BodyId on = kNoBody;
  std::uint32_t part = 0;  ///< which of its prisms
  Vec3 point;              ///< world
  Vec3 force;              ///< on the collider, N
};

/// Where the energy of a step went, J; positive: lost by the bodies. Impulse times the mean of the
/// velocities just before and just after it, so that kinetic and potential energy plus this stay
/// the same, to rounding, but where overlap is pushed out and in a contact's first approach at
/// creeping speed. What a body still moved when it fell asleep counts as lost by contact.
struct StepWork {
  double contact = 0;   ///< by normal impulses
  double friction = 0;  ///< by tangential impulses
  double driven = 0;    ///< by what set_gravity adds to -gravity on Y: given to the bodies, > 0
  double joint = 0;     ///< by joints: what shocks and the correction of drift take (or add, < 0)
};

/// Rigid bodies with contact, friction, restitution and sleep, by sequential impulses in double
/// precision. Bullet's tree of boxes finds the pairs; its contact search and solver are replaced,
/// since no setting of theirs gave exact impacts and standing towers together (docs/accuracy.md):
///  - every body drifts freely to the moment its impulses act (the impact, if something arrives in
///    the step; else the middle of the step), takes them there and drifts on: free flight is the
///    exact parabola, rotation conserves angular momentum and, to fourth order, energy;
///  - restitution is a pass of its own after the solve, on the speed at the moment of impact, so
///    that it neither depends on the step nor disturbs stacks;
///  - overlap is pushed out at 1 m/s at most, without touching a velocity, and without lifting
///    bodies (that have no joints) by more energy than contacts took from them; only what is put
///    into something is lifted out of it all the same;
///  - friction is one vector in Coulomb's cone, against the sliding;
///  - contacts are found and solved in an order of our own keys;
///  - no function of the C library whose bits depend on the processor;
///  - joints are six (or three) of Bullet's rows each, along the joint's own axes, so that their
///  impulses are
///    the load at the joint; Baumgarte's correction of drift with Bullet's share of 0.2 a step.
/// Not thread-safe; a world per thread is fine.
class RigidWorld {
 public:
  explicit RigidWorld(const WorldParams& params);
  ~RigidWorld();
  RigidWorld(const RigidWorld&) = delete;
  RigidWorld& operator=(const RigidWorld&) = delete;

  /// A body made of prisms (its chunks' convex parts).
  BodyId add_body(const BodyParams& params, std::span<const Prism> parts);
  BodyId add_sphere(const BodyParams& params, double radius);
  /// A collider that never moves: part of a wall that stands.
  BodyId add_static(const Pose& pose, std::span<const Prism> parts, const Surface& surface,
                    std::uint64_t order);
  /// What rests on or near it wakes up.
  void remove(BodyId body);

  Pose pose(BodyId body) const;      ///< of the design frame
  Vec3 centre(BodyId body) const;    ///< of mass, world
  Vec3 velocity(BodyId body) const;  ///< of the centre of mass
  Vec3 angular_velocity(BodyId body) const;
  Vec3 velocity_at(BodyId body, Vec3 point) const;
  void set_velocity(BodyId body, Vec3 linear, Vec3 angular);  ///< wakes it
  void apply_impulse(BodyId body, Vec3 impulse, Vec3 point);  ///< at a world point; wakes it
  /// Speed change that an impulse along `direction` (unit) at `point` makes there, 1/kg.
  double inverse_mass_at(BodyId body, Vec3 point, Vec3 direction) const;
  bool is_awake(BodyId body) const;
  void wake(BodyId body);
  /// For so long the body meets spheres and the ground only: what leaves a hole at speed crushes
  /// the edges that would jam rigid ones.
  void exempt(BodyId body, double seconds);

  /// Takes up to `energy` (J) from what bodies that are awake move against each other, as if they
  /// stuck together for a moment; momentum and angular momentum stay. Returns the energy taken.
  /// Of bodies, here and in spend, that are gone already nothing is taken.
  double slow_together(std::span<const BodyId> bodies, double energy);
  /// Energy (J) that its contacts took is something else's, cracks': it lifts nothing any more.
  void spend(BodyId body, double energy);

  /// Joined bodies do not collide with each other, nor those that are two joints apart.
  JointId add_joint(const JointParams& params);
  void remove_joint(JointId joint);
  JointReaction joint_reaction(JointId joint) const;
  /// Where the body overlaps others now it is not pushed out: contact begins so much deeper, until
  /// they have been further apart.
  void accept_overlaps(BodyId body);
  /// A collider that never moves by itself stands elsewhere; what rests on or near it wakes up.
  void move_static(BodyId body, const Pose& pose);
  /// The two bodies never touch from now on (a post that snapped bears no more).
  void separate(BodyId a, BodyId b);
  /// The same body heavier or lighter, inertia in proportion, velocities kept.
  void set_mass(BodyId body, double mass);
  /// Acceleration of free bodies: -gravity on Y, or with the ground's own acceleration taken off.
  void set_gravity(Vec3 gravity);
  /// From the next step on.
  void set_iterations(int iterations);
  /// Steps in which a direct solver of joints gave up and iterated instead.
  std::uint64_t solver_fallbacks() const;
  /// Axis-aligned box, world.
  struct Bounds {
    Vec3 low, high;
  };
  Bounds bounds(BodyId body) const;
  /// Moving bodies that are awake, ascending.
  std::vector<BodyId> awake() const;

  /// Advances by dt > 0, s. Changes of dt from step to step are fine.
  void step(double dt);

  /// Contacts with an impulse in the last step, sorted by the bodies' order.
  std::span<const Contact> contacts() const;
  /// Of everything that slept throughout the last step, on colliders but the ground, in the order
  /// of the bodies' keys. Valid until bodies wake, fall asleep or go.
  std::span<const RestingLoad> resting() const;
  std::uint32_t merged_count() const;  ///< bodies that rest and are fixed now
  /// Sum of the impulses that ground, static colliders and sleepers gave in the last step, N s.
  Vec3 reaction() const;
  /// Impulse of gravity on the moving bodies in the last step, N s: the change of momentum is this
  /// and reaction().
  Vec3 weight() const;
  /// Deepest overlap of two bodies when the last step began, m.
  double overlap() const;
  StepWork work() const;            ///< of the last step
  double kinetic_energy() const;    ///< of all moving bodies, J
  double potential_energy() const;  ///< of all moving bodies, above y = 0, J
  Vec3 momentum() const;            ///< of all moving bodies, kg m/s
  Vec3 angular_momentum(Vec3 about) const;
  std::uint32_t body_count() const;  ///< moving ones
  std::uint32_t awake_count() const;  ///< of them: those that are awake

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunder
