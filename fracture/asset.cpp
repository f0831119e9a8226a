// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/asset.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fracture/cut.hpp"
#include "fracture/quad_grid.hpp"
#include "fracture/sites.hpp"
#include "fracture/slivers.hpp"
#include "fracture/tidy.hpp"
#include "fracture/voronoi.hpp"
#include "meshing/parallel.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

// Default limit for slivers as a part of the generator's typical cell size.
constexpr double kSliverSize = 0.05;
// What is nearer than this part of the wall's size in cut or cracked cells is joined: float32 files
// cannot tell on which side of an edge such a vertex lies.
constexpr double kNearest = 0x1p-20;

std::uint64_t wall_seed(std::uint64_t seed, const std::string& name) {
  std::uint64_t hash = 0xCBF29CE484222325u;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return random_bits(seed, hash);
}

ExactCell exact_voronoi_cell(const Sites& sites, const Pattern& pattern, std::uint32_t cell) {
  const auto at = [&](std::uint32_t s) {
    return LatticePoint{sites.points[s].x, sites.points[s].y};
  };
  ExactCell result{at(cell), {}, {}};
  const LatticePoint p = result.base;
  const LatticeLine box[4] = {{0, -1, 2 * p.y},
                              {1, 0, 2 * (sites.lattice.width - p.x)},
                              {0, 1, 2 * (sites.lattice.height - p.y)},
                              {-1, 0, 2 * p.x}};
  for (std::uint32_t k = pattern.cell_begin[cell]; k < pattern.cell_begin[cell + 1]; ++k) {
    const Across a = pattern.across[k];
    result.lines.push_back(a.is_border() ? box[a.border()] : bisector(at(a.cell()) - p));
  }
  for (std::size_t k = 0; k < result.lines.size(); ++k)
    result.vertices.push_back(
        intersection(result.lines[k == 0 ? result.lines.size() - 1 : k - 1], result.lines[k]));
  return result;
}

ExactCell exact_quad_cell(const QuadGrid& quads, std::uint32_t cell) {
  const Pattern& pattern = quads.pattern;
  const std::uint32_t begin = pattern.cell_begin[cell], end = pattern.cell_begin[cell + 1];
  const auto at = [&](std::uint32_t k) { return quads.points[pattern.corners[k]]; };
  ExactCell result{at(begin), {}, {}};
  for (std::uint32_t k = begin; k < end; ++k) {
    const LatticePoint from = at(k) - result.base;
    result.lines.push_back(line_through(from, at(k + 1 == end ? begin : k + 1) - result.base));
    result.vertices.push_back(crossing_at(from));
  }
  return result;
}

// One generator's work on one wall.
class PatternMaker {
 public:
  PatternMaker(const Wall& wall, const FractureParams& params, FractureStats& stats)
      : wall_(wall),
        params_(params),
        stats_(stats),
        seed_(wall_seed(params.seed, wall.name)),
        box_(bounding_box(wall.region.outline)) {}

  WallPattern operator()(const VoronoiGridParams& p) {
    const GridShape grid = make_grid(box_.low, size(), p.cell);
    return voronoi_of(jittered_sites(grid, p.jitter, seed_));
  }
  WallPattern operator()(const VoronoiSitesParams& p) {
    return voronoi_of(given_sites(make_lattice(box_.low, size()), p.sites));
  }
  WallPattern operator()(const VoronoiRandomParams& p) {
    return voronoi_of(
        random_sites(make_lattice(box_.low, size()), static_cast<std::uint32_t>(p.count), seed_));
  }
  WallPattern operator()(const VoronoiFocusParams& p) {
    return voronoi_of(focused_sites(make_lattice(box_.low, size()), p.points,
                                    {static_cast<std::uint32_t>(p.count), p.radius, p.share},
                                    seed_));
  }
  WallPattern operator()(const QuadGridParams& p) {
    const GridShape grid = make_grid(box_.low, size(), p.cell);
    QuadGrid quads = quad_grid(jittered_points(grid, p.jitter, seed_));
    stats_.quads_split = quads.quads_split;
    const auto cell = [&](std::uint32_t c) { return exact_quad_cell(quads, c); };
    return fit(quads.pattern, {cell, quads.points[quads.pattern.corners[0]]}, grid.lattice);
  }
  WallPattern operator()(const SpiderwebParams& p) {
    LatticeRegion region = region_on(make_lattice(box_.low, size()));
    Pattern pattern = spiderweb(region, p, seed_);
    return {std::move(region), std::move(pattern)};
  }

