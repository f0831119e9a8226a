// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "meshing/error.hpp"

namespace sunder {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

// 65535 in 16 bits means "restart the strip", so it is not an index.
constexpr std::uint32_t kLargestShortIndex = 65534;
constexpr std::uint32_t kUnused = UINT32_MAX;

// The binary is a few large blocks, each one bufferView: positions, normals, texture coordinates
// and indices of all walls, then the bonds.
struct Block {
  std::uint64_t begin = 0, size = 0;
};

struct MaterialIds {
  std::uint32_t outer = kUnused, inner = kUnused;
};

// Everything about the file that is known before the first byte is written.
struct Layout {
  UniqueLists lists;
  std::vector<std::uint64_t> list_begin;                // bytes into the index block
  std::vector<std::uint64_t> first_vertex;              // per wall
  std::vector<std::uint64_t> bonds_begin;               // per wall, bytes into the bond block
  std::vector<std::pair<std::string, bool>> materials;  // name, inner
  std::vector<MaterialIds> materials_of;                // per wall
  std::uint64_t mesh_count = 0;
  Block positions, normals, uvs, indices, bonds;
  std::uint64_t binary_size = 0;
};

constexpr std::uint64_t kBondBytes = 8 + 4 + 12 + 12;

bool is_drawn(const WallView& wall, const std::vector<std::uint32_t>& lists, std::uint32_t list) {
  return list < wall.lists.size() && lists[list] != kUnused;
}

std::uint32_t id_of(std::vector<std::pair<std::string, bool>>& materials, const std::string& name,
                    bool inner) {
  const auto found = std::ranges::find(materials, std::pair(name, inner));
  if (found == materials.end()) materials.emplace_back(name, inner);
  return static_cast<std::uint32_t>(std::ranges::find(materials, std::pair(name, inner)) -
                                    materials.begin());
}

void lay_out_materials(std::span<const WallView> walls, Layout& layout) {
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const WallView& wall = walls[w];
    const auto& lists = layout.lists.of_wall[w];
    MaterialIds ids;
    for (std::uint32_t c = 0; c < wall.chunk_count(); ++c) {
      const bool outer = is_drawn(wall, lists, wall.outer[c]);
      const bool inner = is_drawn(wall, lists, wall.inner[c]);
      if (outer && ids.outer == kUnused) ids.outer = id_of(layout.materials, wall.material, false);
      if (inner && ids.inner == kUnused) ids.inner = id_of(layout.materials, wall.material, true);
      if (outer || inner) ++layout.mesh_count;
    }
    layout.materials_of.push_back(ids);
  }
}

Layout lay_out(std::span<const WallView> walls) {
  Layout layout;
  layout.lists = unique_lists(walls);
  lay_out_materials(walls, layout);
  std::uint64_t vertices = 0, bond_bytes = 0, index_bytes = 0;
  for (const WallView& wall : walls) {
    layout.first_vertex.push_back(vertices);
    layout.bonds_begin.push_back(bond_bytes);
    vertices += wall.vertex_begin.back();
    bond_bytes += wall.bonds.size() * kBondBytes;
  }
  for (const UniqueLists::List& list : layout.lists.lists) {
    layout.list_begin.push_back(index_bytes);
    const std::uint64_t width = list.largest <= kLargestShortIndex ? 2 : 4;
    index_bytes += (list.indices.size() * width + 3) / 4 * 4;
  }
  const auto place = [&layout](std::uint64_t size) {
    const Block block{layout.binary_size, size};
    layout.binary_size += size;
    return block;
  };
  layout.positions = place(12 * vertices);
  layout.normals = place(12 * vertices);
  layout.uvs = place(8 * vertices);
  layout.indices = place(index_bytes);
  layout.bonds = place(bond_bytes);
  return layout;
}

// One glTF document. Objects refer to each other by position in their array, so every array walks
// walls and chunks in the same order and counts along.
class Document {
 public:
  Document(std::span<const WallView> walls, const Layout& layout, ByteSink& sink)
      : walls_(walls), layout_(layout), out_(sink) {}

