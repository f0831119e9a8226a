// SPDX-License-Identifier: GPL-3.0-or-later
// The exact way from a mesh to chunks against the one through a level set: time against error. Both
// end with the same 100 Voronoi cells, bonds and mass properties, on one thread. Prints a table;
// writes the diagram where it is told. Usage: bench_level_set_precision [FILE.svg]
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

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
  double ms = 0;
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
  Point point{name, voxel, 0, 0, 1e300, 0};
  SolidAsset asset;
  for (int run = 0; run < kRuns; ++run) {
    const auto start = std::chrono::steady_clock::now();
    const TriMesh cut = voxel > 0 ? smooth_surface(level_set(given, voxel, 1), 1) : given;
    asset = fracture_solid(model, test::as_surface(cut), 2400, {.seed = 1, .progress = {}});
    const auto time = std::chrono::steady_clock::now() - start;
    point.ms = std::min(point.ms, std::chrono::duration<double, std::milli>(time).count());
  }
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

// --- the diagram -------------------------------------------------------------------------------

constexpr double kTop = 40, kBottom = 340, kPanel = 330;
constexpr int kLowError = -16, kLowMs = 0, kHighMs = 4;  // powers of ten; errors end at 1

template <class... Values>
std::string format(const char* text, Values... values) {
  std::array<char, 400> line{};
  std::snprintf(line.data(), line.size(), text, values...);
  return line.data();
}

double x_of(double left, double error) {
  const double power = std::clamp(std::log10(std::max(error, 1e-300)), double{kLowError}, 0.0);
  return left + kPanel * (power - kLowError) / -kLowError;
}
double y_of(double ms) {
  const double power = std::clamp(std::log10(ms), double{kLowMs}, double{kHighMs});
  return kBottom - (kBottom - kTop) * (power - kLowMs) / (kHighMs - kLowMs);
}

std::string axes(double left, const char* title) {
  const char* line = "<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#ddd'/>\n";
  const char* text = "<text x='%.1f' y='%.1f' text-anchor='%s'>%s</text>\n";
  std::string svg;
  for (int power = kLowError; power <= 0; power += 4) {
    const double x = x_of(left, std::pow(10, power));
    svg += format(line, x, kTop, x, kBottom);
    svg += format("<text x='%.1f' y='%.1f' text-anchor='middle'>1e%d</text>\n", x, kBottom + 18,
                  power);
  }
  for (int power = kLowMs; power <= kHighMs; ++power) {
    const double y = y_of(std::pow(10, power));
    svg += format(line, left, y, left + kPanel, y);
    svg += format(text, left - 8, y + 4, "end", format("%.0f", std::pow(10, power)).c_str());
  }
  return svg + format(text, left + kPanel / 2, kBottom + 42, "middle", title);
}

// A solid's points: those of the level set joined, the exact one hollow.
std::string series(const std::vector<Point>& points, double Point::*error, double left,
                   const char* colour) {
  std::string path, marks;
  for (const Point& p : points) {
    const double x = x_of(left, p.*error), y = y_of(p.ms);
    marks +=
        format("<circle cx='%.1f' cy='%.1f' r='4.5' stroke='%s' stroke-width='2' fill='%s'/>\n", x,
               y, colour, p.voxel > 0 ? colour : "#fff");
    if (p.voxel > 0) path += format("%c%.1f %.1f", path.empty() ? 'M' : 'L', x, y);
  }
  return format("<path d='%s' fill='none' stroke='%s' stroke-width='1.5'/>\n", path.c_str(),
                colour) +
         marks;
}

std::string diagram(const std::vector<std::vector<Point>>& solids) {
  constexpr std::array kColours{"#2471a3", "#27ae60", "#c0392b"};
  const double left = 80, right = left + kPanel + 60, key = right + kPanel + 30;
  std::string svg =
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 1010 400' font-family='DejaVu Sans, "
      "sans-serif' font-size='12' fill='#222'>\n<rect width='100%' height='100%' fill='#fff'/>\n";
  svg += axes(left, "relative error of the volume") + axes(right, "Hausdorff distance, m");
  svg += format(
      "<text transform='translate(22 %.0f) rotate(-90)' text-anchor='middle'>ms, one "
      "thread</text>\n",
      (kTop + kBottom) / 2);
  for (std::size_t i = 0; i < solids.size(); ++i) {
    svg += series(solids[i], &Point::volume, left, kColours[i]);
    svg += series(solids[i], &Point::distance, right, kColours[i]);
    svg += format("<text x='%.0f' y='%.0f' fill='%s'>%s</text>\n", key,
                  kTop + 12 + 22 * static_cast<double>(i), kColours[i], solids[i][0].solid);
  }
  for (const auto& [row, text] : {std::pair{0, "hollow: exact"}, std::pair{1, "full: level set,"},
                                  std::pair{2, "voxels 8 … 1 cm"}})
    svg += format("<text x='%.0f' y='%.0f'>%s</text>\n", key, kTop + 100 + 18.0 * row, text);
  return svg + "</svg>\n";
}

}  // namespace

int main(int count, char** arguments) {
  TriMesh box = box_mesh({0, 0, 0}, {1.01, 0.77, 0.53});
  for (Vec3& p : box.vertices) p = {0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y, p.z};
  const std::pair<const char*, TriMesh> solids[] = {{"sphere", sphere_mesh(0.5, 128)},
                                                    {"torus", torus_mesh(0.5, 0.2, 384, 192)},
                                                    {"turned box", box}};
  std::printf(
      "| solid | way | triangles of chunks | volume error | Hausdorff, m | ms |\n"
      "|---|---|---|---|---|---|\n");
  std::vector<std::vector<Point>> all;
  for (const auto& [name, mesh] : solids) {
    all.emplace_back();
    for (const double voxel : {0.0, 0.08, 0.04, 0.02, 0.01}) {
      const Point p = measured(name, mesh, voxel);
      all.back().push_back(p);
      std::printf("| %s | %s | %zu | %.1e | %.1e | %.1f |\n", name,
                  voxel > 0 ? format("voxels of %g m", voxel).c_str() : "exact", p.triangles,
                  p.volume, p.distance, p.ms);
      std::fflush(stdout);
    }
  }
  if (count < 2) return 0;
  std::FILE* file = std::fopen(arguments[1], "w");
  if (!file) return 1;
  const std::string svg = diagram(all);
  const bool written = std::fwrite(svg.data(), 1, svg.size(), file) == svg.size();
  return std::fclose(file) == 0 && written ? 0 : 1;
}
