// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/solid_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <numeric>
#include <ranges>

#include "meshing/parallel.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr double kSliver = 1e-6;  // of the mean chunk's volume
using Triangle = std::array<std::uint32_t, 3>;

// Parent links of a union-find structure; the root is the least member.
struct Groups {
  std::vector<std::uint32_t> parent;
  explicit Groups(std::size_t count = 0) : parent(count) {
    std::iota(parent.begin(), parent.end(), 0u);
  }
  std::uint32_t root(std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  bool join(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    parent[std::max(a, b)] = std::min(a, b);
    return a != b;
  }
};

// Triangles of the surface's polygons: polygon p's are begin[p] …
struct OuterTriangles {
  std::vector<std::uint32_t> begin{0};
  std::vector<Triangle> triangles;
};

void fill_polygon(const CutSolid& cut, const CutSolid::Polygon& polygon, Vec3 normal,
                  std::vector<Vec2>& points, std::vector<Triangle>& local) {
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  points.clear();
  local.clear();
  const Vec3 o = cut.places[cut.polygon_vertices[polygon.begin]];
  for (std::uint32_t k = polygon.begin; k < polygon.end; ++k) {
    const Vec3 d = cut.places[cut.polygon_vertices[k]] - o;
    // Seen along the normal's greatest part, from outside.
    Vec2 p = x >= y && x >= z ? Vec2{d.y, d.z} : y >= z ? Vec2{d.z, d.x} : Vec2{d.x, d.y};
    const double s = x >= y && x >= z ? normal.x : y >= z ? normal.y : normal.z;
    if (s < 0) p.x = -p.x;
    points.push_back(p);
  }
  if (triangulate_convex(points, local)) return;
  std::vector<std::uint32_t> loop(points.size());
  std::iota(loop.begin(), loop.end(), 0u);
  local = triangulate(points, {loop});
}

OuterTriangles outer_triangles(const TriMesh& mesh, const CutSolid& cut, int threads) {
  OuterTriangles outer;
  for (const auto& p : cut.polygons)
    outer.begin.push_back(outer.begin.back() + (p.end - p.begin) - 2);
  outer.triangles.resize(outer.begin.back());
  for_each_range(cut.polygons.size(), threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Vec2> points;
    std::vector<Triangle> local;
    for (std::size_t p = begin; p < end; ++p) {
      const auto& polygon = cut.polygons[p];
      const auto& t = mesh.triangles[polygon.triangle];
      const Vec3 a = mesh.vertices[t[0]];
      fill_polygon(cut, polygon, cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a), points,
                   local);
      std::uint32_t at = outer.begin[p];
      for (const Triangle& l : local)
        outer.triangles[at++] = {cut.polygon_vertices[polygon.begin + l[0]],
                                 cut.polygon_vertices[polygon.begin + l[1]],
                                 cut.polygon_vertices[polygon.begin + l[2]]};
    }
  });
  return outer;
}

double solid_angle(Vec3 a, Vec3 b, Vec3 c) {
  const double x = length(a), y = length(b), z = length(c);
  return 2 *
         std::atan2(dot(a, cross(b, c)), x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y);
}

struct Partitioner {
  const TriMesh& mesh;
  std::span<const std::uint32_t> parents;
  const SolidComplex& complex;
  const CutSolid& cut;
  SolidStats& stats;
  OuterTriangles outer{};
  std::vector<std::uint32_t> polygon_begin{}, polygons_by_cell{};
  std::vector<std::uint32_t> polygon_part{};               // per polygon
  std::vector<std::array<std::uint32_t, 2>> facet_part{};  // per facet triangle: in a, in b
  std::vector<double> volumes{};                           // per part
  Groups groups{0};                                        // of parts
  // Of the cell at work
  std::vector<std::uint32_t> local_of{}, members{};
  struct Side {
    Triangle corners;
    std::uint32_t* part;
  };
  std::vector<Side> sides{};

  Vec3 place(std::uint32_t v) const { return cut.places[v]; }

