// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <memory>

#include "cli/outputs.hpp"
#include "cli/print_soundness.hpp"
#include "cli/progress.hpp"
#include "cli/read_scene.hpp"
#include "cli/run.hpp"
#include "cli/stopwatch.hpp"
#include "fracture/measure.hpp"
#include "io/export.hpp"
#include "io/report.hpp"
#include "io/scene.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

Scene read(const Options& options) {
  Scene scene = read_scene(options);
  if (scene.walls.empty())
    throw Error(ErrorCode::input, "the scene has no walls, so there is nothing to fracture");
  for (const Wall& wall : scene.walls)
    if (!wall.asset.empty())
      throw Error(ErrorCode::input, "wall " + wall.name + " is an asset (" + wall.asset +
                                        ") and fractured already; leave it out or give an outline");
  return scene;
}

Asset fracture(const Scene& scene, const Options& options, int threads) {
  ProgressBar bar("fracturing", !options.quiet);
  Asset asset;
  const double count = static_cast<double>(scene.walls.size());
  for (const Wall& wall : scene.walls) {
    const double before = static_cast<double>(asset.walls.size());
    const Progress progress = [&](double done) { bar.update((before + done) / count); };
    const double density = find_material(scene.materials, wall.material).density;
    asset.walls.push_back(fracture_wall(wall, density, {scene.seed, threads, progress}));
  }
  return asset;
}

bool needs_meshes(const std::filesystem::path& path) {
  return path.extension() != ".svg" && path.extension() != ".json";
}

std::vector<std::pair<std::string, std::uint64_t>> skipped(const Asset& asset, bool meshed) {
  std::uint64_t outside = 0, uncut = 0, certified = 0, unmeshed = 0;
  for (const WallAsset& wall : asset.walls) {
    outside += wall.stats.cells_outside;
    certified += wall.stats.cells_certified;
    uncut += wall.pattern.cell_count() -
             std::min<std::uint64_t>(wall.stats.cells_cut, wall.pattern.cell_count());
    unmeshed += meshed ? 0 : wall.pattern.cell_count();
  }
  return {{"cells_outside", outside},
          {"cells_not_cut", uncut},
          {"cells_without_exact_arithmetic", certified},
          {"chunks_not_meshed", unmeshed}};
}

Soundness measure_meshes(const MeshedAsset& meshed, bool quiet) {
  ProgressBar bar("measuring", !quiet);
  std::vector<SoupWall> soups;
  for (std::size_t w = 0; w < meshed.asset.walls.size(); ++w)
    soups.push_back(soup_of(meshed.asset.walls[w], meshed.meshes[w]));
  return measure(soups, [&](double done) { bar.update(done); });
}

void print_summary(const Asset& asset, const Scene& scene, const Options& options,
                   const Stopwatch& watch) {
  std::uint64_t chunks = 0, bonds = 0;
  double volume = 0, expected = 0;
  for (const WallAsset& wall : asset.walls) {
    chunks += wall.chunks.size();
    bonds += wall.bonds.size();
    expected += wall.volume_expected;
    for (const MassProperties& chunk : wall.chunks) volume += chunk.volume;
  }
  std::fprintf(stderr, "%llu chunks, %llu bonds, %.9g m³ (off by %.1e), seed %llu\n",
               static_cast<unsigned long long>(chunks), static_cast<unsigned long long>(bonds),
               volume, std::abs(volume - expected) / expected,
               static_cast<unsigned long long>(scene.seed));
  for (const WallAsset& wall : asset.walls)
    if (wall.stats.sites_repeated + wall.stats.slivers_merged > 0)
      std::fprintf(stderr, "%s: %llu slivers merged, %llu repeated sites dropped\n",
                   wall.wall.name.c_str(),
                   static_cast<unsigned long long>(wall.stats.slivers_merged),
                   static_cast<unsigned long long>(wall.stats.sites_repeated));
  for (const auto& path : options.outputs) std::fprintf(stderr, "wrote %s\n", path.c_str());
  if (!options.verbose) return;
  for (const std::string& key :
       given_keys(scene, {"projectiles", "building", "scenario", "simulation"}))
    std::fprintf(stderr, "\"%s\" is not used by fracture\n", key.c_str());
  for (const auto& [step, seconds] : watch.steps())
    std::fprintf(stderr, "%-8s %8.3f ms\n", step.c_str(), 1e3 * seconds);
}

}  // namespace

int run_fracture(const Options& options) {
  Stopwatch watch;
  const Scene scene = read(options);
  const int threads = thread_count(options);
  watch.lap("read");
  const Asset asset = fracture(scene, options, threads);
  watch.lap("fracture");

  const auto wants_report = [](const auto& path) { return path.extension() == ".json"; };
  const bool report_wanted =
      options.json || !options.report.empty() || std::ranges::any_of(options.outputs, wants_report);
  const bool meshed = report_wanted || std::ranges::any_of(options.outputs, needs_meshes);
  const MeshedAsset meshes = meshed ? mesh_asset(asset, threads) : MeshedAsset{asset, {}};
  watch.lap("mesh");
  for (const auto& path : options.outputs)
    if (!wants_report(path)) export_asset(meshes, path);
  watch.lap("write");

  int exit_code = kExitOk;
  if (report_wanted) {
    Report report{SUNDER_VERSION, scene.seed, measure_meshes(meshes, options.quiet), 0, {}, {}};
    for (const WallAsset& wall : asset.walls) report.slivers_merged += wall.stats.slivers_merged;
    watch.lap("measure");
    report.times = watch.steps();
    report.skipped = skipped(asset, meshed);
    write_report(options, report_json(report));
    if (!report.soundness.is_sound()) {
      exit_code = kExitCheckFailed;
      print_soundness(stderr, "the asset", report.soundness);
    }
  }
  if (!options.quiet) print_summary(asset, scene, options, watch);
  return exit_code;
}

}  // namespace sunder
