// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf_document.hpp"

#include <algorithm>

#include "io/gltf_hulls.hpp"
#include "io/gltf_motion.hpp"
#include "io/gltf_part_text.hpp"
#include "io/gltf_series.hpp"
#include "io/gltf_text.hpp"
#include "io/image_file.hpp"
#include "io/moment.hpp"

namespace sunder {
namespace {

// One glTF document. Objects refer to each other by position in their array, so every array walks
// walls and chunks in the same order and counts along.
class Document {
 public:
  Document(std::span<const WallView> walls, const GltfLayout& layout, ByteSink& sink)
      : walls_(walls),
        layout_(layout),
        out_(sink),
        motion_(layout, accessor_count(), out_),
        parts_(layout, motion_.end_accessor(), layout.mesh_count + layout.radii.size(), out_),
        hulls_(walls, layout, {first_projectile(), layout.mesh_count, accessor_count()}, out_) {}

  std::uint64_t write(const std::string& binary_name) {
    out_.text(R"({"asset":{"version":"2.0","generator":"sunder )" SUNDER_VERSION
              R"("},"scene":0,)");
    hulls_.write_extensions();
    write_scene();
    write_nodes();
    if (!layout_.materials.empty()) {
      write_meshes();
      write_materials();
    }
    write_accessors();
    write_views();
    motion_.write_animation(walls_.size(), first_projectile(), parts_);
    write_series(layout_, first_projectile() + layout_.mesh_of.size(), out_);
    if (layout_.binary_size > 0) {
      out_.text(R"(,"buffers":[{"byteLength":)");
      out_.integer(layout_.binary_size);
      if (!binary_name.empty()) {
        out_.text(R"(,"uri":)");
        out_.quoted(binary_name);
      }
      out_.text("}]");
    }
    out_.text("}");
    while (out_.size() % 4 != 0) out_.text(" ");
    out_.flush();
    return out_.size();
  }

 private:
  bool has_mesh(std::size_t w, std::uint32_t chunk) const {
    const auto& lists = layout_.lists.of_wall[w];
    return std::ranges::any_of(walls_[w].parts_of(chunk),
                               [&](const ViewPart& part) { return lists[part.list] != kUnused; });
  }

  void write_scene();
  void write_scene_extras(bool& first);
  void write_nodes();
  void write_wall_node(std::size_t w, std::uint64_t first_child);
  void write_wall_extras(std::size_t w);
  void write_chunk_node(std::size_t w, std::uint32_t chunk, std::string_view name,
                        std::uint64_t mesh);
  void write_meshes();
  void write_primitive(std::uint64_t accessor, bool has_colours, std::uint32_t list,
                       std::uint32_t material);
  void write_materials();
  void write_images();
  void write_image_views(bool& first);
  void write_look(const ViewMaterial& material);
  void write_accessors();
  void write_vertex_accessors(std::size_t w, std::uint32_t chunk);
  void write_list_accessors();
  void write_bond_accessors(std::size_t w);
  void write_views();
  void write_view(GltfBlock block, std::string_view rest, bool& first);

  // Accessors: index lists, then three or with colours four per mesh, then four per wall with
  // bonds.
  std::uint64_t first_vertex_accessor() const { return layout_.lists.lists.size(); }
  std::uint64_t first_bond_accessor() const {
    return first_vertex_accessor() + 3 * layout_.mesh_count + layout_.coloured_count;
  }
  std::uint64_t accessor_count() const {
    std::uint64_t count = first_bond_accessor();
    for (const WallView& wall : walls_) count += wall.bonds.empty() ? 0 : 4;
    return count;
  }
  // Nodes: walls, their chunks, projectiles, parts.
  std::uint64_t first_projectile() const {
    std::uint64_t count = walls_.size();
    for (const WallView& wall : walls_) count += wall.chunk_count();
    return count;
  }

  std::span<const WallView> walls_;
  const GltfLayout& layout_;
  GltfText out_;
  GltfMotion motion_;
  GltfPartText parts_;
  GltfHulls hulls_;
  bool first_accessor_ = true;
};

void Document::write_scene() {
  out_.text(R"("scenes":[{)");
  bool first = true;
  const auto add_root = [&](std::uint64_t node) {
    if (first) out_.text(R"("nodes":[)");
    out_.separate(first);
    out_.integer(node);
  };
  for (std::size_t w = 0; w < walls_.size(); ++w) add_root(w);
  for (std::uint64_t i = 0; i < layout_.mesh_of.size() + layout_.parts.mesh_of.size(); ++i) {
    add_root(first_projectile() + i);
  }
  if (!first) out_.text("]");
  write_scene_extras(first);
  out_.text("}]");
}

