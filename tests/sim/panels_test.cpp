// SPDX-License-Identifier: GPL-3.0-or-later
// Slabs and walls of a building that break.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fracture/recover.hpp"
#include "meshing/error.hpp"
#include "meshing/random.hpp"
#include "sim/frames.hpp"
#include "sim/recorder.hpp"
#include "sim/rigid_world.hpp"
#include "sim/wall_run.hpp"

namespace sunder {
namespace {

Material concrete() {
  return {.name = "concrete",
          .density = 2400,
          .youngs_modulus = 33.6e9,
          .tensile_strength = 2.9e6,
          .compressive_strength = 38e6,
          .fracture_energy = 140,
          .restitution = 0.2,
          .source = {}};
}

Material masonry() {
  return {.name = "masonry",
          .density = 1850,
          .youngs_modulus = 3.5e9,
          .poisson_ratio = 0.15,
          .tensile_strength = 0.25e6,
          .compressive_strength = 8e6,
          .fracture_energy = 12,
          .friction = 0.75,
          .restitution = 0.2,
          .source = {}};
}

Material glass() {
  return {.name = "glass",
          .density = 2500,
          .youngs_modulus = 72e9,
          .poisson_ratio = 0.23,
          .tensile_strength = 41e6,
          .compressive_strength = 1e9,
          .fracture_energy = 7.4,
          .friction = 0.4,
          .restitution = 0.6,
          .source = {}};
}

PanelPattern cells_of(double cell) {
  return {.pattern = VoronoiGridParams{cell, 0.9}, .min_cell = -1, .asset = {}};
}

struct Breakable {
  std::size_t posts = 2, rows = 2, storeys = 1;
  std::optional<PanelPattern> slab = cells_of(1.5), walls = cells_of(1.2);
  std::string wall_material = "masonry";
  double wall_thickness = 0.1;
  std::string solver = "hybrid";
};

CollapseScene breakable_scene(const Breakable& kind = {}) {
  StoreyParams storey;
  storey.slab_material = "concrete";
  storey.slab_pattern = kind.slab;
  storey.wall_thickness = kind.walls ? kind.wall_thickness : 0;
  storey.wall_material = kind.wall_material;
  storey.wall_pattern = kind.walls;
  CollapseScene scene;
  scene.seed = 5;
  scene.frame = empty_frame();
  scene.frame.materials = {concrete(), masonry(), glass()};
  RegularBuilding building;
  building.bays_x.assign(kind.posts - 1, 6);
  building.bays_z.assign(kind.rows - 1, 6);
  building.storeys.assign(kind.storeys, storey);
  add_regular(scene.frame, building);
  join(scene.frame);
  scene.assets.resize(scene.frame.patterns.size());
  scene.simulation.solver = kind.solver;
  scene.simulation.duration = 0.5;
  return scene;
}

Projectile ball(double mass, Vec3 position, Vec3 velocity) {
  Projectile p;
  p.name = "ball";
  p.radius = 0.3;
  p.mass = mass;
  p.position = position;
  p.velocity = velocity;
  return p;
}

/// Through the wall in front (z = 6) and on.
CollapseScene shot_through_wall(const Breakable& kind = {}) {
  CollapseScene scene = breakable_scene(kind);
  scene.projectiles = {ball(900, {2.7, 1.8, 8}, {0.3, 0, -30})};
  return scene;
}

/// From above through the roof.
CollapseScene shot_through_slab(const Breakable& kind = {.walls = {}}) {
  CollapseScene scene = breakable_scene(kind);
  scene.projectiles = {ball(900, {2.8, 5, 3.1}, {0, -30, 0})};
  return scene;
}

/// The upper storey falls on the lower one.
CollapseScene slab_on_slab() {
  CollapseScene scene = breakable_scene({.storeys = 2, .walls = {}});
  for (const char* post : {"post_0_0_1", "post_1_0_1", "post_0_1_1", "post_1_1_1"})
    scene.scenario.remove.emplace_back(post);
  scene.simulation.duration = 1.5;
  return scene;
}

CollapseScene post_removed(const Breakable& kind = {}) {
  CollapseScene scene = breakable_scene(kind);
  scene.scenario.remove = {"post_0_0_0", "post_1_0_0"};
  scene.simulation.duration = 1.2;
  return scene;
}

void make_joints_endless(CollapseScene& scene) {
  for (FrameJoint& joint : scene.frame.joints) {
    joint.strength.force = 1e6 * joint.strength.force;
    joint.strength.torque = 1e6 * joint.strength.torque;
  }
}

/// The ground pushes along x for a while, to both ways with `swings`.
GroundMotion shake(double acceleration, double swings = 0) {
  GroundMotion motion;
  for (int i = 0; i <= 40; ++i) {
    const double t = 0.0125 * i, way = swings > 0 ? std::sin(6.2832 * swings * t) : 1;
    motion.times.push_back(t);
    motion.accelerations.push_back({i == 0 || i == 40 ? 0 : acceleration * way, 0, 0});
  }
  return motion;
}

/// What went in, from outside or by falling, J.
double put_in(const CollapseResult& r) {
  return std::abs(r.energy_in) + std::max(0.0, -r.energy.potential);
}

void expect_books_close(const CollapseResult& r, const std::string& where) {
  EXPECT_LE(std::abs(r.energy.numerical), 1e-6 * put_in(r)) << where;
  EXPECT_LE(r.momentum_error, 1e-12) << where;
}

std::vector<std::string> joints_broken(const CollapseScene& scene, const CollapseResult& r) {
  std::vector<std::string> names;
  for (const JointBreak& each : r.broken_joints)
    names.push_back(scene.frame.joints[each.joint].name);
  return names;
}

/// What a run did to its panels, bit for bit.
auto damage(const CollapseResult& r) {
  return std::tuple(r.panels_broken, r.chunks_freed, r.chunks_split, r.broken_bonds, r.crack_area);
}

const RecordedWall* wall_named(const CollapseResult& r, const std::string& name) {
  for (const RecordedWall& wall : r.recording.walls)
    if (wall.asset.wall.name == name) return &wall;
  return nullptr;
}

TEST(Panels, EnergyAndMomentumOfEveryRunAreAccounted) {
  for (const std::uint64_t seed : {1, 2}) {
    CollapseScene scenes[] = {shot_through_wall(), shot_through_slab(), slab_on_slab(),
                              post_removed()};
    for (std::size_t i = 0; i < std::size(scenes); ++i) {
      scenes[i].seed = seed;
      const CollapseResult r = simulate_collapse(scenes[i], {.keep_history = false});
      expect_books_close(r, "scene " + std::to_string(i) + ", seed " + std::to_string(seed));
      EXPECT_GT(r.broken_bonds, 0u) << "scene " << i;
      EXPECT_GT(r.chunks_freed, 0u) << "scene " << i;
    }
  }
}

TEST(Panels, NothingIsMeshedWhereNothingHappens) {
  const CollapseScene scene = breakable_scene({.posts = 3, .storeys = 2});
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_EQ(r.panels, scene.frame.slabs.size() + scene.frame.walls.size());
  EXPECT_EQ(r.panels_not_meshed, r.panels);
  EXPECT_EQ(r.panels_meshed, 0u);
  EXPECT_EQ(r.panels_broken, 0u);
  EXPECT_EQ(r.panel_solves, 0u);
  EXPECT_EQ(r.chunks, 0u);
  EXPECT_TRUE(r.recording.walls.empty());
  EXPECT_TRUE(r.broken_joints.empty());
  // It is the building that it would be without patterns.
  const CollapseResult whole = simulate_collapse([&] {
    CollapseScene same = scene;
    same.frame.patterns.clear();
    same.assets.clear();
    for (FrameSlab& slab : same.frame.slabs) slab.pattern = kNoPart;
    for (FrameWall& wall : same.frame.walls) wall.pattern = kNoPart;
    return same;
  }());
  EXPECT_EQ(r.hash, whole.hash);
  EXPECT_EQ(r.max_utilisation, whole.max_utilisation);
  EXPECT_EQ(r.sag_end, whole.sag_end);
}

TEST(Panels, SameSceneSameBits) {
  for (const CollapseScene& scene : {shot_through_wall(), slab_on_slab()}) {
    const CollapseResult one = simulate_collapse(scene), two = simulate_collapse(scene);
    EXPECT_EQ(one.hash, two.hash);
    EXPECT_EQ(damage(one), damage(two));
    EXPECT_EQ(one.energy.kinetic, two.energy.kinetic);
  }
}

/// Only the wall in front breaks: by its pattern, or as a wall that is given.
CollapseScene one_wall_scene() {
  CollapseScene scene = shot_through_wall({.slab = {}});
  for (std::size_t w = 0; w < scene.frame.walls.size(); ++w)
    if (scene.frame.walls[w].name != "wall_x_0_1_0") scene.frame.walls[w].pattern = kNoPart;
  return scene;
}

/// The last one's debris meets the walls behind.
TEST(Panels, SkippingChangesNoBit) {
  for (const CollapseScene& scene : {one_wall_scene(), shot_through_slab(), shot_through_wall()}) {
    const CollapseResult some = simulate_collapse(scene);
    const CollapseResult all = simulate_collapse(scene, {.skip = false});
    EXPECT_EQ(joints_broken(scene, some), joints_broken(scene, all));
    EXPECT_EQ(some.broken_bonds, all.broken_bonds);
    EXPECT_EQ(some.chunks_freed, all.chunks_freed);
    EXPECT_EQ(some.hash, all.hash);
    EXPECT_GT(some.broken_bonds, 0u);
    EXPECT_EQ(all.panels_not_meshed, 0u);
    EXPECT_GT(all.panel_solves, some.panel_solves);
  }
}

TEST(Panels, ChunksWeighTogetherWhatThePartDid) {
  const CollapseScene scene = shot_through_wall({.slab = {}});
  const CollapseResult r = simulate_collapse(scene);
  ASSERT_FALSE(r.recording.walls.empty());
  for (const RecordedPart& part : r.recording.parts) {
    if (part.wall == kNoTrack) continue;
    const WallAsset& asset = r.recording.walls[part.wall].asset;
    double volume = 0;
    for (const MassProperties& chunk : asset.chunks) volume += chunk.volume;
    EXPECT_NEAR(volume * asset.density, part.mass, 1e-9 * part.mass);
    EXPECT_EQ(asset.wall.name + "_whole", part.name);
    EXPECT_EQ(part.removed, 0) << "its chunks stand in its place";
  }
}

TEST(Panels, BallGoesThroughTheWallAndTheRestStands) {
  CollapseScene scene = shot_through_wall();
  scene.simulation.duration = 0.2;
  const CollapseResult r = simulate_collapse(scene);
  ASSERT_TRUE(r.projectiles[0].hit);
  EXPECT_TRUE(r.projectiles[0].perforated);
  EXPECT_NEAR(r.projectiles[0].speed_before, 30, 0.2);
  EXPECT_LT(r.projectiles[0].residual_speed, 30);
  EXPECT_GT(r.projectiles[0].residual_speed, 20);
  const RecordedWall* wall = wall_named(r, "wall_x_0_1_0");
  ASSERT_NE(wall, nullptr);
  EXPECT_GT(std::ranges::count(wall->track, kNoTrack), 0) << "some of it stands";
  EXPECT_LT(std::ranges::count(wall->track, kNoTrack),
            static_cast<std::ptrdiff_t>(wall->track.size()));
  EXPECT_EQ(r.parts_freed, 0u);
}

TEST(Panels, PanelThatLosesItsJointsGoesOnAsItMoved) {
  // The roof comes down whole on its beams, hits the ground, and is a body of chunks since.
  CollapseScene scene = breakable_scene({.walls = {}});
  for (const char* post : {"post_0_0_0", "post_1_0_0", "post_0_1_0", "post_1_1_0"})
    scene.scenario.remove.emplace_back(post);
  scene.simulation.duration = 1.2;
  const CollapseResult r = simulate_collapse(scene);
  expect_books_close(r, "roof");
  const RecordedWall* slab = wall_named(r, "slab_0_0_0");
  ASSERT_NE(slab, nullptr);
  const RecordedPart& part = r.recording.parts[scene.frame.slab_part(0)];
  ASSERT_NE(part.track, kNoTrack) << "it fell as a part first";
  const Track& whole = r.recording.tracks[part.track];
  for (const std::uint32_t track : slab->track) {
    ASSERT_NE(track, kNoTrack);
    std::uint32_t root = track, first = r.recording.tracks[track].first;
    while (root != part.track && r.recording.tracks[root].parent != kNoTrack) {
      first = std::min(first, r.recording.tracks[root].first);
      root = r.recording.tracks[root].parent;
    }
    EXPECT_EQ(root, part.track);
    EXPECT_GE(first, whole.first);
    // No jump where it changes bodies: a step of its fall at most, and some room.
    const Pose before = pose_at(r.recording, track, first - 1, {});
    const Pose after = pose_at(r.recording, track, first, {});
    const double step = scene.simulation.step;
    EXPECT_LT(length(after.position - before.position), 1.5 * std::sqrt(2 * 9.81 * 3.5) * step);
  }
}

TEST(Panels, WholeSlabInFreeFallKeepsItsMotion) {
  // No contact: what broke off as a part falls freely, before anything hits it.
  CollapseScene scene = slab_on_slab();
  scene.simulation.duration = 0.6;  // 3.5 m take 0.84 s
  const CollapseResult r = simulate_collapse(scene);
  const RecordedPart& part = r.recording.parts[part_named(scene.frame, "slab_0_0_1")];
  ASSERT_NE(part.track, kNoTrack);
  const std::uint32_t last = static_cast<std::uint32_t>(r.recording.times.size()) - 1;
  const double fallen =
      part.standing.position.y - pose_at(r.recording, part.track, last, part.standing).position.y;
  EXPECT_NEAR(fallen, 0.5 * 9.81 * 0.36, 0.02);
}

TEST(Panels, GroundFloorWallsStandOnTheGround) {
  const CollapseScene scene = shot_through_wall();
  const CollapseResult r = simulate_collapse(scene);
  const RecordedWall* wall = wall_named(r, "wall_x_0_1_0");
  ASSERT_NE(wall, nullptr);
  bool at_bottom = false;
  for (const Bond& bond : wall->asset.bonds) at_bottom |= bond.b == kWorld && bond.normal.y < -0.99;
  EXPECT_TRUE(at_bottom);
}

TEST(Panels, RigidBodiesHaveBreakablePanelsToo) {
  CollapseScene scene = slab_on_slab();
  scene.simulation.solver = "bullet";
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_LE(std::abs(r.energy.numerical), 1e-6 * put_in(r));
  EXPECT_LE(r.momentum_error, 1e-10);
  EXPECT_EQ(r.panels, 2u);
  EXPECT_GT(r.panels_broken, 0u);
  EXPECT_GT(r.chunks_freed, 0u);
}

TEST(Panels, RemovedPanelsAreGone) {
  CollapseScene scene = shot_through_wall();
  scene.scenario.remove = {"wall_x_0_1_0", "slab_0_0_0"};
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_EQ(wall_named(r, "wall_x_0_1_0"), nullptr);
  EXPECT_EQ(wall_named(r, "slab_0_0_0"), nullptr);
  EXPECT_NE(wall_named(r, "wall_x_0_0_0"), nullptr) << "the one behind was hit";
  expect_books_close(r, "removed");
}

TEST(Panels, GlassFacadeBreaksInAWeb) {
  Breakable kind;
  kind.wall_material = "glass";
  kind.wall_thickness = 0.012;
  kind.walls = PanelPattern{
      .pattern = SpiderwebParams{.impacts = {}, .rest_cell = 6}, .min_cell = -1, .asset = {}};
  CollapseScene scene = shot_through_wall(kind);
  scene.simulation.duration = 0.12;
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_TRUE(r.projectiles[0].perforated);
  EXPECT_GT(r.chunks, 10u);
  EXPECT_GT(r.chunks_freed, 5u);
  expect_books_close(r, "glass");
}

/// A pane that was let go as a whole, then hit: the cells of its web hang on nothing either.
TEST(Panels, GlassThatHasComeLooseBreaksInAWebToo) {
  Wall wall;
  wall.region = {rectangle({3, 2}), {}};
  wall.thickness = 0.01;
  wall.material = "glass";
  wall.pattern = SpiderwebParams{.impacts = {}, .rest_cell = 6};
  wall.anchors = {"bottom", "left", "right", "top"};
  ImpactWall pane;
  pane.asset = at_file_precision(fracture_wall(wall, 2500, {.seed = 1}));
  pane.material = glass();
  pane.material.stored_energy = 32.9e3;  // toughened: all of it falls apart
  const ImpactScene scene{1, {}, {ball(900, {1.4, 6, 1}, {0, 0, -20})}, {}};
  const ImpactParams params;
  RigidWorld world{WorldParams{}};
  Recorder recorder;
  ImpactResult result;
  WallRun run(scene, params, world, recorder, result, {.waiting = 1});
  run.set_free(0, pane, {{{0, 5, 0}, {}}, {1.5, 6, 0}, {}, {}}, recorder.add_track(kNoTrack));
  run.launch_due(0);
  double now = 0;
  for (int i = 0; i < 40; ++i) {
    double dt = std::max(run.prepare(1.0 / 240), 1e-6);
    const std::optional<WallRun::Arrival> arrival = run.next_arrival(dt);
    if (arrival) dt = arrival->time;
    if (dt > 0) world.step(dt);
    run.after_step(now += dt);
    if (arrival) run.arrive(*arrival);
  }
  EXPECT_TRUE(result.projectiles[0].hit);
  EXPECT_GT(result.broken_bonds, 0u);
  EXPECT_GT(world.kinetic_energy(), 0);
  EXPECT_TRUE(std::isfinite(world.kinetic_energy()));
  const std::vector<RecordedWall> walls = run.finish();
  for (const std::uint32_t track : walls[0].track) EXPECT_NE(track, kNoTrack);
}

/// A file's wall for a place of the building: cells made in memory as the run would.
WallAsset given_wall(const CollapseScene& scene, const std::string& part, Vec2 size = {}) {
  const PartSolid solid = solid_of(scene.frame, part_named(scene.frame, part));
  Wall wall;
  wall.name = part;
  wall.region = size.x > 0 ? Region{rectangle(size), {}} : solid.outline;
  wall.thickness = 2 * solid.half_length;
  wall.material = "masonry";
  wall.pattern = VoronoiGridParams{1.2, 0.9};
  wall.anchors = {"bottom", "left", "right", "top"};
  return at_file_precision(fracture_wall(wall, 1850, {.seed = scene.seed}));
}

TEST(Panels, GivenWallRunsAsTheSamePatternMadeInMemory) {
  const CollapseScene scene = one_wall_scene();
  const CollapseResult made = simulate_collapse(scene);
  CollapseScene given = scene;
  given.frame.patterns[0].asset = "wall.glb";
  given.assets[0] = given_wall(scene, "wall_x_0_1_0");
  const CollapseResult read = simulate_collapse(given);
  EXPECT_GT(made.broken_bonds, 0u);
  EXPECT_EQ(made.hash, read.hash);
  EXPECT_EQ(damage(made), damage(read));
}

TEST(Panels, GivenWallOfAnotherSizeIsRefusedWithTheSizeNeeded) {
  CollapseScene scene = one_wall_scene();
  scene.frame.patterns[0].asset = "wall.glb";
  scene.assets[0] = given_wall(scene, "wall_x_0_1_0", {4, 2.5});
  try {
    simulate_collapse(scene);
    ADD_FAILURE() << "was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input);
    const std::string what = error.what();
    for (const char* part : {"wall.glb", "4.000000 × 2.500000", "wall_x_0_1_0", "0.100000 m"})
      EXPECT_NE(what.find(part), std::string::npos) << what;
    const PartSolid solid = solid_of(scene.frame, part_named(scene.frame, "wall_x_0_1_0"));
    const Box box = bounding_box(solid.outline.outline);
    EXPECT_NE(what.find(std::to_string(box.high.x - box.low.x)), std::string::npos) << what;
    EXPECT_NE(what.find(std::to_string(box.high.y - box.low.y)), std::string::npos) << what;
  }
}

TEST(Panels, BallFliesThroughTheWindowOfAGivenWall) {
  CollapseScene scene = one_wall_scene();
  scene.frame.patterns[0].asset = "wall.glb";
  const PartSolid solid = solid_of(scene.frame, part_named(scene.frame, "wall_x_0_1_0"));
  const Vec2 corner = bounding_box(solid.outline.outline).low;
  Wall wall;
  wall.region = solid.outline;
  wall.region.openings = {rectangle({2, 1.6}, corner + Vec2{1.7, 0.8})};
  wall.thickness = 2 * solid.half_length;
  wall.pattern = VoronoiGridParams{1.2, 0.9};
  wall.anchors = {"bottom", "left", "right", "top"};
  scene.assets[0] = at_file_precision(fracture_wall(wall, 1850, {.seed = 1}));
  scene.simulation.duration = 0.2;
  const CollapseResult through = simulate_collapse(scene);
  EXPECT_EQ(through.broken_bonds, 0u);
  EXPECT_EQ(through.panels_meshed, 1u);
  scene.projectiles[0].position.x = 0.9;
  scene.projectiles[0].velocity.x = 0;
  EXPECT_GT(simulate_collapse(scene).broken_bonds, 0u) << "beside the window";
}

TEST(Panels, RisingLoadAndShakenGroundRun) {
  CollapseScene rising = breakable_scene();
  rising.scenario.load_rate = 40000;
  rising.simulation.duration = 1;
  const CollapseResult loaded = simulate_collapse(rising);
  EXPECT_LE(loaded.momentum_error, 1e-12);
  EXPECT_GT(loaded.first_failure_load, 0);
  CollapseScene shaken = breakable_scene();
  shaken.scenario.ground_motion = {{0, 0.25, 0.75, 1}, {{}, {15, 0, 6}, {-15, 0, -6}, {}}};
  shaken.simulation.duration = 1;
  const CollapseResult r = simulate_collapse(shaken);
  EXPECT_LE(r.momentum_error, 1e-12);
  EXPECT_LE(std::abs(r.energy.numerical), 1e-6 * put_in(r));
}

/// Cells of a wall in front whose sites are `sites`, or their mirror image.
WallAsset given_sites(const CollapseScene& scene, std::vector<Vec2> sites, bool mirrored) {
  const PartSolid solid = solid_of(scene.frame, part_named(scene.frame, "wall_x_0_1_0"));
  Wall wall;
  wall.region = solid.outline;
  wall.thickness = 2 * solid.half_length;
  wall.material = "masonry";
  wall.anchors = {"bottom", "left", "right", "top"};
  const Box box = bounding_box(solid.outline.outline);
  const Vec2 size = box.high - box.low;
  for (Vec2& site : sites)
    site = box.low + Vec2{size.x * (mirrored ? 1 - site.x : site.x), size.y * site.y};
  wall.pattern = VoronoiSitesParams{.sites = sites};
  return at_file_precision(fracture_wall(wall, 1850, {.seed = 1}));
}

CollapseScene racked_portal(double acceleration, const std::vector<Vec2>& sites, bool mirrored) {
  CollapseScene scene = breakable_scene({.slab = {}});
  for (FrameWall& wall : scene.frame.walls)
    if (wall.name != "wall_x_0_1_0") wall.pattern = kNoPart;
  scene.rules.members_divide = false;  // it is about the wall
  make_joints_endless(scene);
  scene.frame.patterns[0].asset = "wall.glb";
  scene.assets[0] = given_sites(scene, sites, mirrored);
  scene.scenario.ground_motion = shake(acceleration);
  return scene;
}

/// How many bonds cracked at a time, until the first chunk came off.
std::vector<std::uint32_t> first_cracks(const CollapseResult& r) {
  std::vector<std::uint32_t> bonds;
  for (const BreakEvent& event : r.recording.events) {
    bonds.push_back(event.bonds_broken);
    if (event.chunks_freed > 0) break;
  }
  return bonds;
}

TEST(Panels, AMirroredQuakeCracksTheMirroredWallAlike) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    std::vector<Vec2> sites;
    for (std::uint64_t i = 0; i < 60; ++i)
      sites.push_back({random_unit(seed, 2 * i), random_unit(seed, 2 * i + 1)});
    const CollapseResult one = simulate_collapse(racked_portal(25, sites, false));
    const CollapseResult two = simulate_collapse(racked_portal(-25, sites, true));
    EXPECT_GT(one.broken_bonds, 5u) << seed;
    EXPECT_EQ(first_cracks(one), first_cracks(two)) << seed;
    EXPECT_GT(one.energy.fracture, 0) << seed;
    expect_books_close(one, "racked " + std::to_string(seed));
  }
}

