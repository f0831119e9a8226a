// SPDX-License-Identifier: GPL-3.0-or-later
// The restricted diagram: every triangle of the surface clipped by the cells it meets, going from
// cell to cell through the facets that cut it (after Yan, Lévy et al. 2009). Lines of a triangle's
// plane are vectors of their values at its corners, so that a corner of a polygon is a cross
// product and its side of a plane a determinant; floating point decides where its error allows.
#include "fracture/solid_cut.hpp"

#include <algorithm>
#include <bit>
#include <memory>
#include <mutex>
#include <sstream>

#include "fracture/solid_exact.hpp"
#include "meshing/error.hpp"
#include "meshing/parallel.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
using Homogeneous = std::array<Bounded, 3>;

[[noreturn]] void refuse(Vec3 place, const char* what) {
  std::ostringstream text;
  text << "solid: the surface " << what << " near (" << place.x << ", " << place.y << ", "
       << place.z << ") m; valid is a closed surface that does not meet itself";
  throw Error(ErrorCode::geometry, text.str());
}

// Undirected edges of a closed mesh: per triangle that opposite each corner.
struct MeshEdges {
  std::vector<std::array<std::uint32_t, 2>> ends;  // smaller first
  std::vector<std::array<std::uint32_t, 3>> of_triangle;

  explicit MeshEdges(const TriMesh& mesh) : of_triangle(mesh.triangles.size()) {
    struct Side {
      std::uint32_t high, half;
      bool forward;
    };
    std::vector<std::uint32_t> begin(mesh.vertices.size() + 1);
    const auto sides = [&](auto visit) {
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k)
          visit(mesh.triangles[t][(k + 1) % 3], mesh.triangles[t][(k + 2) % 3], 3 * t + k);
    };
    sides([&](std::uint32_t u, std::uint32_t v, std::uint32_t) { ++begin[std::min(u, v) + 1]; });
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) begin[v + 1] += begin[v];
    std::vector<std::uint32_t> at(begin.begin(), begin.end() - 1);
    std::vector<Side> row(3 * mesh.triangles.size());
    sides([&](std::uint32_t u, std::uint32_t v, std::uint32_t half) {
      row[at[std::min(u, v)]++] = {std::max(u, v), half, u < v};
    });
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      std::sort(row.begin() + begin[v], row.begin() + begin[v + 1],
                [](const Side& p, const Side& q) {
                  return std::tie(p.high, p.half) < std::tie(q.high, q.half);
                });
      for (std::uint32_t k = begin[v]; k < begin[v + 1]; k += 2) {
        const bool paired = k + 1 < begin[v + 1] && row[k].high == row[k + 1].high &&
                            row[k].forward != row[k + 1].forward &&
                            (k + 2 == begin[v + 1] || row[k + 2].high != row[k].high);
        if (!paired) refuse(mesh.vertices[v], "has an edge without exactly two triangles");
        for (const Side& side : {row[k], row[k + 1]})
          of_triangle[side.half / 3][side.half % 3] = static_cast<std::uint32_t>(ends.size());
        ends.push_back({v, row[k].high});
      }
    }
  }
};

struct ClipLine {
  TriangleLine line;
  std::uint32_t facet = kNone;
  Homogeneous values;
  double nearest = 0;  // value that is near_ away from a plane
};
struct ClipCorner {
  std::uint32_t line = 0;  // that starts here
  Homogeneous place;       // where it meets the one before
};

// Clips triangles; one per thread.
struct Clipper {
  const TriMesh& mesh;
  std::span<const Vec3> steps;
  const SolidComplex& complex;
  const MeshEdges& edges;
  double near;                      // steps from a plane that count as on it
  std::vector<std::uint32_t> seen;  // per cell: triangle + 1 that met it last
  std::vector<std::uint32_t> queue;
  std::vector<ClipLine> lines;
  std::vector<ClipCorner> corners, kept;
  std::vector<int> signs;
  std::uint32_t triangle = 0, cell = 0;
  Corners3 at;
  std::vector<CutSolid::Polygon> polygons;
  std::vector<CutVertex> symbols;
  std::vector<Vec2> shares;  // where symbols are, along the triangle's two first edges
  std::vector<std::uint32_t> sides;
  std::uint64_t exact_predicates = 0;