void Document::write_scene_extras(bool& first) {
  if (!layout_.recording) return;
  const Recording& recording = *layout_.recording;
  out_.separate(first);
  out_.key_integer(R"("extras":{"sunder":{"steps":)", recording.times.size());
  out_.key(R"(,"duration":)", recording.times.back());
  if (layout_.step) out_.key(R"(,"at":)", recording.times[*layout_.step]);
  out_.key_integer(R"(,"breaks":)", recording.events.size());
  parts_.write_scene_extras();
  out_.text("}}");
}

// The walls come first, so that wall w is node w.
void Document::write_nodes() {
  if (walls_.empty() && layout_.mesh_of.empty() && layout_.parts.mesh_of.empty()) return;
  out_.text(R"(,"nodes":[)");
  bool first = true;
  std::uint64_t child = walls_.size();
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    out_.separate(first);
    write_wall_node(w, child);
    child += walls_[w].chunk_count();
  }
  std::uint64_t mesh = 0;
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    ChunkNames name(walls_[w].first_chunk);
    for (std::uint32_t c = 0; c < walls_[w].chunk_count(); ++c, ++name) {
      write_chunk_node(w, c, *name, has_mesh(w, c) ? mesh++ : kUnused);
    }
  }
  motion_.write_nodes(first);
  parts_.write_nodes(first);
  hulls_.write_nodes();
  out_.text("]");
}

void Document::write_wall_node(std::size_t w, std::uint64_t first_child) {
  const WallView& wall = walls_[w];
  out_.text(R"({"name":)");
  out_.quoted(wall.name);
  out_.place({wall.position, wall.rotation});
  bool first = true;
  for (std::uint32_t c = 0; c < wall.chunk_count(); ++c) {
    if (first) out_.text(R"(,"children":[)");
    out_.separate(first);
    out_.integer(first_child + c);
  }
  hulls_.add_to_wall(w, first);
  if (!first) out_.text("]");
  write_wall_extras(w);
  out_.text("}");
}

void Document::write_wall_extras(std::size_t w) {
  const WallView& wall = walls_[w];
  if (wall.is_solid) {
    out_.text(R"(,"extras":{"sunder":{"sunder":1,"kind":"solid")");
    if (wall.origin != Vec3{}) {
      out_.text(R"(,"origin":)");
      out_.numbers({wall.origin.x, wall.origin.y, wall.origin.z});
    }
  } else {
    out_.key(R"(,"extras":{"sunder":{"sunder":1,"thickness":)", wall.thickness);
  }
  out_.key(R"(,"density":)", wall.density);
  out_.key(R"(,"volume_expected":)", wall.volume_expected);
  out_.text(R"(,"material":)");
  out_.quoted(wall.material);
  out_.text(R"(,"chunks":)");
  out_.integer(wall.chunk_count());
  out_.text(R"(,"bonds":{"count":)");
  out_.integer(wall.bonds.size());
  if (!wall.bonds.empty()) {
    std::uint64_t accessor = first_bond_accessor();
    for (std::size_t i = 0; i < w; ++i) accessor += walls_[i].bonds.empty() ? 0 : 4;
    for (const std::string_view name :
         {R"(,"pairs":)", R"(,"area":)", R"(,"centroid":)", R"(,"normal":)"}) {
      out_.text(name);
      out_.integer(accessor++);
    }
  }
  out_.text("}}}");
}

void Document::write_chunk_node(std::size_t w, std::uint32_t chunk, std::string_view name,
                                std::uint64_t mesh) {
  const WallView& wall = walls_[w];
  const MassProperties& p = wall.chunks[chunk];
  const double density = wall.density;
  out_.text(R"(,{"name":")");
  out_.text(name);
  out_.text("\"");
  if (mesh != kUnused) {
    out_.text(R"(,"mesh":)");
    out_.integer(mesh);
  }
  if (layout_.step) {
    const Recording& recording = *layout_.recording;
    out_.place(pose_in_wall(recording, recording.walls[w], chunk, *layout_.step));
  }
  hulls_.write_in_chunk(w, chunk);
  out_.text(R"(,"extras":{"sunder":{"mass":)");
  out_.number(density * p.volume);
  out_.text(R"(,"volume":)");
  out_.number(p.volume);
  out_.text(R"(,"centroid":[)");
  out_.number(p.centroid.x);
  out_.text(",");
  out_.number(p.centroid.y);
  out_.text(",");
  out_.number(p.centroid.z);
  out_.text(R"(],"inertia":[)");
  out_.number(density * p.inertia.xx);
  out_.text(",");
  out_.number(density * p.inertia.yy);
  out_.text(",");
  out_.number(density * p.inertia.zz);
  out_.text(",");
  out_.number(density * p.inertia.xy);
  out_.text(",");
  out_.number(density * p.inertia.xz);
  out_.text(",");
  out_.number(density * p.inertia.yz);
  out_.text("]}}}");
}

