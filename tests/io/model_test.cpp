// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/model.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>

#include "fracture/solid_shapes.hpp"
#include "io/sample_asset.hpp"
#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "meshing/tri_mesh.hpp"

namespace sunder {
namespace {

constexpr const char* kTetrahedron =
    "v 0 0 0\nv 0.1 0 0\nv 0 0.2 0\nv 0 0 0.3\n"
    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Binary STL of a mesh; the count may lie.
std::string stl_of(const TriMesh& mesh, std::uint32_t lie = 0) {
  std::string bytes(80, ' ');
  put(bytes, static_cast<std::uint32_t>(mesh.triangles.size()) + lie);
  for (const auto& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) put(bytes, 0.0f);  // the normal that many programs write
    for (const std::uint32_t v : triangle) {
      const Vec3 p = mesh.vertices[v];
      for (const double x : {p.x, p.y, p.z}) put(bytes, static_cast<float>(x));
    }
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string refusal(const std::filesystem::path& path) {
  try {
    read_model(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input) << error.what();
    EXPECT_EQ(std::string(error.what()).find(path.string()), 0u) << error.what();
    return error.what();
  }
  return {};
}

void expect_whole(const ModelSurface& surface) {
  const std::size_t triangles = surface.mesh.triangles.size();
  EXPECT_EQ(surface.corners.size(), 3 * triangles);
  EXPECT_EQ(surface.material.size(), triangles);
  for (const std::uint32_t m : surface.material) EXPECT_LT(m, surface.materials.size());
  for (const Corner& corner : surface.corners) {
    const auto [x, y, z] = corner.normal;
    EXPECT_NEAR(x * x + y * y + z * z, 1, 1e-5);
  }
}

TEST(Model, AnObjKeepsTheBitsOfItsFloats) {
  const TestFolder folder;
  put_content(folder / "a.obj", kTetrahedron);
  const ModelSurface surface = read_model(folder / "a.obj");
  expect_whole(surface);
  ASSERT_EQ(surface.mesh.vertices.size(), 4u);
  EXPECT_EQ(surface.mesh.triangles.size(), 4u);
  EXPECT_EQ(check(surface.mesh), MeshDefects{});
  double largest = 0;
  for (const Vec3 v : surface.mesh.vertices) largest = std::max({largest, v.x, v.y, v.z});
  EXPECT_EQ(largest, static_cast<double>(0.3f));
  ASSERT_EQ(surface.materials.size(), 1u);
  EXPECT_EQ(surface.materials[0], SurfaceMaterial{});
  EXPECT_FALSE(surface.has_uvs);
  EXPECT_FALSE(surface.has_colours);
}

TEST(Model, AnStlIsWeldedByItsBitsAndGetsFlatNormals) {
  const TestFolder folder;
  for (const test::Shape& shape : test::shapes()) {
    SCOPED_TRACE(shape.name);
    put_content(folder / "a.stl", stl_of(shape.mesh));
    const ModelSurface surface = read_model(folder / "a.stl");
    expect_whole(surface);
    EXPECT_EQ(surface.mesh.triangles.size(), shape.mesh.triangles.size());
    EXPECT_LE(surface.mesh.vertices.size(), shape.mesh.vertices.size());
    EXPECT_EQ(check(surface.mesh).open_edges, 0u);
    const double volume = mass_properties(shape.mesh).volume;
    EXPECT_NEAR(mass_properties(surface.mesh).volume, volume, 1e-5 * volume);
  }
}

TEST(Model, MinusZeroIsZero) {
  const TestFolder folder;
  TriMesh mesh = test::box({-1, 0, 0}, {1, 1, 1});
  std::string bytes = stl_of(mesh);
  // Of the first triangle only, so that its neighbours say 0 where it says -0.
  for (std::size_t at = 84 + 12; at < 84 + 48; at += 4)
    if (std::string(4, '\0') == bytes.substr(at, 4)) bytes[at + 3] = '\x80';
  put_content(folder / "a.stl", bytes);
  EXPECT_EQ(read_model(folder / "a.stl").mesh.vertices.size(), 8u);
}

TEST(Model, SeveralObjectsAndMaterialsAreOneSurface) {
  const TestFolder folder;
  put_content(folder / "a.mtl",
              "newmtl red\nKd 1 0.25 0\nPr 0.5\nPm 1\nnewmtl unused\nKd 0 0 0\n"
              "newmtl picture\nKd 1 1 1\nmap_Kd images/a b.png\nnewmtl thief\nmap_Kd ../x.png\n");
  std::filesystem::create_directories(folder / "images");
  put_content(folder / "images/a b.png", "\x89PNG");
  put_content(folder.path().parent_path() / "x.png", "\x89PNG");
  put_content(folder / "a.obj",
              "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no one\nusemtl red\nf 1 3 2\n"
              "o two\nusemtl picture\nf 1 2 4\nusemtl thief\nf 1 4 3\nusemtl red\nf 2 3 4\n");
  const ModelSurface surface = read_model(folder / "a.obj");
  expect_whole(surface);
  EXPECT_EQ(check(surface.mesh), MeshDefects{});
  ASSERT_EQ(surface.materials.size(), 3u);
  EXPECT_EQ(surface.materials[0].name, "red");
  EXPECT_EQ(surface.materials[0].base_colour, (std::array<float, 4>{1, 0.25f, 0, 1}));
  EXPECT_EQ(surface.materials[1].texture, "images/a b.png");
  EXPECT_EQ(surface.materials[2].texture, "");
  std::filesystem::remove(folder.path().parent_path() / "x.png");
}

TEST(Model, NodesMoveTurnAndMirrorTheirMeshes) {
  const TestFolder folder;
  const TriMesh box = test::box({0, 0, 0}, {1, 1, 1});
  std::string binary;
  for (const Vec3 p : box.vertices)
    for (const double x : {p.x, p.y, p.z}) put(binary, static_cast<float>(x));
  const std::size_t vertices = binary.size();
  for (const auto& triangle : box.triangles)
    for (const std::uint32_t v : triangle) put(binary, static_cast<std::uint16_t>(v));
  put_content(folder / "a.bin", binary);
  const std::string indices = std::to_string(binary.size() - vertices);
  put_content(folder / "a.gltf",
              R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,2]}],
      "nodes":[{"translation":[10,0,0],"children":[1]},
               {"mesh":0,"scale":[2,2,2],"rotation":[0,0.70710678,0,0.70710678]},
               {"mesh":0,"scale":[-1,1,1]}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3",
                    "min":[0,0,0],"max":[1,1,1]},
                   {"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}],
      "bufferViews":[{"buffer":0,"byteLength":)" +
                  std::to_string(vertices) + R"(},{"buffer":0,"byteOffset":)" +
                  std::to_string(vertices) + R"(,"byteLength":)" + indices + R"(}],
      "buffers":[{"uri":"a.bin","byteLength":)" +
                  std::to_string(binary.size()) + "}]}");
  const ModelSurface surface = read_model(folder / "a.gltf");
  expect_whole(surface);
  EXPECT_EQ(surface.mesh.triangles.size(), 24u);
  EXPECT_EQ(check(surface.mesh), MeshDefects{});
  const MassProperties mass = mass_properties(surface.mesh);
  EXPECT_NEAR(mass.volume, 9, 1e-5);  // a mirrored box faces outwards
  // Boxes of 8 m³ about (11, 1, -1) and 1 m³ about (-0.5, 0.5, 0.5).
  EXPECT_NEAR(mass.centroid.x, (8 * 11 - 0.5) / 9, 1e-5);
  EXPECT_NEAR(mass.centroid.z, (-8 + 0.5) / 9, 1e-5);
}

TEST(Model, ColoursBecomeLinear) {
  const TestFolder folder;
  put_content(folder / "a.ply",
              "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
              "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
              "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
              "0 0 0 255 128 0\n1 0 0 255 128 0\n0 1 0 255 128 0\n0 0 1 255 128 0\n"
              "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  const ModelSurface surface = read_model(folder / "a.ply");
  EXPECT_TRUE(surface.has_colours);
  for (const Corner& corner : surface.corners) {
    EXPECT_NEAR(corner.colour[0], 1, 1e-6);
    EXPECT_NEAR(corner.colour[1], 0.2158605, 0.003);  // ((128/255 + 0.055) / 1.055)^2.4
    EXPECT_EQ(corner.colour[2], 0);
  }
}

TEST(Model, HostileFilesAreErrorsOrSurfaces) {
  const TestFolder folder;
  const std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
      "property float y\nproperty float z\nelement face 4000000000\n"
      "property list uchar int vertex_indices\nend_header\n";
  const std::pair<const char*, std::string> cases[] = {
      {"empty.obj", ""},
      {"empty.stl", ""},
      {"points.obj", "v 0 0 0\nv 1 0 0\n"},
      {"indices.obj", "v 0 0 0\nf 1 2 999999999\n"},
      {"count.stl", stl_of(test::box({0, 0, 0}, {1, 1, 1}), 4000000000u)},
      {"count.ply", ply},
      {"text.glb", "glTF but not really"},
      {"open.gltf", "{\"asset\": {\"version\": \"2.0\"}"},
      {"deep.gltf", std::string(100000, '[')},
      {"zeros.glb", std::string(1000, '\0')},
  };
  for (const auto& [name, content] : cases) {
    put_content(folder / name, content);
    EXPECT_FALSE(refusal(folder / name).empty()) << name;
  }
  EXPECT_NE(refusal(folder / "none.obj").find("No such file"), std::string::npos);
}

TEST(Model, TruncatedAndChangedFilesNeverDoWorseThanFail) {
  const TestFolder folder;
  const std::string stl = stl_of(test::box({0, 0, 0}, {1, 1, 1}));
  const std::string obj = kTetrahedron;
  for (std::uint64_t i = 0; i < 12; ++i) {
    std::string part = stl.substr(0, random_bits(7, i) % stl.size());
    put_content(folder / "a.stl", part);
    refusal(folder / "a.stl");
    part = obj;
    for (std::uint64_t k = 0; k < 4; ++k)
      part[random_bits(8, i, k) % part.size()] = static_cast<char>(random_bits(9, i, k));
    put_content(folder / "a.obj", part);
    refusal(folder / "a.obj");
  }
}

}  // namespace
}  // namespace sunder
