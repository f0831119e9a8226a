// SPDX-License-Identifier: GPL-3.0-or-later
// What a facet of the complex has inside the solid: a polygon, maybe with holes, bounded by where
// the surface crosses the facet and by the inner parts of the facet's own edges. All of its corners
// are known by what they are the meeting of, so loops are chained by number.
#include <algorithm>
#include <memory>
#include <mutex>
#include <numeric>
#include <sstream>

#include "fracture/solid_cut.hpp"
#include "fracture/solid_exact.hpp"
#include "meshing/error.hpp"
#include "meshing/parallel.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
using Link = std::array<std::uint32_t, 2>;  // directed, by cut vertex
using Triangle = std::array<std::uint32_t, 3>;

[[noreturn]] void refuse(Vec3 place) {
  std::ostringstream text;
  text << "solid: the surface does not bound a solid near (" << place.x << ", " << place.y << ", "
       << place.z << ") m; valid is a closed surface that faces outwards and does not meet itself";
  throw Error(ErrorCode::geometry, text.str());
}

// Rows of numbers, one after the other.
struct Rows {
  std::vector<std::uint32_t> begin;
  explicit Rows(std::size_t count) : begin(count + 1) {}
  void count(std::uint32_t row) { ++begin[row + 1]; }
  std::vector<std::uint32_t> starts() {
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    return {begin.begin(), begin.end() - 1};
  }
};

struct FacetCutter {
  const TriMesh& mesh;
  std::span<const Vec3> steps;
  const SolidFrame& frame;
  const SolidComplex& complex;
  CutSolid& cut;
  Rows crossing_rows{complex.edges.size()};  // where the surface crosses each edge, in order
  std::vector<std::uint32_t> crossings{};
  std::vector<std::uint32_t> inner{};  // per corner of the complex: cut vertex, kNone outside
  Rows segment_rows{complex.facets.size()};
  std::vector<Link> segments{};  // where the surface crosses each facet, seen as its boundary

  Corners3 corners_of(std::uint32_t triangle) const {
    const auto& t = mesh.triangles[triangle];
    return {steps[t[0]], steps[t[1]], steps[t[2]]};
  }

  // Whether q is farther along the edge than p.
  bool is_before(std::uint32_t e, std::uint32_t p, std::uint32_t q) {
    const auto& edge = complex.edges[e];
    const auto &f = complex.facets[edge.f].plane, &g = complex.facets[edge.g].plane;
    const Corners3 s = corners_of(cut.vertices[p].a), t = corners_of(cut.vertices[q].a);
    const auto x = along_line<Bounded>(s, f, g), y = along_line<Bounded>(t, f, g);
    const Bounded order = y[0] * x[1] - x[0] * y[1];
    int sign = 0;
    if (order.is_certain() && x[1].is_certain() && y[1].is_certain()) {
      sign = (order.value > 0) == ((x[1].value > 0) == (y[1].value > 0)) ? 1 : -1;
    } else {
      ++cut.exact_predicates;
      sign = exact_order(s, t, f, g);
    }
    if (sign == 0) throw ExactContact{cut.vertices[p].a};
    const Vec3 along = cross(f.n, g.n);
    const bool forward = dot(along, complex.vertices[edge.to] - complex.vertices[edge.from]) > 0;
    return (sign > 0) == forward;
  }

  void sort_crossings() {
    for (const auto& v : cut.vertices)
      if (v.kind == CutVertex::Kind::face_edge) crossing_rows.count(v.b);
    auto at = crossing_rows.starts();
    crossings.resize(crossing_rows.begin.back());
    for (std::uint32_t i = 0; i < cut.vertices.size(); ++i)
      if (cut.vertices[i].kind == CutVertex::Kind::face_edge)
        crossings[at[cut.vertices[i].b]++] = i;
    for (std::uint32_t e = 0; e < complex.edges.size(); ++e) {
      const auto row = crossings_of(e);
      if (row.size() > 1)
        std::sort(row.begin(), row.end(),
                  [&](std::uint32_t p, std::uint32_t q) { return p != q && is_before(e, p, q); });
    }
  }

  std::span<std::uint32_t> crossings_of(std::uint32_t e) {
    return std::span(crossings).subspan(crossing_rows.begin[e],
                                        crossing_rows.begin[e + 1] - crossing_rows.begin[e]);
  }

