// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/import.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <string>

#include "io/export.hpp"
#include "io/imported_asset.hpp"
#include "io/reader_process.hpp"
#include "io/sample_asset.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

// The message of the Error that reading the file throws, empty if it is read.
std::string input_error(const std::filesystem::path& path, ImportLimits limits = {}) {
  try {
    import_asset(path, limits);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input) << error.what();
    EXPECT_EQ(std::string(error.what()).find(path.string()), 0u) << error.what();
    return error.what();
  }
  return "";
}

// A .glb of this JSON and nothing else.
std::string glb(std::string json) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::uint32_t head[] = {0x46546C67, 2, static_cast<std::uint32_t>(20 + json.size()),
                                static_cast<std::uint32_t>(json.size()), 0x4E4F534A};
  return std::string(reinterpret_cast<const char*>(head), sizeof head) + json;
}

// One triangle whose data stand in `uri`.
std::string gltf_with_buffer(const std::string& uri) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,)"
         R"("name":"w_chunk_0000"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
         R"("min":[0,0,0],"max":[1,1,1]}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
         R"("buffers":[{"byteLength":36,"uri":")" +
         uri + "\"}]}";
}

// Cuts the file of a format at twelve places.
void expect_truncations_refused(const std::string& suffix) {
  Asset asset;
  asset.walls.push_back(sample_wall("w", 2, 1));
  const TestFolder folder;
  export_asset(mesh_asset(asset), folder / ("whole" + suffix));
  const std::string whole = content_of(folder / ("whole" + suffix));
  ASSERT_EQ(input_error(folder / ("whole" + suffix)), "");
  for (std::size_t i = 0; i < 12; ++i) {
    put_content(folder / ("cut" + suffix), whole.substr(0, whole.size() * i / 12));
    const ImportLimits limits{.memory = std::uint64_t{256} << 20, .seconds = 0.1};
    EXPECT_NE(input_error(folder / ("cut" + suffix), limits), "") << "cut to " << i << "/12";
  }
}

TEST(Import, TruncatedGlbIsAnError) {
  expect_truncations_refused(".glb");
}
TEST(Import, TruncatedStlIsAnError) {
  expect_truncations_refused(".stl");
}
TEST(Import, TruncatedPlyIsAnError) {
  expect_truncations_refused(".ply");
}

// A text format can end early and still be a file of its kind: less of it, or an error.
TEST(Import, TruncatedObjHoldsLessOrIsAnError) {
  Asset asset;
  asset.walls.push_back(sample_wall("w", 2, 1));
  const TestFolder folder;
  export_asset(mesh_asset(asset), folder / "whole.obj");
  const std::string whole = content_of(folder / "whole.obj");
  const auto triangles = [](const ImportedAsset& read) {
    std::size_t count = 0;
    for (const ImportedChunk& chunk : read.walls.at(0).chunks) count += chunk.inner.size();
    return count;
  };
  const std::size_t all = triangles(import_asset(folder / "whole.obj"));
  for (std::size_t i = 0; i < 12; ++i) {
    put_content(folder / "cut.obj", whole.substr(0, whole.size() * i / 12));
    try {
      EXPECT_LT(triangles(import_asset(folder / "cut.obj")), all);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::input) << error.what();
    }
  }
}

TEST(Import, HostileFilesAreErrors) {
  std::string nested = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)";
  for (int i = 0; i < 20000; ++i) nested += R"({"children":[)" + std::to_string(i + 1) + "]},";
  nested += "{}]}";
  const std::string one_vertex = "v 0 0 0\n", triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex ";
  struct Row {
    const char* name;
    std::string content;
  };
  const Row rows[] = {
      {"empty.glb", ""},
      {"empty.obj", ""},
      {"empty.stl", ""},
      {"empty.ply", ""},
      {"garbage.glb", std::string(1000, '\x93')},
      {"garbage.stl", std::string(1000, '\x93')},
      {"garbage.ply", std::string(1000, '\x93')},
      {"no_meshes.glb", glb(R"({"asset":{"version":"2.0"}})")},
      {"deep_nodes.glb", glb(nested)},
      {"deep_json.gltf", std::string(200000, '[')},
      {"node_cycle.glb", glb(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
                             R"("nodes":[{"children":[1]},{"children":[0]}]})")},
      {"node_missing.glb",
       glb(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[7]}],"nodes":[{}]})")},
      {"accessor_lies.gltf",
       R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
       R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,)"
       R"("componentType":5126,"count":4000000000,"type":"VEC3"}],"bufferViews":[{"buffer":0,)"
       R"("byteLength":36}],"buffers":[{"byteLength":36,"uri":"data:;base64,AAAA"}]})"},
      {"index_out_of_range.obj", triangle + "f 1 2 9\n"},
      {"index_zero.obj", triangle + "f 0 1 2\n"},
      {"no_faces.obj", triangle},
      {"ply_too_many.ply", ply + "4294967295\nproperty float x\nend_header\n0\n"},
      {"ply_negative.ply", ply + "-5\nproperty float x\nend_header\n"},
      {"ply_no_end.ply", ply + "3\nproperty float x\n" + std::string(4096, 'x')},
      {"ply_bad_index.ply", ply + "3\nproperty float x\nproperty float y\nproperty float z\n"
                                  "element face 1\nproperty list uchar int vertex_indices\n"
                                  "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 99\n"},
      {"stl_too_many.stl", std::string(80, ' ') + "\xff\xff\xff\x7f" + std::string(50, '\0')}};
  const TestFolder folder;
  for (const Row& row : rows) {
    put_content(folder / row.name, row.content);
    const ImportLimits limits{.memory = std::uint64_t{256} << 20, .seconds = 0.2};
    EXPECT_FALSE(input_error(folder / row.name, limits).empty()) << row.name;
  }
}

// assimp's material reader crashes on this file: the mesh is refused, and we live on.
TEST(Import, ACrashInsideTheReaderIsAnError) {
  const TestFolder folder;
  put_content(folder / "a.mtl", "map_Kd a.png\n");
  put_content(folder / "a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n");
  const std::string message = input_error(folder / "a.obj");
  EXPECT_NE(message.find("crashed"), std::string::npos) << message;
}

TEST(Import, FilesOutsideTheFolderAreNotOpened) {
  const TestFolder folder;
  std::filesystem::create_directories(folder / "in");
  const std::string triangle(
      "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0"
      "\0\0\0\0\0\0\x80\x3f\0\0\0\0",
      36);
  put_content(folder / "secret.bin", triangle);
  put_content(folder / "in/beside.bin", triangle);
  std::filesystem::create_symlink(folder / "secret.bin", folder / "in/link.bin");
  const std::string secret = (folder / "secret.bin").string();
  put_content(folder / "in/ok.gltf", gltf_with_buffer("beside.bin"));
  EXPECT_EQ(input_error(folder / "in/ok.gltf"), "");
  put_content(folder / "in/ok.gltf", gltf_with_buffer("%62eside.bin"));
  EXPECT_EQ(input_error(folder / "in/ok.gltf"), "");
  for (const std::string& uri :
       {std::string("../secret.bin"), std::string("link.bin"), std::string("%2e%2e/secret.bin"),
        std::string("..%2fsecret.bin"), secret, "file://" + secret, std::string("/dev/zero"),
        std::string("none.bin")}) {
    put_content(folder / "in/a.gltf", gltf_with_buffer(uri));
    EXPECT_FALSE(input_error(folder / "in/a.gltf").empty()) << uri;
  }
}

// The material file crashes the reader that opens it, so it shows whether it was opened.
TEST(Import, MtllibDoesNotLeaveTheFolder) {
  const TestFolder folder;
  std::filesystem::create_directories(folder / "in");
  put_content(folder / "out.mtl", "map_Kd a.png\n");
  put_content(folder / "in/in.mtl", "map_Kd a.png\n");
  const auto is_opened = [&](const std::string& library) {
    put_content(folder / "in/a.obj",
                "mtllib " + library + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n");
    return !input_error(folder / "in/a.obj").empty();
  };
  EXPECT_TRUE(is_opened("in.mtl"));
  EXPECT_FALSE(is_opened("../out.mtl"));
  EXPECT_FALSE(is_opened((folder / "out.mtl").string()));
}

TEST(Import, LimitsHold) {
  const TestFolder folder;
  Asset asset;
  asset.walls.push_back(sample_wall("w", 40, 30));
  export_asset(mesh_asset(asset), folder / "a.glb");
  EXPECT_EQ(input_error(folder / "a.glb"), "");
  const std::string large = input_error(folder / "a.glb", {.file_size = 1000});
  EXPECT_NE(large.find("at most 1000"), std::string::npos) << large;
  const std::string memory = input_error(folder / "a.glb", {.memory = 1 << 20});
  EXPECT_FALSE(memory.empty());
}

TEST(Import, AReaderThatNeverEndsIsStopped) {
  const auto begin = std::chrono::steady_clock::now();
  try {
    const ChildWork read = [] {
      volatile bool done = false;
      while (!done) {
      }
      return [](AnswerWriter&) {};
    };
    run_reader("loop.ply", {.seconds = 0.1}, read, [](AnswerReader&) {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input);
    EXPECT_EQ(std::string(error.what()), "loop.ply: the reader took too long (limit 0.1 s)");
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST(Import, AReaderThatTakesAllMemoryIsStopped) {
  try {
    const ChildWork read = []() -> std::function<void(AnswerWriter&)> {
      ImportedAsset asset;
      while (true) asset.walls.emplace_back().name.assign(1 << 20, 'x');
    };
    run_reader("big.ply", {.memory = std::uint64_t{64} << 20}, read, [](AnswerReader&) {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input);
#ifndef __SANITIZE_ADDRESS__  // whose allocator ends the process instead of throwing
    EXPECT_NE(std::string(error.what()).find("ran out of memory"), std::string::npos)
        << error.what();
#endif
  }
}

// What a hijacked reader might send: the parent must not trust a single number of it.
TEST(Import, ADamagedAnswerIsAnError) {
  try {
    const ChildWork read = [] {
      ImportedAsset asset;
      asset.walls.emplace_back().chunks.push_back({"c", {0, 0, 0}, {0, 1, 2}, {0}});
      // Indices 1 and 2 do not exist.
      return [asset](AnswerWriter& out) { send_asset(asset, out); };
    };
    run_reader("odd.glb", {}, read, [](AnswerReader& in) { receive_asset(in); });
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "odd.glb: the reader's answer is damaged");
  }
}

TEST(Import, WhatIsNotAFileIsAnError) {
  const TestFolder folder;
  EXPECT_NE(input_error(folder / "none.glb").find("No such file"), std::string::npos);
  std::filesystem::create_directories(folder / "folder.glb");
  EXPECT_NE(input_error(folder / "folder.glb").find("regular"), std::string::npos);
  put_content(folder / "a.fbx", "x");
  try {
    import_asset(folder / "a.fbx");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
  }
}

}  // namespace
}  // namespace sunder
