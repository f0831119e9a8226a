// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

#include "io/scene_keys.hpp"
#include "sim/collapse.hpp"
#include "sim/frame.hpp"

// Keys of "building" and "scenario". One row feeds the reader, the schema and the documentation.
namespace sunder {

constexpr std::size_t kMaxParts = 200000;       // members, slabs and wall panels of a building
constexpr std::size_t kMaxBuildingList = 1000;  // entries of lists that are searched

constexpr Range kBuildingPlace{-1e5, 1e5};  // m
constexpr Range kPosts{2, 1000};
constexpr Range kStoreys{1, 1000};
constexpr Range kStoreyNumber{0, 999};
constexpr Range kBayNumber{0, 999};
constexpr Range kBay{0.1, 1000};            // m
constexpr Range kStoreyHeight{0.1, 1000};   // m
constexpr Range kThreshold{0, 1e12, true};  // N or N m
constexpr Range kLoadRate{0, 1e9};          // N/m² per s

inline constexpr std::string_view kSectionNamePattern = "^[A-Za-z0-9_.-]{1,40}$";
inline constexpr std::string_view kPartPattern = "^[A-Za-z0-9_*-]{1,40}$";  // of `without`

inline constexpr SceneKey kBuildingKeys[] = {
    {"posts", "[along x, along z]", "[2, 2], or as many as \"bay\" lists need", "",
     "Posts of the regular building.", kPosts},
    {"storeys", "integer", "1", "", "Storeys of the regular building.", kStoreys},
    {"storey_height", "number", "3.5", "m", "Between the axes of the beams.", kStoreyHeight},
    {"bay", "[along x, along z]", "[6, 6]", "m",
     "Between the axes of posts: each a length, or a list of lengths, one fewer than posts.", kBay},
    {"slab", "slab or false", "{}", "", "The floor slab of every bay, see below; false: none."},
    {"walls", "wall panel or false", "false", "",
     "A panel in every bay of the facade, see below; false: none."},
    {"position", "[x, y, z]", "[0, 0, 0]", "m",
     "Where the first post's foot is in the world; given nodes count from here too.",
     kBuildingPlace},
    {"overrides", "list of overrides", "[]", "",
     "Storeys that differ, see below; at most 1000, later ones win."},
    {"without", "list of texts", "[]", "",
     "Parts of the regular building that are left out, with what rests on them; `*` stands for any "
     "text: `slab_1_1_*` makes an atrium. At most 1000."},
    {"joints", "object of joint classes", "{}", "",
     "How joints are made, see below: `post`, `beam`, `slab`, `wall` and names of the scene's own "
     "that connections use."},
    {"nodes", "list of nodes", "[]", "",
     "Where members given one by one meet, see below. With nodes and none of posts, storeys and "
     "bay, there is no regular building."},
    {"members", "list of members", "[]", "", "Posts and beams given one by one, see below."},
    {"slabs", "list of slabs", "[]", "", "Floor slabs given one by one, see below."},
    {"wall_panels", "list of wall panels", "[]", "", "Wall panels given one by one, see below."},
    {"connections", "list of connections", "[]", "",
     "What members are joined to, see below; left out, it follows from where they meet. One "
     "connection or more: members have no others."},
    {"sections", "list of sections", "[]", "",
     "Cross-sections of the scene's own, see below; at most 1000. One with the name of a built-in "
     "section "
     "replaces the values it gives."},
    {"steels", "list of steels", "[]", "",
     "Steel grades of the scene's own, see below; at most 1000. One with the name of a built-in "
     "grade replaces "
     "the values it gives."},
};

inline constexpr SceneKey kOverrideKeys[] = {
    {"storeys", "[first, last]", "required", "", "Both included; the lowest is 0.", kStoreyNumber},
    {"height", "number", "storey_height", "m", "Between the axes of the beams.", kStoreyHeight},
    {"slab", "slab or false", "as before", "", "Changes the keys it gives; false: none."},
    {"walls", "wall panel or false", "as before", "", "Changes the keys it gives; false: none."},
    {"bays_x", "[first, end]", "all", "",
     "Bays along x that these storeys have, for set-backs; the lowest is 0, `end` is not included.",
     kBayNumber},
    {"bays_z", "[first, end]", "all", "", "The same along z.", kBayNumber},
};

/// Beside the thickness and material of the panels in every bay.
inline constexpr SceneKey kPanelKeys[] = {
    {"pattern", "pattern", "none", "",
     "How it breaks, as a wall's; without, and without `asset`, it stays whole."},
    {"asset", "text", "none", "",
     "A wall that `sunder fracture` wrote, relative to the scene and inside its folder, instead of "
     "`pattern`: as large as the panel, bottom and left side first."},
};

inline constexpr SceneKey kJointKeys[] = {
    {"force", "[x, y, z]", "from section and steel", "N",
     "Thresholds before `strength`: along the member, along its section's y and z. Goes with "
     "`torque`.",
     kThreshold},
    {"torque", "[x, y, z]", "from section and steel", "N m",
     "Thresholds before `strength`, about the same axes. Goes with `force`.", kThreshold},
};

inline constexpr SceneKey kNodePlace{
    "at", "[x, y, z]", "required", "m", "From the building's position.", kBuildingPlace};

inline constexpr SceneKey kSlabNodes{"nodes", "four names", "required", "",
                                     "Of nodes, in order around; there is a beam from each to the "
                                     "next."};
inline constexpr SceneKey kPanelNodes{"nodes", "four names", "required", "",
                                      "Of nodes: lower left, lower right, upper right, upper left; "
                                      "there is a member from each to the "
                                      "next, but between two supports."};

inline constexpr SceneKey kScenarioKeys[] = {
    {"remove", "list of texts", "[]", "",
     "Names of parts that are taken away at time 0; at most 1000."},
    {"load_rate", "number", "0", "N/m² per s",
     "By which the live load of every slab rises from time 0 until the first joint or post fails.",
     kLoadRate},
    {"ground_motion", "text", "none", "",
     "A CSV file relative to the scene and inside its folder, rows of time, ax or time, ax, ay, az "
     "in s and m/s²: the acceleration of the ground."},
};

/// Of "slab": the floor of every bay.
struct SlabParams {
  double thickness = 0.15;  ///< m
  std::string material = "concrete-c30";
};
/// Of "walls": the panels of the facade.
struct PanelParams {
  double thickness = 0.1;  ///< m
  std::string material = "brick";
};
/// A member given by itself; what is empty is as in the rest of the building.
struct GivenMember {
  std::string name, from, to, section, steel, kind;
  double roll_deg = 0;
};
/// Below 0: as in the rest of the building.
struct GivenSlab {
  std::string name;
  double thickness = -1;
  std::string material;
  double live_load = -1;
};
struct GivenPanel {
  std::string name;
  double thickness = -1;
  std::string material;
};

template <>
std::span<const Field<StoreyParams>> fields();  ///< what building and overrides have in common
template <>
std::span<const Field<SlabParams>> fields();
template <>
std::span<const Field<PanelParams>> fields();
template <>
std::span<const Field<FrameNode>> fields();
template <>
std::span<const Field<GivenMember>> fields();
template <>
std::span<const Field<GivenSlab>> fields();
template <>
std::span<const Field<GivenPanel>> fields();
template <>
std::span<const Field<GivenJoint>> fields();

/// Of a joint class, whose name is its key.
inline std::span<const Field<JointClass>> joint_fields() {
  return fields<JointClass>().subspan(1);
}

}  // namespace sunder
