// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/impact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "io/export.hpp"
#include "meshing/error.hpp"
#include "sim/blow.hpp"
#include "sim/penetration.hpp"
#include "tests/sim/impact_scenes.hpp"

namespace sunder {
namespace {

const Material& material_of(const std::string& name) {
  return find_material(builtin_materials(), name);
}

double sum(const EnergyLedger& e) {
  return e.kinetic + e.potential + e.strain + e.fracture + e.friction + e.contact + e.numerical;
}

/// Steel shots light enough to have to tunnel: radius 50 mm, 4.11 kg.
Shot light_shot(double thickness, double speed) {
  Shot shot;
  shot.thickness = thickness;
  shot.radius = 0.05;
  shot.mass = 4.11;
  shot.speed = speed;
  shot.duration = 0.1;
  shot.pattern = R"({"type": "voronoi-grid", "cell": 0.1})";
  shot.width = shot.height = 1.5;
  return shot;
}

TEST(Impact, ConcreteIsPerforatedAboveThePublishedBandAndNeverBelowIt) {
  const Material& c30 = material_of("concrete-c30");
  ConcreteShot published;
  published.mass = 4.11;
  published.diameter = 0.1;
  published.compressive_strength = c30.compressive_strength;
  published.tensile_strength = c30.tensile_strength;
  published.density = c30.density;
  for (const double thickness : {0.1, 0.15, 0.25, 0.4}) {
    const BallisticBand band = ballistic_band(published, thickness);
    const ImpactResult below = run(light_shot(thickness, 0.95 * band.low()));
    EXPECT_FALSE(below.projectiles[0].perforated) << thickness;
    EXPECT_EQ(below.chunks_freed, 0u) << thickness;
    const ImpactResult above = run(light_shot(thickness, 1.05 * band.high()));
    EXPECT_GT(above.chunks_freed, 0u) << thickness;
    EXPECT_TRUE(above.projectiles[0].perforated) << thickness;
  }
}

TEST(Impact, ResidualSpeedFollowsRechtAndIpsonWithThePlugsMass) {
  const double limit = run(light_shot(0.1, 10)).projectiles[0].ballistic_speed;
  for (const double ratio : {1.05, 1.2, 1.5, 2.0, 3.0, 5.0}) {
    Shot shot = light_shot(0.1, ratio * limit);
    shot.simulation = ", \"gravity\": 0";
    const ImpactResult result = run(shot);
    ASSERT_TRUE(result.projectiles[0].perforated) << ratio;
    const double expected = residual_speed(4.11, result.freed_mass, shot.speed, limit);
    EXPECT_NEAR(result.projectiles[0].residual_speed / expected, 1, 0.02) << ratio;
  }
}

TEST(Impact, BouncesBackWithTheRestitutionOfThePair) {
  Shot shot = light_shot(0.4, 30);
  shot.simulation = ", \"gravity\": 0";
  const ImpactResult result = run(shot);
  const double e = std::sqrt(0.5 * material_of("concrete-c30").restitution);
  EXPECT_NEAR(result.energy.kinetic / result.energy_in, e * e, 1e-9);
  EXPECT_NEAR(result.energy.contact / result.energy_in, 1 - e * e, 1e-9);
  EXPECT_NEAR(result.reactions[2], 4.11 * 30 * (1 + e), 1e-6);
}

TEST(Impact, LedgerAddsUpAndCracksCostNoMoreThanTheBallLost) {
  for (const char* material : {"concrete-c20", "concrete-c50", "brick", "gypsum", "float-glass"})
    for (const double speed : {3.0, 10.0, 40.0}) {
      Shot shot;
      shot.material = material;
      shot.speed = speed;
      if (shot.material == "float-glass") shot.thickness = 0.01, shot.mass = 4, shot.radius = 0.05;
      const ImpactResult r = run(shot);
      EXPECT_NEAR(sum(r.energy), r.energy_in, 1e-9 * r.energy_in) << material << ' ' << speed;
      EXPECT_LT(std::abs(r.energy.numerical), 0.02 * r.energy_in) << material << ' ' << speed;
      EXPECT_GE(r.energy.contact, 0) << material << ' ' << speed;
      EXPECT_GE(r.energy.friction, 0) << material << ' ' << speed;
      const double cracks = material_of(material).fracture_energy * r.crack_area;
      EXPECT_NEAR(r.energy.fracture, cracks, 1e-9 * cracks) << material << ' ' << speed;
      EXPECT_LE(r.energy.fracture, r.energy_in) << material << ' ' << speed;
      EXPECT_LT(r.energy_peak_ratio, 1.001) << material << ' ' << speed;
      EXPECT_LT(r.momentum_error, 1e-6) << material << ' ' << speed;
      EXPECT_GT(r.broken_bonds, 0u) << material << ' ' << speed;
    }
}

TEST(Impact, HarderHitsNeverFreeLess) {
  for (const char* material : {"concrete-c30", "brick", "gypsum"}) {
    std::uint64_t before = 0;
    for (const double mass : {30.0, 100.0, 300.0, 1000.0}) {
      Shot shot;
      shot.material = material;
      shot.mass = mass;
      shot.width = 5, shot.height = 4;
      shot.duration = 0.05;
      const std::uint64_t freed = run(shot).chunks_freed;
      EXPECT_GE(freed, before) << material << ' ' << mass;
      before = freed;
    }
    EXPECT_GT(before, 0u) << material;
  }
}

TEST(Impact, SkippingChangesNothing) {
  for (const char* pattern : {R"({"type": "voronoi-grid", "cell": 0.2})",
                              R"({"type": "quad-grid", "cell": 0.2})",
                              R"({"type": "spiderweb", "rest_cell": 0.5})"}) {
    Shot shot;
    shot.pattern = pattern;
    shot.material = "brick";
    shot.duration = 0.4;
    const ImpactResult lazy = run(shot), eager = run(shot, {.skip = false, .progress = {}});
    EXPECT_EQ(lazy.hash, eager.hash) << pattern;
    EXPECT_EQ(lazy.broken_bonds, eager.broken_bonds) << pattern;
    EXPECT_EQ(lazy.energy.kinetic, eager.energy.kinetic) << pattern;
    EXPECT_GT(lazy.chunks_freed, 0u) << pattern;
  }
}

TEST(Impact, RunsTwiceTheSame) {
  Shot shot;
  shot.duration = 1;
  const ImpactResult a = run(shot), b = run(shot);
  EXPECT_EQ(a.hash, b.hash);
  shot.seed = 2;
  EXPECT_NE(run(shot).hash, a.hash);
}

TEST(Impact, WallFromAFileRunsAsTheOneInMemory) {
  Shot shot;
  const Scene scene = parse_scene(scene_text_of(shot), "shot.json");
  Asset asset;
  asset.walls.push_back(fracture_wall(scene.walls[0], 2400, {.seed = scene.seed, .threads = 1}));
  const auto folder = std::filesystem::temp_directory_path() / "sunder_impact_test";
  std::filesystem::create_directories(folder);
  for (const char* name : {"wall.glb", "wall.gltf", "wall.obj"}) {
    export_asset(mesh_asset(asset), folder / name);
    std::string text = scene_text_of(shot);
    const std::size_t from = text.find("\"outline\""), to = text.find("\"thickness\"");
    text.replace(from, to - from, std::string("\"asset\": \"") + name + "\", ");
    const std::size_t pattern = text.find(", \"pattern\"");
    text.erase(pattern, text.find("}]", pattern) - pattern);
    const Scene other = parse_scene(text, (folder / "scene.json").string());
    EXPECT_EQ(simulate_impact(impact_scene(other)).hash, run(shot).hash) << name;
  }
  std::filesystem::remove_all(folder);
}

TEST(Impact, RefusesProjectilesThatStartInsideSomething) {
  const auto expect_refusal = [](const std::string& place, const std::string& word) {
    std::string text = scene_text_of({});
    const std::size_t from = text.find("\"position\": ["), to = text.find("]", from);
    text.replace(from, to - from, "\"position\": [" + place);
    try {
      simulate_impact(impact_scene(parse_scene(text, "shot.json")));
      FAIL() << place;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::input);
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("projectile"), std::string::npos);
    }
  };
  expect_refusal("1.5, 1, 0", "inside wall \"wall\"");
  expect_refusal("1.5, 1, 0.34", "inside wall \"wall\"");
  expect_refusal("1.5, 1, -0.349", "inside wall \"wall\"");
  expect_refusal("3.2, 1, 0.1", "inside wall \"wall\"");
  expect_refusal("9, 0.2, 5", "below the ground");
  EXPECT_NO_THROW(run({.duration = 0.01}));
}