  // Which corners of the complex are inside: along every edge, the surface is crossed that often.
  void find_inner_corners() {
    const auto count = static_cast<std::uint32_t>(complex.vertices.size());
    Rows rows(count);
    for (const auto& edge : complex.edges) rows.count(edge.from), rows.count(edge.to);
    auto at = rows.starts();
    std::vector<std::uint32_t> around(rows.begin.back());
    for (std::uint32_t e = 0; e < complex.edges.size(); ++e)
      around[at[complex.edges[e].from]++] = around[at[complex.edges[e].to]++] = e;
    std::vector<std::uint8_t> state(count, 2);  // 0 outside, 1 inside, 2 not known
    std::vector<std::uint32_t> queue;
    for (std::uint32_t v = 0; v < count; ++v)
      if (complex.is_far[v]) state[v] = 0, queue.push_back(v);
    for (std::size_t i = 0; i < queue.size(); ++i)
      for (std::uint32_t k = rows.begin[queue[i]]; k < rows.begin[queue[i] + 1]; ++k) {
        const auto& edge = complex.edges[around[k]];
        const std::uint32_t other = edge.from ^ edge.to ^ queue[i];
        const auto next =
            static_cast<std::uint8_t>(state[queue[i]] ^ (crossings_of(around[k]).size() & 1));
        if (state[other] == 2) state[other] = next, queue.push_back(other);
        if (state[other] != next) refuse(frame.to_metres(complex.vertices[other]));
      }
    inner.assign(count, kNone);
    for (std::uint32_t v = 0; v < count; ++v) {
      if (state[v] != 1) continue;
      inner[v] = static_cast<std::uint32_t>(cut.vertices.size());
      cut.vertices.push_back({CutVertex::Kind::inner_corner, v, 0});
      cut.places.push_back(frame.to_metres(complex.vertices[v]));
    }
  }

  void find_segments() {
    const auto for_segments = [&](auto visit) {
      for (const auto& polygon : cut.polygons)
        for (std::uint32_t k = polygon.begin; k < polygon.end; ++k) {
          const std::uint32_t f = cut.polygon_lines[k];
          if (f == CutSolid::kOutline || complex.facets[f].a != polygon.cell) continue;
          const std::uint32_t next = k + 1 == polygon.end ? polygon.begin : k + 1;
          visit(f, Link{cut.polygon_vertices[next], cut.polygon_vertices[k]});
        }
    };
    for_segments([&](std::uint32_t f, Link) { segment_rows.count(f); });
    auto at = segment_rows.starts();
    segments.resize(segment_rows.begin.back());
    for_segments([&](std::uint32_t f, Link link) { segments[at[f]++] = link; });
  }

  // The inner parts of a facet's own edge, in the direction of the facet's loop.
  void add_edge(std::uint32_t e, bool forward, std::vector<Link>& links) {
    const auto& edge = complex.edges[e];
    std::uint32_t from = inner[edge.from];
    const auto add = [&](std::uint32_t to) {
      if (from == kNone) {
        from = to;
        return;
      }
      links.push_back(forward ? Link{from, to} : Link{to, from});
      from = kNone;
    };
    for (const std::uint32_t v : crossings_of(e)) add(v);
    if (inner[edge.to] != kNone) add(inner[edge.to]);
    if (from != kNone) refuse(cut.places[from]);
  }

  void add_links(std::uint32_t f, std::vector<Link>& links) {
    links.assign(segments.begin() + segment_rows.begin[f],
                 segments.begin() + segment_rows.begin[f + 1]);
    const auto vertices = complex.vertices_of(f);
    const auto edges = complex.edges_of(f);
    for (std::size_t k = 0; k < vertices.size(); ++k)
      add_edge(edges[k], complex.edges[edges[k]].from == vertices[k], links);
  }
};

// Makes a facet's triangles; one per thread.
struct FacetFiller {
  explicit FacetFiller(FacetCutter& c) : cutter(c) {}
  FacetCutter& cutter;
  std::vector<Link> links;
  IndexLoops loops;  // by number in `used`
  std::vector<std::uint32_t> used;
  std::vector<Vec2> points, ring;
  std::vector<Triangle> triangles, local;
  std::vector<std::uint32_t> counts;

  void chain() {
    loops.clear();
    used.clear();
    std::sort(links.begin(), links.end());
    std::vector<std::uint8_t> done(links.size());
    for (std::size_t start = 0; start < links.size(); ++start) {
      if (done[start]) continue;
      auto& loop = loops.emplace_back();
      for (std::size_t k = start; !done[k];) {
        done[k] = 1;
        loop.push_back(static_cast<std::uint32_t>(used.size()));
        used.push_back(links[k][0]);
        const auto next = std::lower_bound(links.begin(), links.end(), Link{links[k][1], 0});
        if (next == links.end() || (*next)[0] != links[k][1])
          refuse(cutter.cut.places[links[k][1]]);
        k = static_cast<std::size_t>(next - links.begin());
        if (done[k] && k != start) refuse(cutter.cut.places[links[k][0]]);
      }
      if (loop.size() < 3) refuse(cutter.cut.places[links[start][0]]);
    }
  }

