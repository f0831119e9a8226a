// SPDX-License-Identifier: GPL-3.0-or-later
// The same solids and sites into Voronoi cells by sunder and, where it is installed, by Blender's
// add-on Cell Fracture: time against error of the volume, and how many chunks are not closed. One
// thread. Usage: bench_solid_peers [s: Blender gets no more sites than took it this long]
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bench/report.hpp"
#include "bench/work_precision.hpp"
#include "fracture/solid_asset.hpp"
#include "meshing/random.hpp"
#include "tests/fracture/solid_shapes.hpp"

namespace {

using namespace sunder;
namespace fs = std::filesystem;

struct Case {
  std::string name;
  TriMesh mesh;
  double volume = 0;  // of the mesh, m³
  std::vector<Vec3> sites;
};

struct Result {
  std::string program, way;
  std::vector<double> seconds;  // of the processor, one per run
  std::size_t chunks = 0, triangles = 0, unclosed = 0, unclosed_when_welded = 0;
  double volume = 0;  // m³
};

/// Sites drawn evenly in a box, those inside a sphere where there is one.
std::vector<Vec3> sites_in(Vec3 low, Vec3 size, double radius, std::size_t count) {
  std::vector<Vec3> sites;
  for (std::uint64_t i = 0; sites.size() < count; ++i) {
    const Vec3 p{low.x + random_unit(7, i, 0) * size.x, low.y + random_unit(7, i, 1) * size.y,
                 low.z + random_unit(7, i, 2) * size.z};
    if (radius <= 0 || length(p) < 0.99 * radius) sites.push_back(p);
  }
  return sites;
}

Case wall(std::size_t count) {
  const Vec3 low{0, 0, -0.1}, size{6, 3, 0.2};
  return {"wall 6 × 3 × 0.2 m", test::box(low, size), 3.6, sites_in(low, size, 0, count)};
}

Case sphere(std::size_t count) {
  Case c{"sphere of radius 1 m", test::sphere({0, 0, 0}, 1, 32), 0, {}};
  c.volume = mass_properties(c.mesh).volume;
  c.sites = sites_in({-1, -1, -1}, {2, 2, 2}, 1, count);
  return c;
}

/// Chunks with an edge that has not just two triangles.
std::size_t unclosed_chunks(const SolidPartition& p) {
  std::size_t count = 0;
  for (std::uint32_t c = 0; c < p.chunk_count(); ++c) {
    TriMesh mesh{p.vertices, {}};
    for (std::uint32_t t = p.chunk_begin[c]; t < p.chunk_begin[c + 1]; ++t)
      mesh.triangles.push_back(p.triangles[t].corners);
    const MeshDefects defects = check(mesh);
    count += defects.open_edges + defects.nonmanifold_edges > 0;
  }
  return count;
}

Result by_sunder(const Case& c) {
  constexpr int kRuns = 3;
  SolidModel model;
  model.pattern = SolidVoronoiParams{.count = 0, .points = {}, .sites = c.sites};
  Result result{"sunder", "", {}};
  SolidAsset asset;
  for (int run = 0; run < kRuns; ++run) {
    const std::clock_t start = std::clock();
    asset = fracture_solid(model, test::as_surface(c.mesh), 2400, {.seed = 1, .progress = {}});
    result.seconds.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  result.chunks = asset.partition.chunk_count();
  result.triangles = asset.partition.triangles.size();
  for (const auto& chunk : asset.chunks) result.volume += chunk.volume;
  result.unclosed = result.unclosed_when_welded = unclosed_chunks(asset.partition);
  return result;
}

void write_case(const Case& c, const fs::path& file) {
  std::ofstream out(file);
  out.precision(17);
  out << c.mesh.vertices.size() << ' ' << c.mesh.triangles.size() << ' ' << c.sites.size() << '\n';
  for (const Vec3& p : c.mesh.vertices) out << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const auto& t : c.mesh.triangles) out << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  for (const Vec3& p : c.sites) out << p.x << ' ' << p.y << ' ' << p.z << '\n';
}

/// What a command prints; exits where it cannot be run.
std::string printed_by(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) std::abort();
  std::string all;
  for (char line[512]; std::fgets(line, sizeof line, pipe) != nullptr;) all += line;
  pclose(pipe);
  return all;
}

