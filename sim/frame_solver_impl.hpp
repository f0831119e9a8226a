// SPDX-License-Identifier: GPL-3.0-or-later
// What the files of the static solver share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/block_factor.hpp"
#include "sim/block_matrix.hpp"
#include "sim/frame_links.hpp"
#include "sim/frame_solver.hpp"
#include "sim/member_response.hpp"
#include "sim/member_span.hpp"
#include "sim/plate_support.hpp"

namespace sunder {

/// J += m (r² 1 − r rᵀ).
void add_moment(SymMat3& inertia, double mass, Vec3 r);

/// Acceleration that loads the masses of a piece (gravity less its own), linear in space.
struct MassField {
  Vec3 origin, value;       ///< m; m/s² at the origin
  Vec3 acceleration, spin;  ///< angular, rad/s² and rad/s
  Vec3 at(Vec3 point) const {
    const Vec3 arm = point - origin;
    return value - cross(acceleration, arm) - cross(spin, cross(spin, arm));
  }
  bool turns() const { return !(acceleration == Vec3{} && spin == Vec3{}); }
};

struct FrameSolver::Impl {
  Impl(const Frame& frame_to_hold, const FrameSolverParams& parameters, const Impl* like);

  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  static constexpr double kLoadGravity = 9.81;  ///< m/s² by which a live load becomes mass
  /// elastic: an element of the stiffness. hanging: a rigid cantilever at its held end.
  enum class Role : std::uint8_t { elastic, hanging, loose, removed };
  struct PointMass {
    std::uint32_t joint = 0;
    double at = 0, mass = 0;  ///< m from the start, kg
  };
  /// What every solve reads; the rest is in arrays beside, by member.
  struct Member {
    Vec3 start;
    MemberResponse response;     ///< of an elastic one; axes and length always
    double mass = 0, polar = 0;  ///< its own, kg/m and kg m
    double plate_mass = 0;       ///< of slabs and walls, kg/m
    Role role = Role::loose;
    int held_end = 0;                                 ///< of a hanging one, or with a tip
    bool tip = false;                                 ///< elastic, its free end moves on its own
    std::array<std::uint32_t, 2> node{kNone, kNone};  ///< solver nodes; FrameLinks' kFixed, kFree
    Vec3 at(double along) const { return start + along * response.axes.x; }
    bool present() const { return role == Role::elastic || role == Role::hanging; }
  };
  /// Two crossed bars in place of a slab, with their stiffness EA/L.
  struct Diaphragm {
    std::array<BlockChange, 2> bars{BlockChange{kNone, kNone, {}}, BlockChange{kNone, kNone, {}}};
    std::array<double, 2> stiffness{};
    bool active = false;
    double flow = 0;  ///< shear along its first edge by the last displacements, N/m
  };
  /// A member with plastic hinges; moments and rotations (of its nodes against its ends) in its own
  /// axes, of y and z.
  struct Bent {
    std::uint32_t member = kNone;
    BeamElement element;      ///< as if the hinges were rigid
    MemberResponse response;  ///< of that
    Twelve fixed{};           ///< and so loaded
    std::array<std::uint32_t, 2> joint{kNone, kNone};
    std::array<Vec3, 2> moment{}, rotation{};
    std::array<bool, 2> flows{};
  };
  /// A slab or wall as an element of the stiffness.
  struct Panel {
    PanelElement element;
    Twelve pull{};  ///< on nodes that stand where the frame was drawn, N
    std::array<std::uint32_t, 4> member{kNone, kNone, kNone, kNone};  ///< along each edge
    std::array<std::uint32_t, 4> joint{kNone, kNone, kNone, kNone};   ///< of the panel with it
    std::array<std::uint32_t, 4> node{kNone, kNone, kNone, kNone};    ///< solver nodes; kFixed
    bool is_new = false;                ///< the element is not in the factor yet
    bool is_lost = false;               ///< takes no part any more
    std::array<BlockChange, 6> blocks;  ///< in the factor
  };
  /// What holds together but not to the ground.
  struct Piece {
    std::uint32_t pin = kNone;  ///< its lowest solver node
    double mass = 0;
    Vec3 centre;
    SymMat3 inertia;  ///< about the centre, world
  };
  /// The free end of a member in time: what is condensed out of the matrix, and its mass; couplings
  /// are rows of the held end.
  struct Tip {
    std::uint32_t member = 0, node = kNone;  ///< the held end's solver node; kFixed
    Matrix6 inverse{}, coupling{}, mass{}, mass_coupling{};
  };
  /// Velocities of a rigid motion.
  struct RigidField {
    Vec3 centre, velocity, spin;
  };
  /// Springs against a motion that nothing resists.
  struct Restraint {
    std::uint32_t node = kNone;
    BlockChange block;
  };