  std::uint64_t write(const std::string& binary_name) {
    out_.text(R"({"asset":{"version":"2.0","generator":"sunder )" SUNDER_VERSION
              R"("},"scene":0,)");
    write_scene();
    write_nodes();
    if (layout_.mesh_count > 0) {
      write_meshes();
      write_materials();
    }
    write_accessors();
    write_views();
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
  // Commas between the items of an array.
  void separate(bool& first) {
    if (!first) out_.text(",");
    first = false;
  }
  void key(std::string_view name, double value) {
    out_.text(name);
    out_.exact(value);
  }
  void numbers(std::initializer_list<double> values) {
    bool first = true;
    out_.text("[");
    for (const double value : values) {
      separate(first);
      out_.number(value);
    }
    out_.text("]");
  }
  bool has_mesh(std::size_t w, std::uint32_t chunk) const {
    const WallView& wall = walls_[w];
    const auto& lists = layout_.lists.of_wall[w];
    return is_drawn(wall, lists, wall.outer[chunk]) || is_drawn(wall, lists, wall.inner[chunk]);
  }

  void write_scene();
  void write_nodes();
  void write_wall_node(std::size_t w, std::uint64_t first_child);
  void write_wall_extras(std::size_t w);
  void write_chunk_node(const WallView& wall, std::uint32_t chunk, std::string_view name,
                        std::uint64_t mesh);
  void write_meshes();
  void write_primitive(std::uint64_t accessor, std::uint32_t list, std::uint32_t material);
  void write_materials();
  void write_accessors();
  void write_vertex_accessors(const WallView& wall, std::uint32_t chunk, std::uint64_t first);
  void write_bounds(std::span<const float> positions);
  void write_list_accessors();
  void write_bond_accessors(std::size_t w);
  void write_views();
  void write_view(const Block& block, std::string_view rest, bool& first);

  // Accessors: index lists, then three per mesh, then four per wall with bonds.
  std::uint64_t first_vertex_accessor() const { return layout_.lists.lists.size(); }
  std::uint64_t first_bond_accessor() const {
    return first_vertex_accessor() + 3 * layout_.mesh_count;
  }

  std::span<const WallView> walls_;
  const Layout& layout_;
  TextWriter out_;
  bool first_accessor_ = true;
  std::array<std::uint64_t, 5> view_ids_{};  // of the blocks, in their order
};

void Document::write_scene() {
  out_.text(R"("scenes":[{)");
  bool first = true;
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    if (first) out_.text(R"("nodes":[)");
    separate(first);
    out_.integer(w);
  }
  out_.text(first ? "}]" : "]}]");
}

// The walls come first, so that wall w is node w.
void Document::write_nodes() {
  if (walls_.empty()) return;
  out_.text(R"(,"nodes":[)");
  std::uint64_t child = walls_.size();
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    if (w > 0) out_.text(",");
    write_wall_node(w, child);
    child += walls_[w].chunk_count();
  }
  std::uint64_t mesh = 0;
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    ChunkNames name(walls_[w].first_chunk);
    for (std::uint32_t c = 0; c < walls_[w].chunk_count(); ++c, ++name) {
      write_chunk_node(walls_[w], c, *name, has_mesh(w, c) ? mesh++ : kUnused);
    }
  }
  out_.text("]");
}

void Document::write_wall_node(std::size_t w, std::uint64_t first_child) {
  const WallView& wall = walls_[w];
  out_.text(R"({"name":)");
  out_.quoted(wall.name);
  if (wall.position != Vec3{}) {
    out_.text(R"(,"translation":)");
    numbers({wall.position.x, wall.position.y, wall.position.z});
  }
  if (wall.rotation != Quaternion{}) {
    out_.text(R"(,"rotation":)");
    numbers({wall.rotation.x, wall.rotation.y, wall.rotation.z, wall.rotation.w});
  }
  bool first = true;
  for (std::uint32_t c = 0; c < wall.chunk_count(); ++c) {
    if (first) out_.text(R"(,"children":[)");
    separate(first);
    out_.integer(first_child + c);
  }
  if (!first) out_.text("]");
  write_wall_extras(w);
  out_.text("}");
}

