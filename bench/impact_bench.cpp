// SPDX-License-Identifier: GPL-3.0-or-later
// What a hit costs: our step against the same wall with every chunk an active Bullet body, and the
// incremental break against building everything anew. Prints the tables of docs/performance.md.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "bench/peers_bullet.hpp"
#include "bench/report.hpp"
#include "fracture/support_graph.hpp"
#include "io/impact_scene.hpp"
#include "sim/impact.hpp"

namespace sunder {
namespace {

constexpr double kStep = 1.0 / 240;

/// A concrete wall of about this many chunks and a ball for its middle.
ImpactScene scene_of(int chunks) {
  const double cell = 0.25;
  const double height = cell * std::sqrt(chunks / 2.0), width = 2 * height;
  char text[1024];
  std::snprintf(text, sizeof text, R"({"sunder": 1, "seed": 7, "walls": [{"outline": {"rect":
[%.3f, %.3f]}, "thickness": 0.2, "material": "concrete-c30", "anchors": ["bottom"],
"pattern": {"type": "voronoi-grid", "cell": %.3f}}], "projectiles": [{"radius": 0.25, "mass": 514,
"position": [%.3f, %.3f, 0.8], "velocity": [0, 0, -10]}], "simulation": {"duration": 1}})",
                width, height, cell, width / 2, height / 2);
  return impact_scene(parse_scene(text, "bench"));
}

double at(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void print_steps(const char* method, int chunks, const std::vector<double>& ms) {
  std::printf("| %d | %s | %.3g | %.3g | %.3g | %zu |\n", chunks, method, at(ms, 0.5), at(ms, 0.95),
              at(ms, 1), ms.size());
  std::fflush(stdout);
}

/// The run whose longest step was shortest: what another process did meanwhile is not ours.
ImpactResult best_run(const ImpactScene& scene, bool skip) {
  ImpactResult best;
  for (int run = 0; run < (skip ? 5 : 2); ++run) {
    ImpactResult result = simulate_impact(scene, {.skip = skip, .progress = {}});
    if (run == 0 || result.step_ms_max < best.step_ms_max) best = std::move(result);
  }
  return best;
}

void compare_steps() {
  const Block block("impact steps");
  std::printf(
      "| chunks | method | median ms | p95 ms | longest ms | steps |\n"
      "|---|---|---|---|---|---|\n");
  for (const int size : {300, 3000, 30000}) {
    const ImpactScene scene = scene_of(size);
    const auto chunks = static_cast<int>(scene.walls[0].asset.chunks.size());
    for (const bool skip : {true, false}) {
      const ImpactResult best = best_run(scene, skip);
      std::printf("| %d | sunder%s (%llu chunks freed) | %.3g | %.3g | %.3g | %llu |\n", chunks,
                  skip ? "" : ", nothing skipped",
                  static_cast<unsigned long long>(best.chunks_freed), best.step_ms_median,
                  best.step_ms_p95, best.step_ms_max, static_cast<unsigned long long>(best.steps));
    }
    for (const int iterations : {10, 50, 200}) {
      const auto ms =
          step_jointed_wall(scene.walls[0].asset, scene.walls[0].material.tensile_strength,
                            scene.projectiles[0], kStep, iterations, 240, 3);
      print_steps(("Bullet, all active, " + std::to_string(iterations) + " iterations").c_str(),
                  chunks, ms);
    }
  }
}

double best_of(int runs, const std::function<void()>& work, const std::function<void()>& prepare) {
  double best = 1e300;
  for (int i = 0; i < runs; ++i) {
    prepare();
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count());
  }
  return best;
}

/// Bonds of the chunks within a radius of the wall's middle.
std::vector<std::uint32_t> bonds_near(const WallAsset& wall, Vec3 centre, double radius) {
  std::vector<std::uint32_t> bonds;
  for (std::uint32_t b = 0; b < wall.bonds.size(); ++b)
    if (length(wall.bonds[b].centroid - centre) < radius) bonds.push_back(b);
  return bonds;
}

void compare_islands() {
  const Block block("impact islands");
  std::printf(
      "| chunks | chunks freed | bounded search µs | whole graph µs | graph built anew µs "
      "| chunks searched |\n|---|---|---|---|---|---|\n");
  for (const int size : {300, 3000, 30000, 300000}) {
    const ImpactScene scene = scene_of(size);
    const WallAsset& wall = scene.walls[0].asset;
    const auto count = static_cast<std::uint32_t>(wall.chunks.size());
    const double height = 0.25 * std::sqrt(size / 2.0);
    const auto bonds = bonds_near(wall, {height, height / 2, 0}, 0.8);
    const SupportGraph intact(count, wall.bonds);
    SupportGraph graph = intact;
    SupportGraph::Change change;
    std::size_t freed = 0;
    const auto prepare = [&] { graph = intact; };
    const double bounded = best_of(
        7, [&] { change = graph.break_bonds(bonds); }, prepare);
    for (const auto& island : change.islands) freed += island.chunks.size();
    const std::uint64_t searched = change.chunks_searched;
    const double whole = best_of(
        7, [&] { change = graph.break_bonds(bonds, true); }, prepare);
    const double anew = best_of(
        7, [&] { SupportGraph(count, wall.bonds).break_bonds(bonds, true); }, [] {});
    std::printf("| %u | %zu | %.1f | %.1f | %.1f | %llu |\n", count, freed, bounded, whole, anew,
                static_cast<unsigned long long>(searched));
  }
}

}  // namespace
}  // namespace sunder

int main() {
  sunder::compare_steps();
  sunder::compare_islands();
}
