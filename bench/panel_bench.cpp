// SPDX-License-Identifier: GPL-3.0-or-later
// Networks of chunks: error against plate theory by number of cells, and time. Run without options.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/report.hpp"
#include "sim/chunk_network.hpp"

namespace {

using namespace sunder;

const Material kConcrete{.name = "concrete",
                         .density = 2400,
                         .youngs_modulus = 33.6e9,
                         .poisson_ratio = 0,
                         .tensile_strength = 2.9e6,
                         .compressive_strength = 38e6,
                         .source = "C30"};
constexpr std::uint64_t kSeeds = 5;

WallAsset panel(Vec2 size, double thickness, double cell, std::vector<std::string> anchors,
                std::uint64_t seed) {
  Wall wall;
  wall.region = {rectangle(size), {}};
  wall.thickness = thickness;
  wall.pattern = VoronoiGridParams{cell, 0.9};
  wall.anchors = std::move(anchors);
  return fracture_wall(wall, 2400, {.seed = seed});
}

PanelHold held(Vec2 size, bool hinged = false) {
  return {{Vec3{0, 0, 0}, {size.x, 0, 0}, {size.x, size.y, 0}, {0, size.y, 0}},
          {hinged, hinged, hinged, hinged}};
}

/// The chunk's motion taken to its site.
Vec3 at_site(const WallAsset& asset, const PanelState& state, const std::vector<Vec2>& sites,
             std::uint32_t chunk) {
  const Six& d = state.displacements[chunk];
  const Vec3 c = asset.chunks[chunk].centroid;
  const Vec3 arm{sites[chunk].x - c.x, sites[chunk].y - c.y, 0};
  return Vec3{d[0], d[1], d[2]} + cross({d[3], d[4], d[5]}, arm);
}

std::uint32_t nearest(const std::vector<Vec2>& sites, Vec2 place) {
  std::uint32_t best = 0;
  for (std::uint32_t c = 1; c < sites.size(); ++c)
    if (length(sites[c] - place) < length(sites[best] - place)) best = c;
  return best;
}

/// Deflection at a place: from the nearest site along its slope.
double deflection(const WallAsset& asset, const PanelState& state, const std::vector<Vec2>& sites,
                  Vec2 place) {
  const std::uint32_t c = nearest(sites, place);
  const Six& d = state.displacements[c];
  const Vec2 arm = place - sites[c];
  return at_site(asset, state, sites, c).z + d[3] * arm.y - d[4] * arm.x;
}

struct Errors {
  double deflection = 0, edge_moment = 0, centre_moment = 0;
};

/// Bending moment per metre of the bonds that a test picks, weighted with their length.
template <class Test>
double bond_moment(const WallAsset& asset, const PanelState& state, Test test) {
  double sum = 0, share = 0;
  for (std::size_t i = 0; i < asset.bonds.size(); ++i) {
    const Bond& bond = asset.bonds[i];
    if (!test(bond)) continue;
    sum += dot(state.bonds[i].moment, cross({0, 0, 1}, bond.normal));
    share += bond.area / asset.wall.thickness;
  }
  return sum / share;
}

/// A square plate under its weight against Timoshenko and Woinowsky-Krieger, with ν = 0. Clamped,
/// table 35: w = 0.00126532 q a⁴/D, edge moment 0.0513 q a²; centre 0.02291/1.3 q a² (Taylor and
/// Govindjee 2004; the table has 0.0231). On hinges, table 8: 0.00406235 q a⁴/D, centre 0.0479/1.3
/// q a². The shear's part, 0.0737 q a²/κG t, is taken off: of the hinged plate exactly (Mindlin),
/// of the clamped one nearly.
Errors plate(bool hinged, double thickness, int cells, std::uint64_t seed) {
  const double a = 6;
  const WallAsset asset =
      panel({a, a}, thickness, a / cells, {"bottom", "right", "top", "left"}, seed);
  ChunkNetwork network(asset, kConcrete, held({a, a}, hinged));
  network.set_gravity({0, 0, -9.81});
  const PanelState state = network.solve({});
  const double q = 2400 * thickness * 9.81, e = kConcrete.youngs_modulus;
  const double shear = 0.0736713 * q * a * a / (5.0 / 12 * e * thickness);
  const double w = -deflection(asset, state, network.sites(), {a / 2, a / 2}) - shear;
  const double d = e * std::pow(thickness, 3) / 12, near = std::max(a / 40, a / cells);
  const double edge = bond_moment(asset, state, [&](const Bond& bond) {
    return bond.b == kWorld && bond.normal.y < -0.5 && std::abs(bond.centroid.x - a / 2) < near;
  });
  const double centre = bond_moment(asset, state, [&](const Bond& bond) {
    return length(bond.centroid - Vec3{a / 2, a / 2, 0}) < near;
  });
  const double unit = q * a * a;
  return {w / ((hinged ? 0.00406235 : 0.00126532) * unit * a * a / d) - 1,
          hinged ? 0 : std::abs(edge) / (0.0513 * unit) - 1,
          std::abs(centre) / ((hinged ? 0.0479 : 0.02291) / 1.3 * unit) - 1};
}
Errors clamped_plate(double thickness, int cells, std::uint64_t seed) {
  return plate(false, thickness, cells, seed);
}
Errors hinged_plate(double thickness, int cells, std::uint64_t seed) {
  return plate(true, thickness, cells, seed);
}

/// Cantilever strip under its weight: w = q L⁴/8D + q L²/2 κG t, M = q L²/2.
Errors cantilever(double thickness, int cells, std::uint64_t seed) {
  const double a = 4, b = 1;
  const WallAsset asset = panel({a, b}, thickness, std::sqrt(a * b) / cells, {"left"}, seed);
  ChunkNetwork network(asset, kConcrete, held({a, b}));
  network.set_gravity({0, 0, -9.81});
  const PanelState state = network.solve({});
  const double q = 2400 * thickness * 9.81, e = kConcrete.youngs_modulus;
  const double w = -deflection(asset, state, network.sites(), {a, b / 2});
  const double exact = q * std::pow(a, 4) / 8 / (e * std::pow(thickness, 3) / 12) +
                       q * a * a / 2 / (5.0 / 12 * e * thickness);
  return {w / exact - 1,
          -network.reaction(state, 3, {0, b / 2, 0}).moment.y / (q * b * a * a / 2) - 1, 0};
}

/// Racking: a square wall, its upper edge moved sideways against the lower. No closed form: against
/// 0.6018 E t u/2, to which it converges (6400 cells: 0.6027).
Errors racking(double thickness, int cells, std::uint64_t seed) {
  const double a = 3, move = 1e-3;
  const WallAsset asset = panel({a, a}, thickness, a / cells, {"bottom", "top"}, seed);
  ChunkNetwork network(asset, kConcrete, held({a, a}));
  PanelFreedoms freedoms{};
  freedoms[12] = freedoms[18] = move;
  const Reaction top = network.reaction(network.solve(freedoms), 2, {});
  return {top.force.x / (0.6018 * kConcrete.youngs_modulus / 2 * move * thickness) - 1, 0, 0};
}

/// Deep beam: a wall clamped at the left that bends in its plane under its weight; Timoshenko's
/// beam, κ = 5/6.
Errors deep_beam(double thickness, int cells, std::uint64_t seed) {
  const double a = 4, b = 1;
  const WallAsset asset = panel({a, b}, thickness, std::sqrt(a * b) / cells, {"left"}, seed);
  ChunkNetwork network(asset, kConcrete, held({a, b}));
  network.set_gravity({0, -9.81, 0});
  const PanelState state = network.solve({});
  const double q = 2400 * thickness * b * 9.81, e = kConcrete.youngs_modulus;
  const std::vector<Vec2> sites = network.sites();
  const std::uint32_t c = nearest(sites, {a, b / 2});
  const double w =
      -(at_site(asset, state, sites, c).y + state.displacements[c][5] * (a - sites[c].x));
  const double exact = q * std::pow(a, 4) / 8 / (e * thickness * b * b * b / 12) +
                       q * a * a / 2 / (5.0 / 12 * e * thickness * b);
  return {w / exact - 1, 0, 0};
}

struct Scatter {
  double mean = 0, worst = 0;
};

/// Of one kind of error over the seeds.
Scatter scatter(Errors (*errors)(double, int, std::uint64_t), double Errors::*kind,
                double thickness, int cells) {
  Scatter found;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const double each = errors(thickness, cells, seed).*kind;
    found.mean += each / kSeeds;
    found.worst = std::max(found.worst, std::abs(each));
  }
  return found;
}

