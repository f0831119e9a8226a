// SPDX-License-Identifier: GPL-3.0-or-later
// What a surface loses on its way through a level set and back: volume and distance against the
// voxel's size, with the orders they fall by, and the time. Usage: bench_level_set
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "bench/report.hpp"
#include "meshing/level_set.hpp"
#include "meshing/sample_solids.hpp"
#include "meshing/surface_defects.hpp"

namespace {

using namespace sunder;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void measure(const char* name, const TriMesh& given, TriMesh (*surface)(const LevelSet&)) {
  const double volume = mass_properties(given).volume;
  double last_volume = 0, last_distance = 0;
  for (const double voxel : {0.08, 0.04, 0.02, 0.01}) {
    const auto start = std::chrono::steady_clock::now();
    const TriMesh made = surface(level_set(given, voxel));
    const double seconds = seconds_since(start);
    const double volume_error = std::abs(mass_properties(made).volume - volume) / volume;
    const double distance = std::max(farthest(made, TriangleTree(given), voxel / 4),
                                     farthest(given, TriangleTree(made), voxel / 4));
    std::printf("| %s | %g | %zu | %.2e | ", name, voxel, made.triangles.size(), volume_error);
    if (last_volume > 0)
      std::printf("%.2f | %.2e | %.2f", std::log2(last_volume / volume_error), distance,
                  std::log2(last_distance / distance));
    else
      std::printf("| %.2e | ", distance);
    std::printf(" | %.2f | %s | %.2f |\n", distance / voxel,
                diagnose(made, 0).is_solid() ? "yes" : "no", seconds);
    last_volume = volume_error;
    last_distance = distance;
  }
}

}  // namespace

int main() {
  const Block block("level_set orders");
  std::printf(
      "| solid | voxel, m | triangles | volume error | order | Hausdorff, m | order | in voxels | "
      "sound | s |\n|---|---|---|---|---|---|---|---|---|---|\n");
  const TriMesh sphere = sphere_mesh(0.5, 128), torus = torus_mesh(0.5, 0.2, 384, 192);
  TriMesh box = box_mesh({0, 0, 0}, {1.01, 0.77, 0.53});
  for (Vec3& p : box.vertices) p = {0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y, p.z};
  const auto smooth = [](const LevelSet& set) { return smooth_surface(set); };
  measure("sphere", sphere, smooth);
  measure("torus", torus, smooth);
  measure("turned box", box, smooth);
  measure("sphere, tetrahedra", sphere, sound_surface);
  measure("turned box, tetrahedra", box, sound_surface);
}
