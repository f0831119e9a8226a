// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf_motion.hpp"

#include <optional>

#include "io/moment.hpp"

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

void GltfMotion::write_nodes(bool& first) {
  for (std::size_t p = 0; p < layout_.mesh_of.size(); ++p) {
    const RecordedProjectile& recorded = layout_.recording->projectiles[p];
    const Projectile& projectile = recorded.projectile;
    const std::optional<std::uint32_t> step = layout_.step;
    out_.separate(first);
    out_.text(R"({"name":)");
    out_.quoted(projectile.name);
    if (!step || is_there(*layout_.recording, recorded, *step)) {
      out_.key_integer(R"(,"mesh":)", layout_.mesh_count + layout_.mesh_of[p]);
    }
    if (step) {
      out_.place(pose_of(*layout_.recording, recorded, *step));
    } else {
      const Vec3 at = projectile.position;
      out_.text(R"(,"translation":)");
      out_.numbers({at.x, at.y, at.z});
    }
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
    write_scales(0, arrival.keys, first);
  }
  for (const GltfAnimation::Departure& departure : animation.departures) {
    write_scales(animation.key_ranges[departure.keys].count == 2 ? 1 : 0, departure.keys, first);
  }
}

void GltfMotion::write_scales(std::uint64_t offset, std::uint32_t keys, bool& first) {
  write_accessor(GltfBlock::translations, 12 * (layout_.animation.pose_count + offset),
                 layout_.animation.key_ranges[keys].count,
                 R"(,"componentType":5126,"type":"VEC3"})", first);
}

void GltfMotion::write_sampler(std::uint64_t input, std::uint64_t output, bool is_step,
                               bool& first) {
  out_.separate(first);
  out_.key_integer(R"({"input":)", input);
  out_.key_integer(R"(,"output":)", output);
  out_.text(is_step ? R"(,"interpolation":"STEP"})" : "}");
}

// Two samplers per history, then one per arrival and departure.
void GltfMotion::write_samplers(bool& first) {
  const GltfAnimation& animation = layout_.animation;
  for (std::size_t h = 0; h < animation.histories.size(); ++h) {
    const std::uint64_t input = first_times() + animation.histories[h].keys;
    write_sampler(input, first_poses() + 2 * h, false, first);
    write_sampler(input, first_poses() + 2 * h + 1, false, first);
  }
  std::uint64_t scale = first_scales();
  for (const GltfAnimation::Arrival& arrival : animation.arrivals) {
    write_sampler(first_times() + arrival.keys, scale++, true, first);
  }
  for (const GltfAnimation::Departure& departure : animation.departures) {
    write_sampler(first_times() + departure.keys, scale++, true, first);
  }
}

void GltfMotion::write_channel(std::uint64_t sampler, std::uint64_t node, std::string_view path,
                               bool& first) {
  out_.separate(first);
  out_.key_integer(R"({"sampler":)", sampler);
  out_.key_integer(R"(,"target":{"node":)", node);
  out_.text(path);
}

void GltfMotion::write_moves(std::uint64_t node, std::uint32_t history, bool& first) {
  if (history == kNoHistory) return;
  const std::uint64_t sampler = 2 * std::uint64_t{history};
  write_channel(sampler, node, R"(,"path":"translation"}})", first);
  write_channel(sampler + 1, node, R"(,"path":"rotation"}})", first);
}

void GltfMotion::write_scale_channels(std::uint64_t first_projectile, bool& first) {
  const GltfAnimation& animation = layout_.animation;
  const std::uint64_t first_part = first_projectile + layout_.mesh_of.size();
  std::uint64_t sampler = 2 * animation.histories.size();
  for (const GltfAnimation::Arrival& arrival : animation.arrivals) {
    write_channel(sampler++, first_projectile + arrival.projectile, R"(,"path":"scale"}})", first);
  }
  for (const GltfAnimation::Departure& departure : animation.departures) {
    write_channel(sampler++, first_part + departure.part, R"(,"path":"scale"}})", first);
  }
}

void GltfMotion::write_animation(std::uint64_t first_chunk, std::uint64_t first_projectile,
                                 GltfPartText& parts) {
  const GltfAnimation& animation = layout_.animation;
  if (animation.empty() && layout_.parts.glows.empty()) return;
  out_.text(R"(,"animations":[{"name":)");
  out_.text(layout_.recording->parts.empty() ? R"("impact")" : R"("collapse")");
  out_.text(R"(,"channels":[)");
  bool first = true;
  for (std::size_t p = 0; p < animation.of_projectile.size(); ++p) {
    write_moves(first_projectile + p, animation.of_projectile[p], first);
  }
  write_scale_channels(first_projectile, first);
  std::uint64_t node = first_chunk;
  for (const std::vector<std::uint32_t>& wall : animation.of_chunk) {
    for (const std::uint32_t history : wall) write_moves(node++, history, first);
  }
  const std::uint64_t first_part = first_projectile + layout_.mesh_of.size();
  for (std::size_t p = 0; p < animation.of_part.size(); ++p) {
    write_moves(first_part + p, animation.of_part[p], first);
  }
  const std::uint64_t samplers =
      2 * animation.histories.size() + animation.arrivals.size() + animation.departures.size();
  parts.write_channels(first_part, samplers, first);
  out_.text(R"(],"samplers":[)");
  first = true;
  write_samplers(first);
  parts.write_samplers(first);
  out_.text("]}]");
}

}  // namespace sunder