 private:
  Vec2 size() const { return box_.high - box_.low; }

  LatticeRegion region_on(const Lattice& lattice) const {
    return make_lattice_region(wall_.region, lattice, "wall " + wall_.name);
  }

  WallPattern voronoi_of(const Sites& sites) {
    VoronoiStats voronoi_stats;
    Pattern pattern = voronoi(sites, {.threads = params_.threads}, &voronoi_stats);
    stats_.cells_exact = voronoi_stats.exact;
    stats_.cells_certified = voronoi_stats.proposed;
    stats_.sites_repeated = sites.duplicates_dropped;
    const auto cell = [&](std::uint32_t c) { return exact_voronoi_cell(sites, pattern, c); };
    return fit(pattern, {cell, {sites.points[0].x, sites.points[0].y}}, sites.lattice);
  }

  WallPattern fit(Pattern& pattern, const ExactCells& exact, const Lattice& lattice) {
    LatticeRegion region = region_on(lattice);
    if (region.is_box()) return {std::move(region), std::move(pattern)};
    CutStats cut_stats;
    Pattern result = cut(pattern, exact, region, &cut_stats);
    stats_.cells_cut = cut_stats.cells_cut;
    stats_.cells_outside = cut_stats.cells_outside;
    return {std::move(region), std::move(result)};
  }

  const Wall& wall_;
  const FractureParams& params_;
  FractureStats& stats_;
  std::uint64_t seed_;
  Box box_;
};

double typical_cell(const Wall& wall) {
  const auto per_count = [&](double count) { return std::sqrt(area(wall.region) / count); };
  struct {
    decltype(per_count)& spread;
    double operator()(const VoronoiGridParams& p) const { return p.cell; }
    double operator()(const QuadGridParams& p) const { return p.cell; }
    double operator()(const VoronoiSitesParams& p) const {
      return spread(static_cast<double>(p.sites.size()));
    }
    double operator()(const VoronoiRandomParams& p) const {
      return spread(static_cast<double>(p.count));
    }
    // Small cells near the focus and in the web's centre are wanted.
    double operator()(const VoronoiFocusParams& p) const {
      return 0.2 * spread(static_cast<double>(p.count));
    }
    double operator()(const SpiderwebParams& p) const {
      return std::min(p.rest_cell, 0.4 * p.min_radius);
    }
  } size{per_count};
  return std::visit(size, wall.pattern);
}

// Extrusion of a polygon: moments of area times thickness, about the first corner and then moved.
MassProperties prism_properties(const Pattern& pattern, std::uint32_t cell, double thickness) {
  const Vec2 base = pattern.vertices[pattern.corners[pattern.cell_begin[cell]]];
  double area = 0, xx = 0, yy = 0, xy = 0;
  Vec2 first;
  const auto add_loop = [&](LoopRange loop) {
    Vec2 p = pattern.vertices[pattern.corners[loop.end - 1]] - base;
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      const Vec2 q = pattern.vertices[pattern.corners[k]] - base;
      const double twice = cross(p, q);
      const Vec2 sum = p + q;
      area += twice;
      first = first + twice * sum;
      xx += twice * (p.x * p.x + p.x * q.x + q.x * q.x);
      yy += twice * (p.y * p.y + p.y * q.y + q.y * q.y);
      xy += twice * (p.x * (2 * p.y + q.y) + q.x * (p.y + 2 * q.y));
      p = q;
    }
  };
  if (pattern.hole_begin.empty()) {
    add_loop({pattern.cell_begin[cell], pattern.cell_begin[cell + 1]});
  } else {
    for (const LoopRange loop : loops_of(pattern, cell)) add_loop(loop);
  }
  area /= 2;
  const Vec2 c = (1 / (6 * area)) * first;
  xx = thickness * (xx / 12 - area * c.x * c.x);
  yy = thickness * (yy / 12 - area * c.y * c.y);
  xy = thickness * (xy / 24 - area * c.x * c.y);
  const double zz = area * thickness * thickness * thickness / 12;
  return {
      area * thickness, {base.x + c.x, base.y + c.y, 0}, {yy + zz, xx + zz, xx + yy, -xy, 0, 0}};
}

