// SPDX-License-Identifier: GPL-3.0-or-later
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Exporter.hpp>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "fracture/sites.hpp"
#include "io/export.hpp"
#include "io/export_files.hpp"
#include "io/gltf.hpp"
#include "io/obj.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

// --- assimp's files, written through OutputFile -------------------------------------------------

// assimp's exporters do not look at what Write returns, so the first failure is kept and rethrown
// when they are done.
struct Failure {
  std::exception_ptr first;
  void keep() {
    if (!first) first = std::current_exception();
  }
};

class OutputStream : public Assimp::IOStream {
 public:
  OutputStream(OutputFile& file, Failure& failure) : file_(file), failure_(failure) {}
  std::size_t Read(void*, std::size_t, std::size_t) override { return 0; }
  std::size_t Write(const void* data, std::size_t size, std::size_t count) override {
    if (failure_.first) return 0;
    try {
      file_.write({static_cast<const std::byte*>(data), size * count});
      return count;
    } catch (...) {
      failure_.keep();
      return 0;
    }
  }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    try {
      const std::uint64_t from = origin == aiOrigin_CUR   ? file_.position()
                                 : origin == aiOrigin_END ? file_.size()
                                                          : 0;
      if (from + offset > file_.size()) return aiReturn_FAILURE;
      file_.seek(from + offset);
      return aiReturn_SUCCESS;
    } catch (...) {
      failure_.keep();
      return aiReturn_FAILURE;
    }
  }
  std::size_t Tell() const override { return file_.position(); }
  std::size_t FileSize() const override { return file_.size(); }
  void Flush() override {}

 private:
  OutputFile& file_;
  Failure& failure_;
};

// Hands out temporary files; nothing has its name before commit().
class OutputFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* path, const char*) override {
    try {
      files_.push_back(std::make_unique<OutputFile>(path));
      return new OutputStream(*files_.back(), failure);
    } catch (...) {
      failure.keep();
      return nullptr;
    }
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }
  void commit() {
    if (files_.size() == 2) return commit_pair(*files_[1], *files_[0]);
    for (const auto& file : files_) file->commit();
  }

  Failure failure;

 private:
  std::vector<std::unique_ptr<OutputFile>> files_;
};

// A stream of assimp's as our writers see it.
class StreamSink : public ByteSink {
 public:
  StreamSink(Assimp::IOSystem& system, const std::string& path)
      : system_(system), stream_(system.Open(path)) {
    if (stream_ == nullptr) fail();
  }
  ~StreamSink() override {
    if (stream_ != nullptr) system_.Close(stream_);
  }
  StreamSink(const StreamSink&) = delete;
  StreamSink& operator=(const StreamSink&) = delete;
  void write(std::span<const std::byte> bytes) override {
    if (!bytes.empty() && stream_->Write(bytes.data(), bytes.size(), 1) != 1) fail();
  }
  void rewrite_front(std::span<const std::byte> bytes) override {
    if (stream_->Seek(0, aiOrigin_SET) != aiReturn_SUCCESS) fail();
    write(bytes);
    if (stream_->Seek(0, aiOrigin_END) != aiReturn_SUCCESS) fail();
  }

 private:
  [[noreturn]] static void fail() { throw Error(ErrorCode::output, "cannot write"); }
  Assimp::IOSystem& system_;
  Assimp::IOStream* stream_;
};

// --- asset → aiScene ----------------------------------------------------------------------------

constexpr char kBondSuffix[] = "_bonds";