/// "Blender 3.4.1"; empty: it is not installed.
std::string blender_version() {
  const std::string all = printed_by("blender --version 2>/dev/null");
  return all.substr(0, all.find('\n'));
}

Result by_blender(const Case& c, const char* way, int runs) {
  const fs::path file = fs::temp_directory_path() / text("sunder-cells-%d.txt", getpid());
  write_case(c, file);
  Result result{"Cell Fracture", way, {}};
  for (int run = 0; run < runs; ++run) {
    const std::string all = printed_by(
        "blender -b --factory-startup --python-exit-code 1 --python '" SUNDER_CELLS "' -- '" +
        file.string() + "' " + way + " 2>&1");
    const std::size_t at = all.find("CELLS ");
    double seconds = 0;
    if (at == std::string::npos ||
        std::sscanf(all.c_str() + at, "CELLS %lf %zu %zu %lf %zu %zu", &seconds, &result.chunks,
                    &result.triangles, &result.volume, &result.unclosed,
                    &result.unclosed_when_welded) != 6) {
      std::fprintf(stderr, "%s\n", all.c_str());
      std::exit(1);
    }
    result.seconds.push_back(seconds);
  }
  fs::remove(file);
  return result;
}

void print_row(const Case& c, const Result& r, WorkPlot& plot) {
  std::vector<double> ms;
  for (const double s : r.seconds) ms.push_back(1e3 * s);
  const Spread time = spread_of(ms);
  const double error = std::abs(r.volume - c.volume) / c.volume;
  const std::string name = r.program + (r.way.empty() ? "" : ", " + r.way);
  std::printf("| %s | %zu | %s | %zu | %zu | %.4g | %.1e | %zu | %zu |\n", c.name.c_str(),
              c.sites.size(), name.c_str(), r.chunks, r.triangles, time.median, error, r.unclosed,
              r.unclosed_when_welded);
  std::fflush(stdout);
  plot.points.push_back(
      {.method = c.name.substr(0, c.name.find(' ')) + ", " + name,
       .knobs = text("%zu sites", c.sites.size()) + (r.way.empty() ? "" : ", " + r.way),
       .label = text("%zu", c.sites.size()),
       .error = error,
       .time = time});
}

const char* const kNone =
    "Blender's Cell Fracture: `blender` is not installed where this ran; NVIDIA Blast and Houdini, "
    "which no package brings.";
const char* const kSome =
    "NVIDIA Blast and Houdini, which no package brings (Blast's own times are quoted in "
    "[solids.md](solids.md#measured)); Cell Fracture with more sites than took it two seconds "
    "(`./dev bench solid_peers 60`: more).";

}  // namespace

int main(int argc, char** argv) {
  const double limit = argc > 1 ? std::strtod(argv[1], nullptr) : 2;
  const std::string blender = blender_version();
  WorkPlot plot{.block = "solid_peers volume",
                .title = "Voronoi cells of a solid, the same sites",
                .error_axis = "relative error of the chunks' volume",
                .time_axis = "processor ms, one thread",
                .omissions = blender.empty() ? kNone : kSome,
                .points = {}};
  {
    const Block block("solid_peers cells");
    std::printf("%s\n\n", blender.empty() ? "Blender is not installed: sunder alone."
                                          : (blender + ", Cell Fracture.").c_str());
    std::printf(
        "| solid | sites | program | chunks | triangles | ms | volume error | unclosed chunks | "
        "after welding |\n|---|---|---|---|---|---|---|---|---|\n");
    for (const auto& make : {wall, sphere}) {
      double last = 0;
      for (const std::size_t count : {100u, 300u, 1000u, 3000u}) {
        const Case c = make(count);
        print_row(c, by_sunder(c), plot);
        if (blender.empty() || last > limit) continue;
        for (const char* way : {"default", "tight"}) {
          const Result r = by_blender(c, way, count == 100 ? 3 : 1);
          print_row(c, r, plot);
          last = r.seconds.back();
        }
      }
    }
  }
  publish(plot);
}
