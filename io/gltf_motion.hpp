// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "io/gltf_layout.hpp"
#include "io/gltf_text.hpp"

namespace sunder {

/// The parts of a glTF document that a recording adds to its walls: nodes and meshes of the
/// projectiles, and the animation "impact". Each function writes array items after those of the
/// walls; without a recording none writes anything.
class GltfMotion {
 public:
  /// `first_accessor`: how many the walls have.
  GltfMotion(const GltfLayout& layout, std::uint64_t first_accessor, GltfText& out)
      : layout_(layout), first_accessor_(first_accessor), out_(out) {}

  void write_nodes();
  void write_meshes(bool& first);
  void write_accessors(bool& first);
  /// `,"animations":[…]`, if anything moves. `first_chunk`: node of chunk 0 of wall 0.
  void write_animation(std::uint64_t first_chunk, std::uint64_t first_projectile);
  /// `,"extras":{…}` of the scene.
  void write_scene_extras();

 private:
  void write_accessor(GltfBlock block, std::uint64_t offset, std::uint64_t count,
                      std::string_view rest, bool& first);
  void write_sphere_accessors(bool& first);
  void write_key_accessor(const GltfAnimation::Keys& keys, bool& first);
  void write_samplers();
  void write_sampler(std::uint64_t input, std::uint64_t output, bool is_step, bool& first);
  void write_channel(std::uint64_t sampler, std::uint64_t node, std::string_view path, bool& first);
  // Accessors: the sphere's indices, normals and positions per radius; times per range of keys;
  // translations and rotations per history; scales.
  std::uint64_t first_times() const;
  std::uint64_t first_poses() const;
  std::uint64_t first_scales() const;

  const GltfLayout& layout_;
  std::uint64_t first_accessor_;
  GltfText& out_;
};

}  // namespace sunder
