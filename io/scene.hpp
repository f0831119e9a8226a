// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fracture/wall.hpp"

namespace sunder {

/// What a wall is made of; 0 stands for "not known", except in the ratio.
struct Material {
  std::string name;
  double density = 0;           ///< kg/m³
  double youngs_modulus = 0;    ///< Pa
  double poisson_ratio = 0.2;
  double tensile_strength = 0;  ///< Pa
  double fracture_energy = 0;   ///< J per m² of crack, one side counted
  std::string source;           ///< where the numbers are from
};
template <> std::span<const Field<Material>> fields();

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
