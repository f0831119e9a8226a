// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "cli/outputs.hpp"
#include "cli/print_collapse.hpp"
#include "cli/print_run.hpp"
#include "cli/progress.hpp"
#include "cli/read_scene.hpp"
#include "cli/recording_params.hpp"
#include "cli/run.hpp"
#include "cli/stopwatch.hpp"
#include "io/collapse_report.hpp"
#include "io/collapse_scene.hpp"
#include "io/export_recording.hpp"
#include "io/joint_history.hpp"

namespace sunder {
namespace {

Scene read_building(const Options& options) {
  Scene scene = read_scene(options);
  const std::filesystem::path& motion = scene.ground_motion_file;
  if (!motion.empty()) check_not_written(options, {&motion, 1});
  check_moment(options, scene);
  return scene;
}

bool is_recording(const std::filesystem::path& path) {
  return path.extension() != ".json";
}

// What the scene asks for and this version does not do.
std::vector<std::string> shortcomings(const Scene& scene) {
  std::vector<std::string> list;
  if (!scene.walls.empty())
    list.emplace_back("walls beside the building are not used by collapse in this version");
  if (!scene.solids.empty())
    list.emplace_back("solids beside the building are not used by collapse");
  return list;
}

CollapseResult simulate(const CollapseScene& scene, const Options& options) {
  ProgressBar bar("simulating", !options.quiet);
  return simulate_collapse(
      scene, {.skip = !options.no_skip,
              .keep_history =
                  !options.history.empty() || std::ranges::any_of(options.outputs, is_recording),
              .progress = [&](double done) { bar.update(done); }});
}

void write_recording(const Recording& recording, const SimulationParams& simulation,
                     const Options& options) {
  const RecordingParams params = recording_params(options, simulation, recording);
  for (const auto& path : options.outputs)
    if (is_recording(path)) export_recording(recording, path, params);
  if (!options.history.empty()) write_joint_history(recording, options.history);
}

}  // namespace

int run_collapse(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  Stopwatch watch;
  const Scene scene = read_building(options);
  CollapseScene collapse = collapse_scene(scene);
  watch.lap("read");
  CollapseResult result = simulate(collapse, options);
  watch.lap("simulate");
  const RunSettings settings = run_settings(scene, "collapse");
  std::vector<std::string> own = shortcomings(scene);
  if (std::string warning = shortfall(scene, settings); !warning.empty())
    own.push_back(std::move(warning));
  result.warnings.insert(result.warnings.begin(), own.begin(), own.end());
  write_recording(result.recording, collapse.simulation, options);
  watch.lap("write");
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  write_report(options, collapse_report_json({SUNDER_VERSION, collapse, result, took.count(),
                                              watch.steps(), settings}));
  for (const std::string& warning : result.warnings)
    std::fprintf(stderr, "sunder: warning: %s\n", warning.c_str());
  if (options.quiet) return kExitOk;
  print_collapse(collapse, result);
  print_settings(settings);
  print_end(options, scene, "collapse", {}, watch);
  return kExitOk;
}

}  // namespace sunder