  /// What contacts do to the members they are on and the joints of plates that pass them on.
  struct ContactLoads {
    std::vector<std::pair<std::uint32_t, Twelve>> members;    ///< what holds their nodes
    std::vector<std::pair<std::uint32_t, JointLoad>> plates;  ///< by joint, on the carrier
  };
  /// All masses in a unit field along each axis, as far as asked for since the model changed.
  struct Weight {
    std::vector<double> live;  ///< of these loads
    std::array<bool, 3> known{};
    std::array<std::vector<Twelve>, 3> fixed;
    std::array<std::vector<double>, 3> f;  ///< nodal, as if hinges were rigid
  };
  /// What `fixed` and `plate_loads` hold: the weight but for these members and joints.
  struct Laid {
    bool weight = false;   ///< else they are to be written anew
    bool carries = false;  ///< `forces` and `stiff` are those of `loads` and `u`
    FrameLoads loads;
    std::vector<std::uint32_t> members, joints;
  };

  // frame_stiffness.cpp: what can be wrong, and what the members are.
  void check() const;
  void make_members();
  void make_diaphragms();
  void make_masses(const FrameLinks::Edges& edges);
  Role role_of(std::uint32_t m, int& held_end) const;
  Matrix12 mass_matrix(std::uint32_t m) const;
  Matrix12 mass_matrix(std::uint32_t m, const BeamElement& element,
                       std::span<const PointMass> heavy) const;
  void renew(std::uint32_t m);  ///< role, element, stiffness from the links
  void renew_in_factor(std::uint32_t m);
  void set_mass(std::uint32_t m, const BlockChange& next);
  void put(const BlockChange& change);
  void set_in_factor(BlockChange& now, const BlockChange& next);
  void renew_diaphragm(std::uint32_t slab);
  std::string where(std::uint32_t node) const;

  // frame_tips.cpp: members in time that one end let go of.
  /// Its solver node.
  std::uint32_t tip_of(std::uint32_t m) const { return links.node_count() + m; }
  Matrix12 condense_tip(std::uint32_t m, const Matrix12& matrix, const Matrix12& mass);
  void begin_tip(std::uint32_t m, std::uint32_t from);
  void add_mass_of_tips(std::span<const double> x, std::span<double> y) const;
  void solve_with_tips(std::span<const double> f, std::span<double> x) const;

  // frame_changes.cpp: what changes as joints break.
  void update(std::vector<std::uint32_t> members, std::vector<std::uint32_t> plates);
  void renew_plate(std::uint32_t plate);
  void lay_plate(const PlateSupport& plate, double sign);
  void find_pieces();
  void pin_pieces();
  void restrain_rotations();
  void refactor();

  // frame_hinges.cpp: members that bend for good.
  bool can_bend(std::uint32_t joint) const;
  const BeamElement& unbent(std::uint32_t m) const;  ///< the element as if hinges were rigid
  void set_hinges(std::span<const Hinge> hinges);
  void bend(std::uint32_t m);
  static Twelve plastic_motion(const Bent& b, const std::array<Vec3, 2>& rotation);
  static std::array<Vec3, 2> plastic_rotations(const Bent& b, const Twelve& force);
  void load_hinges();
  void turn_hinges();
  double strain_of_hinges() const;
  double work_of(const FrameLoads& loads);
  double power_of(const FrameLoads::OnPart& contact, std::span<const double> v);

