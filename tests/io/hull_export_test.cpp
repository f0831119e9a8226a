// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "io/export.hpp"
#include "io/hull_view.hpp"
#include "io/scene.hpp"
#include "sim/spin.hpp"

namespace sunder {
namespace {

TEST(HullNames, OfHullsAreToldFromThoseOfChunks) {
  for (const char* chunk : {"wall_chunk_0000", "UCX_a_chunk_00123"}) {
    EXPECT_FALSE(is_hull_name(chunk));
    for (const HullNodes nodes : {HullNodes::ucx, HullNodes::convcol}) {
      EXPECT_TRUE(is_hull_name(hull_name(nodes, chunk, 0))) << chunk;
      EXPECT_TRUE(is_hull_name(hull_name(nodes, chunk, 63))) << chunk;
    }
  }
  for (const char* name : {"", "UCX_", "UCX_wall_00", "wall_chunk_0000_00", "UCX_chunk_0000_0",
                           "wall_chunk_12_00-convcolonly"})
    EXPECT_FALSE(is_hull_name(name)) << name;
}

nlohmann::json exported(const HullParams& params) {
  Asset asset;
  Wall wall;
  wall.region.outline = rectangle({3, 2});
  wall.region.openings = {rectangle({0.9, 1.1}, {1, 0})};
  asset.walls.push_back(fracture_wall(wall, 2400, {}));
  MeshedAsset meshed = mesh_asset(asset);
  add_hulls(meshed, params, builtin_materials());
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "sunder_hull_export.gltf";
  export_asset(meshed, path);
  return nlohmann::json::parse(std::ifstream(path));
}

TEST(HullExport, BodiesHaveTheMassAndInertiaOfTheirChunks) {
  HullParams params;
  params.physics = true;
  const nlohmann::json file = exported(params);
  std::size_t bodies = 0;
  for (const auto& node : file["nodes"]) {
    if (!node.contains("extras") || !node["extras"]["sunder"].contains("mass")) continue;
    const auto& motion = node["extensions"]["KHR_physics_rigid_bodies"]["motion"];
    const auto& known = node["extras"]["sunder"];
    EXPECT_EQ(motion["mass"], known["mass"]);
    EXPECT_EQ(motion["centerOfMass"], known["centroid"]);
    const auto& d = motion["inertiaDiagonal"];
    const auto& q = motion["inertiaOrientation"];
    const SymMat3 m = rotated(axes_of({q[0], q[1], q[2], q[3]}), {d[0], d[1], d[2], 0, 0, 0});
    const double inertia[] = {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz};
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_NEAR(inertia[k], known["inertia"][k].get<double>(), 1e-7 * d[0].get<double>() + 1e-7);
    ++bodies;
  }
  EXPECT_GT(bodies, 20u);
}

TEST(HullExport, EveryColliderNamesANodeWithAHull) {
  for (const char* nodes : {"none", "ucx", "convcol"}) {
    HullParams params;
    params.nodes = nodes;
    params.physics = true;
    const nlohmann::json file = exported(params);
    std::vector<int> parents(file["nodes"].size(), 0), colliders(file["nodes"].size(), 0);
    for (const auto& node : file["nodes"]) {
      for (const auto& child : node.value("children", nlohmann::json::array()))
        ++parents[child.get<std::size_t>()];
      if (!node.contains("extensions")) continue;
      const auto& body = node["extensions"]["KHR_physics_rigid_bodies"];
      if (body.contains("collider"))
        ++colliders[body["collider"]["geometry"]["node"].get<std::size_t>()];
    }
    std::size_t hulls = 0;
    for (std::size_t n = 0; n < parents.size(); ++n) {
      const std::string name = file["nodes"][n]["name"];
      const bool is_hull = is_hull_name(name) || name.find("_hull_") != std::string::npos;
      EXPECT_EQ(colliders[n], is_hull ? 1 : 0) << name;
      hulls += is_hull;
      if (n > 0) {
        EXPECT_EQ(parents[n], is_hull && params.nodes == "none" ? 0 : 1) << name;
      }
      if (is_hull) {
        const auto& mesh = file["meshes"][file["nodes"][n]["mesh"].get<std::size_t>()];
        EXPECT_EQ(mesh["name"], name);
      }
    }
    EXPECT_GT(hulls, 20u);
  }
}

}  // namespace
}  // namespace sunder
