// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "io/part_colour.hpp"
#include "io/part_mesh.hpp"
#include "sim/recording.hpp"

namespace sunder {

/// Steps of a light's brightness in an animation.
constexpr std::uint32_t kLightSteps = 64;

/// What the parts of a recording are in a glTF file, planned before a byte is written.
struct GltfParts {
  /// Geometry that all parts of one outline, length and material share. A shape that `glows` has
  /// a morph target per light, which changes COLOR_0 alone.
  struct Shape {
    PartMesh mesh;
    std::uint32_t part = 0;            ///< the first that has it
    std::uint32_t material = 0;        ///< in GltfLayout::materials
    std::uint64_t first_vertex = 0;    ///< among the parts' vertices
    std::uint64_t index_begin = 0;     ///< bytes into the parts' indices
    std::uint64_t first_accessor = 0;  ///< among the parts' accessors
    std::uint64_t first_target = 0;    ///< triple of the colour block
    bool glows = false;

    std::uint32_t index_width() const { return mesh.vertex_count() <= 65535 ? 2 : 4; }
  };
  /// A shape with colours: of a member, shared by all that are not lit; otherwise one for each.
  struct Mesh {
    std::uint32_t shape = 0;
    bool has_colours = false;
    Lights lights{};                 ///< that the colours show
    std::uint64_t first_colour = 0;  ///< triple of the colour block
    std::uint64_t accessor = 0;      ///< of COLOR_0, among the parts' accessors
  };
  /// How the lights of a member change: a key wherever one of them does, and one before.
  struct Glow {
    std::uint32_t part = 0;
    std::vector<std::uint32_t> keys;                         ///< in grid
    std::vector<std::array<std::uint8_t, kLights>> weights;  ///< in 1/kLightSteps
    std::uint64_t first_key = 0;                             ///< among those of all glows
    std::uint64_t accessor = 0;  ///< of its times, then weights, among the parts' accessors
  };

  std::vector<Shape> shapes;
  std::vector<Mesh> meshes;
  std::vector<std::uint32_t> mesh_of;  ///< per part: in meshes; kNoMesh: it is not there
  std::vector<Glow> glows;
  std::vector<float> grid;  ///< times of lights' keys, s, ascending
  std::uint64_t vertex_count = 0, index_bytes = 0, colour_count = 0, key_count = 0;
  std::uint64_t accessor_count = 0;
  std::uint32_t still_count = 0;  ///< vertices that no target moves: of the largest one that glows
};
constexpr std::uint32_t kNoMesh = UINT32_MAX;

/// `step`: the file shows that one moment; otherwise it is animated. Shapes have no material yet.
/// O(parts + times × joints).
GltfParts plan_parts(const Recording& recording, std::optional<std::uint32_t> step);

/// A member's own colour as COLOR_0 has it: linear, what its material's white is multiplied by.
Colour own_colour(const RecordedPart& part);

/// Calls put(colour) for the colour block: COLOR_0 of meshes, then the targets of shapes.
template <class Put>
void for_each_colour(const Recording& recording, const GltfParts& parts, const Put& put) {
  for (const GltfParts::Mesh& mesh : parts.meshes) {
    if (!mesh.has_colours) continue;
    const GltfParts::Shape& shape = parts.shapes[mesh.shape];
    const Colour own = own_colour(recording.parts[shape.part]);
    for (std::uint32_t v = 0; v < shape.mesh.vertex_count(); ++v) {
      put(lit_colour(own, mesh.lights, &shape.mesh.nearness[2 * std::size_t{v}]));
    }
  }
  for (const GltfParts::Shape& shape : parts.shapes) {
    if (!shape.glows) continue;
    const Colour own = own_colour(recording.parts[shape.part]);
    for (std::size_t light = 0; light < kLights; ++light) {
      const Colour full = light_colour(light, own);
      for (std::uint32_t v = 0; v < shape.mesh.vertex_count(); ++v) {
        const double near =
            static_cast<double>(shape.mesh.nearness[2 * std::size_t{v} + light / 3]);
        put(Colour{near * full[0], near * full[1], near * full[2]});
      }
    }
  }
}

}  // namespace sunder