void Document::write_wall_extras(std::size_t w) {
  const WallView& wall = walls_[w];
  key(R"(,"extras":{"sunder":{"sunder":1,"thickness":)", wall.thickness);
  key(R"(,"density":)", wall.density);
  key(R"(,"volume_expected":)", wall.volume_expected);
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

void Document::write_chunk_node(const WallView& wall, std::uint32_t chunk, std::string_view name,
                                std::uint64_t mesh) {
  const MassProperties& p = wall.chunks[chunk];
  const double density = wall.density;
  out_.text(R"(,{"name":")");
  out_.text(name);
  if (mesh != kUnused) {
    out_.text(R"(","mesh":)");
    out_.integer(mesh);
    out_.text(R"(,"extras":{"sunder":{"mass":)");
  } else {
    out_.text(R"(","extras":{"sunder":{"mass":)");
  }
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
    const MaterialIds materials = layout_.materials_of[w];
    ChunkNames name(wall.first_chunk);
    for (std::uint32_t c = 0; c < wall.chunk_count(); ++c, ++name) {
      if (!has_mesh(w, c)) continue;
      separate(first);
      out_.text(R"({"name":")");
      out_.text(*name);
      out_.text(R"(","primitives":[)");
      const bool outer = is_drawn(wall, lists, wall.outer[c]);
      if (outer) write_primitive(accessor, lists[wall.outer[c]], materials.outer);
      if (is_drawn(wall, lists, wall.inner[c])) {
        if (outer) out_.text(",");
        write_primitive(accessor, lists[wall.inner[c]], materials.inner);
      }
      out_.text("]}");
      accessor += 3;
    }
  }
  out_.text("]");
}

void Document::write_primitive(std::uint64_t accessor, std::uint32_t list, std::uint32_t material) {
  out_.text(R"({"attributes":{"POSITION":)");
  out_.integer(accessor);
  out_.text(R"(,"NORMAL":)");
  out_.integer(accessor + 1);
  out_.text(R"(,"TEXCOORD_0":)");
  out_.integer(accessor + 2);
  out_.text(R"(},"indices":)");
  out_.integer(list);
  out_.text(R"(,"material":)");
  out_.integer(material);
  out_.text("}");
}

void Document::write_materials() {
  out_.text(R"(,"materials":[)");
  bool first = true;
  for (const auto& [name, inner] : layout_.materials) {
    const MaterialLook look = look_of(name);
    const auto& colour = inner ? look.inner : look.outer;
    separate(first);
    out_.text(R"({"name":)");
    out_.quoted(name + (inner ? "_inner" : "_outer"));
    out_.text(R"(,"pbrMetallicRoughness":{"baseColorFactor":)");
    numbers({linear(colour[0]), linear(colour[1]), linear(colour[2]), 1});
    out_.text(R"(,"metallicFactor":)");
    out_.number(look.metallic);
    out_.text(R"(,"roughnessFactor":)");
    out_.number(inner ? look.inner_roughness : look.outer_roughness);
    out_.text("}}");
  }
  out_.text("]");
}

void Document::write_accessors() {
  if (layout_.binary_size == 0) return;
  std::uint64_t view = 0;
  const Block blocks[] = {layout_.positions, layout_.normals, layout_.uvs, layout_.indices,
                          layout_.bonds};
  for (std::size_t i = 0; i < 5; ++i) view_ids_[i] = blocks[i].size > 0 ? view++ : 0;
  out_.text(R"(,"accessors":[)");
  write_list_accessors();
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    for (std::uint32_t c = 0; c < walls_[w].chunk_count(); ++c) {
      if (has_mesh(w, c)) write_vertex_accessors(walls_[w], c, layout_.first_vertex[w]);
    }
  }
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    if (!walls_[w].bonds.empty()) write_bond_accessors(w);
  }
  out_.text("]");
}

void Document::write_list_accessors() {
  for (std::size_t i = 0; i < layout_.lists.lists.size(); ++i) {
    const UniqueLists::List& list = layout_.lists.lists[i];
    separate(first_accessor_);
    out_.text(R"({"bufferView":)");
    out_.integer(view_ids_[3]);
    out_.text(R"(,"byteOffset":)");
    out_.integer(layout_.list_begin[i]);
    out_.text(list.largest <= kLargestShortIndex ? R"(,"componentType":5123,"count":)"
                                                 : R"(,"componentType":5125,"count":)");
    out_.integer(list.indices.size());
    out_.text(R"(,"type":"SCALAR"})");
  }
}

void Document::write_vertex_accessors(const WallView& wall, std::uint32_t chunk,
                                      std::uint64_t first) {
  const std::uint64_t vertex = first + wall.vertex_begin[chunk];
  const std::uint64_t count = wall.vertex_count(chunk);
  separate(first_accessor_);
  out_.text(R"({"bufferView":0,"byteOffset":)");
  out_.integer(12 * vertex);
  out_.text(R"(,"componentType":5126,"count":)");
  out_.integer(count);
  out_.text(R"(,"type":"VEC3",)");
  write_bounds(wall.positions.subspan(3 * std::size_t{wall.vertex_begin[chunk]}, 3 * count));
  out_.text(R"(},{"bufferView":1,"byteOffset":)");
  out_.integer(12 * vertex);
  out_.text(R"(,"componentType":5126,"count":)");
  out_.integer(count);
  out_.text(R"(,"type":"VEC3"},{"bufferView":2,"byteOffset":)");
  out_.integer(8 * vertex);
  out_.text(R"(,"componentType":5126,"count":)");
  out_.integer(count);
  out_.text(R"(,"type":"VEC2"})");
}

void Document::write_bounds(std::span<const float> positions) {
  float low[3] = {positions[0], positions[1], positions[2]};
  float high[3] = {positions[0], positions[1], positions[2]};
  for (std::size_t i = 3; i < positions.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const float value = positions[i + k];
      low[k] = value < low[k] ? value : low[k];
      high[k] = value > high[k] ? value : high[k];
    }
  }
  const auto triple = [this](const float* values) {
    out_.number(static_cast<double>(values[0]));
    out_.text(",");
    out_.number(static_cast<double>(values[1]));
    out_.text(",");
    out_.number(static_cast<double>(values[2]));
  };
  out_.text(R"("min":[)");
  triple(low);
  out_.text(R"(],"max":[)");
  triple(high);
  out_.text("]");
}