void measure_errors() {
  const struct {
    const char* name;
    Errors (*errors)(double, int, std::uint64_t);
    double Errors::*kind;
  } rows[] = {{"hinged: deflection", hinged_plate, &Errors::deflection},
              {"hinged: moment in the middle", hinged_plate, &Errors::centre_moment},
              {"clamped: deflection", clamped_plate, &Errors::deflection},
              {"clamped: moment in the middle", clamped_plate, &Errors::centre_moment},
              {"clamped: edge moment", clamped_plate, &Errors::edge_moment},
              {"cantilever 4 × 1 m across its plane", cantilever, &Errors::deflection},
              {"the same in its plane (deep beam)", deep_beam, &Errors::deflection},
              {"racking of 3 × 3 m", racking, &Errors::deflection}};
  const Block block("panel errors");
  std::printf("| | 25 cells | 100 | 400 | 1600 |\n|---|---|---|---|---|\n");
  for (const auto& row : rows) {
    std::printf("| %s |", row.name);
    for (const int cells : {5, 10, 20, 40}) {
      const Scatter found = scatter(row.errors, row.kind, 0.2, cells);
      std::printf(" %+.2f (%.2f) %% |", 100 * found.mean, 100 * found.worst);
    }
    std::printf("\n");
  }
}

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Work>
double best_of(int runs, Work work) {
  double best = 1e9;
  for (int i = 0; i < runs; ++i) {
    const double start = seconds();
    work();
    best = std::min(best, seconds() - start);
  }
  return best * 1e3;
}