aiVector3D to_ai(Vec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// Part of a chunk's vertices and triangles, or nothing.
std::unique_ptr<aiMesh> make_mesh(const WallView& wall, std::uint32_t list, std::uint64_t first,
                                  std::uint32_t begin, std::uint32_t end) {
  const IndexList range = wall.lists[list];
  auto mesh = std::make_unique<aiMesh>();
  mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  mesh->mNumVertices = end - begin;
  mesh->mVertices = new aiVector3D[mesh->mNumVertices];
  mesh->mNormals = new aiVector3D[mesh->mNumVertices];
  mesh->mTextureCoords[0] = new aiVector3D[mesh->mNumVertices];
  mesh->mNumUVComponents[0] = 2;
  if (!wall.colours.empty()) mesh->mColors[0] = new aiColor4D[mesh->mNumVertices];
  for (std::uint32_t v = begin; v < end; ++v) {
    const std::size_t at = first + v;
    mesh->mVertices[v - begin] = {wall.positions[3 * at], wall.positions[3 * at + 1],
                                  wall.positions[3 * at + 2]};
    mesh->mNormals[v - begin] = {wall.normals[3 * at], wall.normals[3 * at + 1],
                                 wall.normals[3 * at + 2]};
    mesh->mTextureCoords[0][v - begin] = {wall.uvs[2 * at], wall.uvs[2 * at + 1], 0};
    if (wall.colours.empty()) continue;
    const auto srgb = [](float value) {
      return static_cast<float>(srgb_channel(static_cast<double>(value)));
    };
    const std::span<const float> c = wall.colours.subspan(4 * at, 4);
    mesh->mColors[0][v - begin] = {srgb(c[0]), srgb(c[1]), srgb(c[2]), c[3]};
  }
  mesh->mNumFaces = range.count / 3;
  mesh->mFaces = new aiFace[mesh->mNumFaces];
  for (std::uint32_t f = 0; f < mesh->mNumFaces; ++f) {
    mesh->mFaces[f].mNumIndices = 3;
    mesh->mFaces[f].mIndices = new unsigned int[3];
    for (std::uint32_t k = 0; k < 3; ++k) {
      mesh->mFaces[f].mIndices[k] = wall.indices[range.begin + 3 * f + k] - begin;
    }
  }
  return mesh;
}

// The vertices of a chunk that a part of it uses, and perhaps others between them.
struct VertexRange {
  std::uint32_t begin = 0, end = 0;
};
VertexRange vertices_of(const WallView& wall, const ViewPart& part) {
  const IndexList range = wall.lists[part.list];
  const auto [least, largest] = std::ranges::minmax(wall.indices.subspan(range.begin, range.count));
  return {least, largest + 1};
}

std::unique_ptr<aiMetadata> chunk_metadata(const MassProperties& p) {
  const std::pair<const char*, double> entries[] = {
      {"volume", p.volume},         {"centroid_x", p.centroid.x}, {"centroid_y", p.centroid.y},
      {"centroid_z", p.centroid.z}, {"inertia_xx", p.inertia.xx}, {"inertia_yy", p.inertia.yy},
      {"inertia_zz", p.inertia.zz}, {"inertia_xy", p.inertia.xy}, {"inertia_xz", p.inertia.xz},
      {"inertia_yz", p.inertia.yz}};
  std::unique_ptr<aiMetadata> data(aiMetadata::Alloc(std::size(entries)));
  unsigned at = 0;
  for (const auto& [key, value] : entries) data->Set(at++, key, value);
  return data;
}

// Bonds as points: where they are, which way they face, and (area, a, b) as texture coordinates.
// assimp cannot copy nested properties, and flat ones take a kilobyte each.
std::unique_ptr<aiMesh> bond_mesh(std::span<const Bond> bonds) {
  static_assert(kMaxCells <= (1u << 24), "chunk numbers are exact in float32");
  auto mesh = std::make_unique<aiMesh>();
  mesh->mPrimitiveTypes = aiPrimitiveType_POINT;
  mesh->mNumVertices = mesh->mNumFaces = static_cast<unsigned>(bonds.size());
  mesh->mVertices = new aiVector3D[bonds.size()];
  mesh->mNormals = new aiVector3D[bonds.size()];
  mesh->mTextureCoords[0] = new aiVector3D[bonds.size()];
  mesh->mNumUVComponents[0] = 3;
  mesh->mFaces = new aiFace[bonds.size()];
  for (unsigned i = 0; i < bonds.size(); ++i) {
    const Bond& bond = bonds[i];
    mesh->mVertices[i] = to_ai(bond.centroid);
    mesh->mNormals[i] = to_ai(bond.normal);
    mesh->mTextureCoords[0][i] = {static_cast<float>(bond.area), static_cast<float>(bond.a),
                                  bond.b == kWorld ? -1.0f : static_cast<float>(bond.b)};
    mesh->mFaces[i].mNumIndices = 1;
    mesh->mFaces[i].mIndices = new unsigned int[1]{i};
  }
  return mesh;
}

std::unique_ptr<aiMetadata> wall_metadata(const WallView& wall) {
  const Quaternion q = wall.rotation;
  const std::pair<const char*, double> entries[] = {{"thickness", wall.thickness},
                                                    {"density", wall.density},
                                                    {"volume_expected", wall.volume_expected},
                                                    {"position_x", wall.position.x},
                                                    {"position_y", wall.position.y},
                                                    {"position_z", wall.position.z},
                                                    {"rotation_x", q.x},
                                                    {"rotation_y", q.y},
                                                    {"rotation_z", q.z},
                                                    {"rotation_w", q.w}};
  constexpr unsigned kNumbers = std::size(entries);
  std::unique_ptr<aiMetadata> data(aiMetadata::Alloc(kNumbers + 2));
  unsigned at = 0;
  for (const auto& [key, value] : entries) data->Set(at++, key, value);
  data->Set(kNumbers, "first_chunk", aiString(wall.first_chunk));
  data->Set(kNumbers + 1, "material", aiString(wall.material));
  return data;
}

aiMatrix4x4 transform_of(const WallView& wall) {
  const Quaternion q = wall.rotation;
  const aiQuaternion rotation(static_cast<float>(q.w), static_cast<float>(q.x),
                              static_cast<float>(q.y), static_cast<float>(q.z));
  return {aiVector3D(1, 1, 1), rotation, to_ai(wall.position)};
}

// Gathers what the nodes refer to while they are made.
struct SceneParts {
  std::vector<std::unique_ptr<aiMesh>> meshes;
  std::vector<std::unique_ptr<aiMaterial>> materials;
  std::vector<std::string> material_names;

  unsigned material(const std::string& name) {
    const auto found = std::ranges::find(material_names, name);
    if (found != material_names.end()) {
      return static_cast<unsigned>(found - material_names.begin());
    }
    auto made = std::make_unique<aiMaterial>();
    const aiString text(name);
    made->AddProperty(&text, AI_MATKEY_NAME);
    materials.push_back(std::move(made));
    material_names.push_back(name);
    return static_cast<unsigned>(materials.size() - 1);
  }
};

void set_children(aiNode& node, std::vector<std::unique_ptr<aiNode>>&& children) {
  if (children.empty()) return;
  node.mNumChildren = static_cast<unsigned>(children.size());
  node.mChildren = new aiNode*[children.size()];
  for (std::size_t i = 0; i < children.size(); ++i) {
    children[i]->mParent = &node;
    node.mChildren[i] = children[i].release();
  }
}

std::unique_ptr<aiNode> chunk_node(const WallView& wall, std::uint32_t chunk,
                                   const std::string& name, SceneParts& parts) {
  auto node = std::make_unique<aiNode>(name);
  node->mMetaData = chunk_metadata(wall.chunks[chunk]).release();
  const std::uint32_t first = wall.vertex_begin[chunk];
  std::vector<unsigned> ids;
  for (const ViewPart& part : wall.parts_of(chunk)) {
    if (wall.lists[part.list].count == 0) continue;
    const auto [begin, end] = vertices_of(wall, part);
    const std::string& material = wall.materials[part.material].name;
    parts.meshes.push_back(make_mesh(wall, part.list, first, begin, end));
    parts.meshes.back()->mName = aiString(name + '_' + material);
    parts.meshes.back()->mMaterialIndex = parts.material(material);
    ids.push_back(static_cast<unsigned>(parts.meshes.size() - 1));
  }
  if (ids.empty()) return node;
  node->mNumMeshes = static_cast<unsigned>(ids.size());
  node->mMeshes = new unsigned[ids.size()];
  std::ranges::copy(ids, node->mMeshes);
  return node;
}

std::unique_ptr<aiNode> bond_node(const WallView& wall, SceneParts& parts) {
  auto node = std::make_unique<aiNode>(wall.name + kBondSuffix);
  parts.meshes.push_back(bond_mesh(wall.bonds));
  parts.meshes.back()->mName = node->mName;
  parts.meshes.back()->mMaterialIndex = parts.material(wall.material + "_inner");
  node->mNumMeshes = 1;
  node->mMeshes = new unsigned[1]{static_cast<unsigned>(parts.meshes.size() - 1)};
  return node;
}

template <class T>
T** release_all(std::vector<std::unique_ptr<T>>& owned) {
  T** pointers = new T*[owned.size()];
  for (std::size_t i = 0; i < owned.size(); ++i) pointers[i] = owned[i].release();
  return pointers;
}

bool shares_vertices(const aiScene& scene) {
  std::vector<bool> seen;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    seen.assign(mesh.mNumVertices, false);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k) {
        const unsigned v = mesh.mFaces[f].mIndices[k];
        if (seen[v]) return true;
        seen[v] = true;
      }
    }
  }
  return false;
}

