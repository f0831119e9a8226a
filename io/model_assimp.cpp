// SPDX-License-Identifier: GPL-3.0-or-later
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "io/export_files.hpp"
#include "io/model.hpp"
#include "io/reader_process.hpp"
#include "io/scene_file.hpp"
#include "io/wall_view.hpp"
#include "meshing/error.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::input, what);
}

// Numbers points by their bits; open addressing, so that a million points cost no allocations.
class VertexTable {
 public:
  explicit VertexTable(std::vector<Vec3>& vertices) : vertices_(vertices) {}
  std::uint32_t id(Vec3 p) {
    if (2 * (vertices_.size() + 1) > slots_.size()) grow();
    p = {p.x + 0.0, p.y + 0.0, p.z + 0.0};  // -0 becomes 0
    std::uint32_t& slot = find(p);
    if (slot == kEmpty) {
      slot = static_cast<std::uint32_t>(vertices_.size());
      vertices_.push_back(p);
    }
    return slot;
  }

 private:
  static constexpr std::uint32_t kEmpty = UINT32_MAX;
  using Bits = std::array<std::uint64_t, 3>;
  static Bits bits_of(Vec3 p) { return std::bit_cast<Bits>(std::array{p.x, p.y, p.z}); }

  std::uint32_t& find(Vec3 p) {
    const Bits key = bits_of(p);
    std::size_t at = mix_bits(mix_bits(mix_bits(key[0]) ^ key[1]) ^ key[2]);
    for (;; ++at) {
      std::uint32_t& slot = slots_[at & (slots_.size() - 1)];
      if (slot == kEmpty || bits_of(vertices_[slot]) == key) return slot;
    }
  }
  void grow() {
    slots_.assign(std::max<std::size_t>(64, 2 * slots_.size()), kEmpty);
    for (std::uint32_t i = 0; i < vertices_.size(); ++i) find(vertices_[i]) = i;
  }

  std::vector<Vec3>& vertices_;
  std::vector<std::uint32_t> slots_;
};

