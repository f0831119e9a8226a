// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/obj.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "io/gltf_layout.hpp"
#include "io/moment.hpp"
#include "io/part_colour.hpp"
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

// What becomes an object: the arrays are per vertex, uvs and colours may be empty.
struct Solid {
  std::string_view name;
  Pose pose;
  std::span<const float> positions, normals, uvs;
  std::span<const Colour> colours;
};

// A wall's colours of a chunk's vertices in sRGB, empty if it has none; `colours` holds them.
std::span<const Colour> srgb_colours(const WallView& wall, std::size_t begin, std::size_t count,
                                     std::vector<Colour>& colours) {
  colours.clear();
  for (std::size_t v = begin; !wall.colours.empty() && v < begin + count; ++v) {
    const std::span<const float> c = wall.colours.subspan(4 * v, 3);
    const auto channel = [](float value) { return srgb_channel(static_cast<double>(value)); };
    colours.push_back({channel(c[0]), channel(c[1]), channel(c[2])});
  }
  return colours;
}

class ObjWriter {
 public:
  ObjWriter(ByteSink& sink, const std::string& material_file) : out_(sink) {
    out_.text("# sunder " SUNDER_VERSION "\nmtllib ");
    out_.text(material_file);
    out_.text("\n");
  }

  // `pose_of_chunk(c)`: of its wall's frame as the chunk carries it.
  template <class PoseOfChunk>
  void write_wall(const WallView& wall, const PoseOfChunk& pose_of_chunk) {
    ChunkNames name(wall.first_chunk);
    std::vector<std::string> materials;
    for (const ViewMaterial& material : wall.materials)
      materials.push_back(obj_name(material.name));
    std::vector<Colour> colours;
    for (std::uint32_t chunk = 0; chunk < wall.chunk_count(); ++chunk, ++name) {
      const std::size_t begin = wall.vertex_begin[chunk], count = wall.vertex_count(chunk);
      start({*name, pose_of_chunk(chunk), wall.positions.subspan(3 * begin, 3 * count),
             wall.normals.subspan(3 * begin, 3 * count), wall.uvs.subspan(2 * begin, 2 * count),
             srgb_colours(wall, begin, count, colours)});
      for (const ViewPart& part : wall.parts_of(chunk)) {
        const IndexList range = wall.lists[part.list];
        write_faces(wall.indices.subspan(range.begin, range.count), materials[part.material]);
      }
      if (wall.hulls.nodes == HullNodes::none) continue;
      for (std::uint32_t i = 0; i < wall.hulls.count(chunk); ++i)
        write_hull(*wall.hulls.set, wall.hulls.begin(chunk) + i,
                   hull_name(wall.hulls.nodes, *name, i), pose_of_chunk(chunk));
    }
  }
  // Begins an object; its faces follow.
  void start(const Solid& solid) {
    position_base_ += positions_.count();
    uv_base_ += uvs_.count();
    normal_base_ += normals_.count();
    has_uvs_ = !solid.uvs.empty();
    out_.text("o ");
    out_.text(solid.name);
    out_.text("\n");
    write_vertices(solid);
  }
  void write_faces(std::span<const std::uint32_t> indices, std::string_view material) {
    if (indices.empty()) return;
    out_.text("usemtl ");
    out_.text(material);
    out_.text("\n");
    for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
      out_.text("f");
      for (const std::uint32_t vertex : indices.subspan(i, 3)) {
        out_.text(" ");
        out_.integer(position_base_ + positions_[vertex]);
        out_.text("/");
        if (has_uvs_) out_.integer(uv_base_ + uvs_[vertex]);
        out_.text("/");
        out_.integer(normal_base_ + normals_[vertex]);
      }
      out_.text("\n");
    }
  }
  // From here on solids without colours are white, which leaves their materials as they are.
  void colour_all() { colours_all_ = true; }
  void finish() { out_.flush(); }

 private:
  void write_hull(const HullSet& set, std::uint32_t hull, const std::string& name,
                  const Pose& pose) {
    const std::size_t begin = set.vertex_begin[hull], end = set.vertex_begin[hull + 1];
    start({name, pose, std::span(set.positions).subspan(3 * begin, 3 * (end - begin)), {}, {}, {}});
    for (std::size_t i = set.index_begin[hull]; i < set.index_begin[hull + 1]; ++i) {
      out_.text(i % 3 == 0 ? "f " : " ");
      out_.integer(position_base_ + positions_[set.indices[i]]);
      if (i % 3 == 2) out_.text("\n");
    }
  }

  void write_vertices(const Solid& solid) {
    const bool placed = solid.pose == Pose{};
    for (const std::uint32_t v : positions_.gather(solid.positions)) {
      const Vec3 p = vector_at(solid.positions, v);
      line("v ", placed ? p : solid.pose * p);
      if (!solid.colours.empty()) {
        for (const double channel : solid.colours[v]) number(channel);
      } else if (colours_all_) {
        out_.text(" 1 1 1");
      }
      out_.text("\n");
    }
    for (const std::uint32_t v : uvs_.gather(solid.uvs)) {
      out_.text("vt ");
      out_.number(static_cast<double>(solid.uvs[2 * v]));
      number(static_cast<double>(solid.uvs[2 * v + 1]));
      out_.text("\n");
    }
    for (const std::uint32_t v : normals_.gather(solid.normals)) {
      const Vec3 n = vector_at(solid.normals, v);
      line("vn ", placed ? n : rotate(solid.pose.rotation, n));
      out_.text("\n");
    }
  }

  static Vec3 vector_at(std::span<const float> values, std::uint32_t vertex) {
    const std::size_t at = 3 * std::size_t{vertex};
    return {static_cast<double>(values[at]), static_cast<double>(values[at + 1]),
            static_cast<double>(values[at + 2])};
  }

  void number(double value) {
    out_.text(" ");
    out_.number(value);
  }
  // Rounded to float32 first: that is what every reader keeps.
  void line(std::string_view kind, Vec3 v) {
    out_.text(kind);
    out_.number(static_cast<double>(static_cast<float>(v.x)));
    number(static_cast<double>(static_cast<float>(v.y)));
    number(static_cast<double>(static_cast<float>(v.z)));
  }

  TextWriter out_;
  Distinct<3> positions_, normals_;
  Distinct<2> uvs_;
  std::uint64_t position_base_ = 1, uv_base_ = 1, normal_base_ = 1;
  bool has_uvs_ = false, colours_all_ = false;
};