// Bonds only for our own formats: in STL and PLY they would be stray points.
std::unique_ptr<aiScene> make_scene(std::span<const WallView> walls, bool with_bonds) {
  SceneParts parts;
  std::vector<std::unique_ptr<aiNode>> wall_nodes;
  for (const WallView& wall : walls) {
    auto node = std::make_unique<aiNode>(wall.name);
    node->mTransformation = transform_of(wall);
    node->mMetaData = wall_metadata(wall).release();
    std::vector<std::unique_ptr<aiNode>> children;
    ChunkNames name(wall.first_chunk);
    for (std::uint32_t c = 0; c < wall.chunk_count(); ++c, ++name) {
      children.push_back(chunk_node(wall, c, std::string(*name), parts));
    }
    if (with_bonds && !wall.bonds.empty()) children.push_back(bond_node(wall, parts));
    set_children(*node, std::move(children));
    wall_nodes.push_back(std::move(node));
  }
  auto scene = std::make_unique<aiScene>();
  scene->mRootNode = new aiNode("sunder");
  set_children(*scene->mRootNode, std::move(wall_nodes));
  scene->mNumMeshes = static_cast<unsigned>(parts.meshes.size());
  scene->mMeshes = release_all(parts.meshes);
  scene->mNumMaterials = static_cast<unsigned>(parts.materials.size());
  scene->mMaterials = release_all(parts.materials);
  // Where faces share vertices assimp's steps unshare them; they fail if told so of others.
  if (shares_vertices(*scene)) scene->mFlags |= AI_SCENE_FLAGS_NON_VERBOSE_FORMAT;
  return scene;
}