void Document::write_bond_accessors(std::size_t w) {
  const std::uint64_t count = walls_[w].bonds.size();
  std::uint64_t offset = layout_.bonds_begin[w];
  const auto accessor = [&](std::string_view kind, std::uint64_t bytes) {
    separate(first_accessor_);
    out_.text(R"({"bufferView":)");
    out_.integer(view_ids_[4]);
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

void Document::write_view(const Block& block, std::string_view rest, bool& first) {
  if (block.size == 0) return;
  separate(first);
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
  write_view(layout_.positions, R"(,"byteStride":12,"target":34962)", first);
  write_view(layout_.normals, R"(,"byteStride":12,"target":34962)", first);
  write_view(layout_.uvs, R"(,"byteStride":8,"target":34962)", first);
  write_view(layout_.indices, R"(,"target":34963)", first);
  write_view(layout_.bonds, "", first);
  out_.text("]");
}

// Collects what is converted on the way out into large writes.
class BinaryWriter {
 public:
  explicit BinaryWriter(ByteSink& sink) : sink_(sink), buffer_(kSize) {}
  ~BinaryWriter() = default;

  template <class T>
  void put(T value) {
    if (used_ + sizeof value > kSize) flush();
    std::memcpy(buffer_.data() + used_, &value, sizeof value);
    used_ += sizeof value;
  }
  void put(Vec3 v) {
    put(std::array{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
  }
  // Texture coordinates, v turned down as glTF wants it: a block at a time, in vector registers.
  void put_uvs(std::span<const float> uvs) {
    std::array<float, 4096> block;
    while (!uvs.empty()) {
      const std::size_t count = std::min(uvs.size(), block.size());
      for (std::size_t i = 0; i + 1 < count; i += 2) {
        block[i] = uvs[i];
        block[i + 1] = 1.0f - uvs[i + 1];
      }
      if (used_ + count * sizeof(float) > kSize) flush();
      std::memcpy(buffer_.data() + used_, block.data(), count * sizeof(float));
      used_ += count * sizeof(float);
      uvs = uvs.subspan(count);
    }
  }
  void flush() {
    if (used_ > 0) sink_.write(std::span(buffer_).first(used_));
    used_ = 0;
  }

 private:
  static constexpr std::size_t kSize = std::size_t{1} << 18;
  ByteSink& sink_;
  std::vector<std::byte> buffer_;
  std::size_t used_ = 0;
};

void write_bonds(std::span<const Bond> bonds, BinaryWriter& out) {
  for (const Bond& bond : bonds) {
    out.put(std::array{bond.a, bond.b});
  }
  for (const Bond& bond : bonds) out.put(static_cast<float>(bond.area));
  for (const Bond& bond : bonds) out.put(bond.centroid);
  for (const Bond& bond : bonds) out.put(bond.normal);
}

void write_list(const UniqueLists::List& list, BinaryWriter& out) {
  if (list.largest > kLargestShortIndex) {
    for (const std::uint32_t index : list.indices) out.put(index);
    return;
  }
  for (const std::uint32_t index : list.indices) out.put(static_cast<std::uint16_t>(index));
  if (list.indices.size() % 2 != 0) out.put(std::uint16_t{0});
}

void write_binary(std::span<const WallView> walls, const Layout& layout, ByteSink& sink) {
  const auto pass = [&sink](std::span<const float> values) {
    if (!values.empty()) sink.write(std::as_bytes(values));
  };
  for (const WallView& wall : walls) pass(wall.positions);
  for (const WallView& wall : walls) pass(wall.normals);
  BinaryWriter out(sink);
  for (const WallView& wall : walls) out.put_uvs(wall.uvs);
  for (const UniqueLists::List& list : layout.lists.lists) write_list(list, out);
  for (const WallView& wall : walls) write_bonds(wall.bonds, out);
  out.flush();
}

// Everything but letters, digits and -._~ as %XX (RFC 3986).
std::string percent_encoded(const std::string& name) {
  constexpr char kHex[] = "0123456789ABCDEF";
  std::string text;
  for (const char c : name) {
    const auto code = static_cast<unsigned char>(c);
    const bool plain = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '.' || c == '_' || c == '~';
    if (plain) {
      text += c;
    } else {
      text += {'%', kHex[code >> 4], kHex[code & 15]};
    }
  }
  return text;
}

void refuse_above_4_gib(std::uint64_t size) {
  if (size > UINT32_MAX) {
    throw Error(ErrorCode::output, "a .glb holds at most 4 GiB, this asset needs " +
                                       std::to_string(size >> 20) + " MiB: write .gltf");
  }
}

}  // namespace

void write_glb(std::span<const WallView> walls, ByteSink& out) {
  const Layout layout = lay_out(walls);
  refuse_above_4_gib(layout.binary_size);
  // The length of the JSON is known when it has been written; the header is filled in at the end.
  const std::array<std::byte, 20> room{};
  out.write(room);
  const std::uint64_t json_size = Document(walls, layout, out).write("");
  const bool has_binary = layout.binary_size > 0;
  const std::uint64_t size = 20 + json_size + (has_binary ? 8 + layout.binary_size : 0);
  refuse_above_4_gib(size);
  if (has_binary) {
    const std::uint32_t head[] = {static_cast<std::uint32_t>(layout.binary_size), 0x004E4942};
    out.write(std::as_bytes(std::span(head)));
    write_binary(walls, layout, out);
  }
  const std::uint32_t head[] = {0x46546C67, 2, static_cast<std::uint32_t>(size),
                                static_cast<std::uint32_t>(json_size), 0x4E4F534A};
  out.rewrite_front(std::as_bytes(std::span(head)));
}

void write_gltf(std::span<const WallView> walls, const std::string& binary_name, ByteSink& json,
                ByteSink& binary) {
  const Layout layout = lay_out(walls);
  Document(walls, layout, json).write(percent_encoded(binary_name));
  write_binary(walls, layout, binary);
}

}  // namespace sunder
