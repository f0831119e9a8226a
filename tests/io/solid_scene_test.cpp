// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "fracture/solid_prepare.hpp"
#include "fracture/solid_shapes.hpp"
#include "io/report.hpp"
#include "io/sample_asset.hpp"
#include "io/scene.hpp"
#include "io/schema_validator.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr const char* kSolids = R"json({"sunder": 1, "seed": 5,
  "walls": [{"name": "facade"}],
  "solids": [
    {"name": "vase", "file": "models/vase.obj", "material": "float-glass", "roughness": 0.002,
     "roughness_size": 0.03, "uv_scale": 0.5, "scale": 0.01, "repair": true, "max_error": 0.001,
     "position": [1, 2, 3], "rotation_deg": [90, 0, 0],
     "craters": [{"centre": [0, 0, 1], "radius": 0.25, "depth": 0.1, "roughness": 0.01,
                  "into": [0, 0, -2]}, {"centre": [1, 0, 0]}],
     "pattern": {"type": "voronoi", "chunks": 50, "near": [[0, 0, 1], [1, 0, 0]], "radius": 0.3,
                 "share": 0.6, "sites": [[0.1, 0.2, 0.3]]}},
    {"file": "models/b.stl", "pattern": {"type": "slices", "slices": [4, 0, 2],
      "offset_variation": 0.2, "angle_variation_deg": 9, "amplitude": 0.01, "wavelength": 0.2}},
    {"file": "models/b.stl", "pattern": {"type": "radial", "centre": [0, 1, 0], "axis": [0, 1, 0],
      "rays": 9, "rings": 3, "radius": 0.75, "variability": 0.1}},
    {"file": "models/b.stl", "pattern": {"type": "brick", "brick": [0.25, 0.0625, 0.125],
      "offset": 0.25, "mortar": 0.01}}
  ]})json";

class SolidScene : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "models");
    for (const char* name : {"models/vase.obj", "models/b.stl", "models/c.fbx"})
      put_content(folder_ / name, "x");
  }
  Scene read(const std::string& text) const {
    put_content(folder_ / "s.json", text);
    return read_scene(folder_ / "s.json");
  }
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::input);
      return error.what();
    }
    return {};
  }
  TestFolder folder_;
};

TEST_F(SolidScene, EveryKeyIsRead) {
  const Scene scene = read(kSolids);
  ASSERT_EQ(scene.solids.size(), 4u);
  const SolidModel& vase = scene.solids[0];
  EXPECT_EQ(vase.name, "vase");
  EXPECT_EQ(vase.file, (folder_ / "models/vase.obj").string());
  EXPECT_EQ(vase.material, "float-glass");
  EXPECT_EQ(vase.roughness, 0.002);
  EXPECT_EQ(vase.roughness_size, 0.03);
  EXPECT_EQ(vase.uv_scale, 0.5);
  EXPECT_EQ(vase.scale, 0.01);
  EXPECT_TRUE(vase.repair);
  EXPECT_EQ(vase.max_error, 0.001);
  EXPECT_EQ(vase.position, (Vec3{1, 2, 3}));
  EXPECT_EQ(vase.rotation, rotation_from_degrees({90, 0, 0}));
  ASSERT_EQ(vase.craters.size(), 2u);
  EXPECT_EQ(vase.craters[0].into, (Vec3{0, 0, -1}));
  EXPECT_EQ(vase.craters[0].depth, 0.1);
  EXPECT_EQ(vase.craters[1].into, Vec3{});
  const auto& voronoi = std::get<SolidVoronoiParams>(vase.pattern);
  EXPECT_EQ(voronoi.count, 50);
  EXPECT_EQ(voronoi.points, (std::vector<Vec3>{{0, 0, 1}, {1, 0, 0}}));
  EXPECT_EQ(voronoi.radius, 0.3);
  EXPECT_EQ(voronoi.share, 0.6);
  EXPECT_EQ(voronoi.sites, (std::vector<Vec3>{{0.1, 0.2, 0.3}}));
  EXPECT_EQ(scene.solids[1].name, "solid_2");
  const auto& slices = std::get<SolidSlicesParams>(scene.solids[1].pattern);
  EXPECT_EQ(slices.slices, (Vec3{4, 0, 2}));
  EXPECT_EQ(slices.offset_variation, 0.2);
  EXPECT_DOUBLE_EQ(slices.angle_variation, std::numbers::pi / 20);
  EXPECT_EQ(slices.amplitude, 0.01);
  EXPECT_EQ(slices.wavelength, 0.2);
  const auto& radial = std::get<SolidRadialParams>(scene.solids[2].pattern);
  EXPECT_EQ(radial.centre, (Vec3{0, 1, 0}));
  EXPECT_EQ(radial.axis, (Vec3{0, 1, 0}));
  EXPECT_EQ(radial.rays, 9);
  EXPECT_EQ(radial.rings, 3);
  EXPECT_EQ(radial.radius, 0.75);
  EXPECT_EQ(radial.variability, 0.1);
  const auto& brick = std::get<SolidBrickParams>(scene.solids[3].pattern);
  EXPECT_EQ(brick.brick, (Vec3{0.25, 0.0625, 0.125}));
  EXPECT_EQ(brick.offset, 0.25);
  EXPECT_EQ(brick.mortar, 0.01);
}

