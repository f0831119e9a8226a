// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/beam_element.hpp"
#include "sim/block_factor.hpp"
#include "sim/frame.hpp"
#include "sim/member_span.hpp"
#include "sim/panel_element.hpp"

namespace sunder {

struct FrameSolverParams {
  bool shear = true;  ///< Timoshenko; false: Euler–Bernoulli
  bool p_delta =
      false;  ///< second order: geometric stiffness of the axial forces at the last solve
  /// How slabs take part: "load" (weight only, a quarter per edge as a line load) or "diaphragm"
  /// (besides, two crossed bars per slab as stiff in its plane as its concrete in shear).
  std::string slabs = "load";
  /// Stiffness × this + mass × that is what is factored: {1, 0} for statics; Newmark asks for
  /// others.
  double stiffness = 1, mass = 0;
  /// Slabs and walls that are elements of the stiffness, see set_panels(). Throws Error{input} for
  /// other parts, and nodes that are not their corners.
  std::vector<PanelElement> panels = {};
  /// A piece of a building that flies, as a frame of its own: mechanisms in it are held and told of
  /// as in pieces that broke off, and walls without a lower beam hang on what is left of them.
  bool free = false;
  /// In time a member that one end let go of moves on as a cantilever; else it is a rigid one.
  bool tips = false;
  /// Of walls, kg, by number; empty: as their outlines weigh. In a piece a wall's neighbours, which
  /// trim it, may be missing.
  std::vector<double> wall_mass = {};
  /// Told the share of the first factor that is done; what it throws leaves the constructor.
  Progress progress = {};
};

/// Loads besides the weight; world, on the undeformed frame.
struct FrameLoads {
  Vec3 gravity{0, -9.81, 0};  ///< on all masses, m/s² (with d'Alembert's forces of a moving frame)
  struct OnPart {
    std::uint32_t part = 0;
    Vec3 point, force;  ///< world, N: a contact
  };
  std::vector<OnPart> contacts = {};
  std::vector<double> live = {};  ///< added load per slab, N/m²; empty: none
  /// A free piece that turns: its loads get what centrifugal forces and the acceleration that its
  /// contacts and gravity give it (rigidly, by the model's own mass matrix) take away, so that they
  /// balance. Pieces not named do not turn. Axes of the undeformed frame, rad/s.
  struct Spin {
    std::uint32_t part = 0;  ///< any of the piece
    Vec3 angular_velocity;
  };
  std::vector<Spin> spins = {};
};

/// What is wrong with a structure that cannot carry.
struct Mechanism {
  std::uint32_t node = kNoPart;  ///< frame node where a pivot vanished
  std::string what;              ///< names the node, its storey (height) and members
};

/// Elastic analysis of a frame whose joints break: small displacements, six freedoms per node.
/// A member whose end joint broke hangs on its other end as a cantilever; a part without any joint
/// is gone from the model. Pieces that hang together but not on the ground ("free") are held by a
/// pin at one node, and their inertia balances their loads (inertia relief), so that it carries
/// nothing, whatever its stiffness.
class FrameSolver {
 public:
  /// Keeps a reference to the frame. Throws Error{input} naming member and storey for zero or
  /// absurd stiffness, mechanisms.
  explicit FrameSolver(const Frame& frame, const FrameSolverParams& params = {});
  /// Takes the order of its nodes from another solver of the same frame and slabs (whatever broke
  /// there since): the same bits as without, in less time, and without METIS and the C library's
  /// rand(), so that it may be made in a thread of its own while `like` is at work. Throws
  /// Error{input} besides if the frame's members meet in other ways than those of `like`.
  FrameSolver(const Frame& frame, const FrameSolverParams& params, const FrameSolver& like);
  ~FrameSolver();
  FrameSolver(const FrameSolver&) = delete;
  FrameSolver& operator=(const FrameSolver&) = delete;