/// A slab on hinges a tenth above its first crack: all bonds that break, each solved for.
void time_cascade(int cells) {
  const double a = 6;
  const WallAsset asset = panel({a, a}, 0.1, a / cells, {"bottom", "right", "top", "left"}, 1);
  ChunkNetwork still(asset, kConcrete, held({a, a}, true));
  still.set_gravity({0, 0, -1});
  double first = 0;
  for (const BondStress& bond : still.solve({}).bonds) first = std::max(first, bond.utilisation);
  std::size_t broken = 0;
  double best = 1e9;
  for (int run = 0; run < 5; ++run) {
    ChunkNetwork network(asset, kConcrete, held({a, a}, true));
    network.set_gravity({0, 0, -1.1 / first});
    best = std::min(best, best_of(1, [&] { broken = network.cascade({}).size(); }));
  }
  std::printf("| %zu | a cascade of %zu bonds | %.3g |\n", asset.chunks.size(), broken, best);
}

void time(int cells) {
  const double a = 6;
  const WallAsset asset = panel({a, a}, 0.15, a / cells, {"bottom", "right", "top", "left"}, 1);
  const double made = best_of(20, [&] {
    ChunkNetwork network(asset, kConcrete, held({a, a}));
    network.stiffness();
  });
  const double constructed = best_of(20, [&] {
    ChunkNetwork network(asset, kConcrete, held({a, a}));
  });
  ChunkNetwork network(asset, kConcrete, held({a, a}));
  network.set_gravity({0, 0, -9.81});
  double sum = 0;
  const double solved = best_of(50, [&] { sum += network.solve({}).bonds[0].utilisation; });
  const auto count = static_cast<std::uint32_t>(asset.bonds.size());
  std::uint32_t next = 0;
  const double broken = best_of(10, [&] {
    network.break_bonds(std::span(&next, 1));
    next = (next + 7) % count;
  });
  const double condensed = best_of(5, [&] {
    network.break_bonds(std::span(&next, 1));
    next = (next + 7) % count;
    network.stiffness();
  });
  const std::pair<const char*, double> rows[] = {{"build and factor", constructed},
                                                 {"the same with the condensation", made},
                                                 {"solve with all stresses", solved},
                                                 {"break a bond", broken},
                                                 {"break a bond and condense again", condensed}};
  for (const auto& [what, ms] : rows)
    std::printf("| %zu | %s | %.3g |\n", asset.chunks.size(), what, ms + 0 * sum);
}

}  // namespace

int main() {
  measure_errors();
  const Block block("panel times");
  std::printf("| chunks | | ms, least |\n|---|---|---|\n");
  for (const int cells : {5, 10, 20}) time(cells);
  for (const int cells : {10, 20}) time_cascade(cells);
}
