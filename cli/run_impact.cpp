// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "cli/outputs.hpp"
#include "cli/print_run.hpp"
#include "cli/progress.hpp"
#include "cli/read_scene.hpp"
#include "cli/run.hpp"
#include "cli/stopwatch.hpp"
#include "io/export_recording.hpp"
#include "io/impact_report.hpp"
#include "io/impact_scene.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

void print_projectile(const ProjectileOutcome& p) {
  if (!p.hit) {
    std::fprintf(stderr, "%s: met no wall\n", p.name.c_str());
  } else if (p.perforated) {
    std::fprintf(stderr,
                 "%s: %.4g m/s in, %.4g m/s behind the wall (which it needs %.4g m/s for)\n",
                 p.name.c_str(), p.speed_before, p.residual_speed, p.ballistic_speed);
  } else {
    std::fprintf(stderr, "%s: %.4g m/s in, did not get through (%.4g m/s needed)\n", p.name.c_str(),
                 p.speed_before, p.ballistic_speed);
  }
}

void print_summary(const ImpactResult& result, const Scene& scene, const Options& options,
                   const Stopwatch& watch) {
  for (const ProjectileOutcome& p : result.projectiles) print_projectile(p);
  std::fprintf(stderr, "%llu of %llu chunks freed, %llu bonds broken, %llu split again, %.4g kg\n",
               as_count(result.chunks_freed), as_count(result.chunks),
               as_count(result.broken_bonds), as_count(result.chunks_split), result.freed_mass);
  print_ledger(result.energy_in, result.energy);
  print_steps(result, scene.seed);
  print_end(options, scene, "impact", {"solids", "building", "scenario"}, watch);
}

Scene read_impact_scene(const Options& options) {
  Scene scene = read_scene(options);
  std::vector<std::filesystem::path> assets;
  for (const Wall& wall : scene.walls)
    if (!wall.asset.empty()) assets.emplace_back(wall.asset);
  check_not_written(options, assets);
  if (scene.walls.empty())
    throw Error(ErrorCode::input, "the scene has no walls, so there is nothing to hit");
  return scene;
}

ImpactResult simulate(const ImpactScene& scene, const Options& options) {
  ProgressBar bar("simulating", !options.quiet);
  return simulate_impact(scene, {!options.no_skip, [&](double done) { bar.update(done); }});
}

}  // namespace

int run_impact(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  Stopwatch watch;
  const Scene scene = read_impact_scene(options);
  const int threads = thread_count(options);
  watch.lap("read");
  const ImpactScene impact = [&] {
    ProgressBar bar("fracturing", !options.quiet);
    return impact_scene(scene, threads, [&](double done) { bar.update(done); });
  }();
  watch.lap("fracture");
  const ImpactResult result = simulate(impact, options);
  watch.lap("simulate");
  const SimulationParams& simulation = scene.simulation;
  const RecordingParams recording{.has_ground = simulation.ground,
                                  .ground_height = simulation.ground_height,
                                  .threads = threads};
  for (const auto& path : options.outputs)
    if (path.extension() != ".json") export_recording(result.recording, path, recording);
  watch.lap("write");
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const ImpactReport report{SUNDER_VERSION, scene.seed, result, took.count(), watch.steps()};
  write_report(options, impact_report_json(report),
               [&] { return impact_page(report, simulation, page_source(options)); });
  for (const std::string& warning : result.warnings)
    std::fprintf(stderr, "sunder: warning: %s\n", warning.c_str());
  if (!options.quiet) print_summary(result, scene, options, watch);
  return kExitOk;
}

}  // namespace sunder
