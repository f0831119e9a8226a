// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/local_web.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include "fracture/breaking.hpp"
#include "fracture/crack_web.hpp"
#include "fracture/gather.hpp"
#include "fracture/local_web_detail.hpp"
#include "meshing/error.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = CrackDrawing::kNone;
using Polygon = std::vector<Vec2>;
using Segment = CrackWeb::Segment;
using Kind = CrackGraph::Kind;

// Least distance of vertices, in min_radius: so the same hit is the same on a larger wall.
constexpr double kLeast = 0x1p-10;
// … but at least this part of the wall's size, well above the rounding to float32.
constexpr double kRounding = 0x1p-20;
// Least min_radius, in that part.
constexpr double kLeastRadius = 64;
// In min_radius: an impact nearer to an edge that may get no vertex moves so far inward, or onto
// the edge's end when that is near. Below how near a polygon's edge may come to its impact.
constexpr double kFromEdge = 0.02;
constexpr double kToCorner = 0.1;
// In min_radius: what is left of old cells and not wider than this joins a neighbour.
constexpr double kRestWidth = 0.05;
// In the least width of the innermost cells: the same for damaged cells.
constexpr double kDamagedWidth = 0.1;

template <class Visit>
void for_each_edge(const Pattern& pattern, std::uint32_t cell, Visit visit) {
  const auto visit_loop = [&](LoopRange loop) {
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) visit(k, loop.next(k));
  };
  if (pattern.hole_begin.empty()) {
    visit_loop({pattern.cell_begin[cell], pattern.cell_begin[cell + 1]});
  } else {
    for (const LoopRange loop : loops_of(pattern, cell)) visit_loop(loop);
  }
}

double distance_to(Vec2 p, Vec2 a, Vec2 b) {
  return length(from_segment(p, a, b));
}

double distance_between(Segment s, Segment t) {
  const Vec2 d = s.b - s.a, e = t.b - t.a;
  if (cross(d, t.a - s.a) * cross(d, t.b - s.a) < 0 &&
      cross(e, s.a - t.a) * cross(e, s.b - t.a) < 0)
    return 0;
  return std::min({distance_to(s.a, t.a, t.b), distance_to(s.b, t.a, t.b),
                   distance_to(t.a, s.a, s.b), distance_to(t.b, s.a, s.b)});
}

// Parameters of the part of a → b that is not further than `margin` outside the lines of a convex
// polygon's edges; low >= high: none.
struct Range {
  double low = 0, high = 1;
};
Range part_in_convex(Vec2 a, Vec2 b, const Polygon& polygon, double margin) {
  Range part;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 p = polygon[k], edge = polygon[(k + 1) % polygon.size()] - p;
    const double value = -cross(edge, a - p) - margin * length(edge), slope = -cross(edge, b - a);
    if (slope > 0) part.high = std::min(part.high, -value / slope);
    if (slope < 0) part.low = std::max(part.low, -value / slope);
    if (slope == 0 && value > 0) return {1, 0};
  }
  return part;
}

// The cracks of one hit, metres.
struct LocalCracks {
  Polygon hull;
  std::vector<Segment> outline, inner;  // the hull's edges, cut off far from the wall
  std::vector<Polygon> radials;         // from the hull outward
};

