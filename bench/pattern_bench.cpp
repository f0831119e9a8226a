// SPDX-License-Identifier: GPL-3.0-or-later
// Time per cell of the Voronoi pattern of a jittered grid against voro++, CGAL's Delaunay
// triangulation with its dual, and the plain clipper that searches two cells around.
// Usage: bench_pattern [window | largest cell count = 1e6 [jitter = 1]]
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>

#include "bench/peers.hpp"
#include "bench/report.hpp"
#include "bench/work_precision.hpp"
#include "fracture/voronoi.hpp"

namespace sunder {
namespace {

double seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Mean of the squared cell areas, in units of the mean area: one number that every program must
// hit.
// Negative if the corners run clockwise.
double area_of(const Polygons& polygons, std::size_t cell) {
  double twice = 0;
  const std::uint32_t begin = polygons.begin[cell], end = polygons.begin[cell + 1];
  for (std::uint32_t k = begin; k < end; ++k)
    twice += cross(polygons.corners[k] - polygons.corners[begin],
                   polygons.corners[k + 1 == end ? begin : k + 1] - polygons.corners[begin]);
  return twice / 2;
}

double area_moment(const Polygons& polygons, double mean) {
  double sum = 0;
  const std::size_t count = polygons.begin.size() - 1;
  for (std::size_t cell = 0; cell < count; ++cell)
    sum += std::pow(area_of(polygons, cell) / mean, 2);
  return sum / static_cast<double>(count);
}

double area_moment(const Pattern& pattern, double mean) {
  double sum = 0;
  for (std::uint32_t cell = 0; cell < pattern.cell_count(); ++cell)
    sum += cell_area(pattern, cell) * cell_area(pattern, cell) / (mean * mean);
  return sum / pattern.cell_count();
}

// FNV-1a over the bytes of a pattern.
std::uint64_t hash_of(const Pattern& pattern) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  const auto add = [&](const auto& values) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    for (std::size_t k = 0; k < values.size() * sizeof values[0]; ++k)
      hash = (hash ^ bytes[k]) * 0x100000001B3u;
  };
  add(pattern.vertices), add(pattern.cell_begin), add(pattern.corners), add(pattern.across);
  return hash;
}

// The plain way: each cell by itself, clipped by the grid cells up to `reach` around.
Polygons window(const Sites& sites, std::int32_t reach) {
  Polygons result;
  std::vector<Vec2> polygon, kept;
  const Vec2 size{static_cast<double>(sites.lattice.width),
                  static_cast<double>(sites.lattice.height)};
  for (std::int32_t j = 0; j < sites.rows; ++j)
    for (std::int32_t i = 0; i < sites.columns; ++i) {
      const auto place = [&](std::int32_t x, std::int32_t y) {
        const Site s = sites.points[static_cast<std::size_t>(y) * sites.columns + x];
        return Vec2{static_cast<double>(s.x), static_cast<double>(s.y)};
      };
      const Vec2 p = place(i, j);
      polygon = {{0, 0}, {size.x, 0}, size, {0, size.y}};
      for (std::int32_t y = std::max(0, j - reach); y <= std::min(sites.rows - 1, j + reach); ++y)
        for (std::int32_t x = std::max(0, i - reach); x <= std::min(sites.columns - 1, i + reach);
             ++x) {
          if (x == i && y == j) continue;
          const Vec2 q = place(x, y), normal = q - p;
          const double offset = dot(normal, p + 0.5 * normal);
          kept.clear();
          for (std::size_t k = 0; k < polygon.size(); ++k) {
            const Vec2 v = polygon[k], w = polygon[k + 1 == polygon.size() ? 0 : k + 1];
            const double a = dot(normal, v) - offset, b = dot(normal, w) - offset;
            if (a <= 0) kept.push_back(v);
            if ((a < 0 && b > 0) || (a > 0 && b < 0)) kept.push_back(v + (a / (a - b)) * (w - v));
          }
          polygon.swap(kept);
        }
      result.corners.insert(result.corners.end(), polygon.begin(), polygon.end());
      result.site.push_back(static_cast<std::uint32_t>(result.site.size()));
      result.begin.push_back(static_cast<std::uint32_t>(result.corners.size()));
    }
  return result;
}

Polygons two_cell_window(const Sites& sites) {
  return window(sites, 2);
}

struct Timing {
  double least = 0, median = 0;  // ns per cell
};

// At least `runs` runs and a tenth of a second.
Timing time_of(std::size_t cells, int runs, clockid_t clock, const std::function<void()>& action) {
  std::vector<double> times;
  for (double total = 0; static_cast<int>(times.size()) < runs || (runs > 1 && total < 0.1);) {
    const double start = seconds(clock);
    action();
    times.push_back(seconds(clock) - start);
    total += times.back();
  }
  std::ranges::sort(times);
  const double scale = 1e9 / static_cast<double>(cells);
  return {times.front() * scale, times[times.size() / 2] * scale};
}

void print(std::size_t cells, const char* what, Timing timing, double reference, double moment,
           const std::string& hash) {
  std::printf("| %zu | %s | %.1f | %.1f | %.2f | %.9f | %s |\n", cells, what, timing.least,
              timing.median, timing.least / reference, moment, hash.c_str());
  std::fflush(stdout);
}

