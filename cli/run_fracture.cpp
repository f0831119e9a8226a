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
#include "fracture/solid_prepare.hpp"
#include "io/export.hpp"
#include "io/export_files.hpp"
#include "io/model.hpp"
#include "io/report.hpp"
#include "io/scene.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

Scene read(const Options& options) {
  Scene scene = read_scene(options);
  if (scene.walls.empty() && scene.solids.empty())
    throw Error(ErrorCode::input, "the scene has no walls or solids to fracture");
  std::vector<std::filesystem::path> models;
  for (const SolidModel& solid : scene.solids) models.emplace_back(solid.file);
  check_not_written(options, models);
  for (const Wall& wall : scene.walls)
    if (!wall.asset.empty())
      throw Error(ErrorCode::input, "wall " + wall.name + " is an asset (" + wall.asset +
                                        ") and fractured already; leave it out or give an outline");
  return scene;
}

// What became of a scene's walls and solids.
struct Fractured {
  Asset walls;
  std::vector<SolidAsset> solids;
  std::vector<ReportedRepair> repairs;
};

void tell_repair(const SolidModel& solid, const Repair& repair) {
  std::fprintf(stderr, "%s: found %s\n", solid.name.c_str(), repair.before.text().c_str());
  for (const std::string& step : repair.steps)
    std::fprintf(stderr, "%s: repair: %s\n", solid.name.c_str(), step.c_str());
  std::fprintf(stderr,
               "%s: volume %.9g m³ before and %.9g m³ after, surfaces at most %.3g m apart\n",
               solid.name.c_str(), repair.volume_before, repair.volume_after, repair.hausdorff);
}

SolidAsset fracture_model(const SolidModel& solid, const Scene& scene, const Options& options,
                          const FractureParams& params, Fractured& result) {
  PreparedSolid prepared = prepare_solid(solid, read_model(solid.file), scene.seed);
  if (prepared.repair) {
    if (!options.quiet) tell_repair(solid, *prepared.repair);
    result.repairs.push_back({solid.name, std::move(*prepared.repair)});
  }
  const double density = find_material(scene.materials, solid.material).density;
  return fracture_solid(solid, std::move(prepared.surface), density, params);
}

Fractured fracture(const Scene& scene, const Options& options, int threads) {
  ProgressBar bar("fracturing", !options.quiet);
  Fractured result;
  const double count = static_cast<double>(scene.walls.size() + scene.solids.size());
  double before = 0;
  const Progress progress = [&](double done) { bar.update((before + done) / count); };
  const FractureParams params{scene.seed, threads, progress};
  for (const Wall& wall : scene.walls) {
    const double density = find_material(scene.materials, wall.material).density;
    result.walls.walls.push_back(fracture_wall(wall, density, params));
    ++before;
  }
  for (const SolidModel& solid : scene.solids) {
    result.solids.push_back(fracture_model(solid, scene, options, params, result));
    ++before;
  }
  return result;
}

bool needs_meshes(const std::filesystem::path& path) {
  const std::string suffix = suffix_of(path);
  return suffix != ".svg" && suffix != ".png" && suffix != ".json";
}

bool holds_hulls(const std::filesystem::path& path) {
  const std::string suffix = suffix_of(path);
  return suffix == ".glb" || suffix == ".gltf" || suffix == ".obj";
}

std::vector<std::pair<std::string, std::uint64_t>> skipped(const Fractured& fractured,
                                                           bool meshed) {
  std::uint64_t outside = 0, uncut = 0, certified = 0, unmeshed = 0, whole = 0;
  for (const WallAsset& wall : fractured.walls.walls) {
    outside += wall.stats.cells_outside;
    certified += wall.stats.cells_certified;
    uncut += wall.pattern.cell_count() -
             std::min<std::uint64_t>(wall.stats.cells_cut, wall.pattern.cell_count());
    unmeshed += meshed ? 0 : wall.pattern.cell_count();
  }
  for (const SolidAsset& solid : fractured.solids) {
    outside += solid.stats.cells_outside;
    uncut += solid.stats.cells_inside;
    unmeshed += meshed ? 0 : solid.partition.chunk_count();
    const std::uint64_t triangles = solid.surface.mesh.triangles.size();
    whole += triangles - std::min(solid.stats.triangles_cut, triangles);
  }
  std::vector<std::pair<std::string, std::uint64_t>> counts{
      {"cells_outside", outside},
      {"cells_not_cut", uncut},
      {"cells_without_exact_arithmetic", certified},
      {"chunks_not_meshed", unmeshed}};
  if (!fractured.solids.empty()) counts.emplace_back("surface_triangles_not_cut", whole);
  return counts;
}

Soundness measure_meshes(const MeshedAsset& meshed, bool quiet) {
  ProgressBar bar("measuring", !quiet);
  std::vector<SoupWall> soups;
  for (std::size_t w = 0; w < meshed.asset.walls.size(); ++w)
    soups.push_back(soup_of(meshed.asset.walls[w], meshed.meshes[w]));
  for (std::size_t s = 0; s < meshed.solids.size(); ++s)
    soups.push_back(soup_of(meshed.solids[s], meshed.solid_meshes[s]));
  return measure(soups, [&](double done) { bar.update(done); });
}

// Sums over walls and solids.
struct Totals {
  std::uint64_t chunks = 0, bonds = 0;
  double volume = 0, expected = 0;
  template <class FracturedThing>
  void add(const FracturedThing& thing) {
    chunks += thing.chunks.size();
    bonds += thing.bonds.size();
    expected += thing.volume_expected;
    for (const MassProperties& chunk : thing.chunks) volume += chunk.volume;
  }
};