  void sort_polygons() {
    polygon_begin.assign(complex.cell_count + 1, 0);
    for (const auto& p : cut.polygons) ++polygon_begin[p.cell + 1];
    std::partial_sum(polygon_begin.begin(), polygon_begin.end(), polygon_begin.begin());
    std::vector<std::uint32_t> at(polygon_begin.begin(), polygon_begin.end() - 1);
    polygons_by_cell.resize(cut.polygons.size());
    for (std::uint32_t p = 0; p < cut.polygons.size(); ++p)
      polygons_by_cell[at[cut.polygons[p].cell]++] = p;
  }

  void gather_cell(std::uint32_t c) {
    sides.clear();
    for (std::uint32_t k = polygon_begin[c]; k < polygon_begin[c + 1]; ++k) {
      const std::uint32_t p = polygons_by_cell[k];
      for (std::uint32_t t = outer.begin[p]; t < outer.begin[p + 1]; ++t)
        sides.push_back({outer.triangles[t], &polygon_part[p]});
    }
    for (const std::uint32_t f : complex.facets_of(c)) {
      const bool is_a = complex.facets[f].a == c;
      for (std::uint32_t t = cut.facet_triangle_begin[f]; t < cut.facet_triangle_begin[f + 1];
           ++t) {
        Triangle corners = cut.facet_triangles[t];
        if (!is_a) std::swap(corners[1], corners[2]);
        sides.push_back({corners, &facet_part[t][is_a ? 0 : 1]});
      }
    }
  }

  double volume_of(const Side& side, Vec3 base) const {
    const Vec3 a = place(side.corners[0]) - base;
    return dot(a, cross(place(side.corners[1]) - base, place(side.corners[2]) - base)) / 6;
  }

  // Shells of the cell at work: their number per side.
  std::vector<std::uint32_t> find_shells(std::uint32_t& count) {
    members.clear();
    for (const Side& side : sides)
      for (const std::uint32_t v : side.corners)
        if (local_of[v] == kNone) {
          local_of[v] = static_cast<std::uint32_t>(members.size());
          members.push_back(v);
        }
    Groups joined(members.size());
    for (const Side& side : sides) {
      joined.join(local_of[side.corners[0]], local_of[side.corners[1]]);
      joined.join(local_of[side.corners[0]], local_of[side.corners[2]]);
    }
    std::vector<std::uint32_t> number(members.size(), kNone), shells;
    count = 0;
    for (const Side& side : sides) {
      std::uint32_t& n = number[joined.root(local_of[side.corners[0]])];
      if (n == kNone) n = count++;
      shells.push_back(n);
    }
    for (const std::uint32_t v : members) local_of[v] = kNone;
    return shells;
  }

  // Cavities go to the smallest shell around them. Returns the shell that each belongs to.
  std::vector<std::uint32_t> owners_of(const std::vector<std::uint32_t>& shells,
                                       std::vector<double>& volume) const {
    std::vector<std::uint32_t> owner(volume.size());
    std::iota(owner.begin(), owner.end(), 0u);
    const std::vector<double> shell_volume = volume;
    for (std::uint32_t s = 0; s < shell_volume.size(); ++s) {
      if (shell_volume[s] >= 0) continue;
      const auto first = std::ranges::find(shells, s) - shells.begin();
      const Vec3 inside = place(sides[static_cast<std::size_t>(first)].corners[0]);
      std::vector<double> turns(shell_volume.size());
      for (std::size_t k = 0; k < sides.size(); ++k)
        if (shells[k] != s)
          turns[shells[k]] +=
              solid_angle(place(sides[k].corners[0]) - inside, place(sides[k].corners[1]) - inside,
                          place(sides[k].corners[2]) - inside);
      for (std::uint32_t around = 0; around < shell_volume.size(); ++around)
        if (around != s && shell_volume[around] > 0 && turns[around] > 2 * std::numbers::pi &&
            (owner[s] == s || shell_volume[around] < shell_volume[owner[s]]))
          owner[s] = around;
      if (owner[s] != s) volume[owner[s]] += shell_volume[s];
    }
    return owner;
  }