void run(std::int32_t side, double jitter) {
  const double length = side;
  const Sites sites = jittered_sites(make_grid({}, {length, length}, 1), jitter, 1);
  const std::size_t cells = sites.points.size();
  const double lattice_mean = static_cast<double>(sites.cell_width) * sites.cell_height;
  struct Ours {
    const char* name;
    VoronoiParams params;
    clockid_t clock;
  };
  double reference = 0;
  for (const Ours& row :
       {Ours{"sunder, AVX2", {VoronoiKernel::avx2, 1}, CLOCK_THREAD_CPUTIME_ID},
        Ours{"sunder, portable", {VoronoiKernel::portable, 1}, CLOCK_THREAD_CPUTIME_ID},
        Ours{"sunder, 2 threads (wall time)", {VoronoiKernel::automatic, 2}, CLOCK_MONOTONIC}}) {
    if (row.params.kernel == VoronoiKernel::avx2 && !has_avx2()) continue;
    Pattern pattern;
    const Timing timing =
        time_of(cells, 5, row.clock, [&] { pattern = voronoi(sites, row.params); });
    if (reference == 0) reference = timing.least;
    char hash[17];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(hash_of(pattern)));
    print(cells, row.name, timing, reference, area_moment(pattern, 1), hash);
  }
  const int runs = cells > 300000 ? 2 : 5;
  struct Peer {
    const char* name;
    Polygons (*cells)(const Sites&);
  };
  for (const Peer& peer :
       {Peer{"CGAL Delaunay + dual", cgal_cells}, Peer{"two-cell window", two_cell_window},
        Peer{"voro++", voropp_cells}}) {
    Polygons polygons;
    const Timing timing =
        time_of(cells, runs, CLOCK_THREAD_CPUTIME_ID, [&] { polygons = peer.cells(sites); });
    print(cells, peer.name, timing, reference, area_moment(polygons, lattice_mean), "");
  }
}

/// Share of cells whose area is off by a millionth of the mean cell: a neighbour is missing.
double wrong_share(const Pattern& pattern, const Polygons& polygons, double mean) {
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < polygons.site.size(); ++k)
    wrong += std::fabs(std::fabs(area_of(polygons, k)) / mean -
                       cell_area(pattern, polygons.site[k])) > 1e-6;
  return static_cast<double>(wrong) / static_cast<double>(polygons.site.size());
}

Spread spread_of_runs(std::size_t cells, int runs, const std::function<void()>& action) {
  std::vector<double> ns;
  for (int run = 0; run < runs; ++run) {
    const double start = seconds(CLOCK_THREAD_CPUTIME_ID);
    action();
    ns.push_back(1e9 / static_cast<double>(cells) * (seconds(CLOCK_THREAD_CPUTIME_ID) - start));
  }
  return spread_of(ns);
}

/// Windows of one to three cells, and those who look as far as they must: cells wrong against time.
void plot_windows(std::int32_t side) {
  const Sites sites = jittered_sites(make_grid({}, {double(side), double(side)}, 1), 1, 1);
  const std::size_t cells = sites.points.size();
  const double mean = static_cast<double>(sites.cell_width) * sites.cell_height;
  WorkPlot plot{.block = "pattern window",
                .title = text("Voronoi cells of a grid of %d × %d sites, jitter 1", side, side),
                .error_axis = "share of cells with a neighbour missing",
                .time_axis = "ns per cell, one thread",
                .least_error = 0.5 / static_cast<double>(cells),
                .none = "none",
                .omissions =
                    "bounded window searches that grow until they are safe, which is what "
                    "voro++ does; graphics processors; other jitters (below 2/3 two cells "
                    "are enough, which is proven).",
                .points = {}};
  constexpr int kRuns = 5;
  Pattern pattern = voronoi(sites, {});
  for (const auto& [name, kernel] : {std::pair{"sunder, AVX2", VoronoiKernel::avx2},
                                     std::pair{"sunder, portable", VoronoiKernel::portable}}) {
    if (kernel == VoronoiKernel::avx2 && !has_avx2()) continue;
    const Spread time = spread_of_runs(cells, kRuns, [&] {
      pattern = voronoi(sites, {kernel, 1});
    });
    plot.points.push_back(
        {.method = name, .knobs = "certified", .label = "", .error = 0, .time = time});
  }
  Polygons polygons;
  for (const std::int32_t reach : {1, 2, 3}) {
    const Spread time = spread_of_runs(cells, 3, [&] { polygons = window(sites, reach); });
    plot.points.push_back({.method = "window",
                           .knobs = text("%d cells around", reach),
                           .label = text("±%d", reach),
                           .error = wrong_share(pattern, polygons, mean),
                           .time = time});
  }
  for (const auto& [name, peer] :
       {std::pair{"CGAL Delaunay + dual", &cgal_cells}, std::pair{"voro++", &voropp_cells}}) {
    const Spread time = spread_of_runs(cells, 3, [&] { polygons = peer(sites); });
    plot.points.push_back({.method = name,
                           .knobs = "",
                           .label = "",
                           .error = wrong_share(pattern, polygons, mean),
                           .time = time});
  }
  publish(plot);
}

}  // namespace
}  // namespace sunder

int main(int argc, char** argv) {
  const bool has_part = argc > 1 && std::string(argv[1]) == "window";
  const double largest = argc > 1 ? std::atof(argv[1]) : 1e6;
  const double jitter = argc > 2 ? std::atof(argv[2]) : 1;
  if (!has_part) {
    const sunder::Block block("pattern times");
    std::printf("| cells | program | least ns per cell | median | ratio | mean area² | bytes |\n");
    std::printf("|---|---|---|---|---|---|---|\n");
    for (const int side : {10, 32, 100, 316, 1000})
      if (side * side <= largest * 1.1) sunder::run(side, jitter);
  }
  if (argc < 2 || has_part) sunder::plot_windows(1000);
}
