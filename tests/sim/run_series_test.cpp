// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of a run over time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/frames.hpp"
#include "sim/impact_scenes.hpp"

namespace sunder {
namespace {

constexpr double RunSample::*kEnergies[] = {
    &RunSample::kinetic,  &RunSample::potential, &RunSample::strain,
    &RunSample::fracture, &RunSample::friction,  &RunSample::contact,
    &RunSample::damping,  &RunSample::plastic,   &RunSample::joint};

double sum_of(const RunSample& s) {
  double sum = 0;
  for (const auto energy : kEnergies) sum += s.*energy;
  return sum;
}

CollapseScene struck_frame(const std::string& solver) {
  CollapseScene scene = regular_scene(2, 2, 3);
  scene.simulation.solver = solver;
  scene.simulation.duration = 1;
  Projectile p;
  p.name = "ball";
  p.radius = 0.5;
  p.mass = 4000;
  p.position = {-3, 3.6, 0.2};
  p.velocity = {25, 0, 0};
  scene.projectiles = {p};
  return scene;
}

/// A slab that breaks, hit from above.
CollapseScene struck_slab() {
  StoreyParams storey;
  storey.slab_pattern = {.pattern = VoronoiGridParams{1.5, 0.9}, .min_cell = -1, .asset = {}};
  CollapseScene scene = regular_scene(2, 2, 1, storey);
  Material& concrete = scene.frame.materials[0];
  concrete.youngs_modulus = 33.6e9;
  concrete.tensile_strength = 2.9e6;
  concrete.compressive_strength = 38e6;
  concrete.fracture_energy = 140;
  scene.assets.resize(scene.frame.patterns.size());
  scene.simulation.solver = "hybrid";
  scene.simulation.duration = 0.5;
  scene.projectiles = struck_frame("hybrid").projectiles;
  scene.projectiles[0].position = {2.8, 5, 3.1};
  scene.projectiles[0].velocity = {0, -30, 0};
  return scene;
}

void expect_same(const RunSample& s, const EnergyLedger& e) {
  EXPECT_EQ(s.kinetic, e.kinetic);
  EXPECT_EQ(s.potential, e.potential);
  EXPECT_EQ(s.strain, e.strain);
  EXPECT_EQ(s.fracture, e.fracture);
  EXPECT_EQ(s.friction, e.friction);
  EXPECT_EQ(s.contact, e.contact);
  EXPECT_EQ(s.numerical, e.numerical);
}

double largest_use(const std::vector<RunSample>& series) {
  return std::ranges::max(series, {}, &RunSample::max_utilisation).max_utilisation;
}

void expect_last_is_the_result(const CollapseResult& r) {
  const RunSample& last = r.recording.series.back();
  expect_same(last, r.energy);
  EXPECT_EQ(last.time, r.simulated_s);
  EXPECT_EQ(last.damping, r.damping);
  EXPECT_EQ(last.plastic, r.plastic);
  EXPECT_EQ(last.joint, r.joint_work);
  EXPECT_EQ(last.broken_joints, r.broken_joints.size());
  EXPECT_EQ(last.broken_bonds, r.broken_bonds);
  EXPECT_EQ(largest_use(r.recording.series), r.max_utilisation);
}

/// Whatever one moment's numbers are, they add up to what has gone in, and counts never fall.
void expect_sound(const CollapseResult& r) {
  const std::vector<RunSample>& series = r.recording.series;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const RunSample& s = series[i];
    EXPECT_LT(std::abs(s.numerical), 1e-6 * (r.energy_in + std::max(0.0, -s.potential))) << s.time;
    const auto broken = std::ranges::count_if(
        r.broken_joints, [&](const JointBreak& each) { return each.time <= s.time; });
    // Those that break at time 0 do after the first sample.
    EXPECT_EQ(s.broken_joints, i == 0 ? 0 : static_cast<std::uint64_t>(broken)) << s.time;
    EXPECT_GE(s.broken_bonds, series[i > 0 ? i - 1 : 0].broken_bonds);
  }
}

TEST(RunSeries, EndsWithTheLedgerOfTheReport) {
  for (const char* solver : {"bullet", "hybrid"}) {
    const CollapseResult r = simulate_collapse(struck_frame(solver));
    expect_last_is_the_result(r);
    expect_sound(r);
    EXPECT_GT(r.broken_joints.size(), 0u) << solver;
    EXPECT_EQ(r.recording.seed, 1u);
  }
  const CollapseResult slab = simulate_collapse(struck_slab());
  expect_last_is_the_result(slab);
  expect_sound(slab);
  EXPECT_GT(slab.broken_bonds, 0u);
  const ImpactResult impact = run({});
  const RunSample& last = impact.recording.series.back();
  expect_same(last, impact.energy);
  EXPECT_EQ(last.time, impact.simulated_s);
  EXPECT_EQ(last.broken_bonds, impact.broken_bonds);
  EXPECT_GT(impact.broken_bonds, 0u);
  EXPECT_EQ(largest_use(impact.recording.series), impact.max_utilisation);
}

TEST(RunSeries, IsSampledEveryHistoryStepAndAtTheEnd) {
  Shot shot;
  shot.duration = 0.45;
  shot.simulation = R"(, "history_step": 0.1)";
  const ImpactResult r = run(shot);
  const std::vector<RunSample>& series = r.recording.series;
  ASSERT_EQ(series.size(), 6u);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(series[i].time, 0.1 * static_cast<double>(i), shot.step * static_cast<double>(i));
  EXPECT_EQ(series[5].time, 0.45);
  CollapseScene scene = struck_frame("hybrid");
  scene.simulation.history_step = scene.simulation.duration = 0.25;
  const CollapseResult c = simulate_collapse(scene, {.keep_history = false});
  ASSERT_EQ(c.recording.series.size(), 2u) << "the last one is not there twice";
  EXPECT_TRUE(c.recording.samples.empty());
}

TEST(RunSeries, AFallingBallFollowsItsParabola) {
  Shot shot;
  shot.speed = 0;
  shot.mass = 100;
  shot.duration = 0.3, shot.step = 0.01;  // it starts 1 m up
  shot.simulation = R"(, "history_step": 0.01)";
  const ImpactResult r = run(shot);
  EXPECT_EQ(r.recording.series.size(), 31u);
  for (const RunSample& s : r.recording.series) {
    const double speed = 9.81 * s.time;
    EXPECT_NEAR(s.kinetic, 50 * speed * speed, 1e-9) << s.time;
    EXPECT_NEAR(s.potential, -s.kinetic, 1e-9) << s.time;
    EXPECT_NEAR(sum_of(s), 0, 1e-9) << s.time;
    EXPECT_EQ(s.moving, 1u);
    EXPECT_EQ(s.max_utilisation, 0);
  }
}

TEST(RunSeries, HowOftenItIsSampledChangesNothing) {
  CollapseScene scenes[] = {struck_frame("bullet"), struck_frame("hybrid"), struck_slab()};
  for (CollapseScene& scene : scenes) {
    scene.simulation.duration = 0.5;
    scene.simulation.history_step = scene.simulation.step;
    const CollapseResult often = simulate_collapse(scene);
    scene.simulation.history_step = 10;
    const CollapseResult seldom = simulate_collapse(scene);
    EXPECT_EQ(often.hash, seldom.hash);
    EXPECT_EQ(often.max_utilisation, seldom.max_utilisation);
    EXPECT_EQ(seldom.recording.series.size(), 2u);
    EXPECT_EQ(often.recording.series.size(), often.steps + 1);
    expect_same(seldom.recording.series.back(), often.energy);
  }
  Shot shot;
  shot.simulation = R"(, "history_step": 0.0001)";
  const ImpactResult often = run(shot), seldom = run({});
  EXPECT_EQ(often.hash, seldom.hash);
  EXPECT_EQ(often.max_utilisation, seldom.max_utilisation);
}

}  // namespace
}  // namespace sunder
