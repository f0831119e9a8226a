// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "cli/outputs.hpp"
#include "cli/print_run.hpp"
#include "cli/progress.hpp"
#include "cli/read_scene.hpp"
#include "cli/recording_params.hpp"
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

void print_summary(const ImpactResult& result, const Scene& scene, const RunSettings& settings,
                   const Options& options, const Stopwatch& watch) {
  for (const ProjectileOutcome& p : result.projectiles) print_projectile(p);
  std::fprintf(stderr, "%llu of %llu chunks freed, %llu bonds broken, %llu split again, %.4g kg\n",
               as_count(result.chunks_freed), as_count(result.chunks),
               as_count(result.broken_bonds), as_count(result.chunks_split), result.freed_mass);
  print_ledger(result.energy_in, result.energy);
  print_steps(result, scene.seed);
  print_settings(settings);
  print_end(options, scene, "impact", {"solids", "building", "scenario"}, watch);
}

Scene read_impact_scene(const Options& options) {
  Scene scene = read_scene(options);
  std::vector<std::filesystem::path> assets;
  for (const Wall& wall : scene.walls)
    if (!wall.asset.empty()) assets.emplace_back(wall.asset);
  check_not_written(options, assets);
  check_moment(options, scene);
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
  ImpactResult result = simulate(impact, options);
  const RunSettings settings = run_settings(scene, "impact");
  if (const std::string warning = shortfall(scene, settings); !warning.empty())
    result.warnings.push_back(warning);
  watch.lap("simulate");
  const RecordingParams recording = recording_params(options, scene.simulation, result.recording);
  for (const auto& path : options.outputs)
    if (path.extension() != ".json") export_recording(result.recording, path, recording);
  watch.lap("write");
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const std::string text = impact_report_json(
      {SUNDER_VERSION, scene.seed, result, took.count(), watch.steps(), settings});
  write_report(options, text);
  for (const std::string& warning : result.warnings)
    std::fprintf(stderr, "sunder: warning: %s\n", warning.c_str());
  if (!options.quiet) print_summary(result, scene, settings, options, watch);
  return kExitOk;
}

}  // namespace sunder