void Document::write_meshes() {
  out_.text(R"(,"meshes":[)");
  std::uint64_t accessor = first_vertex_accessor();
  bool first = true;
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const WallView& wall = walls_[w];
    const auto& lists = layout_.lists.of_wall[w];
    const auto& materials = layout_.materials_of[w];
    ChunkNames name(wall.first_chunk);
    for (std::uint32_t c = 0; c < wall.chunk_count(); ++c, ++name) {
      if (!has_mesh(w, c)) continue;
      out_.separate(first);
      out_.text(R"({"name":")");
      out_.text(*name);
      out_.text(R"(","primitives":[)");
      bool first_part = true;
      for (const ViewPart& part : wall.parts_of(c)) {
        if (lists[part.list] == kUnused) continue;
        out_.separate(first_part);
        write_primitive(accessor, !wall.colours.empty(), lists[part.list],
                        materials[part.material]);
      }
      out_.text("]}");
      accessor += wall.colours.empty() ? 3 : 4;
    }
  }
  motion_.write_meshes(first);
  parts_.write_meshes(first);
  hulls_.write_meshes();
  out_.text("]");
}

void Document::write_primitive(std::uint64_t accessor, bool has_colours, std::uint32_t list,
                               std::uint32_t material) {
  out_.text(R"({"attributes":{"POSITION":)");
  out_.integer(accessor);
  out_.text(R"(,"NORMAL":)");
  out_.integer(accessor + 1);
  out_.text(R"(,"TEXCOORD_0":)");
  out_.integer(accessor + 2);
  if (has_colours) out_.key_integer(R"(,"COLOR_0":)", accessor + 3);
  out_.text(R"(},"indices":)");
  out_.integer(list);
  out_.text(R"(,"material":)");
  out_.integer(material);
  out_.text("}");
}

void Document::write_materials() {
  out_.text(R"(,"materials":[)");
  bool first = true;
  for (const ViewMaterial& material : layout_.materials) {
    out_.separate(first);
    out_.text(R"({"name":)");
    out_.quoted(material.name);
    write_look(material);
  }
  out_.text("]");
  write_images();
}

void Document::write_look(const ViewMaterial& material) {
  const auto [r, g, b] = material.colour;
  out_.text(R"(,"pbrMetallicRoughness":{"baseColorFactor":)");
  out_.numbers({r, g, b, material.alpha});
  if (!material.image.empty()) {
    const auto image = std::ranges::find(layout_.images, material.image, &GltfImage::image);
    out_.key_integer(R"(,"baseColorTexture":{"index":)",
                     static_cast<std::uint64_t>(image - layout_.images.begin()));
    out_.text("}");
  }
  out_.text(R"(,"metallicFactor":)");
  out_.number(material.metallic);
  out_.text(R"(,"roughnessFactor":)");
  out_.number(material.roughness);
  out_.text("}");
  if (material.alpha < 1) out_.text(R"(,"alphaMode":"BLEND")");
  out_.text("}");
}

// Texture i shows image i.
void Document::write_images() {
  if (layout_.images.empty()) return;
  out_.text(R"(,"textures":[)");
  bool first = true;
  for (std::size_t i = 0; i < layout_.images.size(); ++i) {
    out_.separate(first);
    out_.key_integer(R"({"source":)", i);
    out_.text("}");
  }
  out_.text(R"(],"images":[)");
  std::uint64_t view = 0;
  for (const GltfLayout::Block& block : layout_.blocks) view += block.size > 0;
  first = true;
  for (const GltfImage& image : layout_.images) {
    out_.separate(first);
    if (image.bytes.empty()) {
      out_.text(R"({"uri":)");
      out_.quoted(percent_encoded(image.uri));
    } else {
      out_.key_integer(R"({"bufferView":)", view++);
      out_.text(R"(,"mimeType":)");
      out_.quoted(image.mime);
    }
    out_.text("}");
  }
  out_.text("]");
}

void Document::write_image_views(bool& first) {
  for (const GltfImage& image : layout_.images) {
    if (image.bytes.empty()) continue;
    out_.separate(first);
    out_.key_integer(R"({"buffer":0,"byteOffset":)", image.begin);
    out_.key_integer(R"(,"byteLength":)", image.bytes.size());
    out_.text("}");
  }
}

void Document::write_accessors() {
  if (layout_.binary_size == 0) return;
  out_.text(R"(,"accessors":[)");
  write_list_accessors();
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    for (std::uint32_t c = 0; c < walls_[w].chunk_count(); ++c) {
      if (has_mesh(w, c)) write_vertex_accessors(w, c);
    }
  }
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    if (!walls_[w].bonds.empty()) write_bond_accessors(w);
  }
  motion_.write_accessors(first_accessor_);
  parts_.write_accessors(first_accessor_);
  hulls_.write_accessors(first_accessor_);
  out_.text("]");
}

