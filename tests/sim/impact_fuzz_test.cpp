// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes in which random runs found faults, reduced, and what must hold in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "meshing/error.hpp"
#include "sim/wall_state.hpp"
#include "tests/sim/impact_scenes.hpp"

namespace sunder {
namespace {

ImpactScene scene_of(const std::string& text) {
  return impact_scene(parse_scene(text, "fuzz.json"));
}

/// Momentum that bodies have at the end, from their last two poses: right if nothing touches then.
Vec3 momentum_at_end(const ImpactResult& result) {
  const Recording& r = result.recording;
  const double dt = r.times.back() - r.times[r.times.size() - 2];
  Vec3 sum;
  const auto add = [&](std::uint32_t track, Vec3 point, double mass, const Pose& standing) {
    const auto end = static_cast<std::uint32_t>(r.times.size());
    const Vec3 path = pose_at(r, track, end - 1, standing) * point -
                      pose_at(r, track, end - 2, standing) * point;
    sum = sum + (mass / dt) * path;
  };
  for (const RecordedWall& wall : r.walls)
    for (std::uint32_t c = 0; c < wall.track.size(); ++c)
      if (wall.track[c] != kNoTrack)
        add(wall.track[c], wall.asset.chunks[c].centroid,
            wall.asset.density * wall.asset.chunks[c].volume,
            {wall.asset.wall.position, wall.asset.wall.rotation});
  for (const RecordedProjectile& p : r.projectiles)
    add(p.track, {}, p.projectile.mass, {p.projectile.position, {}});
  return sum;
}

// What the solver had given the second wall's anchors was counted once more when it broke.
TEST(ImpactFuzz, MomentumIsKeptWhenDebrisBreaksTheNextWall) {
  const ImpactScene scene = scene_of(R"({"sunder": 1, "walls": [
    {"name": "first", "outline": {"rect": [1, 1]}, "thickness": 0.05, "material": "brick",
     "anchors": ["left", "right"], "pattern": {"type": "voronoi-grid", "cell": 0.4}},
    {"name": "second", "outline": {"rect": [1, 1]}, "thickness": 0.004, "material": "float-glass",
     "anchors": ["left", "right"], "pattern": {"type": "voronoi-grid", "cell": 0.06},
     "position": [0, 0, -0.4]}],
    "projectiles": [{"radius": 0.1, "mass": 300, "position": [0.5, 0.5, 0.2],
                     "velocity": [0, 0, -20]}],
    "simulation": {"duration": 0.2, "step": 0.002, "gravity": 0, "ground": false}})");
  const ImpactResult result = simulate_impact(scene);
  const auto& events = result.recording.events;
  ASSERT_TRUE(std::ranges::any_of(events, [](const BreakEvent& e) { return e.wall == 1; }));
  const Vec3 end = momentum_at_end(result);
  EXPECT_NEAR(end.x, result.reactions[0], 1e-3 * 6000);
  EXPECT_NEAR(end.y, result.reactions[1], 1e-3 * 6000);
  EXPECT_NEAR(end.z, -6000 + result.reactions[2], 1e-3 * 6000);
}

// A ball between a wall and something heavy: the solver passes its energy on to the heavy one.
TEST(ImpactFuzz, EnergyThatAContactPassedOnIsNotSpentOnTheWallAgain) {
  const ImpactScene scene = scene_of(R"({"sunder": 1, "seed": 192, "walls": [
    {"name": "w0", "outline": {"polygon": [[0, 0], [1.99918776, 0], [1.99918776, 0.801410572],
      [0.999593881, 0.801410572], [0.799675105, 1.60282114], [0, 1.60282114]]},
     "thickness": 0.00673306597, "material": "toughened-glass", "position": [0, 6, 0],
     "rotation_deg": [34.8982107, -106.277565, -157.697989], "anchors": ["bottom", "right"],
     "pattern": {"type": "quad-grid", "cell": 0.416597207, "jitter": 0.772513157}}],
    "projectiles": [
     {"radius": 0.945642592, "mass": 16550.2759, "position": [3.25420714, 3.81395063, -0.636900471],
      "velocity": [0, 0, 0]},
     {"radius": 0.945642592, "mass": 27.0839174, "position": [3.25420714, 3.81395063, -0.636900471],
      "velocity": [-106.254514, 71.3776357, 20.7957105], "time": 0.0218761447,
      "youngs_modulus": 764685053}],
    "simulation": {"duration": 0.05, "step": 0.00833333333, "iterations": 105, "break_depth": 0,
                   "max_error": 0.185657177}})");
  const ImpactResult result = simulate_impact(scene);
  EXPECT_GT(result.broken_bonds, 0u);
  EXPECT_LT(result.energy_peak_ratio, 1.001);
  EXPECT_GE(result.energy.contact, 0);
}

TEST(ImpactFuzz, AFreeFallHasNoEnergyPeak) {
  const ImpactScene scene = scene_of(R"({"sunder": 1, "walls": [
    {"outline": {"polygon": [[0, 0], [3.38980165, 0], [3.38980165, 0.897153176],
      [1.69490082, 0.897153176], [1.35592066, 1.79430635], [0, 1.79430635]]},
     "thickness": 0.0882026786, "material": "brick", "position": [0, 1.45816182, 0],
     "pattern": {"type": "voronoi-random", "count": 12}}],
    "projectiles": [{"radius": 0.053545668, "mass": 5.04813882, "velocity": [0, 0, 0],
                     "position": [1.1165604, 2.95606596, 0.810936874]}],
    "simulation": {"duration": 0.533431683, "step": 0.001}})");
  const ImpactResult result = simulate_impact(scene);
  EXPECT_LT(result.energy.potential, -1000);
  EXPECT_NEAR(result.energy_peak_ratio, 1, 1e-9);
}

