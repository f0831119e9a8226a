// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "cli/outputs.hpp"
#include "cli/progress.hpp"
#include "cli/read_scene.hpp"
#include "cli/run.hpp"
#include "cli/stopwatch.hpp"
#include "io/export_recording.hpp"
#include "io/impact_report.hpp"
#include "io/impact_scene.hpp"
#include "io/output.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

unsigned long long as_count(std::uint64_t value) {
  return value;
}

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
  const EnergyLedger& e = result.energy;
  std::fprintf(stderr,
               "energy in %.4g J: kinetic %.4g, potential %.4g, fracture %.4g, contact %.4g, "
               "friction %.4g, numerical %.2g\n",
               result.energy_in, e.kinetic, e.potential, e.fracture, e.contact, e.friction,
               e.numerical);
  std::fprintf(stderr, "%llu steps (%llu substeps), %.3g ms median, %.3g ms longest, seed %llu\n",
               as_count(result.steps), as_count(result.substeps), result.step_ms_median,
               result.step_ms_max, as_count(scene.seed));
  for (const auto& path : options.outputs) std::fprintf(stderr, "wrote %s\n", path.c_str());
  if (!options.verbose) return;
  for (const std::string& key : given_keys(scene, {"building"}))
    std::fprintf(stderr, "\"%s\" is not used by impact\n", key.c_str());
  for (const auto& [step, seconds] : watch.steps())
    std::fprintf(stderr, "%-8s %8.3f ms\n", step.c_str(), 1e3 * seconds);
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
  const std::string text =
      impact_report_json({SUNDER_VERSION, scene.seed, result, took.count(), watch.steps()});
  if (options.json) std::fputs(text.c_str(), stdout);
  if (!options.report.empty()) write_file(options.report, text);
  for (const auto& path : options.outputs)
    if (path.extension() == ".json") write_file(path, text);
  for (const std::string& warning : result.warnings)
    std::fprintf(stderr, "sunder: warning: %s\n", warning.c_str());
  if (!options.quiet) print_summary(result, scene, options, watch);
  return kExitOk;
}

}  // namespace sunder
