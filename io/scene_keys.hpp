// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <iterator>
#include <string_view>
#include <vector>

#include "fracture/solid_model.hpp"
#include "fracture/wall.hpp"
#include "meshing/field.hpp"

namespace sunder {

/// A scene key that is not a plain field of a parameter struct. Like Field, one row feeds the
/// reader, the JSON schema and the documentation.
struct SceneKey {
  std::string_view name;
  std::string_view type;           ///< as the documentation shows it
  std::string_view default_value;  ///< as the documentation shows it
  std::string_view unit;
  std::string_view effect;
  Range range = {};  ///< of each number
};

// Valid values of the keys below.
constexpr Range kSceneVersion{1, 1};
constexpr Range kShapeSize{1e-6, 1e6};   // m
constexpr Range kShapePlace{-1e6, 1e6};  // m
constexpr Range kTurn{-360, 360};        // degrees
constexpr Range kVelocity{-1e5, 1e5};    // m/s

inline constexpr SceneKey kSceneKeys[] = {
    {"$schema", "text", "", "", "Where an editor finds the JSON schema; not read."},
    {"sunder", "integer", "required", "", "Version of the scene format: 1.", kSceneVersion},
    {"seed", "integer", "1", "",
     "Chooses the random numbers; the same seed gives the same bytes. 64 bits."},
    {"walls", "list of walls", "required unless there are solids or a building", "",
     "The walls, see below."},
    {"solids", "list of solids", "[]", "",
     "Models that are fractured as a whole, see below; only `sunder fracture` uses them."},
    {"materials", "list of materials", "[]", "",
     "Materials of the scene's own. One with the name of a built-in material replaces the values "
     "it gives."},
    {"projectiles", "list of projectiles", "[]", "",
     "What hits the walls or the building, see below; `sunder fracture` does not use it."},
    {"building", "building", "none", "",
     "A frame building, see below; `sunder fracture` and `sunder impact` do not use it."},
    {"scenario", "scenario", "{}", "",
     "What happens to the building besides projectiles, see below; needs a building."},
    {"simulation", "simulation", "{}", "",
     "How long and how exactly to simulate, see below; `sunder fracture` does not use it."},
    {"hulls", "hulls", "{}", "",
     "Collision hulls beside the chunks, see below; only `sunder fracture` uses them."},
};

inline constexpr SceneKey kWallKeys[] = {
    {"outline", "shape", "{\"rect\": [6, 3]}", "", "The wall's outline in its own plane."},
    {"openings", "list of shapes", "[]", "",
     "Doors and windows; they may touch the outline and each other but neither cross nor overlap."},
    {"pattern", "pattern", "{\"type\": \"voronoi-grid\"}", "", "How the wall breaks into cells."},
    {"position", "[x, y, z]", "[0, 0, 0]", "m", "Where the wall's origin is in the world.",
     kShapePlace},
    {"rotation_deg", "[x, y, z]", "[0, 0, 0]", "degrees",
     "Turns about the world's x, then y, then z axis through the wall's origin.", kTurn},
};

inline constexpr SceneKey kSolidKeys[] = {
    {"pattern", "solid pattern", "{\"type\": \"voronoi\"}", "", "How the solid breaks into cells."},
    {"craters", "list of craters", "[]", "",
     "What is taken away before the solid is fractured, see below."},
    {"position", "[x, y, z]", "[0, 0, 0]", "m", "Where the model's origin is in the world.",
     kShapePlace},
    {"rotation_deg", "[x, y, z]", "[0, 0, 0]", "degrees",
     "Turns about the world's x, then y, then z axis through the model's origin.", kTurn},
};

inline constexpr SceneKey kCraterKeys[] = {
    {"centre", "[x, y, z]", "required", "m", "In the model's frame, after `scale`.", kShapePlace},
    {"into",
     "[x, y, z]",
     "into the nearest face",
     "",
     "Direction of the depth; any length but 0.",
     kShapePlace},
};

/// Of the field `material`, whose default is not that of a wall with an asset.
inline constexpr std::string_view kAssetMaterial =
    "A wall with \"asset\" and without \"material\" keeps the material of its file.";

inline constexpr SceneKey kProjectileKeys[] = {
    {"position", "[x, y, z]", "required", "m",
     "Its centre at `time`; neither in a wall nor below the ground.", kShapePlace},
    {"velocity", "[x, y, z]", "required", "m/s", "At `time`; at most 100000 m/s in all.",
     kVelocity},
};

inline constexpr SceneKey kShapeKeys[] = {
    {"rect", "[width, height]", "this or polygon", "m", "A rectangle with this size.", kShapeSize},
    {"at", "[x, y]", "[0, 0]", "m", "Lower left corner of the rectangle.", kShapePlace},
    {"polygon", "list of [x, y]", "this or rect", "m",
     "At least three corners in either direction, without self-intersection.", kShapePlace},
};

/// What each generator does, in the order of kPatternTypes.
inline constexpr std::string_view kPatternEffects[] = {
    "Voronoi cells of one random site per grid cell: chunks of like size.",
    "Voronoi cells of sites given by hand.",
    "Voronoi cells of independent uniform sites: chunks of very different sizes.",
    "Voronoi cells of sites that lie denser around the given points, as around an impact.",
    "Quads between the jittered points of a grid.",
    "Local damage around impact points: a polygon with ring and radial cracks, larger cells "
    "elsewhere.",
};
static_assert(std::size(kPatternEffects) == std::size(kPatternTypes));

/// The same of kSolidPatternTypes.
inline constexpr std::string_view kSolidPatternEffects[] = {
    "Voronoi cells of sites in space: uniform in the solid, denser around points, or given.",
    "Slices across each axis.",
    "Rays and rings about an axis, as glass breaks.",
    "Courses of bricks along y.",
};
static_assert(std::size(kSolidPatternEffects) == std::size(kSolidPatternTypes));

/// Letters that names may have: they end up in files that other programs read. At most 40, so that
/// "<name>_chunk_000000" stays below 57.
constexpr std::size_t kMaxNameLength = 40;
inline constexpr std::string_view kNamePattern = "^[A-Za-z0-9_-]{1,40}$";

/// Appends the names of a table's rows.
template <std::size_t count>
void append_keys(std::vector<std::string_view>& keys, const SceneKey (&table)[count]) {
  for (const SceneKey& row : table) keys.push_back(row.name);
}

}  // namespace sunder