  Clipper(const TriMesh& m, std::span<const Vec3> s, const SolidComplex& c, const MeshEdges& e,
          double n)
      : mesh(m), steps(s), complex(c), edges(e), near(n), seen(c.cell_count) {}

  int side(const ClipCorner& corner, const TriangleLine& before, const ClipLine& line) {
    const Bounded value = value_at(corner.place, line.values);
    const double weight = corner.place[0].value + corner.place[1].value + corner.place[2].value;
    if (std::abs(value.value) < line.nearest * weight) throw ExactContact{triangle};
    if (value.is_certain()) return value.value > 0 ? 1 : -1;
    ++exact_predicates;
    const int sign = exact_side(at, before, lines[corner.line].line, line.line);
    if (sign == 0) throw ExactContact{triangle};
    return sign;
  }

  // Sign of the plane's value at a point that is given, not computed.
  int plane_side(const SolidComplex::Plane& plane, Vec3 x) {
    const Bounded value = plane_value<Bounded>(plane, x);
    if (value.is_certain()) return value.value > 0 ? 1 : -1;
    ++exact_predicates;
    const Corners3 point{x, x, x};
    const int sign = exact_side(point, {1}, {2}, {-1, &plane, 1});
    if (sign == 0) throw ExactContact{triangle};
    return sign;
  }

  // The cell of a point: across facets that it is beyond, each nearer to it.
  std::uint32_t locate(Vec3 x, std::uint32_t start) {
    for (std::uint32_t c = start, steps_taken = 0; steps_taken <= complex.cell_count;
         ++steps_taken) {
      double most = 0;
      std::uint32_t through = kNone;
      for (const std::uint32_t f : complex.facets_of(c)) {
        const auto& facet = complex.facets[f];
        if (plane_side(facet.plane, x) != (facet.a == c ? 1 : -1)) continue;
        const double beyond = std::abs(plane_value<double>(facet.plane, x));
        if (through == kNone || beyond > most) most = beyond, through = f;
      }
      if (through == kNone) return c;
      c = complex.across(through, c);
    }
    refuse(mesh.vertices[mesh.triangles[triangle][0]], "is in no cell of the pattern");
  }

  void start_polygon() {
    lines.clear();
    corners.clear();
    for (int k = 0; k < 3; ++k) lines.push_back({{k}, kNone, line_values<Bounded>(at, {k}), 0});
    // Corner 0 lies between the edges opposite 1 and 2.
    for (const std::uint32_t k : {2u, 0u, 1u})
      corners.push_back({k, meeting(lines[(k + 2) % 3].values, lines[k].values)});
  }

  // False when nothing of the triangle is inside.
  bool clip(std::uint32_t f) {
    const auto& facet = complex.facets[f];
    ClipLine cutter{{-1, &facet.plane, facet.a == cell ? -1.0 : 1.0}, f, {}, 0};
    cutter.values = line_values<Bounded>(at, cutter.line);
    if (std::ranges::all_of(cutter.values, [](Bounded v) { return v.value > 0 && v.is_certain(); }))
      return true;
    if (near > 0) cutter.nearest = near * length(facet.plane.n);
    const std::size_t n = corners.size();
    signs.resize(n);
    std::size_t inside = 0;
    for (std::size_t k = 0; k < n; ++k) {
      signs[k] = side(corners[k], lines[corners[(k + n - 1) % n].line].line, cutter);
      inside += signs[k] > 0;
    }
    if (inside == n) return true;
    if (inside == 0) return false;
    std::size_t first = 0;  // corner outside after one inside
    while (!(signs[first] < 0 && signs[(first + n - 1) % n] > 0)) ++first;
    std::size_t last = first;  // corner outside before one inside
    while (signs[(last + 1) % n] < 0) last = (last + 1) % n;
    const auto id = static_cast<std::uint32_t>(lines.size());
    lines.push_back(cutter);
    kept.clear();
    for (std::size_t k = (last + 1) % n; k != first; k = (k + 1) % n) kept.push_back(corners[k]);
    if (kept.size() != inside) refuse(mesh.vertices[mesh.triangles[triangle][0]], "is too flat");
    const auto& in = lines[corners[(first + n - 1) % n].line].values;
    const std::uint32_t out = corners[last].line;
    kept.push_back({id, meeting(in, cutter.values)});
    kept.push_back({out, meeting(cutter.values, lines[out].values)});
    corners.swap(kept);
    return true;
  }