// Drawn as a spiderweb on a plain square that holds all of it, the impact in its middle.
LocalCracks plan_local_cracks(Vec2 impact, const SpiderwebParams& given, double wall_size,
                              std::uint64_t seed) {
  SpiderwebParams params = given;
  params.impacts = {{0, 0}};
  const double reach = std::max(params.max_radius, params.radial > 0 ? params.reach : 0);
  const double half = std::min(1.25 * reach, 4 * wall_size);
  if (!(half > 0 && std::isfinite(half)))
    throw Error(ErrorCode::input, "max_radius and reach must be positive and finite");
  const Vec2 size{2 * half, 2 * half}, origin{-half, -half};
  const Lattice lattice = make_lattice(origin, size);
  const LatticeRegion region = make_lattice_region({rectangle(size, origin), {}}, lattice, "web");
  const double spacing = 0.5 * (params.min_radius + params.max_radius) / lattice.step.x;
  SpiderwebStats stats;
  const CrackWeb web = plan_cracks(region, params, spacing, seed, stats);
  const Vec2 middle = web.zones.front().impact;
  const auto metres = [&](Vec2 p) { return impact + lattice.step.x * (p - middle); };
  LocalCracks cracks;
  for (const Vec2 p : web.hulls.front()) cracks.hull.push_back(metres(p));
  Vec2 end;
  for (std::size_t i = 0; i < web.cracks.size(); ++i) {
    const auto& [a, b] = web.cracks[i];
    if (i < web.radial_begin) {
      (i < web.inner_begin ? cracks.outline : cracks.inner).push_back({metres(a), metres(b)});
      continue;
    }
    if (i == web.radial_begin || !(a == end)) cracks.radials.push_back({metres(a)});
    cracks.radials.back().push_back(metres(b));
    end = b;
  }
  return cracks;
}

class WebMaker {
 public:
  WebMaker(const WallAsset& asset, std::span<const std::uint8_t> intact,
           const SpiderwebParams& params)
      : pattern_(asset.pattern),
        intact_(intact),
        params_(params),
        size_(wall_size(asset)),
        radius_(std::min(params.min_radius, size_ / 4)),
        least_(std::max(kRounding * size_, kLeast * radius_)) {
    if (params.min_radius < kLeastRadius * kRounding * size_) {
      std::ostringstream message;
      message << "min_radius = " << params.min_radius << " m is too small for a wall of " << size_
              << " m; at least " << kLeastRadius * kRounding * size_ << " m";
      throw Error(ErrorCode::geometry, message.str());
    }
  }

  LocalWeb run(std::uint32_t start, Vec2 impact, std::uint64_t seed) {
    cracks_ = plan_local_cracks(place_centre(start, impact), params_, size_, seed);
    find_cells(start);
    for (Polygon& radial : cracks_.radials) follow(radial);
    std::ranges::sort(cells_);
    CrackDrawing drawing(least_);
    draw_old_edges(drawing);
    draw_cracks(drawing);
    auto triangles = triangulate_cracks(drawing.graph());
    if (!triangles) return {};
    mark_damage(*triangles, impact);
    return collect(*triangles);
  }

 private:
  static double wall_size(const WallAsset& asset) {
    const Box box = bounding_box(asset.region.places);
    return std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  }

  Vec2 at(std::uint32_t corner) const { return pattern_.vertices[pattern_.corners[corner]]; }
  bool leads_on(Across across) const { return !across.is_border() && intact_[across.cell()] != 0; }
  // Whether the edge may get no vertex, though no intact cell lies across.
  bool is_fixed(std::uint32_t k, std::uint32_t next) const {
    const Vec2 a = at(k), b = at(next);
    if (!pattern_.across[k].is_border()) return true;
    return !(a.x == b.x && rounded_to_float(a).x == a.x) &&
           !(a.y == b.y && rounded_to_float(a).y == a.y);
  }

  // The cells from `found` on that are joined to it across edges that `meets` says yes to.
  template <class Meets>
  void spread(std::vector<std::uint32_t>& found, Meets meets) const {
    std::set<std::uint32_t> seen(found.begin(), found.end());
    for (std::size_t i = 0; i < found.size(); ++i)
      for_each_edge(pattern_, found[i], [&](std::uint32_t k, std::uint32_t next) {
        const Across across = pattern_.across[k];
        if (!leads_on(across) || seen.contains(across.cell()) || !meets(at(k), at(next))) return;
        seen.insert(across.cell());
        found.push_back(across.cell());
      });
  }