TEST_F(SolidScene, TheSchemaAcceptsIt) {
  const SchemaValidator validator(json_schema("scene"));
  EXPECT_TRUE(validator.accepts(kSolids));
}

TEST_F(SolidScene, ASceneOfSolidsOnlyIsAScene) {
  const Scene scene = read(R"({"sunder": 1, "solids": [{"file": "models/b.stl"}]})");
  EXPECT_EQ(scene.solids[0].name, "solid");
  EXPECT_EQ(std::get<SolidVoronoiParams>(scene.solids[0].pattern).count, 100);
}

TEST_F(SolidScene, NamesDifferAmongWallsAndSolids) {
  EXPECT_NE(refusal(R"({"sunder": 1, "walls": [{"name": "a"}],
                       "solids": [{"name": "a", "file": "models/b.stl"}]})")
                .find("/solids/0/name: a wall or solid named \"a\" exists already"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"sunder": 1, "solids": [{"name": "solid_2", "file": "models/b.stl"},
                       {"file": "models/b.stl"}]})")
                .find("/solids/1: a wall or solid named \"solid_2\" exists already"),
            std::string::npos);
}

TEST_F(SolidScene, AModelHasASuffixThatIsRead) {
  EXPECT_NE(refusal(R"({"sunder": 1, "solids": [{"file": "models/c.fbx"}]})")
                .find("/solids/0/file: the model \"models/c.fbx\" is not .obj, .glb, .gltf, .stl"),
            std::string::npos);
}

// --- what becomes of a model before it is fractured ----------------------------------------------

TEST(SolidPrepare, ScalesAndLeavesASoundModelAlone) {
  SolidModel solid;
  solid.scale = 0.5;
  const PreparedSolid prepared =
      prepare_solid(solid, test::as_surface(test::box({0, 0, 0}, {2, 2, 2})), 1);
  EXPECT_FALSE(prepared.repair);
  EXPECT_DOUBLE_EQ(mass_properties(prepared.surface.mesh).volume, 1);
}

ModelSurface open_box() {
  ModelSurface surface = test::as_surface(test::box({0, 0, 0}, {1, 1, 1}));
  surface.mesh.triangles.pop_back();
  surface.corners.resize(surface.corners.size() - 3);
  surface.material.pop_back();
  return surface;
}

TEST(SolidPrepare, RefusesWhatIsNoSolidAndSaysWhere) {
  SolidModel solid;
  solid.file = "open.obj";
  try {
    prepare_solid(solid, open_box(), 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::geometry);
    const std::string message = error.what();
    EXPECT_EQ(message.find("open.obj: is not a solid: 3 open edges, first near ("), 0u) << message;
    EXPECT_NE(message.find("--repair"), std::string::npos) << message;
  }
}

TEST(SolidPrepare, RepairsWhenAskedAndReportsIt) {
  SolidModel solid;
  solid.repair = true;
  PreparedSolid prepared = prepare_solid(solid, open_box(), 1);
  ASSERT_TRUE(prepared.repair);
  EXPECT_FALSE(prepared.repair->steps.empty());
  EXPECT_NEAR(mass_properties(prepared.surface.mesh).volume, 1, 1e-9);
  Report report;
  report.repairs.push_back({"crate", *prepared.repair});
  const auto json = nlohmann::ordered_json::parse(report_json(report));
  const auto& repair = json["repair"].at(0);
  EXPECT_EQ(repair["solid"], "crate");
  EXPECT_EQ(repair["volume_after"].get<double>(), prepared.repair->volume_after);
  EXPECT_EQ(repair["steps"].size(), prepared.repair->steps.size());
  const SchemaValidator validator(json_schema("report"));
  EXPECT_TRUE(validator.accepts(json.dump()));
}

TEST(SolidPrepare, ACraterGoesIntoTheNearestFace) {
  SolidModel solid;
  solid.max_error = 0.02;
  solid.craters = {{.centre = {0.5, 1, 0.5}, .radius = 0.3, .depth = 0.2, .into = {}}};
  const PreparedSolid prepared =
      prepare_solid(solid, test::as_surface(test::box({0, 0, 0}, {1, 1, 1})), 1);
  const double volume = mass_properties(prepared.surface.mesh).volume;
  EXPECT_LT(volume, 1 - 0.01);
  EXPECT_GT(volume, 1 - 0.06);
  EXPECT_TRUE(diagnose(prepared.surface).is_solid());
}

}  // namespace
}  // namespace sunder