void print_merged(const std::string& name, std::uint64_t slivers, std::uint64_t sites) {
  if (slivers + sites == 0) return;
  std::fprintf(stderr, "%s: %llu slivers merged, %llu repeated sites dropped\n", name.c_str(),
               static_cast<unsigned long long>(slivers), static_cast<unsigned long long>(sites));
}

void print_summary(const Fractured& fractured, const Scene& scene, const Options& options,
                   const Stopwatch& watch) {
  Totals totals;
  for (const WallAsset& wall : fractured.walls.walls) totals.add(wall);
  for (const SolidAsset& solid : fractured.solids) totals.add(solid);
  std::fprintf(stderr, "%llu chunks, %llu bonds, %.9g m³ (off by %.1e), seed %llu\n",
               static_cast<unsigned long long>(totals.chunks),
               static_cast<unsigned long long>(totals.bonds), totals.volume,
               std::abs(totals.volume - totals.expected) / totals.expected,
               static_cast<unsigned long long>(scene.seed));
  for (const WallAsset& wall : fractured.walls.walls)
    print_merged(wall.wall.name, wall.stats.slivers_merged, wall.stats.sites_repeated);
  for (const SolidAsset& solid : fractured.solids)
    print_merged(solid.solid.name, solid.stats.slivers_merged, 0);
  for (const auto& path : options.outputs) std::fprintf(stderr, "wrote %s\n", path.c_str());
  if (!options.verbose) return;
  for (const std::string& key :
       given_keys(scene, {"projectiles", "building", "scenario", "simulation"}))
    std::fprintf(stderr, "\"%s\" is not used by fracture\n", key.c_str());
  for (const auto& [step, seconds] : watch.steps())
    std::fprintf(stderr, "%-8s %8.3f ms\n", step.c_str(), 1e3 * seconds);
}

// Where a solid did not bear the roughness or the waves that were asked for.
void print_roughness(const SolidAsset& asset) {
  const auto print = [&](const char* what, double used, double asked) {
    if (used >= 0.999 * asked) return;
    std::fprintf(stderr, "%s: %s of %.3g m instead of %.3g m, or chunks would cross themselves\n",
                 asset.solid.name.c_str(), what, used, asked);
  };
  print("roughness", asset.stats.roughness, asset.solid.roughness);
  if (const auto* slices = std::get_if<SolidSlicesParams>(&asset.solid.pattern))
    print("waves", asset.stats.amplitude, slices->amplitude);
}

void print_hulls(const MeshedAsset& asset) {
  if (asset.hulls.empty()) return;
  std::uint64_t hulls = 0, over = 0;
  HullSet::Error worst;
  for (const HullSet& set : asset.hulls) {
    hulls += set.hull_count();
    for (const HullSet::Error& error : set.errors) {
      worst.volume = std::max(worst.volume, error.volume);
      worst.distance = std::max(worst.distance, error.distance);
      over += std::max(error.volume, error.distance) > asset.hull_params.error;
    }
  }
  std::fprintf(stderr,
               "%llu hulls, at most %.3g of a chunk's volume too much and %.3g of its size off; "
               "%llu chunks above %g\n",
               static_cast<unsigned long long>(hulls), worst.volume, worst.distance,
               static_cast<unsigned long long>(over), asset.hull_params.error);
}

}  // namespace

int run_fracture(const Options& options) {
  Stopwatch watch;
  const Scene scene = read(options);
  const int threads = thread_count(options);
  watch.lap("read");
  const Fractured fractured = fracture(scene, options, threads);
  watch.lap("fracture");

  const auto wants_report = [](const auto& path) { return path.extension() == ".json"; };
  const bool report_wanted = options.json || !options.reports.empty() ||
                             std::ranges::any_of(options.outputs, wants_report);
  const bool meshed = report_wanted || std::ranges::any_of(options.outputs, needs_meshes);
  MeshedAsset meshes = meshed ? mesh_asset(fractured.walls, threads, fractured.solids)
                              : MeshedAsset{fractured.walls, {}, fractured.solids, {}};
  watch.lap("mesh");
  if (scene.hulls.is_wanted() && std::ranges::any_of(options.outputs, holds_hulls)) {
    add_hulls(meshes, scene.hulls, scene.materials, threads);
    watch.lap("hulls");
  }
  meshes.picture_width = options.picture_width.value_or(kPictureWidth);
  for (const auto& path : options.outputs)
    if (!wants_report(path)) export_asset(meshes, path);
  watch.lap("write");

  int exit_code = kExitOk;
  if (report_wanted) {
    Report report{SUNDER_VERSION,   scene.seed, measure_meshes(meshes, options.quiet), 0, {}, {},
                  fractured.repairs};
    for (const WallAsset& wall : fractured.walls.walls)
      report.slivers_merged += wall.stats.slivers_merged;
    for (const SolidAsset& solid : fractured.solids)
      report.slivers_merged += solid.stats.slivers_merged;
    watch.lap("measure");
    report.times = watch.steps();
    report.skipped = skipped(fractured, meshed);
    write_report(options, report_json(report),
                 [&] { return soundness_page(report, page_source(options)); });
    if (!report.soundness.is_sound()) {
      exit_code = kExitCheckFailed;
      print_soundness(stderr, "the asset", report.soundness);
    }
  }
  if (!options.quiet) print_summary(fractured, scene, options, watch);
  if (!options.quiet) {
    for (const SolidAsset& solid : fractured.solids) print_roughness(solid);
    print_hulls(meshes);
  }
  return exit_code;
}

}  // namespace sunder