Vec3 from_ai(const aiVector3D& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

// Where a node puts its meshes; products in doubles, so that a chain of nodes rounds once.
struct Affine {
  std::array<Vec3, 3> rows{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  Vec3 move;
  bool is_trivial = true;

  static Affine from(const aiMatrix4x4& m) {
    if (m == aiMatrix4x4()) return {};
    const auto number = [](ai_real value) { return static_cast<double>(value); };
    return {{Vec3{number(m.a1), number(m.a2), number(m.a3)},
             Vec3{number(m.b1), number(m.b2), number(m.b3)},
             Vec3{number(m.c1), number(m.c2), number(m.c3)}},
            {number(m.a4), number(m.b4), number(m.c4)},
            false};
  }
  Vec3 turn(Vec3 v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
  Vec3 operator()(Vec3 v) const { return is_trivial ? v : turn(v) + move; }
  Affine operator*(const Affine& other) const {
    if (is_trivial) return other;
    if (other.is_trivial) return *this;
    Affine result;
    for (std::size_t i = 0; i < 3; ++i) {
      result.rows[i] =
          rows[i].x * other.rows[0] + rows[i].y * other.rows[1] + rows[i].z * other.rows[2];
    }
    result.move = (*this)(other.move);
    result.is_trivial = false;
    return result;
  }
  double determinant() const { return dot(rows[0], cross(rows[1], rows[2])); }
  // Of normals: the inverse transposed, up to a positive factor.
  Vec3 turn_normal(Vec3 n) const {
    const Vec3 turned =
        n.x * cross_of_columns(1, 2) + n.y * cross_of_columns(2, 0) + n.z * cross_of_columns(0, 1);
    return determinant() < 0 ? -1.0 * turned : turned;
  }

 private:
  Vec3 column(int i) const {
    const auto part = [i](Vec3 row) { return i == 0 ? row.x : i == 1 ? row.y : row.z; };
    return {part(rows[0]), part(rows[1]), part(rows[2])};
  }
  Vec3 cross_of_columns(int a, int b) const { return cross(column(a), column(b)); }
};

std::array<float, 3> unit(Vec3 v, Vec3 otherwise) {
  const double size = length(v);
  if (!(size > 0 && std::isfinite(size))) {
    const double other = length(otherwise);
    v = other > 0 && std::isfinite(other) ? (1 / other) * otherwise : Vec3{0, 0, 1};
  } else {
    v = (1 / size) * v;
  }
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// Joins the meshes of a scene.
class Joiner {
 public:
  Joiner(const aiScene& scene, const std::filesystem::path& path)
      : scene_(scene), path_(path), vertices_(surface_.mesh.vertices) {
    const std::string suffix = suffix_of(path);
    is_srgb_ = suffix == ".obj" || suffix == ".ply";
    new_id_.assign(scene.mNumMaterials, kNone);
  }

  ModelSurface run() {
    if (scene_.mRootNode != nullptr) visit(*scene_.mRootNode, {});
    if (surface_.mesh.triangles.empty()) refuse("it holds no triangles");
    return std::move(surface_);
  }

 private:
  static constexpr std::uint32_t kNone = UINT32_MAX;

  void visit(const aiNode& node, const Affine& above) {
    const Affine place = above * Affine::from(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      if (node.mMeshes[i] >= scene_.mNumMeshes) refuse("a node names a mesh that does not exist");
      append(*scene_.mMeshes[node.mMeshes[i]], place);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], place);
  }

  void append(const aiMesh& mesh, const Affine& place) {
    const bool mirrored = place.determinant() < 0;
    surface_.has_uvs |= mesh.HasTextureCoords(0);
    surface_.has_colours |= mesh.HasVertexColors(0);
    std::uint32_t material = kNone;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < 3) continue;  // points and lines bound no volume
      if (face.mNumIndices > 3) refuse("a face has more than three corners");
      std::array<unsigned, 3> at{face.mIndices[0], face.mIndices[1], face.mIndices[2]};
      if (mirrored) std::swap(at[1], at[2]);
      for (const unsigned v : at)
        if (v >= mesh.mNumVertices) refuse("an index is out of range");
      if (material == kNone) material = material_id(mesh.mMaterialIndex);
      append_triangle(mesh, at, place);
      surface_.material.push_back(material);
    }
  }

  void append_triangle(const aiMesh& mesh, const std::array<unsigned, 3>& at, const Affine& place) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = place(from_ai(mesh.mVertices[at[k]]));
    surface_.mesh.triangles.push_back({vertices_.id(p[0]), vertices_.id(p[1]), vertices_.id(p[2])});
    const Vec3 flat = cross(p[1] - p[0], p[2] - p[0]);
    for (const unsigned v : at) {
      Corner corner;
      const Vec3 normal = mesh.HasNormals() ? place.turn_normal(from_ai(mesh.mNormals[v])) : Vec3{};
      corner.normal = unit(normal, flat);
      if (mesh.HasTextureCoords(0)) {
        const aiVector3D& uv = mesh.mTextureCoords[0][v];
        corner.uv = {std::isfinite(uv.x) ? uv.x : 0, std::isfinite(uv.y) ? uv.y : 0};
      }
      if (mesh.HasVertexColors(0)) corner.colour = colour_of(mesh.mColors[0][v], is_srgb_);
      surface_.corners.push_back(corner);
    }
  }

  static std::array<float, 4> colour_of(const aiColor4D& colour, bool is_srgb) {
    const auto channel = [](ai_real value) { return value >= 0 ? std::min(value, 1.0f) : 0.0f; };
    std::array<float, 4> result{channel(colour.r), channel(colour.g), channel(colour.b),
                                channel(colour.a)};
    for (std::size_t k = 0; is_srgb && k < 3; ++k)
      result[k] = static_cast<float>(linear_channel(static_cast<double>(result[k])));
    return result;
  }

  std::uint32_t material_id(unsigned index) {
    if (index >= scene_.mNumMaterials) refuse("a mesh has a material that does not exist");
    if (new_id_[index] == kNone) {
      new_id_[index] = static_cast<std::uint32_t>(surface_.materials.size());
      surface_.materials.push_back(material_of(*scene_.mMaterials[index]));
    }
    return new_id_[index];
  }

  SurfaceMaterial material_of(const aiMaterial& material) const {
    SurfaceMaterial result;
    const std::string name = material.GetName().C_Str();
    const std::string suffix = suffix_of(path_);
    if (name == AI_DEFAULT_MATERIAL_NAME || suffix == ".stl" || suffix == ".ply") return result;
    result.name = name.empty() ? "outer" : name;
    aiColor4D base;
    if (material.Get(AI_MATKEY_BASE_COLOR, base) == aiReturn_SUCCESS) {
      result.base_colour = colour_of(base, false);
    } else if (material.Get(AI_MATKEY_COLOR_DIFFUSE, base) == aiReturn_SUCCESS) {
      result.base_colour = colour_of(base, false);
      ai_real opacity = 1;
      if (material.Get(AI_MATKEY_OPACITY, opacity) == aiReturn_SUCCESS)
        result.base_colour[3] = std::clamp(opacity, 0.0f, 1.0f);
    }
    const auto share = [&](const char* key, unsigned type, unsigned index, float& value) {
      ai_real given = 0;
      if (material.Get(key, type, index, given) == aiReturn_SUCCESS && given >= 0)
        value = std::min(given, 1.0f);
    };
    share(AI_MATKEY_METALLIC_FACTOR, result.metallic);
    share(AI_MATKEY_ROUGHNESS_FACTOR, result.roughness);
    for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
      aiString image;
      if (!result.texture.empty() || material.GetTexture(type, 0, &image) != aiReturn_SUCCESS)
        continue;
      result.texture = image_beside(path_, image.C_Str());
    }
    return result;
  }

  const aiScene& scene_;
  std::filesystem::path path_;
  ModelSurface surface_;
  VertexTable vertices_;
  std::vector<std::uint32_t> new_id_;  // of the scene's materials
  bool is_srgb_ = false;
};

