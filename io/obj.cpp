// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/obj.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <set>
#include <vector>

#include "meshing/error.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

// Names end at white space in most readers.
std::string obj_name(std::string name) {
  for (char& c : name) {
    const auto code = static_cast<unsigned char>(c);
    if (code <= ' ' || code == 0x7F || c == '#' || c == '\\') c = '_';
  }
  return name;
}

// Vertices of a chunk → the different values among them, in order of first use. OBJ indexes
// positions, texture coordinates and normals apart, so a chunk's faces share its corners.
template <std::size_t Width>
class Distinct {
 public:
  // Fills `ids` for `values` and returns the vertices that hold each value first.
  std::span<const std::uint32_t> gather(std::span<const float> values) {
    const std::size_t count = values.size() / Width;
    const std::size_t size = std::bit_ceil(2 * count + 1);
    table_.assign(size, UINT32_MAX);
    ids_.resize(count);
    first_.clear();
    for (std::uint32_t v = 0; v < count; ++v) {
      const float* value = &values[v * Width];
      std::size_t at = hash(value) & (size - 1);
      while (table_[at] != UINT32_MAX && !equal(&values[first_[table_[at]] * Width], value)) {
        at = (at + 1) & (size - 1);
      }
      if (table_[at] == UINT32_MAX) {
        table_[at] = static_cast<std::uint32_t>(first_.size());
        first_.push_back(v);
      }
      ids_[v] = table_[at];
    }
    return first_;
  }
  std::uint32_t operator[](std::uint32_t vertex) const { return ids_[vertex]; }
  std::uint64_t count() const { return first_.size(); }

 private:
  // 0 and -0 are one value and one text.
  static bool equal(const float* a, const float* b) { return std::equal(a, a + Width, b); }
  static std::uint64_t hash(const float* value) {
    std::uint64_t key = 0;
    for (std::size_t k = 0; k < Width; ++k) {
      key = (key ^ std::bit_cast<std::uint32_t>(value[k] + 0.0f)) * 0x9E3779B97F4A7C15u;
      key ^= key >> 29;
    }
    return key;
  }
  std::vector<std::uint32_t> table_, ids_, first_;
};

class ObjWriter {
 public:
  explicit ObjWriter(ByteSink& sink) : out_(sink) {}

  void write(std::span<const WallView> walls, const std::string& material_file) {
    out_.text("# sunder " SUNDER_VERSION "\nmtllib ");
    out_.text(material_file);
    out_.text("\n");
    for (const WallView& wall : walls) {
      ChunkNames name(wall.first_chunk);
      const std::string material = obj_name(wall.material);
      for (std::uint32_t chunk = 0; chunk < wall.chunk_count(); ++chunk, ++name) {
        out_.text("o ");
        out_.text(*name);
        out_.text("\n");
        write_vertices(wall, chunk);
        write_faces(wall, wall.outer[chunk], material, "_outer\n");
        write_faces(wall, wall.inner[chunk], material, "_inner\n");
        position_base_ += positions_.count();
        uv_base_ += uvs_.count();
        normal_base_ += normals_.count();
      }
    }
    out_.flush();
  }

 private:
  void write_vertices(const WallView& wall, std::uint32_t chunk) {
    const std::size_t begin = wall.vertex_begin[chunk], count = wall.vertex_count(chunk);
    const auto positions = wall.positions.subspan(3 * begin, 3 * count);
    const auto uvs = wall.uvs.subspan(2 * begin, 2 * count);
    const auto normals = wall.normals.subspan(3 * begin, 3 * count);
    const bool placed = wall.position == Vec3{} && wall.rotation == Quaternion{};
    for (const std::uint32_t v : positions_.gather(positions)) {
      const Vec3 p = vector_at(positions, v);
      line("v ", placed ? p : rotate(wall.rotation, p) + wall.position);
    }
    for (const std::uint32_t v : uvs_.gather(uvs)) {
      out_.text("vt ");
      out_.number(static_cast<double>(uvs[2 * v]));
      out_.text(" ");
      out_.number(static_cast<double>(uvs[2 * v + 1]));
      out_.text("\n");
    }
    for (const std::uint32_t v : normals_.gather(normals)) {
      const Vec3 n = vector_at(normals, v);
      line("vn ", placed ? n : rotate(wall.rotation, n));
    }
  }

  static Vec3 vector_at(std::span<const float> values, std::uint32_t vertex) {
    const std::size_t at = 3 * std::size_t{vertex};
    return {static_cast<double>(values[at]), static_cast<double>(values[at + 1]),
            static_cast<double>(values[at + 2])};
  }

  // Rounded to float32 first: that is what every reader keeps.
  void line(std::string_view kind, Vec3 v) {
    out_.text(kind);
    out_.number(static_cast<double>(static_cast<float>(v.x)));
    out_.text(" ");
    out_.number(static_cast<double>(static_cast<float>(v.y)));
    out_.text(" ");
    out_.number(static_cast<double>(static_cast<float>(v.z)));
    out_.text("\n");
  }

  void write_faces(const WallView& wall, std::uint32_t list, std::string_view material,
                   std::string_view side) {
    if (list == RenderMeshes::kNoList || wall.lists[list].count == 0) return;
    out_.text("usemtl ");
    out_.text(material);
    out_.text(side);
    const IndexList range = wall.lists[list];
    const auto indices = wall.indices.subspan(range.begin, range.count);
    for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
      out_.text("f");
      for (const std::uint32_t vertex : indices.subspan(i, 3)) {
        out_.text(" ");
        out_.integer(position_base_ + positions_[vertex]);
        out_.text("/");
        out_.integer(uv_base_ + uvs_[vertex]);
        out_.text("/");
        out_.integer(normal_base_ + normals_[vertex]);
      }
      out_.text("\n");
    }
  }

  TextWriter out_;
  Distinct<3> positions_, normals_;
  Distinct<2> uvs_;
  std::uint64_t position_base_ = 1, uv_base_ = 1, normal_base_ = 1;
};

void write_material(TextWriter& out, const std::string& name,
                    const std::array<std::uint8_t, 3>& rgb, double roughness, double metallic) {
  out.text("newmtl ");
  out.text(name);
  out.text("\nKd");
  for (const std::uint8_t channel : rgb) {
    out.text(" ");
    out.number(linear(channel));
  }
  out.text("\nPr ");
  out.number(roughness);
  out.text("\nPm ");
  out.number(metallic);
  out.text("\n\n");
}

}  // namespace

void write_obj(std::span<const WallView> walls, const std::string& material_file, ByteSink& out) {
  if (std::ranges::any_of(material_file, [](unsigned char c) { return c < ' ' || c == 0x7F; })) {
    throw Error(ErrorCode::output, "an .obj cannot name its .mtl: control character in the name");
  }
  ObjWriter(out).write(walls, material_file);
}

void write_mtl(std::span<const WallView> walls, ByteSink& sink) {
  TextWriter out(sink);
  out.text("# sunder " SUNDER_VERSION "\n");
  std::set<std::string> written;
  for (const WallView& wall : walls) {
    const std::string name = obj_name(wall.material);
    if (!written.insert(name).second) continue;
    const MaterialLook look = look_of(wall.material);
    write_material(out, name + "_outer", look.outer, look.outer_roughness, look.metallic);
    write_material(out, name + "_inner", look.inner, look.inner_roughness, look.metallic);
  }
  out.flush();
}

}  // namespace sunder
