// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fracture/wall.hpp"
#include "meshing/field.hpp"
#include "sim/joint_strength.hpp"
#include "sim/material.hpp"
#include "sim/section.hpp"
#include "sim/spin.hpp"

namespace sunder {

constexpr std::uint32_t kNoPart = 0xFFFFFFFFu;

/// Where members meet. Y up, m.
struct FrameNode {
  std::string name;
  Vec3 position;
  bool support = false;  ///< held by the ground, all six freedoms
};

/// A straight steel member between two nodes. Members meet at nodes only: one that passes a node
/// without ending there is not connected with it.
struct FrameMember {
  enum class Kind : std::uint8_t { post, beam };
  std::string name;
  Kind kind = Kind::beam;
  std::uint32_t from = 0, to = 0;  ///< nodes; of a post `from` is the lower one
  std::uint32_t section = 0, steel = 0;
  double roll = 0;  ///< about the member's axis, rad, right-handed from→to
};

/// A floor between four nodes, on the beams between them; rests on top of the beams.
struct FrameSlab {
  std::string name;
  std::array<std::uint32_t, 4> nodes{};  ///< corners, in order around
  std::array<std::uint32_t, 4> beams{};  ///< beams[i] joins nodes[i] and nodes[(i+1)%4]; members
  double thickness = 0;                  ///< m
  std::uint32_t material = 0;
  double live_load = 0;             ///< N/m², as mass (by 9.81 m/s²) that moves with the slab
  std::uint32_t pattern = kNoPart;  ///< that it breaks by; kNoPart: it stays whole
};

/// A wall panel in a bay of the facade, between two posts, a lower and an upper beam.
struct FrameWall {
  std::string name;
  std::array<std::uint32_t, 4> nodes{};  ///< lower left, lower right, upper right, upper left
  /// Members: lower beam, right post, upper beam, left post; kNoPart: none (ground floor).
  std::array<std::uint32_t, 4> edges{kNoPart, kNoPart, kNoPart, kNoPart};
  double thickness = 0;
  std::uint32_t material = 0;
  std::uint32_t pattern = kNoPart;  ///< as a slab's
};

/// How slabs and wall panels break: by a pattern, or into the chunks of a wall that
/// `sunder fracture` wrote.
struct PanelPattern {
  PatternParams pattern;
  double min_cell = -1;  ///< as Wall's
  std::string asset;     ///< the file; empty: none
};

/// How a kind of joint is made. The six thresholds are either given, as the paper does: two vectors
/// times an overall strength; or they follow from the section and steel of the member that ends.
struct JointClass {
  std::string name;        ///< "post", "beam", "slab", "wall" or the scene's own
  double strength = 1;     ///< overall factor
  Vec3 force{}, torque{};  ///< N and N m; both zero: from section and steel
  std::string interaction = "linear";
  bool rigid = true;      ///< false: the parts turn freely about the joint (no torque passes)
  bool bearing = false;   ///< compression passes by contact (splices and bases of posts)
  double friction = 0.6;  ///< mohr: tan φ
  /// How far the end of a member turns in a plastic hinge before the joint parts, rad; 0: brittle.
  double rotation_capacity = 0;
};
template <>
std::span<const Field<JointClass>> fields();  ///< the plain keys; force and torque beside them

/// "post", "beam", "slab" and "wall" as they are unless the frame has its own. Posts and beams take
/// the plastic resistances of their section, posts bear by contact. Slabs and walls have no
/// section: 0.3 MN and 0.1 MN m per axis unless their class says else, the ellipsoid of all six:
/// about four headed studs of 19 mm, 81.7 kN each (EN 1994-1-1, 6.6.3.1), in a row of about a
/// metre.
std::vector<JointClass> built_in_classes();

/// A connection that can break. Part numbers count members, then slabs, then walls (see
/// part_count).
struct FrameJoint {
  /// inside: between the two parts of a beam that divided; of a post that is a splice too.
  enum class Kind : std::uint8_t { base, splice, beam_end, slab, wall, inside };
  /// "<part a>@<part b>", "<part a>@ground"; "<part a>@ground@<node>" if both its ends are held
  std::string name;
  Kind kind = Kind::beam_end;
  std::uint32_t a = 0;                ///< the part that ends here
  std::uint32_t b = kNoPart;          ///< the part that carries it; kNoPart: the ground
  std::uint32_t node = kNoPart;       ///< of members; kNoPart for slabs and walls
  std::uint8_t end_a = 2, end_b = 2;  ///< of members: 0 from, 1 to; 2: in between, or not a member
  Vec3 point;                         ///< world, m
  /// x along the member that ends, y and z those of its section. Slabs and walls: x from the
  /// carrier into the slab (up) or the wall, y along the carrier.
  Axes axes;
  JointStrength strength;
  std::uint32_t joint_class = 0;
  std::uint8_t edge = 0;  ///< of slabs and walls: along which of their four edges
  double share = 1;       ///< of that edge's length
};

/// A building as data. Everything that analyses or moves it (rigid bodies, the static solver) reads
/// this and nothing else.
struct Frame {
  std::vector<FrameNode> nodes;
  std::vector<FrameMember> members;
  std::vector<FrameSlab> slabs;
  std::vector<FrameWall> walls;
  std::vector<FrameJoint> joints;
  std::vector<Section> sections;
  std::vector<SteelGrade> steels;
  std::vector<Material> materials;
  std::vector<JointClass> classes;
  std::vector<PanelPattern> patterns;