  // The impact, a little aside where no crack could start on an edge that must stay whole.
  Vec2 place_centre(std::uint32_t start, Vec2 impact) const {
    const double aside = kFromEdge * radius_;
    std::vector<std::uint32_t> around{start};
    spread(around, [&](Vec2 a, Vec2 b) { return distance_to(impact, a, b) <= aside; });
    Vec2 corner, away;
    double to_corner = kToCorner * radius_, to_edge = aside;
    bool has_corner = false, has_edge = false;
    for (const std::uint32_t cell : around)
      for_each_edge(pattern_, cell, [&](std::uint32_t k, std::uint32_t next) {
        const Vec2 a = at(k), b = at(next);
        if (leads_on(pattern_.across[k]) || !is_fixed(k, next)) return;
        const double distance = distance_to(impact, a, b);
        if (distance > aside) return;
        for (const Vec2 end : {a, b})
          if (length(impact - end) <= to_corner) {
            has_corner = true;
            corner = end;
            to_corner = length(impact - end);
          }
        if (distance <= to_edge) {
          has_edge = true;
          to_edge = distance;
          away = (1 / length(b - a)) * Vec2{a.y - b.y, b.x - a.x};
        }
      });
    if (has_corner) return corner;
    return has_edge ? impact + (aside - to_edge) * away : impact;
  }

  void find_cells(std::uint32_t start) {
    cells_ = {start};
    spread(cells_, [&](Vec2 a, Vec2 b) {
      const Range part = part_in_convex(a, b, cracks_.hull, 4 * least_);
      return part.low <= part.high;
    });
    member_.insert(cells_.begin(), cells_.end());
  }

  // Adds the cells along a radial crack. It ends where it leaves the intact cells, otherwise at a
  // corner of the cell its tip is in.
  void follow(Polygon& radial) {
    std::vector<std::uint32_t> here;
    for (const std::uint32_t cell : cells_)
      if (contains(pattern_, cell, radial.front())) here.push_back(cell);
    for (std::size_t i = 1; i < radial.size(); ++i) {
      const Segment step{radial[i - 1], radial[i]};
      spread(here, [&](Vec2 a, Vec2 b) { return distance_between(step, {a, b}) <= 4 * least_; });
      for (const std::uint32_t cell : here)
        if (member_.insert(cell).second) cells_.push_back(cell);
      std::erase_if(here, [&](std::uint32_t c) { return !contains(pattern_, c, step.b); });
      if (!here.empty()) continue;
      radial.resize(i + 1);
      return;
    }
    if (here.empty()) return;
    const Vec2 from = radial[radial.size() - 2], tip = radial.back() - from;
    double best = 0.7 * length(tip);  // cosine times length: within 45°
    for_each_edge(pattern_, here.front(), [&](std::uint32_t k, std::uint32_t) {
      const Vec2 d = at(k) - from;
      if (!(dot(d, tip) > best * length(d)) || length(d) < 4 * least_) return;
      best = dot(d, tip) / length(d);
      radial.back() = at(k);
    });
  }

  std::uint32_t local(CrackDrawing& drawing, std::uint32_t vertex) {
    const auto [found, is_new] = local_.try_emplace(vertex, 0);
    if (is_new) {
      found->second = drawing.add_vertex(pattern_.vertices[vertex]);
      source_.push_back(vertex);
    }
    return found->second;
  }

