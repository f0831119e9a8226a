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
#include "cli/run.hpp"
#include "cli/stopwatch.hpp"
#include "cli/usage.hpp"
#include "io/collapse_report.hpp"
#include "io/collapse_scene.hpp"
#include "io/export_recording.hpp"
#include "io/joint_history.hpp"
#include "io/printable.hpp"

namespace sunder {
namespace {

Scene read_building(const Options& options) {
  Scene scene = read_scene(options);
  const std::filesystem::path& motion = scene.ground_motion_file;
  if (!motion.empty()) check_not_written(options, {&motion, 1});
  const double duration = scene.simulation.duration;
  if (options.at && *options.at > duration)
    usage("--at " + number_text(*options.at) + " is after the end of the run, which lasts " +
          number_text(duration) + " s");
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
  RecordingParams params{.has_ground = simulation.ground,
                         .ground_height = simulation.ground_height,
                         .threads = thread_count(options)};
  for (const auto& path : options.outputs) {
    if (!is_recording(path)) continue;
    params.at = path.extension() == ".svg" ? std::nullopt : options.at;
    // The last step may end a rounding before the run does.
    if (params.at) params.at = std::min(*params.at, recording.times.back());
    export_recording(recording, path, params);
  }
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
  const std::vector<std::string> own = shortcomings(scene);
  result.warnings.insert(result.warnings.begin(), own.begin(), own.end());
  write_recording(result.recording, collapse.simulation, options);
  watch.lap("write");
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const CollapseReport report{SUNDER_VERSION, collapse, result, took.count(), watch.steps()};
  write_report(options, collapse_report_json(report),
               [&] { return collapse_page(report, page_source(options)); });
  for (const std::string& warning : result.warnings)
    std::fprintf(stderr, "sunder: warning: %s\n", warning.c_str());
  if (options.quiet) return kExitOk;
  print_collapse(collapse, result);
  print_end(options, scene, "collapse", {}, watch);
  return kExitOk;
}

}  // namespace sunder