  std::uint32_t common_edge(std::uint32_t f, std::uint32_t g) const {
    for (const std::uint32_t e : complex.edges_of(f))
      if (std::ranges::find(complex.edges_of(g), e) != complex.edges_of(g).end()) return e;
    refuse(mesh.vertices[mesh.triangles[triangle][0]], "leaves the pattern's frame");
  }

  CutVertex symbol(const ClipLine& before, const ClipLine& after) const {
    const int p = before.line.corner, q = after.line.corner;
    if (p >= 0 && q >= 0)
      return {CutVertex::Kind::corner,
              mesh.triangles[triangle][static_cast<std::size_t>(3 - p - q)], 0};
    if (p < 0 && q < 0)
      return {CutVertex::Kind::face_edge, triangle, common_edge(before.facet, after.facet)};
    const auto edge = edges.of_triangle[triangle][static_cast<std::size_t>(std::max(p, q))];
    return {CutVertex::Kind::edge_facet, edge, p < 0 ? before.facet : after.facet};
  }

  void emit() {
    const auto begin = static_cast<std::uint32_t>(symbols.size());
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const ClipCorner& corner = corners[k];
      const ClipLine& before = lines[corners[(k + corners.size() - 1) % corners.size()].line];
      const ClipLine& after = lines[corner.line];
      symbols.push_back(symbol(before, after));
      sides.push_back(after.facet);
      const double w = corner.place[0].value + corner.place[1].value + corner.place[2].value;
      shares.push_back({corner.place[1].value / w, corner.place[2].value / w});
      if (after.facet == kNone) continue;
      const std::uint32_t next = complex.across(after.facet, cell);
      if (seen[next] == triangle + 1) continue;
      seen[next] = triangle + 1;
      queue.push_back(next);
    }
    polygons.push_back({triangle, cell, begin, static_cast<std::uint32_t>(symbols.size())});
  }

  void cut_triangle(std::uint32_t t, std::uint32_t start) {
    triangle = t;
    for (std::size_t k = 0; k < 3; ++k) at[k] = steps[mesh.triangles[t][k]];
    queue.assign(1, start);
    seen[start] = t + 1;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      cell = queue[i];
      start_polygon();
      for (const std::uint32_t f : complex.facets_of(cell))
        if (!clip(f)) refuse(mesh.vertices[mesh.triangles[t][0]], "has a triangle without area");
      emit();
    }
  }

  void run(std::size_t begin, std::size_t end) {
    std::uint32_t hint = 0;
    for (std::size_t t = begin; t < end; ++t) {
      triangle = static_cast<std::uint32_t>(t);
      hint = locate(steps[mesh.triangles[t][0]], hint);
      cut_triangle(triangle, hint);
    }
  }
};

// Numbers vertices by what identifies them, in the order in which they come.
struct VertexTable {
  std::vector<std::uint32_t> slots;
  const std::vector<CutVertex>& vertices;