void write_spheres(const RecordedMoment& moment, ObjWriter& out) {
  const SphereMesh sphere = sphere_mesh();
  const std::vector<std::uint32_t> indices(sphere.indices.begin(), sphere.indices.end());
  std::vector<float> normals, positions(3 * sphere.vertices.size());
  for (const Vec3 v : sphere.vertices) {
    for (const double x : {v.x, v.y, v.z}) normals.push_back(static_cast<float>(x));
  }
  for (const RecordedProjectile& projectile : moment.recording.projectiles) {
    if (!is_there(moment.recording, projectile, moment.step)) continue;
    for (std::size_t i = 0; i < normals.size(); ++i) {
      positions[i] = static_cast<float>(projectile.projectile.radius) * normals[i];
    }
    const Pose pose = pose_of(moment.recording, projectile, moment.step);
    out.start({projectile.projectile.name, pose, positions, normals, {}, {}});
    out.write_faces(indices, "steel_outer");
  }
}

void write_parts(const RecordedMoment& moment, ObjWriter& out) {
  const Recording& recording = moment.recording;
  const GltfParts parts = plan_parts(recording, moment.step);
  std::vector<Colour> colours;
  for (std::uint32_t p = 0; p < recording.parts.size(); ++p) {
    if (parts.mesh_of[p] == kNoMesh) continue;
    const RecordedPart& part = recording.parts[p];
    const GltfParts::Mesh& mesh = parts.meshes[parts.mesh_of[p]];
    const PartMesh& shape = parts.shapes[mesh.shape].mesh;
    const auto [r, g, b] = member_look(part.material).colour;
    const Colour own{r / 255.0, g / 255.0, b / 255.0};
    colours.clear();
    for (std::uint32_t v = 0; part.has_ends && v < shape.vertex_count(); ++v) {
      colours.push_back(lit_colour(own, mesh.lights, &shape.nearness[2 * std::size_t{v}]));
    }
    out.start({part.name, pose_of(recording, part, moment.step), shape.positions, shape.normals,
               shape.uvs, colours});
    out.write_faces(shape.indices, obj_name(part.material) + (part.has_ends ? "" : "_outer"));
  }
}

