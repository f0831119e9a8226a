// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf_part_text.hpp"

#include <algorithm>
#include <string>

#include "io/moment.hpp"

namespace sunder {
namespace {

constexpr std::string_view kVectors = R"(,"componentType":5126,"type":"VEC3"})";

std::array<std::vector<std::uint32_t>, 2> joints_at(const Recording& recording,
                                                    std::uint32_t part) {
  std::array<std::vector<std::uint32_t>, 2> result;
  for (std::uint32_t j = 0; j < recording.joints.size(); ++j) {
    const RecordedJoint& joint = recording.joints[j];
    if (joint.part_a == part && joint.end_a < 2) result[joint.end_a].push_back(j);
    if (joint.part_b == part && joint.end_b < 2) result[joint.end_b].push_back(j);
  }
  return result;
}

}  // namespace

void GltfPartText::write_node_extras(std::uint32_t part) {
  const RecordedPart& recorded_part = recorded()[part];
  out_.key(R"(,"extras":{"sunder":{"mass":)", recorded_part.mass);
  out_.text(R"(,"material":)");
  out_.quoted(recorded_part.material);
  if (recorded_part.has_ends) {
    out_.key(R"(,"length":)", 2 * recorded_part.half_length);
    out_.text(R"(,"ends":[)");
    bool first_end = true;
    for (const std::vector<std::uint32_t>& joints : joints_at(*layout_.recording, part)) {
      out_.separate(first_end);
      out_.text("[");
      bool first = true;
      for (const std::uint32_t j : joints) {
        out_.separate(first);
        out_.quoted(layout_.recording->joints[j].name);
      }
      out_.text("]");
    }
    out_.text("]");
  }
  out_.text("}}}");
}

void GltfPartText::write_nodes(bool& first) {
  for (std::uint32_t p = 0; p < layout_.parts.mesh_of.size(); ++p) {
    const RecordedPart& part = recorded()[p];
    out_.separate(first);
    out_.text(R"({"name":)");
    out_.quoted(part.name);
    const std::uint32_t mesh = layout_.parts.mesh_of[p];
    if (mesh != kNoMesh) out_.key_integer(R"(,"mesh":)", first_mesh_ + mesh);
    out_.place(layout_.step ? pose_of(*layout_.recording, part, *layout_.step) : part.standing);
    write_node_extras(p);
  }
}

void GltfPartText::write_targets(const GltfParts::Shape& shape) {
  const std::uint64_t still = first_accessor_ + shape.first_accessor + 4;
  out_.text(R"(,"targets":[)");
  bool first = true;
  for (std::size_t light = 0; light < kLights; ++light) {
    out_.separate(first);
    out_.key_integer(R"({"POSITION":)", still);
    out_.key_integer(R"(,"COLOR_0":)", still + 1 + light);
    out_.text("}");
  }
  out_.text("]");
}

void GltfPartText::write_meshes(bool& first) {
  for (const GltfParts::Mesh& mesh : layout_.parts.meshes) {
    const GltfParts::Shape& shape = layout_.parts.shapes[mesh.shape];
    const std::uint64_t accessor = first_accessor_ + shape.first_accessor;
    out_.separate(first);
    out_.key_integer(R"({"primitives":[{"attributes":{"POSITION":)", accessor + 1);
    out_.key_integer(R"(,"NORMAL":)", accessor + 2);
    out_.key_integer(R"(,"TEXCOORD_0":)", accessor + 3);
    if (mesh.has_colours) out_.key_integer(R"(,"COLOR_0":)", first_accessor_ + mesh.accessor);
    out_.key_integer(R"(},"indices":)", accessor);
    out_.key_integer(R"(,"material":)", shape.material);
    if (shape.glows) write_targets(shape);
    out_.text("}]");
    if (shape.glows) {
      out_.text(R"(,"weights":[0,0,0,0,0,0],"extras":{"targetNames":["force_0","torque_0",)"
                R"("failed_0","force_1","torque_1","failed_1"]})");
    }
    out_.text("}");
  }
}

void GltfPartText::write_vectors(GltfBlock block, std::uint64_t first_vector, std::uint64_t count,
                                 bool& first) {
  out_.accessor(layout_[block].view, 12 * first_vector, count, kVectors, first);
}

void GltfPartText::write_shape_accessors(const GltfParts::Shape& shape, bool& first) {
  const std::uint64_t count = shape.mesh.vertex_count();
  out_.accessor(layout_[GltfBlock::indices].view, layout_.part_list_begin + shape.index_begin,
                shape.mesh.indices.size(),
                shape.index_width() == 2 ? R"(,"componentType":5123,"type":"SCALAR"})"
                                         : R"(,"componentType":5125,"type":"SCALAR"})",
                first);
  out_.accessor(layout_[GltfBlock::positions].view,
                12 * (layout_.first_part_position + shape.first_vertex), count,
                R"(,"componentType":5126,"type":"VEC3",)", first);
  out_.bounds(shape.mesh.positions);
  out_.text("}");
  write_vectors(GltfBlock::normals, layout_.first_part_normal + shape.first_vertex, count, first);
  out_.accessor(layout_[GltfBlock::uvs].view, 8 * (layout_.first_part_uv + shape.first_vertex),
                count, R"(,"componentType":5126,"type":"VEC2"})", first);
  if (!shape.glows) return;
  out_.accessor(layout_[GltfBlock::positions].view,
                12 * (layout_.first_part_position + layout_.parts.vertex_count), count,
                R"(,"componentType":5126,"type":"VEC3","min":[0,0,0],"max":[0,0,0]})", first);
  for (std::size_t light = 0; light < kLights; ++light) {
    write_vectors(GltfBlock::colours, shape.first_target + light * count, count, first);
  }
}

void GltfPartText::write_glow_accessors(const GltfParts::Glow& glow, bool& first) {
  const std::vector<float>& grid = layout_.parts.grid;
  out_.accessor(layout_[GltfBlock::times].view, 4 * (layout_.common_times() + glow.first_key),
                glow.keys.size(), R"(,"componentType":5126,"type":"SCALAR","min":)", first);
  out_.numbers({static_cast<double>(grid[glow.keys.front()])});
  out_.text(R"(,"max":)");
  out_.numbers({static_cast<double>(grid[glow.keys.back()])});
  out_.text("}");
  out_.accessor(layout_[GltfBlock::weights].view, 4 * kLights * glow.first_key,
                kLights * glow.keys.size(), R"(,"componentType":5126,"type":"SCALAR"})", first);
}

void GltfPartText::write_accessors(bool& first) {
  const GltfParts& parts = layout_.parts;
  for (const GltfParts::Shape& shape : parts.shapes) write_shape_accessors(shape, first);
  for (const GltfParts::Mesh& mesh : parts.meshes) {
    if (!mesh.has_colours) continue;
    write_vectors(GltfBlock::colours, mesh.first_colour,
                  parts.shapes[mesh.shape].mesh.vertex_count(), first);
  }
  for (const GltfParts::Glow& glow : parts.glows) write_glow_accessors(glow, first);
}

void GltfPartText::write_channels(std::uint64_t first_node, std::uint64_t first_sampler,
                                  bool& first) {
  for (std::size_t g = 0; g < layout_.parts.glows.size(); ++g) {
    out_.separate(first);
    out_.key_integer(R"({"sampler":)", first_sampler + g);
    out_.key_integer(R"(,"target":{"node":)", first_node + layout_.parts.glows[g].part);
    out_.text(R"(,"path":"weights"}})");
  }
}

void GltfPartText::write_samplers(bool& first) {
  for (const GltfParts::Glow& glow : layout_.parts.glows) {
    out_.separate(first);
    out_.key_integer(R"({"input":)", first_accessor_ + glow.accessor);
    out_.key_integer(R"(,"output":)", first_accessor_ + glow.accessor + 1);
    out_.text("}");
  }
}

void GltfPartText::write_broken_joints() {
  const Recording& recording = *layout_.recording;
  const double end = recording.times[layout_.step.value_or(recording.times.size() - 1)];
  out_.text(R"(,"broken_joints":[)");
  bool first = true;
  for (const RecordedJoint& joint : recording.joints) {
    if (!(joint.broken <= end)) continue;
    out_.separate(first);
    out_.text(R"({"joint":)");
    out_.quoted(joint.name);
    out_.key(R"(,"time":)", joint.broken);
    out_.text(R"(,"parts":[)");
    out_.quoted(recorded()[joint.part_a].name);
    if (joint.part_b != kNoTrack) {
      out_.text(",");
      out_.quoted(recorded()[joint.part_b].name);
    }
    out_.text("]}");
  }
  out_.text("]");
}

void GltfPartText::write_scene_extras() {
  if (recorded().empty()) return;
  const auto members = std::ranges::count_if(recorded(), &RecordedPart::has_ends);
  out_.key_integer(R"(,"parts":)", recorded().size());
  out_.key_integer(R"(,"members":)", static_cast<std::uint64_t>(members));
  out_.key_integer(R"(,"joints":)", layout_.recording->joints.size());
  write_broken_joints();
}

}  // namespace sunder