  std::uint32_t part_count() const {
    return static_cast<std::uint32_t>(members.size() + slabs.size() + walls.size());
  }
  std::uint32_t slab_part(std::uint32_t slab) const {
    return static_cast<std::uint32_t>(members.size()) + slab;
  }
  std::uint32_t wall_part(std::uint32_t wall) const {
    return static_cast<std::uint32_t>(members.size() + slabs.size()) + wall;
  }
  const std::string& part_name(std::uint32_t part) const;
  double length(const FrameMember& member) const;  ///< between its nodes, m
};

/// Axes of a member: x from→to; z along the web: up for beams, along world z for posts (world x for
/// what is parallel to z and upright), before `roll`; y = z × x.
Axes axes_of(const Frame& frame, const FrameMember& member);

/// The number of a pattern among the frame's, which gets it; kNoPart for none.
std::uint32_t add_pattern(Frame& frame, const std::optional<PanelPattern>& pattern);

/// A joint that is asked for by name of its parts, when the default ones are not wanted.
struct GivenJoint {
  std::string of, to, at;   ///< part names ("ground" for to), node name
  std::string joint_class;  ///< empty: by kind
};

/// Fills frame.joints. Default (no `given`): a post's foot on the post below it or on the ground if
/// its node is a support; a beam's ends on the post below the node, else the post above, else the
/// member of lowest number that goes on; a slab on the middles of its four beams; a wall on those
/// of its edges. `given` replaces those of members. Strengths follow from the classes. O(parts).
void join(Frame& frame, const std::vector<GivenJoint>& given = {});

/// A member is about to be taken away: what it carried at its nodes is carried by the next in rank
/// there (a post above, else a beam), so that the others still meet. Returns the joints whose part
/// b changed; joints of the member itself stay as they are. O(joints at its nodes), after a search.
std::vector<std::uint32_t> hand_over_joints(Frame& frame, std::uint32_t member);

/// What is wrong with a frame, as data.
struct FrameDefect {
  std::string part;  ///< name of the node, member, slab, wall or joint
  std::string what;  ///< "has zero length", "is not connected to the ground", …
};
/// Members of zero length or beyond sizes (1 mm … 1 km), that meet nothing, joints to nothing,
/// parts without a way to a support (disconnected storeys; the first few by name), two members
/// between the same nodes, posts on their head, slabs that are not level and convex, walls that are
/// no upright rectangle, names that occur twice, no support. Empty: sound. O(parts log parts).
std::vector<FrameDefect> defects_of(const Frame& frame);

/// A regular frame: posts × rows, storeys, bays; x to the right, z towards the viewer, the first
/// post at the origin.
struct StoreyParams {
  double height = 3.5;  ///< m
  std::string post_section = "HEB300", beam_section = "IPE300", steel = "s235";
  double slab_thickness = 0.15;  ///< m; 0: none
  std::string slab_material = "concrete-c30";
  double wall_thickness = 0;  ///< m; 0: none
  std::string wall_material = "brick";
  double live_load = 0;                                    ///< N/m²
  std::optional<PanelPattern> slab_pattern{}, wall_pattern{};  ///< none: they stay whole
  /// Range of bays that this storey has along x and z, [first, end): set-backs.
  std::array<std::uint32_t, 2> bays_x{0, 0xFFFFFFFFu}, bays_z{0, 0xFFFFFFFFu};
};
struct RegularBuilding {
  std::vector<double> bays_x{6}, bays_z{6};  ///< m: posts = bays + 1
  std::vector<StoreyParams> storeys{1};
  Vec3 position;  ///< of the first post's foot
  /// Names of parts that are left out; '*' stands for any text: an atrium is "slab_1_1_*". Beams
  /// and posts that are left out take the slabs and walls that rest on them along.
  std::vector<std::string> without;
};
/// Names: post_<x>_<z>_<storey>, beam_x_<x>_<z>_<storey> (along x, from post x to x+1),
/// beam_z_…, slab_<x>_<z>_<storey>, wall_x_…, wall_z_…; nodes node_<x>_<z>_<level>, storeys and
/// levels from 0. Fills nodes, members, slabs, walls; sections, steels, materials must hold what it
/// names, else Error{input}. Joints: see join.
void add_regular(Frame& frame, const RegularBuilding& building);

/// A part as a solid: a prism in a frame of its own. For members x of the outline is local y, y is
/// local z of axes_of(member), and the prism's z runs from → to; for slabs the outline lies in plan
/// and z points up; for walls as a wall's. Posts go from node to node; beams end `kJointGap` short
/// of the posts' faces; slabs lie on their beams with corners cut for the posts; walls fill the bay
/// between the steel and the floors, `kJointGap` short all around. Members weigh as much as from
/// node to node and slabs as much as their whole bay, so that the building's weight is that of its
/// drawing; inertia is that of the prism as it stands, with that mass.
struct PartSolid {
  Region outline;          ///< drawn, m
  std::vector<Vec2> hull;  ///< collides: convex, counter-clockwise
  double half_length = 0;  ///< along z, m
  Vec3 centre;             ///< world
  Axes axes;               ///< x, y, z of the prism in the world
  double mass = 0;         ///< kg, live load included
  SymMat3 inertia;         ///< about the centre, prism axes, kg m²
  std::string material;    ///< "steel", or of slab or wall
};
/// Between the slab's nodes, in plan, m².
double slab_area(const Frame& frame, std::uint32_t slab);
constexpr double kJointGap = 0.005;                          // m
PartSolid solid_of(const Frame& frame, std::uint32_t part);  ///< O(parts): for many, solids_of
std::vector<PartSolid> solids_of(const Frame& frame);        ///< of all parts, by number; O(parts)

}  // namespace sunder