  // The border of all cells, and the edges between them that lie outside the damage; those that
  // run into it wait.
  void draw_old_edges(CrackDrawing& drawing) {
    std::uint32_t count = 0;
    for (const std::uint32_t cell : cells_)
      for_each_edge(pattern_, cell, [&](std::uint32_t k, std::uint32_t next) {
        const Across across = pattern_.across[k];
        if (!across.is_border() && member_.contains(across.cell())) return;
        const Kind kind = is_fixed(k, next) ? Kind::fixed : Kind::border;
        drawing.add_edge({local(drawing, pattern_.corners[k]),
                          local(drawing, pattern_.corners[next]), count++, kind});
      });
    for (const std::uint32_t cell : cells_)
      for_each_edge(pattern_, cell, [&](std::uint32_t k, std::uint32_t next) {
        const Across across = pattern_.across[k];
        if (across.is_border() || across.cell() < cell || !member_.contains(across.cell())) return;
        const std::uint32_t a = pattern_.corners[k], b = pattern_.corners[next];
        const Range part = part_in_convex(at(k), at(next), cracks_.hull, 0);
        if (part.low < part.high) {
          cut_seams_.push_back({a, b, part});
        } else {
          drawing.add_edge({local(drawing, a), local(drawing, b), kNone, Kind::seam});
        }
      });
    for (const auto& seam : cut_seams_) {  // before any new vertex
      if (seam.inside.low > 0) local(drawing, seam.from);
      if (seam.inside.high < 1) local(drawing, seam.to);
    }
  }

  void draw_cracks(CrackDrawing& drawing) {
    for (const auto& [a, b] : cracks_.outline) drawing.draw(a, b, Kind::hull);
    for (const auto& [from, to, inside] : cut_seams_) {
      const Vec2 a = pattern_.vertices[from], b = pattern_.vertices[to];
      const double beyond = 4 * least_ / length(b - a);  // certainly across the hull
      if (inside.low * length(b - a) > least_)
        drawing.draw_towards(local(drawing, from), a + (inside.low + beyond) * (b - a), Kind::seam);
      if ((1 - inside.high) * length(b - a) > least_)
        drawing.draw_towards(local(drawing, to), a + (inside.high - beyond) * (b - a), Kind::seam);
    }
    for (const auto& [a, b] : cracks_.inner) drawing.draw(a, b, Kind::crack);
    for (const Polygon& radial : cracks_.radials) {
      if (drawing.vertex_for(radial.front()) == kNone) continue;
      for (std::size_t i = 1; i < radial.size(); ++i)
        if (!drawing.draw(radial[i - 1], radial[i], Kind::crack)) break;
    }
  }

  // What lies in the hull, and what was hit where the hull had to be led aside.
  void mark_damage(CrackedTriangles& triangles, Vec2 impact) const {
    const auto corners = [&](std::uint32_t t) {
      const auto& [a, b, c] = triangles.triangles[t];
      return Polygon{triangles.vertices[a], triangles.vertices[b], triangles.vertices[c]};
    };
    triangles.is_damaged.assign(triangles.triangles.size(), false);
    for (const auto& part : parts_between_cracks(triangles)) {
      const Polygon largest = corners(part.front());
      if (is_in_convex(cracks_.hull, (1.0 / 3) * (largest[0] + largest[1] + largest[2])) ||
          std::ranges::any_of(part, [&](auto t) { return is_in_convex(corners(t), impact); }))
        for (const std::uint32_t t : part) triangles.is_damaged[t] = true;
    }
  }

  GatherParams gather_params() const {
    const double innermost =
        radius_ / static_cast<double>((params_.rings + 1) * params_.max_points);
    return {.cell_area = std::numeric_limits<double>::infinity(),
            .least_width = std::max(least_, kDamagedWidth * innermost),
            .least_rest_width = std::max(least_, kRestWidth * radius_),
            .least_edge = 0};
  }

