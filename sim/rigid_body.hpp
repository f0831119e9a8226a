// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/box_tree.hpp"
#include "sim/rigid_world.hpp"
#include "sim/spin.hpp"
#include "sim/touch.hpp"

// Internal to the rigid world: what it keeps of a body.
namespace sunder {

/// A body's solid, relative to its centre of mass, in the axes of its design frame: a sphere, or
/// the union of prisms.
struct Shape {
  bool is_ground = false;  ///< the half-space y <= 0 of its frame
  double radius = 0;       ///< above 0: a sphere
  std::vector<Hull> hulls;
  Box3 box;                       ///< around all hulls
  double reach = 0;               ///< furthest corner from the centre of mass
  std::unique_ptr<BoxTree> tree;  ///< of the hulls' boxes, when there are many
};
Shape shape_of(std::span<const Prism> parts, Vec3 centroid);
Box3 world_box(const Shape& shape, const Place& at);
/// Exact also for many hulls: O(corners).
Box3 tight_box(const Shape& shape, const Place& at);

/// A contact between hulls (numbers within their shapes; 0 for a sphere).
struct PartTouch {
  Touch touch;
  std::uint32_t part_a = 0, part_b = 0;
};
/// Appends contacts nearer than `margin`, ordered by parts. At most one of a, b is the ground.
void touch_shapes(const Shape& a, const Place& at_a, const Shape& b, const Place& at_b,
                  double margin, TouchScratch& scratch, std::vector<PartTouch>& found);

/// What a contact point of the last step leaves for the next one.
struct Remembered {
  BodyId other = kNoBody;
  std::uint32_t part_own = 0, part_other = 0;
  Vec3 point;  ///< from the centre of mass, axes of the design frame
  double impulse = 0;
  Vec3 friction;  ///< impulse, world
  bool used = false;
};

struct RigidBody {
  BodyId id = kNoBody;
  std::uint64_t order = 0;
  bool moves = false, awake = false;
  double mass = 0, inverse_mass = 0;
  SymMat3 inertia, inverse_inertia;  ///< axes of the design frame
  Vec3 centroid;                     ///< design frame
  Surface surface;
  Shape shape;
  BoxTree::Leaf leaf = nullptr;

  Vec3 centre;
  Quaternion rotation;
  Axes axes;  ///< of rotation
  Vec3 velocity, spin;
  double still_for = 0;  ///< s
  double exempt_for = 0;  ///< s
  std::vector<Remembered> memory;

  // Of the step in progress.
  Vec3 velocity_before, spin_before;
  Box3 swept;               ///< wherever it may be during the step
  double contact_time = 0;  ///< since the start of the step: its impulses act then
  bool arrives = false;     ///< contact_time is that of an impact
  std::uint32_t slot = 0;   ///< in the solver's table; 0: does not move, or has no contact
  Vec3 shift;               ///< of the centre until contact_time
  Quaternion rotation_then;
  Axes axes_then;  ///< of rotation_then
  Vec3 spin_then;  ///< before the impulses

  Place place(Vec3 origin) const { return {axes, centre - origin}; }
  Vec3 angular_momentum(const Axes& at, Vec3 w) const { return at * (inertia * into(at, w)); }
};

/// Contacts are solved in this order.
inline bool ranks_before(const RigidBody& a, const RigidBody& b) {
  return a.order != b.order ? a.order < b.order : a.id < b.id;
}

}  // namespace sunder