// n ∝ √v (Vandenberghe et al. 2013), with 20 seeds per speed.
TEST(Impact, RadialCracksOfGlassGrowWithTheRootOfTheSpeed) {
  double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0, points = 0;
  for (const double speed : {12.0, 25.0, 50.0, 100.0}) {
    double corners = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Shot shot;
      shot.material = "pmma";
      shot.thickness = 0.003, shot.mass = 0.064, shot.radius = 0.0125, shot.speed = speed;
      shot.width = shot.height = 1, shot.seed = seed, shot.duration = 1.0 / 120;
      shot.anchors = R"(["bottom", "left", "right", "top"])";
      shot.pattern = R"({"type": "spiderweb", "rings": 0, "radial": 0, "rest_cell": 2})";
      corners += static_cast<double>(run(shot).chunks_freed) / 20;
    }
    const double x = std::log(speed), y = std::log(corners);
    sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y, points += 1;
  }
  const double slope = (points * sum_xy - sum_x * sum_y) / (points * sum_xx - sum_x * sum_x);
  EXPECT_NEAR(slope, 0.5, 0.05);
}

TEST(Impact, ToughenedGlassBreaksAsAWhole) {
  Shot shot;
  shot.material = "toughened-glass";
  shot.thickness = 0.008, shot.mass = 4.11, shot.radius = 0.05, shot.speed = 12;
  shot.width = shot.height = 1;
  shot.anchors = R"(["bottom", "left", "right", "top"])";
  shot.pattern = R"({"type": "voronoi-grid", "cell": 0.08})";
  const ImpactResult result = run(shot);
  EXPECT_EQ(result.chunks_freed, result.chunks);
  EXPECT_LE(result.energy.fracture, result.energy_in);
  shot.material = "float-glass";
  const ImpactResult float_glass = run(shot);
  EXPECT_LT(float_glass.chunks_freed, float_glass.chunks);
}