  LocalWeb collect(const CrackedTriangles& triangles) const {
    LocalWeb web;
    std::vector<std::uint8_t> is_damaged;
    const Pattern made = gather(triangles, gather_params(), &is_damaged);
    std::map<std::vector<std::uint32_t>, std::uint32_t> old_cells;
    for (const std::uint32_t cell : cells_) old_cells[loop_from_least(cell)] = cell;
    const std::vector<std::uint32_t> number = number_vertices(triangles, made);
    std::set<std::uint32_t> kept;
    std::vector<std::vector<std::uint32_t>> loops;
    for (std::uint32_t c = 0; c < made.cell_count(); ++c) {
      std::vector<std::uint32_t> loop;
      for (std::uint32_t k = made.cell_begin[c]; k < made.cell_begin[c + 1]; ++k)
        loop.push_back(number[made.corners[k]]);
      std::ranges::rotate(loop, std::ranges::min_element(loop));
      const auto old = old_cells.find(loop);
      if (old != old_cells.end() && !is_damaged[c]) {
        kept.insert(old->second);
        continue;
      }
      loops.push_back(std::move(loop));
      web.is_damaged.push_back(is_damaged[c]);
    }
    for (const std::uint32_t cell : cells_)
      if (!kept.contains(cell)) web.removed.push_back(cell);
    add_cells(made, number, std::move(loops), web);
    return web;
  }

  std::vector<std::uint32_t> loop_from_least(std::uint32_t cell) const {
    std::vector<std::uint32_t> loop(pattern_.corners.begin() + pattern_.cell_begin[cell],
                                    pattern_.corners.begin() + pattern_.cell_begin[cell + 1]);
    std::ranges::rotate(loop, std::ranges::min_element(loop));
    return loop;
  }

  // The wall's number of each vertex; a new one gets one past the wall's, in the order of `made`.
  std::vector<std::uint32_t> number_vertices(const CrackedTriangles& triangles,
                                             const Pattern& made) const {
    std::map<std::pair<double, double>, std::uint32_t> old;
    for (std::uint32_t v = 0; v < source_.size(); ++v)
      old[{triangles.vertices[v].x, triangles.vertices[v].y}] = source_[v];
    std::vector<std::uint32_t> number;
    auto next = static_cast<std::uint32_t>(pattern_.vertices.size());
    for (const Vec2 p : made.vertices) {
      const auto found = old.find({p.x, p.y});
      number.push_back(found == old.end() ? next++ : found->second);
    }
    return number;
  }

  void add_cells(const Pattern& made, const std::vector<std::uint32_t>& number,
                 std::vector<std::vector<std::uint32_t>> loops, LocalWeb& web) const {
    const auto first = static_cast<std::uint32_t>(pattern_.vertices.size());
    for (std::uint32_t v = 0; v < made.vertices.size(); ++v)
      if (number[v] >= first) web.new_vertices.push_back(made.vertices[v]);
    for (auto& loop : loops) web.added.push_back({{std::move(loop)}});
  }

  struct CutSeam {
    std::uint32_t from, to;
    Range inside;
  };

  const Pattern& pattern_;
  std::span<const std::uint8_t> intact_;
  const SpiderwebParams& params_;
  double size_, radius_, least_;  // radius_: min_radius, unless the wall is small beside it
  LocalCracks cracks_;
  std::vector<std::uint32_t> cells_;  // that the damage meets
  std::set<std::uint32_t> member_;    // the same
  std::map<std::uint32_t, std::uint32_t> local_;
  std::vector<std::uint32_t> source_;  // of the drawing's first vertices, in the wall
  std::vector<CutSeam> cut_seams_;
};

}  // namespace

LocalWeb local_web(const WallAsset& asset, std::span<const std::uint8_t> intact, Vec2 impact,
                   const SpiderwebParams& params, std::uint64_t seed, std::uint32_t start) {
  const Pattern& pattern = asset.pattern;
  assert(intact.size() == pattern.cell_count());
  const auto is_hit = [&](std::uint32_t c) { return intact[c] && contains(pattern, c, impact); };
  if (start >= pattern.cell_count() || !is_hit(start))
    for (start = 0; start < pattern.cell_count() && !is_hit(start);) ++start;
  if (start == pattern.cell_count()) return {};
  return WebMaker(asset, intact, params).run(start, impact, seed);
}

}  // namespace sunder