  VertexTable(std::size_t most, const std::vector<CutVertex>& v)
      : slots(std::bit_ceil(2 * most + 16), kNone), vertices(v) {}
  // The slot of a vertex, holding its number or kNone.
  std::uint32_t& slot(const CutVertex& v) {
    std::uint64_t h = (static_cast<std::uint64_t>(v.a) << 32 | v.b) * 0x9E3779B97F4A7C15u;
    h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(v.kind)) * 0xBF58476D1CE4E5B9u;
    for (std::size_t i = (h >> 20) & (slots.size() - 1);; i = (i + 1) & (slots.size() - 1))
      if (slots[i] == kNone || vertices[slots[i]] == v) return slots[i];
  }
};

Vec3 place_of(const CutVertex& v, Vec2 share, const TriMesh& mesh, std::span<const Vec3> steps,
              const SolidComplex& complex, const MeshEdges& edges) {
  if (v.kind == CutVertex::Kind::corner) return mesh.vertices[v.a];
  if (v.kind == CutVertex::Kind::face_edge) {
    const auto& t = mesh.triangles[v.a];
    const Vec3 o = mesh.vertices[t[0]];
    return o + share.x * (mesh.vertices[t[1]] - o) + share.y * (mesh.vertices[t[2]] - o);
  }
  const auto [from, to] = edges.ends[v.a];
  const double p = plane_value<double>(complex.facets[v.b].plane, steps[from]);
  const double q = plane_value<double>(complex.facets[v.b].plane, steps[to]);
  const double part = std::clamp(p / (p - q), 0.0, 1.0);
  return mesh.vertices[from] + part * (mesh.vertices[to] - mesh.vertices[from]);
}

}  // namespace

CutSolid cut_surface(const TriMesh& mesh, const TriMesh& shown, std::span<const Vec3> steps,
                     const SolidFrame& frame, const SolidComplex& complex, int threads) {
  const MeshEdges edges(mesh);
  std::vector<std::pair<std::size_t, std::unique_ptr<Clipper>>> parts;
  std::mutex lock;
  for_each_range(mesh.triangles.size(), threads, [&](std::size_t begin, std::size_t end) {
    auto clipper = std::make_unique<Clipper>(mesh, steps, complex, edges, frame.near);
    clipper->run(begin, end);
    const std::scoped_lock guard(lock);
    parts.emplace_back(begin, std::move(clipper));
  });
  std::ranges::sort(parts, {}, [](const auto& part) { return part.first; });
  CutSolid cut;
  std::size_t symbols = 0;
  for (const auto& [begin, part] : parts) symbols += part->symbols.size();
  VertexTable table(symbols, cut.vertices);
  for (const auto& [begin, part] : parts) {
    const auto offset = static_cast<std::uint32_t>(cut.polygon_vertices.size());
    for (std::size_t k = 0; k < part->symbols.size(); ++k) {
      std::uint32_t& slot = table.slot(part->symbols[k]);
      if (slot == kNone) {
        slot = static_cast<std::uint32_t>(cut.vertices.size());
        cut.vertices.push_back(part->symbols[k]);
        const auto place = [&](const TriMesh& m) {
          return place_of(part->symbols[k], part->shares[k], m, steps, complex, edges);
        };
        cut.places.push_back(place(mesh));
        if (&shown != &mesh) cut.surface_places.push_back(place(shown));
      }
      cut.polygon_vertices.push_back(slot);
    }
    cut.polygon_lines.insert(cut.polygon_lines.end(), part->sides.begin(), part->sides.end());
    for (auto polygon : part->polygons) {
      polygon.begin += offset;
      polygon.end += offset;
      cut.polygons.push_back(polygon);
    }
    cut.exact_predicates += part->exact_predicates;
  }
  return cut;
}

CutSolid cut_solid(const TriMesh& mesh, const TriMesh& shown, std::span<const Vec3> steps,
                   const SolidFrame& frame, const SolidComplex& complex, int threads) {
  CutSolid cut = cut_surface(mesh, shown, steps, frame, complex, threads);
  cut_facets(mesh, steps, frame, complex, threads, cut);
  return cut;
}

}  // namespace sunder
