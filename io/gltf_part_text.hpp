// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "io/gltf_layout.hpp"
#include "io/gltf_text.hpp"

namespace sunder {

/// What the parts of a recording add to a glTF document: their nodes, meshes, accessors and the
/// lights on members' ends. Each function writes array items after those that are there.
class GltfPartText {
 public:
  /// `first_accessor`: how many the walls and the motion have; `first_mesh` likewise.
  GltfPartText(const GltfLayout& layout, std::uint64_t first_accessor, std::uint64_t first_mesh,
               GltfText& out)
      : layout_(layout), first_accessor_(first_accessor), first_mesh_(first_mesh), out_(out) {}

  void write_nodes(bool& first);
  void write_meshes(bool& first);
  void write_accessors(bool& first);
  /// `first_node`: of part 0; `first_sampler`: of the first light.
  void write_channels(std::uint64_t first_node, std::uint64_t first_sampler, bool& first);
  void write_samplers(bool& first);
  /// `,"parts":…` of the scene's extras: counts, and the joints that broke.
  void write_scene_extras();

 private:
  void write_node_extras(std::uint32_t part);
  void write_targets(const GltfParts::Shape& shape);
  void write_shape_accessors(const GltfParts::Shape& shape, bool& first);
  void write_vectors(GltfBlock block, std::uint64_t first_vector, std::uint64_t count, bool& first);
  void write_glow_accessors(const GltfParts::Glow& glow, bool& first);
  void write_broken_joints();
  const std::vector<RecordedPart>& recorded() const { return layout_.recording->parts; }

  const GltfLayout& layout_;
  std::uint64_t first_accessor_, first_mesh_;
  GltfText& out_;
};

}  // namespace sunder