  // frame_ways.cpp: how far masses move.
  struct LineWay {
    Vec3 moved, turned;
  };
  void held_under_each(std::uint32_t m, std::span<const BeamLoad> loads,
                       std::span<Twelve> held_nodes) const;
  Twelve elastic_motion(std::uint32_t m, std::span<const double> motion, bool bends) const;
  LineWay line_way(std::uint32_t m, const Twelve& motion) const;
  Vec3 point_way(std::uint32_t m, Vec3 point, const Twelve& motion) const;
  std::vector<std::uint32_t> members_under(std::span<const std::uint32_t> parts) const;
  template <class Visit>
  void each_share(const PlateSupport& plate, const std::vector<double>& live,
                  const Visit& visit) const;
  std::vector<MassWay> mass_ways(std::span<const double> motion, const std::vector<double>& live,
                                 bool bends, std::span<const std::uint32_t> parts) const;
  double line_height(std::uint32_t m, const Twelve& motion);
  double height(const std::vector<double>& live);
  std::vector<std::uint32_t> parts_at(std::span<const std::uint32_t> joints,
                                      std::span<const std::uint32_t> going) const;

  // frame_momentum.cpp: what breaks leave of motion.
  std::vector<FrameLinks::End> ends_at(std::uint32_t frame_node) const;
  void note_parted(std::uint32_t frame_node, const std::vector<FrameLinks::End>& were);
  void add_missing(std::uint32_t m, const Matrix12& mass, const RigidField& field,
                   std::span<const double> v, std::span<double> missing) const;
  void add_missing(std::uint32_t part, const RigidField& field, std::span<const double> v,
                   std::span<double> missing) const;
  void mass_times(std::span<const double> a, std::span<double> force) const;
  void add_velocities(std::vector<double>& left, std::span<double> x) const;
  void keep_momentum(std::span<const std::uint32_t> parts, std::span<const MassWay> until,
                     std::span<double> v) const;

  // frame_range.cpp: how far members turn.
  double turn_at(std::uint32_t m, std::span<const double> motion) const;

  // frame_panels.cpp: slabs and walls that are elastic.
  void add_panel_edges(FrameLinks::Edges& edges) const;
  void make_panels();
  void take_element(Panel& panel, const PanelElement& element) const;
  void set_panels(std::span<const PanelElement> wanted);
  void place_edges(Panel& panel) const;
  void place_corners(Panel& panel) const;
  void renew_panels();
  Twelve motion_of(const Panel& panel, std::span<const double> motion, bool from_rest) const;
  static void add_at_corners(const Panel& panel, const Twelve& force, std::span<double> result);
  void add_panels(std::span<const double> motion, std::span<double> result) const;
  void add_panel_loads(std::span<double> result) const;
  double strain_of_panels() const;

  // frame_loads.cpp: from loads to nodal forces.
  void collect(const FrameLoads& loads, std::span<double> f);
  Twelve held_under(std::uint32_t m, const BeamLoad& load) const;
  BeamLoad::Point point_on(std::uint32_t m, Vec3 point, Vec3 force, Vec3 moment) const;
  Twelve held_at(std::uint32_t m, Vec3 point, Vec3 force, Vec3 moment) const;
  void add_load(std::uint32_t m, const BeamLoad& load);
  const ContactLoads& contacts_of(const FrameLoads& loads);
  std::vector<std::pair<std::uint32_t, JointLoad>> shares_of(
      std::uint32_t plate, const FrameLoads::OnPart& contact) const;
  void share_contact(std::uint32_t plate, const FrameLoads::OnPart& contact);
  void lay_live(const std::vector<double>& live);
  void add_field(std::uint32_t m, const MassField& field);
  void add_turning(std::uint32_t m, double line, const MassField& field);
  double line_mass(std::uint32_t m) const;
  void weigh_pieces();
  void relieve_pieces();
  void weigh_plates(const FrameLoads& loads);
  Vec3 plate_weight(const PlateSupport& plate, std::uint32_t i, const FrameLoads& loads) const;
  void sum_at_nodes(std::span<double> result) const;
  std::uint32_t piece_of(const Member& member) const;

  // frame_weight.cpp: the same where nothing flies, from what changes between two loads.
  void know_weight(const FrameLoads& loads);
  Twelve held_by(std::uint32_t m, const FrameLoads& loads, const ContactLoads& contacts) const;
  void nodal_load(const FrameLoads& loads, std::span<double> result);
  void lay(const FrameLoads& loads);
  void unlay();
  double work_on_elastic(const FrameLoads& loads);
  bool carries(std::span<const double> motion, const FrameLoads& loads) const;

