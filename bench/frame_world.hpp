// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sim/frame.hpp"
#include "sim/projectile.hpp"
#include "sim/rigid_world.hpp"

namespace sunder {

/// Rigid parts and the joints between them, for whatever engine carries them.
struct Assembly {
  struct Joint {
    std::uint32_t a = 0, b = kNoPart;  ///< parts; kNoPart: the ground
    Vec3 point;                        ///< world, m
    Axes axes;                         ///< world
  };
  /// A point of a part whose descent is its sag.
  struct Top {
    std::uint32_t part = 0;
    Vec3 stood;  ///< world, m
  };
  std::vector<PartSolid> parts;
  std::vector<Joint> joints;
  std::vector<Top> tops;
  double weight() const;  ///< N
};

/// A frame; `tops` are those of its columns.
Assembly assembly_of(const Frame& frame);
/// `count` posts of `mass` kg and `height` m, one on top of the other.
Assembly column_of(int count, double mass, double height);
/// `count` boxes of `mass` kg, together `length` m, in a row along x from a fixed end.
Assembly cantilever_of(int count, double mass, double length);

/// What a joint gives part a, in the joint's axes.
struct PartReaction {
  Vec3 force;             ///< N
  Vec3 torque;            ///< about the joint's point, N m
  Vec3 torque_at_centre;  ///< about part a's centre of mass, N m
};

/// An assembly that moves.
class FrameWorld {
 public:
  virtual ~FrameWorld() = default;
  virtual void step(double dt) = 0;
  virtual void set_iterations(int iterations) = 0;
  virtual void add_ball(const Projectile& ball) = 0;
  /// Where a point of a part is that stood at `stood`, world.
  virtual Vec3 place(std::uint32_t part, Vec3 stood) const = 0;
  virtual PartReaction reaction(std::uint32_t joint) const = 0;  ///< in the last step
  virtual double gap(std::uint32_t joint) const = 0;             ///< between the two sides, m
  virtual std::uint64_t fallbacks() const = 0;  ///< steps in which a direct solver gave up
};

std::unique_ptr<FrameWorld> rigid_frame(const Assembly& assembly, const WorldParams& params);

}  // namespace sunder
