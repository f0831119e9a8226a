// SPDX-License-Identifier: GPL-3.0-or-later
// The exact way from a mesh to chunks against the one through a level set: time against error. Both
// end with the same 100 Voronoi cells, bonds and mass properties, on one thread. Usage:
// bench_level_set_precision
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "bench/report.hpp"
#include "bench/work_precision.hpp"
#include "fracture/solid_asset.hpp"
#include "meshing/level_set.hpp"
#include "tests/fracture/solid_shapes.hpp"
#include "tests/meshing/sample_solids.hpp"

namespace {

using namespace sunder;

struct Point {
  const char* solid = "";
  double voxel = 0;     // m; 0: the exact way
  double volume = 0;    // relative error
  double distance = 0;  // Hausdorff, m
  Spread ms;
  std::size_t triangles = 0;  // of all chunks
};

TriMesh outer_faces(const SolidPartition& partition) {
  TriMesh mesh{partition.vertices, {}};
  for (const auto& t : partition.triangles)
    if (!t.is_inner()) mesh.triangles.push_back(t.corners);
  return mesh;
}

Point measured(const char* name, const TriMesh& given, double voxel) {
  constexpr int kRuns = 3;
  SolidModel model;
  model.pattern = SolidVoronoiParams{.count = 100, .points = {}, .sites = {}};
  Point point{name, voxel, 0, 0, {}, 0};
  std::vector<double> times;
  SolidAsset asset;
  for (int run = 0; run < kRuns; ++run) {
    const std::clock_t start = std::clock();
    const TriMesh cut = voxel > 0 ? smooth_surface(level_set(given, voxel, 1), 1) : given;
    asset = fracture_solid(model, test::as_surface(cut), 2400, {.seed = 1, .progress = {}});
    times.push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  point.ms = spread_of(times);
  const double volume = mass_properties(given).volume;
  double sum = 0;
  for (const auto& chunk : asset.chunks) sum += chunk.volume;
  point.volume = std::abs(sum - volume) / volume;
  const TriMesh outer = outer_faces(asset.partition);
  const double spacing = voxel > 0 ? voxel / 4 : 0.005;
  point.distance = std::max(farthest(outer, TriangleTree(given), spacing),
                            farthest(given, TriangleTree(outer), spacing));
  point.triangles = asset.partition.triangles.size();
  return point;
}

WorkPlot plot_of(const std::vector<Point>& points, double Point::*error, const char* block,
                 const char* axis) {
  WorkPlot plot{.block = block,
                .title = "100 Voronoi cells of a mesh: cut exactly, or after a level set",
                .error_axis = axis,
                .time_axis = "processor ms, one thread",
                .least_error = 1e-17,
                .omissions =
                    "Houdini and NVIDIA Blast, which are not here (Blast's times are quoted in "
                    "[solids.md](solids.md#measured)); Blender's Cell Fracture, which "
                    "[performance.md](performance.md#solids) has; adaptive level sets; meshes that are no solids, which only a level set can repair.",
                .points = {}};
  for (const Point& p : points)
    plot.points.push_back(
        {.method = std::string(p.solid) + (p.voxel > 0 ? ", level set" : ", exact"),
         .knobs = p.voxel > 0 ? text("voxels of %g m", p.voxel) : "exact",
         .label = p.voxel > 0 ? text("%g cm", 100 * p.voxel) : "exact",
         .error = p.*error,
         .time = p.ms});
  return plot;
}

}  // namespace

int main() {
  TriMesh box = box_mesh({0, 0, 0}, {1.01, 0.77, 0.53});
  for (Vec3& p : box.vertices) p = {0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y, p.z};
  const std::pair<const char*, TriMesh> solids[] = {{"sphere", sphere_mesh(0.5, 128)},
                                                    {"torus", torus_mesh(0.5, 0.2, 384, 192)},
                                                    {"turned box", box}};
  std::vector<Point> all;
  {
    const Block block("level_set_precision table");
    std::printf(
        "| solid | way | triangles of chunks | volume error | Hausdorff, m | ms |\n"
        "|---|---|---|---|---|---|\n");
    for (const auto& [name, mesh] : solids)
      for (const double voxel : {0.0, 0.08, 0.04, 0.02, 0.01}) {
        const Point& p = all.emplace_back(measured(name, mesh, voxel));
        std::printf("| %s | %s | %zu | %.1e | %.1e | %.1f |\n", name,
                    voxel > 0 ? text("voxels of %g m", voxel).c_str() : "exact", p.triangles,
                    p.volume, p.distance, p.ms.median);
        std::fflush(stdout);
      }
  }
  publish(
      plot_of(all, &Point::volume, "level_set_precision volume", "relative error of the volume"));
  publish(plot_of(all, &Point::distance, "level_set_precision distance", "Hausdorff distance, m"));
}