  void split_cell(std::uint32_t c) {
    gather_cell(c);
    if (sides.empty()) {
      ++stats.cells_outside;
      return;
    }
    stats.cells_inside += polygon_begin[c] == polygon_begin[c + 1];
    std::uint32_t count = 0;
    const std::vector<std::uint32_t> shells = find_shells(count);
    std::vector<double> volume(count);
    const Vec3 base = place(sides[0].corners[0]);
    for (std::size_t k = 0; k < sides.size(); ++k) volume[shells[k]] += volume_of(sides[k], base);
    const std::vector<std::uint32_t> owner = owners_of(shells, volume);
    std::vector<std::uint32_t> number(count, kNone);
    for (std::uint32_t s = 0; s < count; ++s)
      if (owner[s] == s) {
        number[s] = static_cast<std::uint32_t>(volumes.size());
        volumes.push_back(volume[s]);
      }
    for (std::size_t k = 0; k < sides.size(); ++k) *sides[k].part = number[owner[shells[k]]];
  }

  void split_cells() {
    sort_polygons();
    polygon_part.assign(cut.polygons.size(), kNone);
    facet_part.assign(cut.facet_triangles.size(), {kNone, kNone});
    local_of.assign(cut.vertices.size(), kNone);
    for (std::uint32_t c = 0; c < complex.cell_count; ++c) split_cell(c);
    groups = Groups(volumes.size());
  }

  void join_labels() {
    if (complex.labels.empty()) return;
    for (std::uint32_t f = 0; f < complex.facets.size(); ++f) {
      if (complex.labels[complex.facets[f].a] != complex.labels[complex.facets[f].b]) continue;
      for (std::uint32_t t = cut.facet_triangle_begin[f]; t < cut.facet_triangle_begin[f + 1]; ++t)
        groups.join(facet_part[t][0], facet_part[t][1]);
    }
  }

  using Contact = std::array<std::uint32_t, 2>;
  std::map<Contact, double> contact_areas() const {
    std::map<Contact, double> areas;
    for (std::size_t t = 0; t < facet_part.size(); ++t) {
      const Triangle& c = cut.facet_triangles[t];
      const auto [p, q] = std::minmax(facet_part[t][0], facet_part[t][1]);
      areas[{p, q}] += length(cross(place(c[1]) - place(c[0]), place(c[2]) - place(c[0]))) / 2;
    }
    return areas;
  }

  std::vector<double> group_volumes() {
    std::vector<double> sum(volumes.size());
    for (std::uint32_t p = 0; p < volumes.size(); ++p) sum[groups.root(p)] += volumes[p];
    return sum;
  }

  // Joins groups below the least volume to the neighbour with which they share most.
  void join_slivers() {
    std::vector<double> sum = group_volumes();
    const auto chunks = static_cast<double>(
        std::ranges::count_if(std::views::iota(0u, static_cast<std::uint32_t>(volumes.size())),
                              [&](std::uint32_t p) { return groups.root(p) == p; }));
    const double least = kSliver * std::accumulate(sum.begin(), sum.end(), 0.0) / chunks;
    const auto is_sliver = [&](std::uint32_t root) { return sum[root] < least; };
    bool any = false;
    for (std::uint32_t p = 0; p < volumes.size(); ++p) any |= groups.root(p) == p && is_sliver(p);
    if (!any) return;
    const auto areas = contact_areas();
    for (bool joined = true; joined;) {
      joined = false;
      std::map<Contact, double> shared;
      for (const auto& [pair, area] : areas) {
        const std::uint32_t a = groups.root(pair[0]), b = groups.root(pair[1]);
        if (a == b) continue;
        if (is_sliver(a)) shared[{a, b}] += area;
        if (is_sliver(b)) shared[{b, a}] += area;
      }
      std::map<std::uint32_t, std::pair<double, std::uint32_t>> best;
      for (const auto& [pair, area] : shared) {
        auto& entry = best.try_emplace(pair[0], -1.0, kNone).first->second;
        if (area > entry.first) entry = {area, pair[1]};
      }
      for (const auto& [sliver, entry] : best)
        if (groups.join(sliver, entry.second)) ++stats.slivers_merged, joined = true;
      sum = group_volumes();
    }
  }