TEST(Impact, FastShotsDoNotTunnel) {
  for (const double speed : {300.0, 3000.0})
    for (const double step : {1.0 / 30, 1.0 / 240}) {
      Shot shot = light_shot(0.05, speed);
      shot.step = step;
      shot.duration = 2 * step;
      const ImpactResult result = run(shot);
      EXPECT_TRUE(result.projectiles[0].hit) << speed;
      EXPECT_GT(result.chunks_freed, 0u) << speed;
    }
}

TEST(Impact, AWallWithoutAnchorsStandsFreeAndTopples) {
  Shot shot;
  shot.anchors = "[]";
  shot.thickness = 0.3;
  shot.mass = 5, shot.radius = 0.08, shot.speed = 2;
  shot.duration = 0.5;
  const ImpactResult stands = run(shot);
  EXPECT_EQ(stands.broken_bonds, 0u);
  EXPECT_EQ(stands.recording.tracks.size(), 2u);
  EXPECT_LT(std::abs(stands.recording.tracks[0].poses.back().rotation.x), 0.01);
}

TEST(Impact, UntouchedWallsCostNothing) {
  Shot shot;
  std::string text = scene_text_of(shot);
  const std::string far = R"({"name": "far", "position": [50, 0, 0], "anchors": ["bottom"]}, )";
  text.insert(text.find("\"walls\": [") + 10, far);
  const ImpactResult result = simulate_impact(impact_scene(parse_scene(text, "two.json")));
  EXPECT_EQ(result.walls_untouched, 1u);
  EXPECT_GE(result.hulls_not_built, result.recording.walls[0].track.size());
  for (const std::uint32_t track : result.recording.walls[0].track) EXPECT_EQ(track, kNoTrack);
}

}  // namespace
}  // namespace sunder
