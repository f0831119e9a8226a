// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes into chunks: time, and what is wrong with the result. The wall of 6 × 3 × 0.2 m is the one
// that NVIDIA Blast was timed on (medians on a like machine, one thread, mesh to buffers in
// memory). Usage: bench_solid
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "bench/report.hpp"
#include "fracture/solid_asset.hpp"
#include "tests/fracture/solid_shapes.hpp"

namespace {

using namespace sunder;

double seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Of several runs; by the processor's time, or by the wall's where threads share the work.
template <class Work>
double least_seconds(int runs, clockid_t clock, Work work) {
  double least = 1e300;
  for (int i = 0; i < runs; ++i) {
    const double start = seconds(clock);
    work();
    least = std::min(least, seconds(clock) - start);
  }
  return least;
}

int open_chunks(const SolidPartition& p) {
  int open = 0;
  for (std::uint32_t c = 0; c < p.chunk_count(); ++c) {
    TriMesh mesh{p.vertices, {}};
    std::vector<std::uint32_t> used;
    for (std::uint32_t t = p.chunk_begin[c]; t < p.chunk_begin[c + 1]; ++t)
      for (const std::uint32_t v : p.triangles[t].corners) used.push_back(v);
    std::ranges::sort(used);
    used.erase(std::ranges::unique(used).begin(), used.end());
    mesh.vertices.clear();
    for (const std::uint32_t v : used) mesh.vertices.push_back(p.vertices[v]);
    const auto local = [&](std::uint32_t v) {
      return static_cast<std::uint32_t>(std::ranges::lower_bound(used, v) - used.begin());
    };
    for (std::uint32_t t = p.chunk_begin[c]; t < p.chunk_begin[c + 1]; ++t) {
      const auto& k = p.triangles[t].corners;
      mesh.triangles.push_back({local(k[0]), local(k[1]), local(k[2])});
    }
    open += check(mesh) != MeshDefects{};
  }
  return open;
}

void row(const char* name, const TriMesh& mesh, const SolidModel& model, double blast) {
  const ModelSurface surface = test::as_surface(mesh);
  SolidAsset asset;
  const auto cut = [&](int threads) {
    return least_seconds(7, threads > 1 ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, [&] {
      asset = fracture_solid(model, surface, 2400, {.seed = 1, .threads = threads, .progress = {}});
    });
  };
  const double two = cut(2), one = cut(1);
  SolidMeshes meshes;
  const double render =
      least_seconds(7, CLOCK_PROCESS_CPUTIME_ID, [&] { meshes = solid_meshes(asset, 1); });
  double sum = 0;
  for (const auto& chunk : asset.chunks) sum += chunk.volume;
  std::printf("| %s | %zu | %u | %zu | %zu | %.2f | %.2f | %.2f | ", name, mesh.triangles.size(),
              asset.partition.chunk_count(), asset.partition.triangles.size(), asset.bonds.size(),
              1e3 * one, 1e3 * two, 1e3 * render);
  if (blast > 0)
    std::printf("%.0f | %.0f | ", 1e3 * blast, blast / (one + render));
  else
    std::printf("– | – | ");
  std::printf("%.0e | %d | %llu |\n", std::abs(sum - asset.volume_expected) / asset.volume_expected,
              open_chunks(asset.partition),
              static_cast<unsigned long long>(asset.stats.exact_predicates));
  std::fflush(stdout);
}

SolidModel voronoi(std::int64_t count) {
  SolidModel model;
  SolidVoronoiParams pattern;
  pattern.count = count;
  model.pattern = pattern;
  return model;
}

}  // namespace

int main() {
  const Block block("solid chunks");
  std::printf(
      "| mesh, pattern | its triangles | chunks | triangles | bonds | cut ms | 2 threads, by the "
      "clock ms | "
      "buffers ms | Blast ms | faster | volume error | unsound chunks | decided exactly |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  const TriMesh wall = test::box({0, 0, -0.1}, {6, 3, 0.2});
  row("wall, voronoi 100", wall, voronoi(100), 0.085);
  row("wall, voronoi 1000", wall, voronoi(1000), 4.3);
  row("wall, voronoi 2000", wall, voronoi(2000), 20.5);
  row("wall, voronoi 5000", wall, voronoi(5000), 295);
  row("sphere, voronoi 1000", test::sphere({0, 0, 0}, 1, 158), voronoi(1000), 0);
  row("torus, voronoi 1000", test::torus(1, 0.3, 320, 160), voronoi(1000), 0);
  row("gear, voronoi 1000", test::gear(), voronoi(1000), 0);
  SolidModel slices, bricks, rough = voronoi(100);
  SolidSlicesParams grid;
  grid.slices = {29, 14, 1};
  slices.pattern = grid;
  row("wall, slices 30 × 15 × 2", wall, slices, 0);
  SolidBrickParams brick;
  brick.mortar = 0.01;
  bricks.pattern = brick;
  row("wall, bricks with mortar", wall, bricks, 0);
  rough.roughness = 0.01;
  row("wall, voronoi 100, rough 1 cm", wall, rough, 0);
  return 0;
}