TEST(ImpactFuzz, RefusesAProjectileInsideAPartThatAnOpeningCutOff) {
  const ImpactScene scene = scene_of(R"({"sunder": 1, "walls": [
    {"name": "wall", "outline": {"rect": [3, 2]}, "thickness": 0.2, "anchors": ["left"],
     "openings": [{"rect": [1, 2], "at": [1, 0]}]}],
    "projectiles": [{"radius": 0.1, "mass": 1, "position": [2.5, 1, 0], "velocity": [0, 0, 0]}],
    "simulation": {"duration": 0.1}})");
  EXPECT_THROW(simulate_impact(scene), Error);
}

constexpr const char* kHard = R"("materials": [{"name": "hard", "density": 2000,
  "youngs_modulus": 3e10, "restitution": 1}], )";

TEST(ImpactFuzz, AWallThatIsPushedAlongIsNotPerforated) {
  const ImpactScene scene = scene_of(std::string(R"({"sunder": 1, )") + kHard + R"("walls": [
    {"outline": {"rect": [1, 1]}, "thickness": 0.1, "material": "hard"}],
    "projectiles": [{"radius": 0.1, "mass": 2000, "position": [0.5, 0.5, 0.2],
                     "velocity": [0, 0, -5], "restitution": 0}],
    "simulation": {"duration": 0.5, "gravity": 0, "ground": false}})");
  const ImpactResult result = simulate_impact(scene);
  EXPECT_TRUE(result.projectiles[0].hit);
  EXPECT_EQ(result.broken_bonds, 0u);
  EXPECT_FALSE(result.projectiles[0].perforated);
}

// Cracks were free of charge for a ball that bounced off without loss.
TEST(ImpactFuzz, CracksCostABallThatBouncesOff) {
  for (const double speed : {0.5, 1.0, 2.0}) {
    const ImpactScene scene = scene_of(R"({"sunder": 1, "materials": [
      {"name": "springy", "density": 2400, "youngs_modulus": 3e10, "tensile_strength": 3e5,
       "fracture_energy": 140, "restitution": 1}], "walls": [{"outline": {"rect": [4, 4]},
       "thickness": 0.2, "material": "springy",
       "anchors": ["bottom", "left", "right", "top"],
       "pattern": {"type": "voronoi-grid", "cell": 1}}],
      "projectiles": [{"radius": 0.25, "mass": 514, "position": [2, 2, 0.4], "restitution": 1,
                       "velocity": [0, 0, )" + number_text_of(-speed) + R"(]}],
      "simulation": {"duration": 0.3, "step": 0.01, "gravity": 0, "ground": false}})");
    const ImpactResult r = simulate_impact(scene);
    EXPECT_GT(r.energy.fracture, 0) << speed;
    EXPECT_GE(r.energy.contact, -1e-9 * r.energy_in) << speed;
    EXPECT_LE(r.energy.kinetic + r.energy.fracture, (1 + 1e-9) * r.energy_in) << speed;
  }
}

/// Replaces a convex cell by triangles around a point inside it; borders get a corner more.
void fan(WallState& wall, std::uint32_t cell, Vec2 middle) {
  const Pattern& pattern = wall.asset.pattern;
  const auto centre = static_cast<std::uint32_t>(pattern.vertices.size());
  std::vector<Vec2> vertices{rounded_to_float(middle)};
  std::vector<NewCell> added;
  for (const LoopRange loop : loops_of(pattern, cell))
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      const std::uint32_t from = pattern.corners[k], to = pattern.corners[loop.next(k)];
      if (!pattern.across[k].is_border()) {
        added.push_back({{{centre, from, to}}});
        continue;
      }
      const auto between = centre + static_cast<std::uint32_t>(vertices.size());
      vertices.push_back(
          rounded_to_float(0.5 * (pattern.vertices[from] + pattern.vertices[to])));
      added.push_back({{{centre, from, between}}});
      added.push_back({{{centre, between, to}}});
    }
  const std::vector<std::uint32_t> removed{cell};
  wall.replace(removed, vertices, added);
}

TEST(ImpactFuzz, CracksStayWhenTheirCellsAreReplaced) {
  Shot shot;
  shot.pattern = R"({"type": "voronoi-grid", "cell": 0.5})";
  const ImpactScene scene = impact_scene_of(shot);
  WallState wall(scene.walls[0]);
  const std::vector<Bond> bonds = wall.asset.bonds;
  for (std::size_t i = 0; i < bonds.size(); ++i)
    if (i % 3 == 0 || bonds[i].b == kWorld) wall.crack(bonds[i]);
  double cracked = 0, now = 0;
  for (const Bond& bond : bonds) cracked += wall.is_cracked(bond) ? bond.area : 0;
  ASSERT_GT(cracked, 0);
  for (int i = 0; i < 10; ++i) {
    const MassProperties& mass = wall.asset.chunks.front();
    fan(wall, 0, {mass.centroid.x, mass.centroid.y});
  }
  for (const Bond& bond : wall.asset.bonds) now += wall.is_cracked(bond) ? bond.area : 0;
  EXPECT_NEAR(now, cracked, 1e-12);
}

}  // namespace
}  // namespace sunder