TEST(Panels, WallsOfAShakenBuildingCrackAndTheBooksClose) {
  CollapseScene scene = breakable_scene({.posts = 3, .storeys = 2, .slab = {}});
  make_joints_endless(scene);
  scene.scenario.ground_motion = shake(20, 3);
  scene.simulation.duration = 0.3;  // then debris meets debris, and roundings grow
  const CollapseResult r = simulate_collapse(scene);
  EXPECT_GT(r.panels_broken, 0u);
  EXPECT_GT(r.energy.fracture, 0) << "what the cracked parts had stored";
  expect_books_close(r, "shaken");
  const CollapseResult all = simulate_collapse(scene, {.skip = false});
  EXPECT_EQ(r.broken_bonds, all.broken_bonds);
  EXPECT_EQ(r.crack_area, all.crack_area);
}

// Racking is what walls resist: the frame gives way less, and gets less work done on it.
TEST(Panels, WallsHoldAFrameThatWouldSway) {
  double work[2] = {};
  for (const bool elastic : {false, true}) {
    CollapseScene scene = breakable_scene({.slab = {}});
    if (!elastic)
      for (FrameWall& wall : scene.frame.walls) wall.pattern = kNoPart;
    for (Material& m : scene.frame.materials) {
      m.tensile_strength *= 1e4;
      m.compressive_strength *= 1e4;
    }
    scene.rules.breaking = false;
    scene.simulation.quasi_static = true;
    scene.scenario.ground_motion = shake(5);
    scene.simulation.duration = 0.4;
    const CollapseResult r = simulate_collapse(scene);
    work[elastic] = r.energy.strain;
    EXPECT_EQ(r.broken_bonds, 0u);
  }
  EXPECT_LT(work[1], 0.4 * work[0]);  // 0.29
}

