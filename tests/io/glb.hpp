// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sunder {

using Json = nlohmann::json;

/// A .glb file as a player reads it.
class Glb {
 public:
  explicit Glb(const std::string& bytes) {
    std::uint32_t head[5];
    std::memcpy(head, bytes.data(), sizeof head);
    json = Json::parse(bytes.substr(20, head[3]));
    binary = bytes.substr(28 + head[3]);
    const Json& nodes = json["nodes"];
    for (std::size_t i = 0; i < nodes.size(); ++i) node_of[nodes[i]["name"]] = i;
  }

  /// The numbers of an accessor.
  std::vector<float> values(std::size_t accessor) const {
    const Json& a = json["accessors"].at(accessor);
    const Json& view = json["bufferViews"].at(a["bufferView"].get<std::size_t>());
    const std::map<std::string, std::size_t> widths = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
    std::vector<float> result(a["count"].get<std::size_t>() * widths.at(a["type"]));
    EXPECT_EQ(a["componentType"], 5126);
    const std::size_t offset = view["byteOffset"].get<std::size_t>() + a.value("byteOffset", 0u);
    EXPECT_LE(offset + 4 * result.size(), binary.size());
    std::memcpy(result.data(), binary.data() + offset, 4 * result.size());
    return result;
  }

  /// Sampler of a node's channel; null: the node has none of that path.
  const Json* sampler(const std::string& node, const std::string& path) const {
    if (!json.contains("animations")) return nullptr;
    const Json& animation = json["animations"].at(0);
    for (const Json& channel : animation["channels"]) {
      if (channel["target"]["node"] == node_of.at(node) && channel["target"]["path"] == path) {
        return &animation["samplers"].at(channel["sampler"].get<std::size_t>());
      }
    }
    return nullptr;
  }

  /// An index list.
  std::vector<std::uint32_t> indices(std::size_t accessor) const {
    const Json& a = json["accessors"].at(accessor);
    const Json& view = json["bufferViews"].at(a["bufferView"].get<std::size_t>());
    EXPECT_EQ(a["componentType"], 5123);
    std::vector<std::uint16_t> values(a["count"].get<std::size_t>());
    const std::size_t offset = view["byteOffset"].get<std::size_t>() + a.value("byteOffset", 0u);
    std::memcpy(values.data(), binary.data() + offset, 2 * values.size());
    return {values.begin(), values.end()};
  }

  /// The first primitive of a node's mesh.
  const Json& primitive(const std::string& node) const {
    const std::size_t mesh = json["nodes"].at(node_of.at(node))["mesh"];
    return json["meshes"].at(mesh)["primitives"].at(0);
  }

  Json json;
  std::string binary;
  std::map<std::string, std::size_t> node_of;
};

}  // namespace sunder