void Document::write_list_accessors() {
  for (std::size_t i = 0; i < layout_.lists.lists.size(); ++i) {
    const UniqueLists::List& list = layout_.lists.lists[i];
    out_.separate(first_accessor_);
    out_.text(R"({"bufferView":)");
    out_.integer(layout_[GltfBlock::indices].view);
    out_.text(R"(,"byteOffset":)");
    out_.integer(layout_.list_begin[i]);
    out_.text(list.largest <= kLargestShortIndex ? R"(,"componentType":5123,"count":)"
                                                 : R"(,"componentType":5125,"count":)");
    out_.integer(list.indices.size());
    out_.text(R"(,"type":"SCALAR"})");
  }
}

void Document::write_vertex_accessors(std::size_t w, std::uint32_t chunk) {
  const WallView& wall = walls_[w];
  const std::uint64_t vertex = layout_.first_vertex[w] + wall.vertex_begin[chunk];
  const std::uint64_t count = wall.vertex_count(chunk);
  out_.separate(first_accessor_);
  out_.text(R"({"bufferView":0,"byteOffset":)");
  out_.integer(12 * vertex);
  out_.text(R"(,"componentType":5126,"count":)");
  out_.integer(count);
  out_.text(R"(,"type":"VEC3",)");
  out_.bounds(wall.positions.subspan(3 * std::size_t{wall.vertex_begin[chunk]}, 3 * count));
  out_.text(R"(},{"bufferView":1,"byteOffset":)");
  out_.integer(12 * vertex);
  out_.text(R"(,"componentType":5126,"count":)");
  out_.integer(count);
  out_.text(R"(,"type":"VEC3"},{"bufferView":2,"byteOffset":)");
  out_.integer(8 * vertex);
  out_.text(R"(,"componentType":5126,"count":)");
  out_.integer(count);
  out_.text(R"(,"type":"VEC2"})");
  if (wall.colours.empty()) return;
  out_.accessor(layout_[GltfBlock::colours].view,
                12 * (layout_.first_colour[w] + wall.vertex_begin[chunk]), count,
                R"(,"componentType":5126,"type":"VEC3"})", first_accessor_);
}

void Document::write_bond_accessors(std::size_t w) {
  const std::uint64_t count = walls_[w].bonds.size();
  std::uint64_t offset = layout_.bonds_begin[w];
  const auto accessor = [&](std::string_view kind, std::uint64_t bytes) {
    out_.separate(first_accessor_);
    out_.text(R"({"bufferView":)");
    out_.integer(layout_[GltfBlock::bonds].view);
    out_.text(R"(,"byteOffset":)");
    out_.integer(offset);
    out_.text(kind);
    out_.text(R"(,"count":)");
    out_.integer(count);
    out_.text("}");
    offset += bytes * count;
  };
  accessor(R"(,"componentType":5125,"type":"VEC2")", 8);
  accessor(R"(,"componentType":5126,"type":"SCALAR")", 4);
  accessor(R"(,"componentType":5126,"type":"VEC3")", 12);
  accessor(R"(,"componentType":5126,"type":"VEC3")", 12);
}

void Document::write_view(GltfBlock id, std::string_view rest, bool& first) {
  const GltfLayout::Block& block = layout_[id];
  if (block.size == 0) return;
  out_.separate(first);
  out_.text(R"({"buffer":0,"byteOffset":)");
  out_.integer(block.begin);
  out_.text(R"(,"byteLength":)");
  out_.integer(block.size);
  out_.text(rest);
  out_.text("}");
}

void Document::write_views() {
  if (layout_.binary_size == 0) return;
  bool first = true;
  out_.text(R"(,"bufferViews":[)");
  write_view(GltfBlock::positions, R"(,"byteStride":12,"target":34962)", first);
  write_view(GltfBlock::normals, R"(,"byteStride":12,"target":34962)", first);
  write_view(GltfBlock::uvs, R"(,"byteStride":8,"target":34962)", first);
  write_view(GltfBlock::colours, R"(,"byteStride":12,"target":34962)", first);
  write_view(GltfBlock::indices, R"(,"target":34963)", first);
  for (const GltfBlock block : {GltfBlock::bonds, GltfBlock::times, GltfBlock::translations,
                                GltfBlock::rotations, GltfBlock::weights,
                                GltfBlock::utilisations}) {
    write_view(block, "", first);
  }
  write_image_views(first);
  out_.text("]");
}

}  // namespace

std::uint64_t write_gltf_document(std::span<const WallView> walls, const GltfLayout& layout,
                                  const std::string& binary_name, ByteSink& sink) {
  return Document(walls, layout, sink).write(binary_name);
}

}  // namespace sunder