void write_material(TextWriter& out, const std::string& name, const ViewMaterial& material) {
  out.text("newmtl ");
  out.text(name);
  out.text("\nKd");
  for (const double channel : material.colour) {
    out.text(" ");
    out.number(channel);
  }
  if (material.alpha < 1) {
    out.text("\nd ");
    out.number(material.alpha);
  }
  out.text("\nPr ");
  out.number(material.roughness);
  out.text("\nPm ");
  out.number(material.metallic);
  if (!material.uri.empty()) {
    out.text("\nmap_Kd ");
    out.text(material.uri);
  }
  out.text("\n\n");
}

void check_name(const std::string& material_file) {
  if (std::ranges::any_of(material_file, [](unsigned char c) { return c < ' ' || c == 0x7F; })) {
    throw Error(ErrorCode::output, "an .obj cannot name its .mtl: control character in the name");
  }
}

// Materials by name; each is written once.
class MtlWriter {
 public:
  explicit MtlWriter(ByteSink& sink) : out_(sink) { out_.text("# sunder " SUNDER_VERSION "\n"); }

  void write(const ViewMaterial& material) {
    const std::string name = obj_name(material.name);
    if (written_.insert(name).second) write_material(out_, name, material);
  }
  void finish() { out_.flush(); }

 private:
  TextWriter out_;
  std::set<std::string> written_;
};

}  // namespace

void write_obj(std::span<const WallView> walls, const std::string& material_file, ByteSink& sink) {
  check_name(material_file);
  ObjWriter out(sink, material_file);
  if (std::ranges::any_of(walls, [](const WallView& wall) { return !wall.colours.empty(); }))
    out.colour_all();
  for (const WallView& wall : walls) {
    out.write_wall(wall, [&wall](std::uint32_t) { return Pose{wall.position, wall.rotation}; });
  }
  out.finish();
}

void write_obj(std::span<const WallView> walls, const RecordedMoment& moment,
               const std::string& material_file, ByteSink& sink) {
  check_name(material_file);
  ObjWriter out(sink, material_file);
  // Where some corners have colours, assimp paints those without black.
  if (!moment.recording.parts.empty()) out.colour_all();
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const Pose standing{walls[w].position, walls[w].rotation};
    const std::vector<std::uint32_t>& track = moment.recording.walls[w].track;
    out.write_wall(walls[w], [&](std::uint32_t chunk) {
      return pose_at(moment.recording, track[chunk], moment.step, standing);
    });
  }
  write_spheres(moment, out);
  write_parts(moment, out);
  out.finish();
}

void write_mtl(std::span<const WallView> walls, ByteSink& sink) {
  MtlWriter out(sink);
  for (const WallView& wall : walls) {
    for (const ViewMaterial& material : wall.materials) out.write(material);
  }
  out.finish();
}

void write_mtl(std::span<const WallView> walls, const RecordedMoment& moment, ByteSink& sink) {
  MtlWriter out(sink);
  for (const WallView& wall : walls) {
    for (const ViewMaterial& material : wall.materials) out.write(material);
  }
  if (!moment.recording.projectiles.empty()) out.write(outer_material("steel"));
  for (const RecordedPart& part : moment.recording.parts) {
    out.write(part.has_ends ? member_material(part.material) : outer_material(part.material));
  }
  out.finish();
}

}  // namespace sunder