// --- aiScene → the writers' input ---------------------------------------------------------------

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::output, "scene: " + what);
}

// The arrays of a wall read from a scene, for its view to look at.
struct GatheredWall {
  WallView view;
  RenderMeshes meshes;
  std::vector<MassProperties> chunks;
  std::vector<Bond> bonds;
};

template <class T>
T required(const aiMetadata* data, const char* key) {
  T value{};
  if (data == nullptr || !data->Get(key, value)) refuse(std::string("no property ") + key);
  return value;
}

Vec3 required_vector(const aiMetadata* data, const std::string& key) {
  return {required<double>(data, (key + "_x").c_str()),
          required<double>(data, (key + "_y").c_str()),
          required<double>(data, (key + "_z").c_str())};
}

Vec3 from_ai(const aiVector3D& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

std::vector<Bond> bonds_from(const aiScene& scene, const aiNode& node) {
  if (node.mNumMeshes != 1 || node.mMeshes[0] >= scene.mNumMeshes) refuse("bonds are not one mesh");
  const aiMesh& mesh = *scene.mMeshes[node.mMeshes[0]];
  if (!mesh.HasPositions() || !mesh.HasNormals() || !mesh.HasTextureCoords(0)) {
    refuse("bonds lack positions, normals or texture coordinates");
  }
  const auto id = [](float value) {
    if (value == -1) return kWorld;
    if (!(value >= 0 && value < static_cast<float>(kMaxCells))) refuse("a bond joins no chunk");
    return static_cast<std::uint32_t>(value);
  };
  std::vector<Bond> bonds;
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& data = mesh.mTextureCoords[0][i];
    bonds.push_back({id(data.y), id(data.z), static_cast<double>(data.x),
                     from_ai(mesh.mVertices[i]), from_ai(mesh.mNormals[i])});
  }
  return bonds;
}

