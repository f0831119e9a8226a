// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "meshing/vec.hpp"
#include "sim/rigid_world.hpp"
#include "sim/spin.hpp"
#include "sim/touch_points.hpp"

class btCollisionDispatcher;
class btCollisionShape;
class btTransform;

// Internal to the rigid world: shapes and where they touch.
namespace sunder {

/// Axis-aligned box; empty at first.
struct WorldBox {
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void add(Vec3 point);
  void grow(double by);
};
bool overlap(const WorldBox& a, const WorldBox& b);

/// A body's solid in Bullet's frame of it: a union of prisms, a ball, or the half-space y <= 0.
class Solid {
 public:
  struct Impl;
  Solid();  ///< the half-space
  explicit Solid(double radius);
  /// `axes`, `centre`: of Bullet's frame, in the frame of the prisms.
  Solid(std::span<const Prism> prisms, const Axes& axes, Vec3 centre);
  Solid(Solid&&) noexcept;
  ~Solid();

  bool is_half_space() const;
  double radius() const;        ///< above 0: a ball
  double reach() const;         ///< furthest corner from the centre of mass
  btCollisionShape& shape() const;
  /// Not of the half-space.
  WorldBox extent(const btTransform& at) const;
  /// Never smaller than `extent`; cheap also for many prisms.
  WorldBox rough_extent(const btTransform& at) const;

 private:
  friend class Toucher;
  std::unique_ptr<Impl> impl_;
};

/// How one body moves against another.
struct RelativePath {
  Vec3 velocity, acceleration;
  double duration = 0;  ///< 0: it is not known well enough to be followed
};

/// A contact between parts (numbers within their solids; 0 for a ball).
struct PartTouch {
  std::uint32_t part_a = 0, part_b = 0;
  TouchPoint point;  ///< normal from b to a
};

/// Finds where solids touch. Keeps scratch memory, hence one per thread.
class Toucher {
 public:
  Toucher();
  ~Toucher();
  btCollisionDispatcher& dispatcher();

  /// Appends contacts nearer than `margin`, at most four per pair of parts, ordered by parts.
  /// `path` is that of a: if one of them is a ball, far contacts are those of the moment it
  /// arrives, not of now: its normal turns on the way to a corner.
  void find(const Solid& a, const btTransform& at_a, const Solid& b, const btTransform& at_b,
            double margin, const RelativePath& path, std::vector<PartTouch>& found);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunder
