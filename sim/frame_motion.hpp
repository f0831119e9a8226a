// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/collapse.hpp"
#include "sim/contact_order.hpp"
#include "sim/divided_members.hpp"
#include "sim/member_span.hpp"
#include "sim/panel_element.hpp"
#include "sim/rigid_world.hpp"

namespace sunder {

/// Energy that a building's motion accounts for itself, J; positive: lost by what moves.
struct MotionLosses {
  double joint = 0;     ///< in rigid joints
  double fracture = 0;  ///< what was stored elastically where something broke
  double damping = 0;   ///< of the ringing frame
  double plastic = 0;   ///< work of plastic hinges
  double contact = 0;   ///< less (or more) than the world has booked for contacts
};

/// How the parts of a building move and what its joints carry: the solver. What breaks, and why, is
/// decided by the run that owns it and the world.
class FrameMotion {
 public:
  virtual ~FrameMotion() = default;

  /// Takes up the weight, until time 0.
  virtual void settle(const Progress& progress) = 0;
  /// After a substep of the world that ended at `now`; the last of a step says so.
  virtual void follow(double now, double dt, bool ends_step) = 0;
  /// Load that a joint is judged by.
  virtual JointLoad load(std::uint32_t joint) const = 0;
  /// False: no load of this joint has changed since it was read last.
  virtual bool is_live(std::uint32_t joint) const = 0;
  virtual bool any_live() const { return true; }  ///< false: no joint is
  /// Joints let go; unless `bears_on` their parts do not touch each other from now on either.
  virtual void break_joint(std::uint32_t joint, bool bears_on) = 0;
  /// A joint's plastic hinge.
  struct HingeState {
    bool flows = false;   ///< its bending moments stay as they are
    double rotation = 0;  ///< plastic, of the member's end against the node, rad
  };
  virtual HingeState hinge(std::uint32_t) const { return {}; }
  /// The joint bends from now on, its moments (M_y, M_z; joint axes) held at these. False: it
  /// cannot.
  virtual bool yield(std::uint32_t, Vec3) { return false; }
  /// Whether other joints take over at once what a broken one carried.
  virtual bool redistributes() const = 0;
  /// After all joints of a batch: what came loose starts to move. True if other loads followed.
  virtual bool settle_breaks() = 0;
  /// Joints that have to go too: what they hold has lost too many others to be in balance.
  virtual std::vector<std::uint32_t> unheld_joints() const = 0;
  /// Joints with what stands of what has become a mechanism, or moved so far that it does not stand
  /// any more. They let go when nothing is over its strength.
  virtual std::vector<std::uint32_t> mechanism_joints() const { return {}; }
  /// What can be given back what the frame does not take of its blow.
  virtual void add_projectile(BodyId, double /*mass*/) {}
  /// Share of what struck the part in the last step that it could take up.
  virtual double borne(std::uint32_t) const { return 1; }
  /// Of what struck the part in the last step it bore but this share: its joints broke. Returns the
  /// impulse that the frame has not taken up, N s; nothing presses on the part any more.
  virtual Vec3 give_back(std::uint32_t, double) { return {}; }
  /// The frame's joints with these numbers have another part b now.
  virtual void rejoin(std::span<const std::uint32_t> joints) = 0;

  // Members that divide between their ends.
  /// What a member carries between its ends. False: nothing is known of it.
  virtual bool find_span(std::uint32_t, MemberSpan&) const { return false; }
  virtual bool finds_spans() const { return false; }  ///< of any member
  /// Before members of the frame divide, while no break is unsettled, each at most once.
  virtual void begin_divisions(std::span<const MemberCut>) {}
  /// After all of them. Joints that came in are intact.
  virtual void end_divisions(std::span<const MemberDivision>) {}

  virtual void remove_part(std::uint32_t part) = 0;
  /// More live load on every slab, N/m².
  virtual void add_load(double more) = 0;

  // Slabs and walls that break into chunks of someone else's.
  /// Told of every body that parts become, where it is then.
  virtual void when_released(std::function<void(BodyId)>) {}
  /// Whether a part hangs on the ground and is not moved by the world.
  virtual bool stands(std::uint32_t part) const = 0;
  /// The collision shape of a part that stands is taken away, with what touched it; the part still
  /// loads the frame. Returns the body that it was.
  virtual BodyId give_up_shape(std::uint32_t part) = 0;
  /// What touches this fixed body touches the part.
  virtual void take_shape(std::uint32_t part, BodyId body) = 0;
  /// So much is left of a part that stands, kg.
  virtual void set_mass(std::uint32_t part, double mass) = 0;
  /// How a node of the frame that stands moved from where it was drawn, m.
  virtual Vec3 displacement(std::uint32_t) const { return {}; }
  /// Slabs and walls that are elastic from now, at rest, on.
  virtual void set_panels(std::vector<PanelElement>) {}
  /// Some of them are softer now.
  virtual void change_panels(std::span<const PanelStiffness>) {}
  /// Of an elastic panel's corners since then, m, world; none: it takes no part (any more).
  virtual std::optional<Twelve> panel_motion(std::uint32_t) const { return {}; }
  /// A part without joints goes, with the motion it has; its energy goes along.
  struct Leaving {
    Pose pose;  ///< of its frame
    Vec3 centre, velocity, angular_velocity;
  };
  virtual Leaving release(std::uint32_t part) = 0;

  /// Of the part's own frame (see PartSolid) now.
  virtual Pose pose(std::uint32_t part) const = 0;
  virtual bool is_moving(std::uint32_t part) const = 0;
  virtual bool any_moving() const { return true; }  ///< false: no part is
  /// kNoPart: the body is none of the building's.
  virtual std::uint32_t part_of(BodyId body, std::uint32_t prism) const = 0;
  virtual double sag(std::uint32_t member) const = 0;  ///< of the end of a member, m down
  /// Mean force and torque of the ground at rest, per joint to the ground in order.
  virtual std::vector<SupportReaction> supports() const = 0;
  /// Weight that stands on the ground without a support, N: panels of the ground floor.
  virtual double unsupported() const { return 0; }
  virtual double joint_gap(std::uint32_t joint) const = 0;
  virtual std::uint64_t bodies() const = 0;

  virtual double kinetic() const = 0;    ///< of what is not in the world, J
  virtual double strain() const = 0;     ///< J
  virtual double potential() const = 0;  ///< of what is not in the world, against standing, J
  virtual double baseline() const = 0;   ///< potential of the world's bodies where they started, J
  virtual MotionLosses losses() const = 0;
  virtual double given() const = 0;  ///< energy that removed and added masses brought, J
  virtual SolveCounts solves() const = 0;
  virtual double residual() const = 0;  ///< of equilibrium, largest so far, relative
  virtual std::optional<Buckling> buckling() const { return {}; }
};

/// Every part a rigid body, every joint six equations: the solver "bullet".
std::unique_ptr<FrameMotion> jointed_motion(const CollapseScene& scene, RigidWorld& world,
                                            const std::vector<PartSolid>& solids);
/// What hangs together is one piece, elastic inside; what hangs on the ground stands: "hybrid".
std::unique_ptr<FrameMotion> elastic_motion(const CollapseScene& scene, RigidWorld& world,
                                            const std::vector<PartSolid>& solids);

}  // namespace sunder