// A material without strengths has no network, and is the load alone that it is.
TEST(Panels, ABuildingThatLosesAPostKeepsMoreOfItsJoints) {
  CollapseScene scene = breakable_scene({.posts = 3, .storeys = 2});
  for (Material& m : scene.frame.materials) m.tensile_strength *= 5;  // bars
  scene.scenario.remove = {"post_1_1_0"};
  scene.simulation.duration = 0.6;
  CollapseScene load = scene;
  for (Material& m : load.frame.materials) m.tensile_strength = 0;
  const CollapseResult elastic = simulate_collapse(scene), bare = simulate_collapse(load);
  EXPECT_LE(std::abs(elastic.energy.numerical), 1e-6 * std::abs(elastic.energy.strain));
  EXPECT_LT(2 * elastic.broken_joints.size(), bare.broken_joints.size());
}

// Alone, at once, in second order, with bars in the slabs: the same state until something cracks.
TEST(Panels, WhateverTheOptionsNothingChangesBeforeSomethingHappens) {
  for (int options = 0; options < 8; ++options) {
    CollapseScene scene = breakable_scene({.storeys = 2});
    scene.simulation.quasi_static = (options & 1) != 0;
    scene.simulation.p_delta = (options & 2) != 0;
    scene.simulation.diaphragms = (options & 4) != 0;
    scene.simulation.duration = 0.2;
    EXPECT_EQ(simulate_collapse(scene).panels_broken, 0u) << options;
    // A push of next to nothing wakes the frame: it rings about the same state, or about that of
    // first order.
    scene.scenario.ground_motion = {{0, 0.1, 0.2}, {{}, {1e-6, 0, 0}, {}}};
    const CollapseResult pushed = simulate_collapse(scene);
    EXPECT_EQ(pushed.panels_broken, 0u) << options;
    EXPECT_TRUE(pushed.broken_joints.empty()) << options;
    const bool same_order = options == 0 || scene.simulation.quasi_static;
    EXPECT_NEAR(pushed.max_utilisation, pushed.utilisation_at_rest, same_order ? 1e-6 : 1e-3)
        << options;
    // And a strong one cracks something.
    scene.scenario.ground_motion = shake(35);
    const CollapseResult shaken = simulate_collapse(scene);
    EXPECT_GT(shaken.panels_broken, 0u) << options;
    expect_books_close(shaken, std::to_string(options));
  }
}