void send_model(const ModelSurface& surface, AnswerWriter& out) {
  out.array(surface.mesh.vertices);
  out.array(surface.mesh.triangles);
  out.array(surface.corners);
  out.array(surface.material);
  out.value(static_cast<std::uint64_t>(surface.materials.size()));
  for (const SurfaceMaterial& material : surface.materials) {
    out.text(material.name);
    out.value(material.base_colour);
    out.value(material.metallic);
    out.value(material.roughness);
    out.text(material.texture);
  }
  out.value(static_cast<std::uint8_t>(surface.has_uvs));
  out.value(static_cast<std::uint8_t>(surface.has_colours));
}

ModelSurface receive_model(AnswerReader& in) {
  ModelSurface surface;
  surface.mesh.vertices = in.array<Vec3>();
  surface.mesh.triangles = in.array<std::array<std::uint32_t, 3>>();
  surface.corners = in.array<Corner>();
  surface.material = in.array<std::uint32_t>();
  const std::uint64_t materials = in.count(4);
  for (std::uint64_t i = 0; i < materials; ++i) {
    SurfaceMaterial material;
    material.name = in.text();
    material.base_colour = in.value<std::array<float, 4>>();
    material.metallic = in.value<float>();
    material.roughness = in.value<float>();
    material.texture = in.text();
    surface.materials.push_back(std::move(material));
  }
  surface.has_uvs = in.value<std::uint8_t>() != 0;
  surface.has_colours = in.value<std::uint8_t>() != 0;
  const std::size_t triangles = surface.mesh.triangles.size();
  const auto exists = [&](const auto& triangle) {
    return std::ranges::all_of(triangle,
                               [&](std::uint32_t v) { return v < surface.mesh.vertices.size(); });
  };
  if (surface.corners.size() != 3 * triangles || surface.material.size() != triangles ||
      !std::ranges::all_of(surface.mesh.triangles, exists) ||
      std::ranges::any_of(surface.material, [&](std::uint32_t m) { return m >= materials; })) {
    AnswerReader::fail();
  }
  return surface;
}

}  // namespace

ModelSurface read_model(const std::filesystem::path& path, ImportLimits limits) {
  limit_to_file(path, limits);
  ModelSurface surface;
  const ChildWork read = [&] {
    Assimp::Importer importer;
    const aiScene& scene = read_scene_file(importer, path, limits);
    return [surface = Joiner(scene, path).run()](AnswerWriter& out) { send_model(surface, out); };
  };
  run_reader(path.string(), limits, read, [&](AnswerReader& in) { surface = receive_model(in); });
  return surface;
}

}  // namespace sunder