  void flatten(Vec3 normal) {
    const Vec3 n = (1 / length(normal)) * normal;
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    const Vec3 axis = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    const Vec3 side = cross(axis, n);
    const Vec3 u = (1 / length(side)) * side, v = cross(n, u);
    const Vec3 o = cutter.cut.places[used[0]];
    points.clear();
    for (const std::uint32_t i : used) {
      const Vec3 d = cutter.cut.places[i] - o;
      points.push_back({dot(d, u), dot(d, v)});
    }
  }

  double area(const std::vector<std::uint32_t>& loop) const {
    double sum = 0;
    for (std::size_t k = 1; k + 1 < loop.size(); ++k)
      sum += cross(points[loop[k]] - points[loop[0]], points[loop[k + 1]] - points[loop[0]]);
    return sum;
  }

  void fill(std::uint32_t f) {
    cutter.add_links(f, links);
    if (links.empty()) return;
    chain();
    flatten(cutter.complex.facets[f].plane.n);
    local.clear();
    if (loops.size() > 1 || !triangulate_convex(points, local)) {
      std::ranges::stable_sort(loops, std::greater{}, [&](const auto& l) { return area(l); });
      local = triangulate(points, loops);
    }
    for (const Triangle& t : local) triangles.push_back({used[t[0]], used[t[1]], used[t[2]]});
  }

  void run(std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const std::size_t before = triangles.size();
      fill(static_cast<std::uint32_t>(f));
      counts.push_back(static_cast<std::uint32_t>(triangles.size() - before));
    }
  }
};

}  // namespace

bool triangulate_convex(std::span<const Vec2> points, std::vector<Triangle>& triangles) {
  constexpr double kStraight = 1e-7;  // sine of a corner's turn
  const auto n = static_cast<std::uint32_t>(points.size());
  if (n == 3) return triangles.push_back({0, 1, 2}), true;
  for (std::uint32_t k = 0; k < n; ++k) {
    const Vec2 a = points[k] - points[(k + n - 1) % n], b = points[(k + 1) % n] - points[k];
    const double turn = cross(a, b);
    if (!(turn > 0 && turn * turn > kStraight * kStraight * dot(a, a) * dot(b, b))) return false;
  }
  std::uint32_t ring[64];
  if (n > 64) return false;
  std::iota(ring, ring + n, 0u);
  for (std::uint32_t left = n; left > 3; --left) {
    double least = 0;
    std::uint32_t best = left;
    for (std::uint32_t k = 0; k < left; ++k) {
      const Vec2 d = points[ring[(k + 1) % left]] - points[ring[(k + left - 1) % left]];
      if (best == left || dot(d, d) < least) least = dot(d, d), best = k;
    }
    triangles.push_back({ring[(best + left - 1) % left], ring[best], ring[(best + 1) % left]});
    std::copy(ring + best + 1, ring + left, ring + best);
  }
  triangles.push_back({ring[0], ring[1], ring[2]});
  return true;
}

void cut_facets(const TriMesh& mesh, std::span<const Vec3> steps, const SolidFrame& frame,
                const SolidComplex& complex, int threads, CutSolid& cut) {
  FacetCutter cutter{mesh, steps, frame, complex, cut};
  cutter.sort_crossings();
  cutter.find_inner_corners();
  cutter.find_segments();
  std::vector<std::pair<std::size_t, std::unique_ptr<FacetFiller>>> parts;
  std::mutex lock;
  for_each_range(complex.facets.size(), threads, [&](std::size_t begin, std::size_t end) {
    auto filler = std::make_unique<FacetFiller>(cutter);
    filler->run(begin, end);
    const std::scoped_lock guard(lock);
    parts.emplace_back(begin, std::move(filler));
  });
  std::ranges::sort(parts, {}, [](const auto& part) { return part.first; });
  cut.facet_triangle_begin.assign(1, 0);
  for (const auto& [begin, part] : parts) {
    for (const std::uint32_t count : part->counts)
      cut.facet_triangle_begin.push_back(cut.facet_triangle_begin.back() + count);
    cut.facet_triangles.insert(cut.facet_triangles.end(), part->triangles.begin(),
                               part->triangles.end());
  }
}

}  // namespace sunder