TEST(Panels, BallThatStartsInsideAPanelIsRefused) {
  CollapseScene scene = shot_through_wall();
  const PartSolid wall = solid_of(scene.frame, part_named(scene.frame, "wall_x_0_1_0"));
  scene.projectiles[0].position = wall.centre;
  EXPECT_THROW(simulate_collapse(scene), Error);
}

TEST(Panels, LoosePartsLieOnAPanelThatStandsAsChunks) {
  // The blow makes the slab chunks; nothing breaks, so the upper storey comes to rest on it.
  CollapseScene scene = slab_on_slab();
  scene.frame.slabs[1].pattern = kNoPart;
  for (Material& m : scene.frame.materials) {
    m.tensile_strength *= 1e4;
    m.compressive_strength *= 1e4;
  }
  for (FrameJoint& joint : scene.frame.joints)
    if (joint.a < scene.frame.slab_part(1)) {
      joint.strength.force = 1e6 * joint.strength.force;
      joint.strength.torque = 1e6 * joint.strength.torque;
    }
  scene.simulation.duration = 2;
  const CollapseResult r = simulate_collapse(scene);
  ASSERT_NE(wall_named(r, "slab_0_0_0"), nullptr) << "it stands as chunks";
  // Through the slab they would lie on the beams below, which are 0.3 m high.
  const double on_slab = 3.5 + 0.3 + scene.frame.slabs[0].thickness;
  for (std::uint32_t m = 0; m < scene.frame.members.size(); ++m) {
    const RecordedPart& part = r.recording.parts[m];
    if (!part.name.starts_with("beam") || !part.name.ends_with("_1")) continue;
    const auto last = static_cast<std::uint32_t>(r.recording.times.size() - 1);
    EXPECT_GT(pose_at(r.recording, part.track, last, part.standing).position.y, on_slab - 0.05)
        << part.name;
  }
}

TEST(Panels, BallMayComeLaterAndARunMayBeShorterThanAStep) {
  CollapseScene scene = shot_through_wall();
  scene.projectiles[0].time = 0.1;
  const CollapseResult late = simulate_collapse(scene);
  EXPECT_TRUE(late.projectiles[0].perforated);
  expect_books_close(late, "late");
  scene.simulation.duration = 0.3 * scene.simulation.step;
  const CollapseResult brief = simulate_collapse(scene);
  EXPECT_EQ(brief.steps, 1u);
  EXPECT_EQ(brief.panels_broken, 0u);
  scene.projectiles[0].time = 0;
  scene.projectiles[0].position.z = 6.4;
  const CollapseResult close = simulate_collapse(scene);
  EXPECT_GT(close.panels_meshed, 0u);
  EXPECT_LE(close.momentum_error, 1e-12);
}

}  // namespace
}  // namespace sunder