std::vector<std::uint8_t> anchored_edges(const Wall& wall, const LatticeRegion& region) {
  std::vector<std::uint8_t> anchored(region.edge_count(), 0);
  const std::int64_t right = region.lattice.width, top = region.lattice.height;
  for (std::uint32_t f = 0; f < region.loop_begin[1]; ++f) {
    const LatticePoint a = region.corners[f], b = region.corners[region.next(f)];
    for (const std::string& side : wall.anchors)
      anchored[f] |= (side == "bottom" && a.y == 0 && b.y == 0) ||
                     (side == "top" && a.y == top && b.y == top) ||
                     (side == "left" && a.x == 0 && b.x == 0) ||
                     (side == "right" && a.x == right && b.x == right);
  }
  return anchored;
}

}  // namespace

std::string WallAsset::chunk_name(std::uint32_t chunk) const {
  const std::size_t digits =
      std::max<std::size_t>(4, std::to_string(std::max(1u, pattern.cell_count()) - 1).size());
  std::string number = std::to_string(chunk);
  number.insert(0, digits - std::min(digits, number.size()), '0');
  return wall.name + "_chunk_" + number;
}

WallPattern make_pattern(const Wall& given, const FractureParams& params, FractureStats* stats) {
  const Wall wall = with_local_origin(given);
  FractureStats own;
  FractureStats& s = stats ? *stats : own;
  WallPattern result = std::visit(PatternMaker(wall, params, s), wall.pattern);
  const double cell = typical_cell(wall);
  const Vec2 size = bounding_box(wall.region.outline).high;
  const bool plain = result.pattern.all_convex;  // neither cut nor cracked: no edge is too short
  if (!plain)
    result.pattern = join_near_vertices(std::move(result.pattern),
                                        std::min(kNearest * std::max(size.x, size.y), 1e-3 * cell));
  const double least = wall.min_cell >= 0 ? wall.min_cell : kSliverSize * cell;
  result.pattern = merge_slivers(std::move(result.pattern), least * least, &s.slivers_merged);
  if (!plain || s.slivers_merged > 0) result.pattern = split_pinches(std::move(result.pattern));
  return result;
}

WallAsset fracture_wall(const Wall& given, double density, const FractureParams& params) {
  const Wall wall = with_local_origin(given);
  const auto report = [&](double done) {
    if (params.progress) params.progress(done);
  };
  WallAsset asset{wall, density, {}, {}, {}, {}, 0, {}};
  report(0);
  WallPattern made = make_pattern(wall, params, &asset.stats);
  asset.region = std::move(made.region);
  asset.pattern = std::move(made.pattern);
  report(0.6);
  asset.chunks.resize(asset.pattern.cell_count());
  for_each_range(asset.chunks.size(), params.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      asset.chunks[c] =
          prism_properties(asset.pattern, static_cast<std::uint32_t>(c), wall.thickness);
  });
  report(0.8);
  asset.bonds = find_bonds(asset.pattern, wall.thickness, anchored_edges(wall, asset.region));
  asset.volume_expected = area(asset.region) * wall.thickness;
  report(1);
  return asset;
}

}  // namespace sunder
