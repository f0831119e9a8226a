// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/error_front.hpp"
#include "fracture/hulls.hpp"
#include "fracture/solid_model.hpp"
#include "fracture/wall.hpp"
#include "sim/collapse.hpp"
#include "sim/frame.hpp"
#include "sim/material.hpp"
#include "sim/projectile.hpp"
#include "sim/simulation_params.hpp"

namespace sunder {

/// A scene file.
struct Scene {
  std::uint64_t seed = 1;
  std::vector<Wall> walls;
  std::vector<SolidModel> solids;
  std::vector<Material> materials;  ///< built in, then the scene's own
  std::vector<Projectile> projectiles;
  std::optional<Frame> building;  ///< sound and joined
  BreakingRules rules;            ///< of the building's posts and joints
  Scenario scenario;
  std::filesystem::path ground_motion_file;  ///< that the scenario names; empty: none
  SimulationParams simulation;
  std::optional<ErrorChoice> error_choice;  ///< of a scene that gives max_error
  HullParams hulls;
  std::vector<std::string> keys;  ///< top-level keys that the file gives, in its order
};

/// Those of `keys` that the scene's file gives: what a verb has no use for, and says so.
std::vector<std::string> given_keys(const Scene& scene,
                                    std::initializer_list<std::string_view> keys);

struct SceneParams {
  /// "a.b=value" as --set gives them, applied before checking.
  std::vector<std::string> overrides = {};
  bool allow_outside = false;  ///< paths may leave the scene's folder
};

/// Reads and checks a scene. A wall that is an asset and gives no material has an empty one: that
/// of its file. Throws Error{input}: `file:line: /json/pointer: what, value, what would be valid`,
/// one message per error, the first one found. Never crashes, never allocates more than a small
/// multiple of the file.
Scene read_scene(const std::filesystem::path& path, const SceneParams& params = {});
/// The same from text; `name` stands for the file in messages.
Scene parse_scene(std::string_view text, const std::string& name, const SceneParams& params = {});

/// Built-in materials (data/materials.json, compiled in).
const std::vector<Material>& builtin_materials();
/// The material of that name; throws Error{input} with "did you mean".
const Material& find_material(const std::vector<Material>& materials, const std::string& name);

/// JSON Schema (draft-07) of "scene", "material", "report" (of fracture and check), "impact-report"
/// or "collapse-report". Throws Error{usage} for another.
inline constexpr std::string_view kSchemas[] = {"scene", "material", "report", "impact-report",
                                                "collapse-report"};
std::string json_schema(std::string_view which);
/// docs/parameters.md, from the same tables.
std::string parameters_markdown();

}  // namespace sunder
