// SPDX-License-Identifier: GPL-3.0-or-later
// What a wall costs from seed to file, per chunk, and what one hit costs. One process per size, so
// that the peak memory is that size's own. Usage: bench_wall [folder for the files] [sizes…]
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/report.hpp"
#include "fracture/breaking.hpp"
#include "fracture/chunk_mesh.hpp"
#include "fracture/measure.hpp"
#include "io/export.hpp"
#include "meshing/random.hpp"

namespace {

using namespace sunder;
using Clock = std::chrono::steady_clock;

template <class Work>
double seconds(Work work) {
  const auto start = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

template <class Work>
double least_seconds(int runs, Work work) {
  double least = 1e300;
  for (int i = 0; i < runs; ++i) least = std::min(least, seconds(work));
  return least;
}

Wall square_wall(double cells) {
  const double side = std::sqrt(cells);
  Wall wall;
  wall.region.outline = rectangle({side, side});
  wall.pattern = VoronoiGridParams{1, 1};
  wall.thickness = 0.5;
  return wall;
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// The corners of the faces a change shows, as a renderer would be handed them.
double emit_faces(const Pattern& pattern, const BreakableWall::Change& change,
                  std::vector<float>& out) {
  out.clear();
  for (const std::uint32_t k : change.shown)
    for (const float z : {-0.25f, 0.25f}) {
      const Vec2 p = pattern.vertices[pattern.corners[k]];
      out.insert(out.end(), {static_cast<float>(p.x), static_cast<float>(p.y), z});
    }
  return out.empty() ? 0 : out[0];
}

void bench_size(double cells, const std::filesystem::path& folder) {
  const Wall wall = square_wall(cells);
  const int runs = cells <= 1e4 ? 15 : cells <= 1e5 ? 7 : 3;
  Asset asset;
  asset.walls.resize(1);
  const FractureParams one{.seed = 1, .threads = 1};
  const double pattern = least_seconds(runs, [&] { make_pattern(wall, one); });
  const double whole =
      least_seconds(runs, [&] { asset.walls[0] = fracture_wall(wall, 2400, one); });
  const double mesh = least_seconds(runs, [&] { render_meshes(asset.walls[0], 1); });
  const MeshedAsset meshed = mesh_asset(asset, 1);
  const auto file = folder / "bench.glb";
  const double write = least_seconds(runs, [&] { export_asset(meshed, file); });
  const auto seed_to_file = [&](int threads) {
    return least_seconds(runs, [&] {
      Asset fresh;
      fresh.walls.push_back(fracture_wall(wall, 2400, {.seed = 1, .threads = threads}));
      export_asset(mesh_asset(fresh, threads), file);
    });
  };
  const double end_to_end = seed_to_file(1), two_threads = seed_to_file(2);
  const auto size = static_cast<double>(std::filesystem::file_size(file));
  std::filesystem::remove(file);

  const Pattern& p = asset.walls[0].pattern;
  BreakableWall state(p);
  std::vector<float> buffer;
  double sum = 0;
  const int hits = static_cast<int>(std::min(2000.0, cells / 4));
  const double hit = seconds([&] {
                       for (int i = 0; i < hits; ++i) {
                         const auto cell = static_cast<std::uint32_t>(
                             random_bits(5, static_cast<std::uint64_t>(i)) % p.cell_count());
                         sum += emit_faces(p, state.break_cells(std::span(&cell, 1)), buffer);
                       }
                     }) /
                     hits;
  const double count = p.cell_count();
  const auto ns = [&](double s) { return 1e9 * s / count; };
  std::printf(
      "| %.0e | %.0f | %.0f | %.0f | %.0f | %.0f | %.1f | %.1f | %.0f | %.0f | %.2f | %.1e |\n",
      cells, ns(pattern), ns(whole - pattern), ns(mesh), ns(whole + mesh), ns(write),
      1e3 * end_to_end, 1e3 * two_threads, size / count, peak_megabytes(), 1e6 * hit,
      (whole + mesh) / hit + 0 * sum);
  std::fflush(stdout);
}

// Whole processes, from start to exit.
void bench_process(const char* what, const std::string& arguments, const std::string& folder) {
  const std::string command =
      std::string(SUNDER_PROGRAM) + " " + arguments + " > " + folder + "/bench.out 2>&1";
  std::vector<double> times;
  for (int i = 0; i < 30; ++i)
    times.push_back(seconds([&] {
      if (std::system(command.c_str()) != 0) std::abort();
    }));
  std::ranges::sort(times);
  std::printf("| `sunder %s` | %.1f | %.1f |\n", what, 1e3 * times.front(),
              1e3 * times[times.size() / 2]);
}

void bench_processes(const std::string& folder) {
  const Block block("wall processes");
  std::printf("| process, shell included | least ms | median ms |\n|---|---|---|\n");
  bench_process("--version", "--version", folder);
  const std::string wall = "fracture --wall 6x3x0.2 --cell 0.3 -o ";
  bench_process((wall + "wall.glb").c_str(), wall + folder + "/bench.glb", folder);
  std::filesystem::remove(folder + "/bench.glb");
  std::filesystem::remove(folder + "/bench.out");
}

/// Each size in a process of its own, for its peak of memory. False: one of them failed.
bool bench_sizes(const char* name, const std::vector<double>& sizes,
                 const std::filesystem::path& folder) {
  const Block block(name);
  std::printf(
      "| chunks | pattern ns | mass + bonds ns | meshes ns | in memory ns | GLB ns | "
      "seed to file ms | 2 threads ms | bytes | peak MB | one hit us | rebuild / hit |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const double cells : sizes) {
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
      bench_size(cells, folder);
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (status != 0) return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path memory = std::filesystem::exists("/dev/shm")
                                           ? std::filesystem::path("/dev/shm")
                                           : std::filesystem::temp_directory_path();
  bool is_done = bench_sizes("wall files", {1e2, 1e3, 1e4, 1e5, 1e6}, memory);
  bench_processes(memory.string());
  is_done &= bench_sizes("wall disk", {1e4, 1e5}, argc > 1 ? argv[1] : ".");
  return is_done ? 0 : 1;
}