  SolidPartition emit() {
    SolidPartition result;
    std::vector<std::uint32_t> chunk(volumes.size());
    std::uint32_t count = 0;
    for (std::uint32_t p = 0; p < volumes.size(); ++p)
      chunk[p] = groups.root(p) == p ? count++ : chunk[groups.root(p)];
    result.chunk_begin.assign(count + 1, 0);
    std::vector<std::uint32_t> face_of(facet_part.size(), kNone);
    for (std::size_t p = 0; p < cut.polygons.size(); ++p)
      result.chunk_begin[chunk[polygon_part[p]] + 1] += outer.begin[p + 1] - outer.begin[p];
    for (std::uint32_t f = 0; f < complex.facets.size(); ++f) {
      const std::size_t first = result.faces.size();
      for (std::uint32_t t = cut.facet_triangle_begin[f]; t < cut.facet_triangle_begin[f + 1];
           ++t) {
        const std::uint32_t a = chunk[facet_part[t][0]], b = chunk[facet_part[t][1]];
        if (a == b) continue;
        std::size_t face = first;
        while (face < result.faces.size() &&
               !(result.faces[face].a == a && result.faces[face].b == b))
          ++face;
        if (face == result.faces.size()) {
          const Vec3 n = complex.facets[f].plane.n;
          result.faces.push_back({a, b, (1 / length(n)) * n});
        }
        face_of[t] = static_cast<std::uint32_t>(face);
        ++result.chunk_begin[a + 1];
        ++result.chunk_begin[b + 1];
      }
    }
    std::partial_sum(result.chunk_begin.begin(), result.chunk_begin.end(),
                     result.chunk_begin.begin());
    fill(result, chunk, face_of);
    return result;
  }

  void fill(SolidPartition& result, const std::vector<std::uint32_t>& chunk,
            const std::vector<std::uint32_t>& face_of) const {
    std::vector<std::uint32_t> at(result.chunk_begin.begin(), result.chunk_begin.end() - 1);
    std::vector<std::uint32_t> number(cut.vertices.size(), kNone);
    result.triangles.resize(result.chunk_begin.back());
    const auto add = [&](std::uint32_t c, const Triangle& corners, std::uint32_t source) {
      auto& triangle = result.triangles[at[c]++];
      triangle.source = source;
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t& v = number[corners[k]];
        if (v == kNone) {
          v = static_cast<std::uint32_t>(result.vertices.size());
          result.vertices.push_back(cut.places[corners[k]]);
        }
        triangle.corners[k] = v;
      }
    };
    for (std::size_t p = 0; p < cut.polygons.size(); ++p) {
      const std::uint32_t t = cut.polygons[p].triangle;
      for (std::uint32_t k = outer.begin[p]; k < outer.begin[p + 1]; ++k)
        add(chunk[polygon_part[p]], outer.triangles[k], parents.empty() ? t : parents[t]);
    }
    for (std::size_t t = 0; t < face_of.size(); ++t) {
      if (face_of[t] == kNone) continue;
      const Triangle& c = cut.facet_triangles[t];
      const std::uint32_t source = SolidPartition::kInner | face_of[t];
      add(chunk[facet_part[t][0]], c, source);
      add(chunk[facet_part[t][1]], {c[0], c[2], c[1]}, source);
    }
  }
};

// Whether no chunk meets itself along an edge.
bool is_manifold(const SolidPartition& partition) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::uint32_t c = 0; c < partition.chunk_count(); ++c) {
    edges.clear();
    for (std::uint32_t t = partition.chunk_begin[c]; t < partition.chunk_begin[c + 1]; ++t)
      for (std::size_t k = 0; k < 3; ++k)
        edges.push_back(
            {partition.triangles[t].corners[k], partition.triangles[t].corners[(k + 1) % 3]});
    std::ranges::sort(edges);
    if (std::ranges::adjacent_find(edges) != edges.end()) return false;
  }
  return true;
}

}  // namespace

SolidPartition partition_solid(const TriMesh& mesh, std::span<const std::uint32_t> parents,
                               const SolidComplex& complex, const CutSolid& cut, int threads,
                               SolidStats& stats) {
  Partitioner work{
      .mesh = mesh, .parents = parents, .complex = complex, .cut = cut, .stats = stats};
  work.outer = outer_triangles(mesh, cut, threads);
  work.split_cells();
  stats.cells += complex.cell_count;
  stats.islands_split += work.volumes.size() - (complex.cell_count - stats.cells_outside);
  work.join_labels();
  work.join_slivers();
  SolidPartition result = work.emit();
  if (stats.slivers_merged == 0 || is_manifold(result)) return result;
  stats.slivers_merged = 0;
  work.groups = Groups(work.volumes.size());
  work.join_labels();
  return work.emit();
}

}  // namespace sunder
