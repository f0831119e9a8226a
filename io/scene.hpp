// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fracture/wall.hpp"
#include "sim/material.hpp"
#include "sim/projectile.hpp"
#include "sim/simulation_params.hpp"

namespace sunder {

/// A scene file.
struct Scene {
  std::uint64_t seed = 1;
  std::vector<Wall> walls;
  std::vector<Material> materials;     ///< built in, then the scene's own
  std::vector<std::string> not_used;   ///< top-level keys this verb has no use for ("building" …)
};

struct SceneParams {
  std::vector<std::string> overrides = {};  ///< "a.b=value" as --set gives them, applied before checking
  bool allow_outside = false;          ///< asset paths may leave the scene's folder
};

/// Reads and checks a scene. Throws Error{input}:
/// `file:line: /json/pointer: what, value, what would be valid`, one message per error, the first
/// one found. Never crashes, never allocates more than a small multiple of the file.
Scene read_scene(const std::filesystem::path& path, const SceneParams& params = {});
/// The same from text; `name` stands for the file in messages.
Scene parse_scene(std::string_view text, const std::string& name, const SceneParams& params = {});

/// Built-in materials (data/materials.json, compiled in).
const std::vector<Material>& builtin_materials();
/// The material of that name; throws Error{input} with "did you mean".
const Material& find_material(const std::vector<Material>& materials, const std::string& name);

/// JSON Schema (draft-07) of "scene", "material" or "report". Throws Error{usage} for another.
std::string json_schema(std::string_view which);
/// docs/parameters.md, from the same tables.
std::string parameters_markdown();

}  // namespace sunder
