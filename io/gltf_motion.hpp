// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "io/gltf_layout.hpp"
#include "io/gltf_part_text.hpp"
#include "io/gltf_text.hpp"

namespace sunder {

/// The parts of a glTF document that a recording adds to its walls: nodes and meshes of the
/// projectiles, and the animation: "impact", or "collapse" of a building. Each function writes
/// array items after those of the walls; without a recording none writes anything.
class GltfMotion {
 public:
  /// `first_accessor`: how many the walls have.
  GltfMotion(const GltfLayout& layout, std::uint64_t first_accessor, GltfText& out)
      : layout_(layout), first_accessor_(first_accessor), out_(out) {}

  void write_nodes(bool& first);
  void write_meshes(bool& first);
  void write_accessors(bool& first);
  /// How many accessors there are after those written here.
  std::uint64_t end_accessor() const {
    return first_scales() + layout_.animation.arrivals.size() + layout_.animation.departures.size();
  }
  /// `,"animations":[…]`, if anything moves or lights up. `first_chunk`: node of chunk 0 of wall 0.
  void write_animation(std::uint64_t first_chunk, std::uint64_t first_projectile,
                       GltfPartText& parts);

 private:
  void write_accessor(GltfBlock block, std::uint64_t offset, std::uint64_t count,
                      std::string_view rest, bool& first) {
    out_.accessor(layout_[block].view, offset, count, rest, first);
  }
  void write_sphere_accessors(bool& first);
  void write_key_accessor(const GltfAnimation::Keys& keys, bool& first);
  void write_scales(std::uint64_t offset, std::uint32_t keys, bool& first);
  void write_samplers(bool& first);
  void write_moves(std::uint64_t node, std::uint32_t history, bool& first);
  void write_scale_channels(std::uint64_t first_projectile, bool& first);
  void write_sampler(std::uint64_t input, std::uint64_t output, bool is_step, bool& first);
  void write_channel(std::uint64_t sampler, std::uint64_t node, std::string_view path, bool& first);
  // Accessors: the sphere's indices, normals and positions per radius; times per range of keys;
  // translations and rotations per history; scales per arrival and departure.
  std::uint64_t first_times() const;
  std::uint64_t first_poses() const;
  std::uint64_t first_scales() const;

  const GltfLayout& layout_;
  std::uint64_t first_accessor_;
  GltfText& out_;
};

}  // namespace sunder