  // frame_spans.cpp: members between their ends.
  struct PointLoad {
    std::uint32_t member = 0;
    BeamLoad::Point point;
    bool by_plate = false;  ///< a slab or wall passes it on
  };
  void list_points();
  std::vector<PointLoad> points_of(std::uint32_t m, bool with_contacts);
  Vec3 pull_at(std::uint32_t m, Vec3 point) const;
  bool find_span(std::uint32_t m, MemberSpan& span);
  Six motion_within(std::uint32_t m, double along, std::span<const double> motion, OnMember loads);

  // frame_solver.cpp: breaking, and from displacements to forces.
  void break_joints(std::span<const std::uint32_t> joints);
  Twelve displacements_of(const Member& member, std::span<const double> motion) const;
  Twelve end_force(std::uint32_t m, const Twelve& motion) const;
  void shear_diaphragm(std::uint32_t slab);
  Vec3 diaphragm_shear(std::uint32_t joint) const;
  void add_diaphragms(std::span<const double> motion, std::span<double> result) const;
  void recover();
  void add_spring(const Restraint& spring, std::span<double> force) const;
  double rest_of(std::span<const double> motion);
  void solve_refined();
  void iterate_second_order();
  Vec3 displacement(std::uint32_t frame_node) const;
  double axial(std::uint32_t m) const;
  JointLoad through(std::uint32_t joint);  ///< on part a, world
  template <class Apply>
  void sum_members(std::span<const double> motion, std::span<double> result,
                   const Apply& apply) const;

  const Frame& frame;
  const FrameSolverParams params;
  FrameLinks links;
  std::vector<Member> members;
  std::vector<BeamElement> elements;                 ///< of the members
  std::vector<std::vector<PointMass>> point_masses;  ///< of walls that hang, per member
  std::vector<BlockChange> in_factor;                ///< per member
  std::optional<BlockMatrix> masses;                 ///< if it is in the factor
  std::vector<BlockChange> in_mass;                  ///< per member
  std::vector<Bent> bent;                            ///< by when they first had a hinge
  std::vector<std::uint32_t> bent_of;                ///< per member; kNone: it has none
  std::vector<Twelve> height_rows;                   ///< of a metre's mass on a member, if known
  std::vector<std::uint8_t> height_known;            ///< per member, since it was renewed
  std::vector<Tip> tips;                             ///< by member
  std::vector<BegunTip> begun;                       ///< not yet told of
  std::vector<double> axial_in_factor;               ///< N, of the geometric stiffness
  std::vector<PlateSupport> plates;
  std::vector<std::vector<std::uint32_t>> plates_on;  ///< per member
  std::vector<Diaphragm> diaphragms;                  ///< per slab; none for "load"
  std::vector<Panel> panels;                          ///< by part
  std::vector<std::uint8_t> gone;                     ///< per part: removed
  std::vector<std::uint32_t> piece_of_node;           ///< kNone: on the ground
  std::vector<Piece> pieces;
  std::vector<std::uint32_t> idle;         ///< solver nodes without members, ascending
  /// Solver nodes that came into use since part_motion(), and what they moved with before.
  std::vector<std::array<std::uint32_t, 2>> parted;
  std::vector<std::uint32_t> pinned;       ///< solver nodes, ascending
  std::vector<Restraint> rotations, held;  ///< held: where a pivot vanished
  double pin_stiffness = 0, pin_turn = 0;  ///< N/m, N m/rad
  bool any_hinge = false;
  std::optional<BlockFactor> factor;  ///< none without solver nodes
  bool built = false;
  std::vector<BlockChange> changes;       ///< not yet in the factor
  std::vector<std::uint8_t> to_restrain;  ///< solver nodes whose members changed

  // Of the last loads.
  std::vector<double> live_line;       ///< kg/m that live loads add; empty: none
  std::vector<Twelve> fixed, forces;   ///< per member: of the nodes on it, world
  std::vector<MassField> fields;       ///< per piece; last: what stands on the ground
  std::vector<JointLoad> plate_loads;  ///< per joint: force and torque on the carrier, world
  Weight weight;
  Laid laid;
  ContactLoads contact_loads;
  std::vector<PointLoad> points;  ///< contacts of `laid`, by member, if they are known
  bool points_known = false;
  std::vector<double> f, u;
  std::vector<double> stiff;         ///< stiffness × u
  std::vector<double> rest, before;         ///< of the refinement
  std::vector<std::uint32_t> ends_through;  ///< of through()
};

}  // namespace sunder