  /// Takes joints away and updates the factor exactly: see BlockFactor.
  void break_joints(std::span<const std::uint32_t> joints);
  /// Parts leave the model altogether, with all their joints (they fell off, or were removed).
  void remove_parts(std::span<const std::uint32_t> parts);
  void take_out(std::span<const std::uint32_t> joints,
                std::span<const std::uint32_t> parts);  ///< both at once
  /// So much is left of a slab or wall panel, kg.
  void set_plate_mass(std::uint32_t part, double mass);
  /// Slabs and walls become other elements of the stiffness. What they put on a node passes no
  /// joint there. Throws Error{input} for parts that are none of the parameters' `panels`, and
  /// nodes that are not their corners.
  void set_panels(std::span<const PanelElement> elements);
  /// Of the nodes of an element from where it is at rest, m; none: it takes no part (any more).
  std::optional<Twelve> panel_motion(std::uint32_t part) const;
  /// A plastic hinge at the end of a joint's part a. It turns about the section's axes while its
  /// moments are held, else it is rigid with the rotation that is left. Joint axes, y and z only;
  /// signs as JointLoad, so that moment · rotation is work done.
  struct Hinge {
    std::uint32_t joint = 0;
    Vec3 moment;    ///< held while it flows, N m
    Vec3 rotation;  ///< of the node against the member; followed while it flows, rad
    bool flows = true;
  };
  /// Whether the joint can become a hinge: an intact rigid one of members, whose part a hangs on
  /// both its ends and carries no other there.
  bool can_bend(std::uint32_t joint) const;
  /// Makes joints hinges, or changes them, where they can bend; they go with their joints.
  /// Second order does not see the rotation of hinges.
  void set_hinges(std::span<const Hinge> hinges);
  std::vector<Hinge> hinges() const;  ///< by joint; rotations of the last displacements

  /// Parts that nothing in the model holds any more, not removed: members without joints or on one
  /// hinge, slabs on less than three joints or on joints in line, walls on less than two (of the
  /// ground floor: none). They take part in nothing. Ascending.
  std::vector<std::uint32_t> loose_parts() const;
  /// Joints by which a slab or wall hangs on a free piece and on something else as well: plates
  /// are loads, they hold nothing together. Ascending.
  std::vector<std::uint32_t> bridging_joints() const;
  /// Where what is left moved without resistance; springs hold it. The loads there mean nothing.
  std::vector<Mechanism> mechanisms() const;

  /// Elastic members that turn or twist between their nodes by more than this, rad, or stretch by
  /// this share; by the displacements now.
  std::vector<std::uint32_t> turned_members(double limit) const;
  /// The largest share of the way from other displacements to those now on which none does.
  double share_within(std::span<const double> from, double limit) const;
  /// Those that would turn if the springs of mechanisms() did not carry some of the loads.
  std::vector<std::uint32_t> unresisted_members() const;