MassProperties mass_from(const aiMetadata* data) {
  const auto number = [data](const char* key) { return required<double>(data, key); };
  return {number("volume"),
          required_vector(data, "centroid"),
          {number("inertia_xx"), number("inertia_yy"), number("inertia_zz"), number("inertia_xy"),
           number("inertia_xz"), number("inertia_yz")}};
}

// Appends a mesh to the chunk that began at vertex `first`; returns its list.
std::uint32_t append_mesh(const aiMesh& mesh, std::size_t first, RenderMeshes& out) {
  if (!mesh.HasPositions() || !mesh.HasNormals() || !mesh.HasTextureCoords(0)) {
    refuse("a mesh lacks positions, normals or texture coordinates");
  }
  const auto base = static_cast<std::uint32_t>(out.positions.size() / 3 - first);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D p = mesh.mVertices[v], n = mesh.mNormals[v], t = mesh.mTextureCoords[0][v];
    out.positions.insert(out.positions.end(), {p.x, p.y, p.z});
    out.normals.insert(out.normals.end(), {n.x, n.y, n.z});
    out.uvs.insert(out.uvs.end(), {t.x, t.y});
  }
  IndexList list{static_cast<std::uint32_t>(out.indices.size()), 3 * mesh.mNumFaces};
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    if (mesh.mFaces[f].mNumIndices != 3) refuse("a face is not a triangle");
    for (unsigned k = 0; k < 3; ++k) {
      const unsigned index = mesh.mFaces[f].mIndices[k];
      if (index >= mesh.mNumVertices) refuse("an index is out of range");
      out.indices.push_back(base + index);
    }
  }
  out.lists.push_back(list);
  return static_cast<std::uint32_t>(out.lists.size() - 1);
}

bool is_inner(const aiScene& scene, const aiMesh& mesh) {
  if (mesh.mMaterialIndex >= scene.mNumMaterials) refuse("a mesh has no material");
  const std::string name = scene.mMaterials[mesh.mMaterialIndex]->GetName().C_Str();
  return name.ends_with("_inner");
}

void append_chunk(const aiScene& scene, const aiNode& node, GatheredWall& wall) {
  RenderMeshes& out = wall.meshes;
  const std::size_t first = out.positions.size() / 3;
  out.outer.push_back(RenderMeshes::kNoList);
  out.inner.push_back(RenderMeshes::kNoList);
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    if (node.mMeshes[i] >= scene.mNumMeshes) refuse("a node names a mesh that does not exist");
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    std::uint32_t& list = is_inner(scene, mesh) ? out.inner.back() : out.outer.back();
    if (list != RenderMeshes::kNoList) refuse("a chunk has two meshes of one side");
    list = append_mesh(mesh, first, out);
  }
  out.vertex_begin.push_back(static_cast<std::uint32_t>(out.positions.size() / 3));
  wall.chunks.push_back(mass_from(node.mMetaData));
}

void gather(const aiScene& scene, const aiNode& node, GatheredWall& wall) {
  const aiMetadata* data = node.mMetaData;
  const auto first_chunk = required<aiString>(data, "first_chunk");
  ChunkNames name(first_chunk.C_Str());
  for (unsigned i = 0; i < node.mNumChildren; ++i, ++name) {
    const aiNode& child = *node.mChildren[i];
    if (node.mName.C_Str() + std::string(kBondSuffix) == child.mName.C_Str()) {
      wall.bonds = bonds_from(scene, child);
      continue;
    }
    if (*name != child.mName.C_Str()) refuse("chunk names do not count up");
    append_chunk(scene, child, wall);
  }
  const Vec3 axis = required_vector(data, "rotation");
  wall.view = {.name = node.mName.C_Str(),
               .first_chunk = first_chunk.C_Str(),
               .material = required<aiString>(data, "material").C_Str(),
               .position = required_vector(data, "position"),
               .rotation = {axis.x, axis.y, axis.z, required<double>(data, "rotation_w")},
               .thickness = required<double>(data, "thickness"),
               .density = required<double>(data, "density"),
               .volume_expected = required<double>(data, "volume_expected"),
               .chunks = wall.chunks,
               .bonds = wall.bonds};
  show_meshes(wall.meshes, wall.view);
}

