// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/principal_axes.hpp"
#include "sim/rigid_world.hpp"
#include "sim/solid.hpp"
#include "sim/spin.hpp"

class btManifoldPoint;
class btRigidBody;

// Internal to the rigid world: what it keeps of a body, and of a contact while a step is taken.
namespace sunder {

struct RigidJoint;

/// What a body that sleeps lies on.
struct Support {
  BodyId on = kNoBody;
  std::uint32_t part = 0;  ///< of its solid
  Vec3 point;              ///< world
  Vec3 share;              ///< force on it by weight that the sleeper has to hand on
};

/// Two bodies' parts overlapped from the start: so deep, m.
struct Overlap {
  BodyId other = kNoBody;
  std::uint32_t part = 0, part_of_other = 0;
  double depth = 0;
};

struct Body {
  explicit Body(Solid of);
  ~Body();

  BodyId id = kNoBody;
  std::uint64_t order = 0;
  bool moves = false, awake = false;
  double mass = 0;
  SymMat3 inertia, inverse_inertia;  ///< axes of the design frame
  Vec3 centroid;                     ///< design frame
  PrincipalAxes principal;           ///< of the inertia: Bullet's frame, in the design frame
  Surface surface;
  Solid solid;
  std::unique_ptr<btRigidBody> in_bullet;

  Vec3 centre;
  Quaternion rotation;  ///< of the design frame
  Axes axes;            ///< of rotation
  Vec3 velocity, spin;
  double still_for = 0;   ///< s
  double exempt_for = 0;  ///< s; meets only balls and the ground
  std::vector<Support> supports;  ///< of one that sleeps; their shares are together 1 upwards
  std::uint64_t slept = 0;        ///< when it fell asleep: counts up
  bool is_merged = false;         ///< asleep, and touching it wakes it no more
  std::vector<RigidJoint*> joints;   ///< by age
  std::vector<const Body*> passes;   ///< bodies that it never touches
  std::vector<Overlap> overlaps;     ///< that are not pushed out
  /// Energy that contacts took from it and pushing overlap out has not given back, J.
  double taken = 0;
  double granted = 0;  ///< for what it was put into, J
  bool is_new = true;  ///< has not taken a step yet
  std::vector<const Body*> near;     ///< up to two joints away, sorted; valid if near_is_known
  bool near_is_known = true;

  // Of the step in progress.
  Vec3 velocity_before, spin_before;
  WorldBox swept;           ///< wherever it may be during the step
  double contact_time = 0;  ///< since the start of the step: its impulses act then
  bool arrives = false;     ///< contact_time is that of an impact
  std::uint32_t slot = 0;   ///< 0: does not move, or has no contact
  Vec3 shift;               ///< of the centre until contact_time
  Quaternion rotation_then;
  Axes axes_then;                   ///< of rotation_then
  Vec3 spin_then;                   ///< before the impulses
  Vec3 velocity_after, spin_after;  ///< the solver's
  Vec3 push, turn;  ///< displacement that removes overlap, m and rad; leaves velocities alone

  bool is_ground() const { return id == kGround; }
  Vec3 angular_momentum(const Axes& at, Vec3 w) const { return at * (inertia * into(at, w)); }
  /// Spin that goes with an angular momentum.
  Vec3 spin_at(const Axes& at, Vec3 l) const { return at * (inverse_inertia * into(at, l)); }
  double kinetic_energy() const {
    return (mass * dot(velocity, velocity) + dot(spin, angular_momentum(axes, spin))) / 2;
  }
};

/// Contacts are solved in this order.
inline bool ranks_before(const Body& a, const Body& b) {
  return a.order != b.order ? a.order < b.order : a.id < b.id;
}

/// A contact point of the step in progress, and how its bodies come to it. Positions are relative
/// to `origin`, the centre of one that moves.
struct Meeting {
  Body* a = nullptr;
  Body* b = nullptr;
  Vec3 origin;
  Vec3 point, normal;  ///< at the start of the step; the normal leads from b to a
  double gap = 0;
  double gap_then = 0;       ///< when the bodies are where their impulses act
  double closing = 0;        ///< normal speed towards each other at the start, m/s
  double pull = 0;           ///< by how much gravity adds to it, m/s²
  bool arrives = false;      ///< the gap closes within the step, at more than a creeping speed
  double arrival_time = 0;   ///< since the start of the step
  double arrival_speed = 0;  ///< m/s
  double bound = 0;          ///< the normal velocity may not fall below it, m/s
  Vec3 arm_a, arm_b;         ///< from the centres to the point when the impulses act
  /// Impulses of a contact that lasts, in the time before something arrives: not solved for.
  double given = 0, given_along = 0, given_across = 0;
  btManifoldPoint* solved = nullptr;
};

constexpr double kCreep = 0.05;  ///< m/s; slower arrivals do not bounce

/// `solid` is described in Bullet's frame: centre of mass and principal axes.
std::unique_ptr<Body> moving_body(const BodyParams& params, const PrincipalAxes& principal,
                                  Solid solid);
/// Slower than so much of the speeds at which bodies fall asleep.
bool is_slow(const Body& body, double share);
/// How far a corner may go by rotation in a step, m.
double sweep(const Body& body, double dt);
/// Fills closing, pull and the arrival from the bodies at the start of a step.
void set_approach(Meeting& meeting, Vec3 gravity, double dt);
/// Fills shift, rotation, axes and spin at the body's contact_time.
void drift_to_impulses(Body& body, Vec3 gravity);
/// Fills gap_then, arms and bound from where the bodies have drifted to.
void place_point(Meeting& meeting, double dt);
/// Bodies in contact with each other are lifted out of overlaps (their push and turn) by no more
/// energy than contacts took from them before, and `taken` (J) in this step; what is left is
/// theirs, by mass.
void bound_pushes(std::span<Body* const> bodies, double taken, Vec3 gravity);
/// Bodies that take their first step are also lifted out of what they are put into: adds the energy
/// for it to the two of a meeting.
void grant_overlap(const Meeting& meeting, Vec3 gravity);
/// From the impulses to the end of the step. Returns the energy that lifting the body out of an
/// overlap gave, J.
double advance(Body& body, Vec3 gravity, double dt);

}  // namespace sunder