  /// Displacements, joint loads and reactions under these loads; refined (at most three times)
  /// while the residual falls and is above 1e-11 and what rounding of the displacements makes.
  void solve(const FrameLoads& loads);
  JointLoad joint_load(std::uint32_t joint) const;  ///< of an intact joint
  Vec3 displacement(std::uint32_t node) const;      ///< m
  Vec3 rotation(std::uint32_t node) const;          ///< rad
  Vec3 reaction(std::uint32_t joint) const;  ///< of a joint to the ground, force on the part, N
  Vec3 reaction_moment(std::uint32_t joint) const;  ///< about the node, N m
  double axial(std::uint32_t member) const;         ///< mean, tension positive, N
  /// What an elastic member carries between its ends, without what panels on its edges ask of it.
  /// False: it hangs as a rigid cantilever, or carries nothing.
  bool find_span(std::uint32_t member, MemberSpan& span) const;
  /// Displacement and rotation (with no loads: their speeds) of a place on an elastic member whose
  /// nodes move so: in balance with what of the last loads is on it, m from its start.
  enum class OnMember : std::uint8_t { nothing, weight, all };
  Six motion_within(std::uint32_t member, double along, std::span<const double> motion,
                    OnMember loads) const;
  /// |K u − f| / |f|, largest norm; printed in every report. In wrecks whose linear displacements
  /// reach kilometres no less than the rounding of u leaves: some 1e-12 per metre.
  double residual() const;
  /// What the pins of free pieces carry, largest, N or N m: 0 but for rounding.
  double pin_force() const;
  /// ½ uᵀ K u, of the elastic part of u where there are hinges, with what panels store, J.
  double strain_energy() const;
  /// Work of these loads on the displacements as they are, J.
  double work_of(const FrameLoads& loads) const;
  /// Of a contact alone on velocities of the freedoms, W. Hinges turn freely.
  double power_of(const FrameLoads::OnPart& contact, std::span<const double> v) const;
  /// What of a part's mass the model carries, kg, and mass × way (or velocity) of its places, kg m:
  /// as its weight is shared by the nodes, so that work_of(weight) is the sum by gravity.
  struct MassWay {
    double mass = 0;
    Vec3 moved;
    Vec3 centre;      ///< of that mass, m
    Vec3 turned;      ///< first moment of mass × way about the centre, kg m²
    SymMat3 inertia;  ///< of that mass, lines and points, about the centre, kg m²
  };
  /// Of these parts alone, in their order. O(their joints, times a logarithm).
  std::vector<MassWay> ways_of_displacements(const std::vector<double>& live,
                                             std::span<const std::uint32_t> parts) const;
  std::vector<MassWay> ways_of(std::span<const double> velocities,  ///< without live loads
                               std::span<const std::uint32_t> parts) const;
  /// Σ moved.y of all parts by the displacements, kg m.
  double height_of_masses(const std::vector<double>& live) const;
  /// Parts whose ways may change as these joints break and these parts are removed with all of
  /// theirs (give those joints too); asked before. Ascending, each once.
  std::vector<std::uint32_t> parts_at(std::span<const std::uint32_t> joints,
                                      std::span<const std::uint32_t> parts) const;
  FactorCounts counts() const;

  // For dynamics: vectors of six numbers per free node (`freedoms`), in an order of their own, then
  // with `tips` of six per member for its free end (0 where it has none).
  std::size_t freedoms() const;
  /// The free end of a member in time, that hangs on the other one; kHeld: it is none.
  std::size_t freedom_of_tip(std::uint32_t member) const;
  /// A free end that came to be: it starts as these six freedoms (kHeld: at rest), moved and turned
  /// so that the member, which bends no more in hinges, is bent as before.
  struct BegunTip {
    std::size_t tip = 0, from = 0;
    Vec3 moved, turned;
  };
  /// Since the last call; the displacements have them.
  std::vector<BegunTip> begun_tips();
  /// Of displacements (bent) or velocities.
  static void begin_tips(std::span<const BegunTip> begun, std::span<double> motion, bool bent);
  /// Brings free ends into balance with the other displacements under these loads.
  void rest_tips(std::span<double> u, const FrameLoads& loads) const;
  /// The first of a node's six; kHeld: a support.
  std::size_t freedom(std::uint32_t node) const;
  static constexpr std::size_t kHeld = static_cast<std::size_t>(-1);
  std::span<const double> displacements() const;
  void set_displacements(std::span<const double> u, const FrameLoads& loads);  ///< then joint loads
  void load_vector(const FrameLoads& loads, std::span<double> f) const;
  void stiffness_times(std::span<const double> u, std::span<double> f) const;  ///< K u
  void mass_times(std::span<const double> a, std::span<double> f) const;  ///< M a, all loads' mass
  void solve_system(std::span<const double> f, std::span<double> u) const;  ///< factored matrix
  /// Nodes that moved as one until breaks since this was asked last: the displacements of both are
  /// what they were; so shall be other motions.
  using Parted = std::vector<std::array<std::uint32_t, 2>>;
  Parted take_parted();
  static void part_motion(const Parted& parted, std::span<double> motion);
  /// With mass in the matrix. Velocities after breaks: those of these parts that the model carries in
  /// another way now (`before`: their ways of the velocities until then) keep their momentum and angular
  /// momentum, as rigid bodies that are joined to what carries them without bouncing back. So
  /// kinetic energy does not grow.
  void keep_momentum(std::span<const std::uint32_t> parts, std::span<const MassWay> before,
                     std::span<double> v) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunder
