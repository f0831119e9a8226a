// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/imported_glb.hpp"

#include <array>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "io/string_sink.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

// Appends an item made of texts to a JSON list without its brackets.
void add_item(std::string& list, std::initializer_list<std::string_view> texts) {
  if (!list.empty()) list += ',';
  for (const std::string_view text : texts) list += text;
}

// JSON lists of a document that grows chunk by chunk, and its binary.
struct PlainGlb {
  std::string nodes, roots, meshes, accessors, views, binary;
  std::size_t accessor_count = 0, mesh_count = 0;

  // Number of the new accessor.
  template <class T>
  std::string add(const std::vector<T>& values, const char* type, const char* component,
                  std::size_t width) {
    const std::size_t size = values.size() * sizeof(T);
    const std::string number = std::to_string(accessor_count++);
    add_item(views, {R"({"buffer":0,"byteOffset":)", std::to_string(binary.size()),
                     R"(,"byteLength":)", std::to_string(size), "}"});
    add_item(accessors,
             {R"({"bufferView":)", number, R"(,"componentType":)", component, R"(,"count":)",
              std::to_string(values.size() / width), R"(,"type":")", type, "\"}"});
    binary.append(reinterpret_cast<const char*>(values.data()), size);
    return number;
  }
};

void add_chunk(const ImportedChunk& chunk, PlainGlb& glb) {
  std::array<std::vector<std::uint32_t>, 2> sides;
  for (std::size_t t = 0; t < chunk.inner.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) sides[chunk.inner[t]].push_back(chunk.triangles[3 * t + k]);
  if (sides[0].empty() && sides[1].empty()) return;
  const std::string position = glb.add(chunk.positions, "VEC3", "5126", 3);
  std::string primitives;
  for (std::size_t side = 0; side < 2; ++side) {
    if (sides[side].empty()) continue;
    add_item(primitives, {R"({"attributes":{"POSITION":)", position, R"(},"indices":)",
                          glb.add(sides[side], "SCALAR", "5125", 1), R"(,"material":)",
                          side == 0 ? "0" : "1", "}"});
  }
  const std::string number = std::to_string(glb.mesh_count++);
  add_item(glb.nodes, {R"({"name":)", json_quoted(chunk.name), R"(,"mesh":)", number, "}"});
  add_item(glb.roots, {number});
  add_item(glb.meshes, {R"({"primitives":[)", primitives, "]}"});
}

std::string document_of(const PlainGlb& glb) {
  std::string json;
  add_item(json,
           {R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)", glb.roots,
            R"(]}],"materials":[{"name":"outer","pbrMetallicRoughness":{"baseColorFactor":)",
            R"([0.43,0.42,0.39,1]}},{"name":"broken_inner","pbrMetallicRoughness":)",
            R"({"baseColorFactor":[0.23,0.2,0.17,1]}}],"nodes":[)", glb.nodes, R"(],"meshes":[)",
            glb.meshes, R"(],"accessors":[)", glb.accessors, R"(],"bufferViews":[)", glb.views,
            R"(],"buffers":[{"byteLength":)", std::to_string(glb.binary.size()), "}]}"});
  json.append((4 - json.size() % 4) % 4, ' ');
  return json;
}

void append_word(std::size_t value, std::string& out) {
  const auto word = static_cast<std::uint32_t>(value);
  out.append(reinterpret_cast<const char*>(&word), sizeof word);
}

}  // namespace

std::string glb_of(const ImportedAsset& asset) {
  PlainGlb glb;
  for (const ImportedWall& wall : asset.walls)
    for (const ImportedChunk& chunk : wall.chunks) add_chunk(chunk, glb);
  if (glb.mesh_count == 0) throw Error(ErrorCode::input, "the file has no triangles to show");
  const std::string json = document_of(glb);
  std::string bytes = "glTF";
  append_word(2, bytes);
  append_word(28 + json.size() + glb.binary.size(), bytes);
  append_word(json.size(), bytes);
  bytes += "JSON";
  bytes += json;
  append_word(glb.binary.size(), bytes);
  bytes.append("BIN\0", 4);
  return bytes + glb.binary;
}

}  // namespace sunder
