// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tests/stress/dice.hpp"

namespace sunder::stress {

using Json = nlohmann::ordered_json;

/// A random scene and the model that it names, if any, as an OBJ file's text.
struct Scene {
  Json json;
  std::string model;  ///< of "model.obj"; empty: none
};

/// Name of the model's file in the scenes that have one.
inline constexpr const char* kModelFile = "@MODEL@";

// All lengths are drawn over decades, all counts small enough for a second or so of work.

/// Walls of every generator: 1 mm to 1 km, far from the origin, as thin as paper, with polygons and
/// openings, with sites on a line, on a lattice, on the border, twice in nearly one place.
Scene wall_scene(Dice& dice);
/// Closed models (blobs, rings, boxes) in every solid pattern, moved and turned.
Scene solid_scene(Dice& dice);
/// The same models with faces missing, turned over or doubled, to be repaired.
Scene broken_model_scene(Dice& dice);
/// Walls that are hit: speeds 0.1 to 1000 m/s, masses over six decades, steps over two.
Scene impact_scene(Dice& dice);
/// Frame buildings that are hit, shaken by a lost post or loaded until they fail, by both solvers.
Scene building_scene(Dice& dice);
/// Frame buildings whose slabs and walls break too.
Scene panel_scene(Dice& dice);

}  // namespace sunder::stress
