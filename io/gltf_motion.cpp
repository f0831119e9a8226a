// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf_motion.hpp"

#include <algorithm>
#include <limits>

namespace sunder {

std::uint64_t GltfMotion::first_times() const {
  return first_accessor_ + (layout_.radii.empty() ? 0 : 2 + layout_.radii.size());
}
std::uint64_t GltfMotion::first_poses() const {
  return first_times() + layout_.animation.key_ranges.size();
}
std::uint64_t GltfMotion::first_scales() const {
  return first_poses() + 2 * layout_.animation.histories.size();
}

void GltfMotion::write_scene_extras() {
  if (!layout_.recording) return;
  const Recording& recording = *layout_.recording;
  out_.key_integer(R"(,"extras":{"sunder":{"steps":)", recording.times.size());
  out_.key(R"(,"duration":)", recording.times.back());
  out_.key_integer(R"(,"breaks":)", recording.events.size());
  out_.text("}}");
}

void GltfMotion::write_nodes() {
  for (std::size_t p = 0; p < layout_.mesh_of.size(); ++p) {
    const Projectile& projectile = layout_.recording->projectiles[p].projectile;
    out_.text(R"(,{"name":)");
    out_.quoted(projectile.name);
    out_.key_integer(R"(,"mesh":)", layout_.mesh_count + layout_.mesh_of[p]);
    const Vec3 at = projectile.position;
    out_.text(R"(,"translation":)");
    out_.numbers({at.x, at.y, at.z});
    out_.text(R"(,"extras":{"sunder":{"mass":)");
    out_.number(projectile.mass);
    out_.text(R"(,"radius":)");
    out_.number(projectile.radius);
    out_.text(R"(,"time":)");
    out_.number(projectile.time);
    out_.text("}}}");
  }
}

void GltfMotion::write_meshes(bool& first) {
  for (std::size_t r = 0; r < layout_.radii.size(); ++r) {
    out_.separate(first);
    out_.key_integer(R"({"primitives":[{"attributes":{"POSITION":)", first_accessor_ + 2 + r);
    out_.key_integer(R"(,"NORMAL":)", first_accessor_ + 1);
    out_.key_integer(R"(},"indices":)", first_accessor_);
    out_.key_integer(R"(,"material":)", layout_.sphere_material);
    out_.text("}]}");
  }
}

void GltfMotion::write_accessor(GltfBlock block, std::uint64_t offset, std::uint64_t count,
                                std::string_view rest, bool& first) {
  out_.separate(first);
  out_.key_integer(R"({"bufferView":)", layout_[block].view);
  out_.key_integer(R"(,"byteOffset":)", offset);
  out_.key_integer(R"(,"count":)", count);
  out_.text(rest);
}

void GltfMotion::write_sphere_accessors(bool& first) {
  if (layout_.radii.empty()) return;
  write_accessor(GltfBlock::indices, layout_.sphere_list_begin, kSphereIndices,
                 R"(,"componentType":5123,"type":"SCALAR"})", first);
  const std::uint64_t begin = 12 * layout_.first_sphere_vertex;
  write_accessor(GltfBlock::normals, begin, kSphereVertices,
                 R"(,"componentType":5126,"type":"VEC3"})", first);
  for (std::size_t r = 0; r < layout_.radii.size(); ++r) {
    write_accessor(GltfBlock::positions, begin + 12 * r * kSphereVertices, kSphereVertices,
                   R"(,"componentType":5126,"type":"VEC3","min":)", first);
    // Poles and the meridians at quarter turns lie on the axes.
    const double radius = static_cast<double>(static_cast<float>(layout_.radii[r]));
    out_.numbers({-radius, -radius, -radius});
    out_.text(R"(,"max":)");
    out_.numbers({radius, radius, radius});
    out_.text("}");
  }
}

void GltfMotion::write_key_accessor(const GltfAnimation::Keys& keys, bool& first) {
  write_accessor(GltfBlock::times, 4 * std::uint64_t{keys.first}, keys.count,
                 R"(,"componentType":5126,"type":"SCALAR","min":)", first);
  const auto time = [this](std::uint32_t key) {
    const double exact = layout_.recording->times[layout_.animation.steps[key]];
    return static_cast<double>(static_cast<float>(exact));
  };
  out_.numbers({time(keys.first)});
  out_.text(R"(,"max":)");
  out_.numbers({time(keys.first + keys.count - 1)});
  out_.text("}");
}

void GltfMotion::write_accessors(bool& first) {
  write_sphere_accessors(first);
  const GltfAnimation& animation = layout_.animation;
  for (const GltfAnimation::Keys& keys : animation.key_ranges) write_key_accessor(keys, first);
  for (const GltfAnimation::History& history : animation.histories) {
    const std::uint64_t count = animation.key_count(history);
    write_accessor(GltfBlock::translations, 12 * history.begin, count,
                   R"(,"componentType":5126,"type":"VEC3"})", first);
    write_accessor(GltfBlock::rotations, 16 * history.begin, count,
                   R"(,"componentType":5126,"type":"VEC4"})", first);
  }
  for (const GltfAnimation::Arrival& arrival : animation.arrivals) {
    write_accessor(GltfBlock::translations, 12 * animation.pose_count,
                   animation.key_ranges[arrival.keys].count,
                   R"(,"componentType":5126,"type":"VEC3"})", first);
  }
}

void GltfMotion::write_sampler(std::uint64_t input, std::uint64_t output, bool is_step,
                               bool& first) {
  out_.separate(first);
  out_.key_integer(R"({"input":)", input);
  out_.key_integer(R"(,"output":)", output);
  out_.text(is_step ? R"(,"interpolation":"STEP"})" : "}");
}

// Two samplers per history, then one per arrival.
void GltfMotion::write_samplers() {
  const GltfAnimation& animation = layout_.animation;
  bool first = true;
  for (std::size_t h = 0; h < animation.histories.size(); ++h) {
    const std::uint64_t input = first_times() + animation.histories[h].keys;
    write_sampler(input, first_poses() + 2 * h, false, first);
    write_sampler(input, first_poses() + 2 * h + 1, false, first);
  }
  for (std::size_t a = 0; a < animation.arrivals.size(); ++a) {
    write_sampler(first_times() + animation.arrivals[a].keys, first_scales() + a, true, first);
  }
}

void GltfMotion::write_channel(std::uint64_t sampler, std::uint64_t node, std::string_view path,
                               bool& first) {
  out_.separate(first);
  out_.key_integer(R"({"sampler":)", sampler);
  out_.key_integer(R"(,"target":{"node":)", node);
  out_.text(path);
}

void GltfMotion::write_animation(std::uint64_t first_chunk, std::uint64_t first_projectile) {
  const GltfAnimation& animation = layout_.animation;
  if (animation.empty()) return;
  out_.text(R"(,"animations":[{"name":"impact","channels":[)");
  bool first = true;
  const auto move = [&](std::uint64_t node, std::uint32_t history) {
    if (history == kNoHistory) return;
    const std::uint64_t sampler = 2 * std::uint64_t{history};
    write_channel(sampler, node, R"(,"path":"translation"}})", first);
    write_channel(sampler + 1, node, R"(,"path":"rotation"}})", first);
  };
  for (std::size_t p = 0; p < animation.of_projectile.size(); ++p) {
    move(first_projectile + p, animation.of_projectile[p]);
  }
  for (std::size_t a = 0; a < animation.arrivals.size(); ++a) {
    write_channel(2 * animation.histories.size() + a,
                  first_projectile + animation.arrivals[a].projectile, R"(,"path":"scale"}})",
                  first);
  }
  std::uint64_t node = first_chunk;
  for (const std::vector<std::uint32_t>& wall : animation.of_chunk) {
    for (const std::uint32_t history : wall) move(node++, history);
  }
  out_.text(R"(],"samplers":[)");
  write_samplers();
  out_.text("]}]");
}

}  // namespace sunder