// --- our formats, registered with assimp ---------------------------------------------------------

void write_scene(const std::string& path, Assimp::IOSystem& system, const aiScene& scene) {
  if (scene.mRootNode == nullptr) refuse("no nodes");
  std::vector<GatheredWall> gathered(scene.mRootNode->mNumChildren);
  std::vector<WallView> walls;
  for (unsigned i = 0; i < scene.mRootNode->mNumChildren; ++i) {
    gather(scene, *scene.mRootNode->mChildren[i], gathered[i]);
    walls.push_back(gathered[i].view);
  }
  validate(walls);
  const std::string suffix = suffix_of(path);
  const std::filesystem::path companion = companion_of(path);
  StreamSink sink(system, path);
  if (suffix == ".glb") return write_glb(walls, sink);
  StreamSink companion_sink(system, companion.string());
  if (suffix == ".gltf") {
    return write_gltf(walls, companion.filename().string(), sink, companion_sink);
  }
  write_obj(walls, companion.filename().string(), sink);
  write_mtl(walls, companion_sink);
}

// What assimp calls. Its own exception cannot be thrown from outside its library and others it
// swallows, so what went wrong is kept for export_through_assimp to throw.
void export_scene(const char* path, Assimp::IOSystem* system, const aiScene* scene,
                  const Assimp::ExportProperties*) {
  auto& files = dynamic_cast<OutputFiles&>(*system);
  try {
    write_scene(path, files, *scene);
  } catch (...) {
    files.failure.keep();
  }
}

void register_formats(Assimp::Exporter& exporter) {
  using Entry = Assimp::Exporter::ExportFormatEntry;
  exporter.RegisterExporter(Entry("sunder-glb", "sunder GLB", "glb", export_scene));
  exporter.RegisterExporter(Entry("sunder-gltf", "sunder glTF", "gltf", export_scene));
  exporter.RegisterExporter(Entry("sunder-obj", "sunder Wavefront OBJ", "obj", export_scene));
}

const char* format_of(const std::filesystem::path& path) {
  const std::string suffix = suffix_of(path);
  if (suffix == ".glb") return "sunder-glb";
  if (suffix == ".gltf") return "sunder-gltf";
  if (suffix == ".obj") return "sunder-obj";
  if (suffix == ".stl") return "stlb";
  if (suffix == ".ply") return "plyb";
  throw Error(ErrorCode::usage, path.string() + ": suffix \"" + path.extension().string() +
                                    "\" is not one of .glb .gltf .obj .stl .ply .svg .html");
}

}  // namespace

void export_through_assimp(const MeshedAsset& asset, const std::filesystem::path& path) {
  std::string format = format_of(path);
  const bool is_soup = suffix_of(path) == ".stl" || suffix_of(path) == ".ply";
  const std::string name = path.string();
  if (!asset.solids.empty() && !is_soup)
    throw Error(ErrorCode::usage, name + ": solids go through assimp as .stl and .ply only");
  const std::vector<WallView> walls = views_of(asset, path);
  // assimp 5.2 writes colours of a binary PLY as floats where its header says bytes.
  const auto has_colours = [](const WallView& wall) { return !wall.colours.empty(); };
  if (format == "plyb" && std::ranges::any_of(walls, has_colours)) format = "ply";
  try {
    validate(walls);
    const std::unique_ptr<aiScene> scene = make_scene(walls, !is_soup);
    Assimp::Exporter exporter;
    register_formats(exporter);
    auto* files = new OutputFiles;
    exporter.SetIOHandler(files);  // owns it
    const aiReturn result = exporter.Export(scene.get(), format.c_str(), name);
    if (files->failure.first) std::rethrow_exception(files->failure.first);
    if (result != aiReturn_SUCCESS) throw Error(ErrorCode::output, exporter.GetErrorString());
    files->commit();
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.starts_with(name)) throw;
    throw Error(error.code(), name + ": " + message);
  }
}

}  // namespace sunder
