// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of one triangle of the surface that lie in one chunk become one polygon again: corners that
// only the cutting needed go.
#include <algorithm>
#include <cmath>

#include "fracture/solid_parts.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
using Link = std::array<std::uint32_t, 2>;
using Triangle = SolidPartition::Triangle;

struct Merger {
  const TriMesh& surface;
  SolidPartition& partition;
  std::vector<Triangle> merged{};
  std::vector<Link> links{}, border{};
  std::vector<std::uint32_t> used{};
  std::vector<Vec2> points{};
  std::vector<std::uint32_t> kept{};  // sources whose groups stay as they are in this chunk

  // Directed edges of the triangles that no other of them has in reverse.
  void find_border(std::span<const Triangle> group) {
    links.clear();
    border.clear();
    for (const Triangle& t : group)
      for (std::size_t k = 0; k < 3; ++k) links.push_back({t.corners[k], t.corners[(k + 1) % 3]});
    std::ranges::sort(links);
    for (const Link& link : links)
      if (!std::ranges::binary_search(links, Link{link[1], link[0]})) border.push_back(link);
  }

  bool has_inner_corner(std::span<const Triangle> group) const {
    for (const Triangle& t : group)
      for (const std::uint32_t v : t.corners) {
        const auto at = std::ranges::lower_bound(border, Link{v, 0});
        if (at == border.end() || (*at)[0] != v) return true;
      }
    return false;
  }

  // False where a corner has more than one edge leaving it: such groups stay as they are.
  bool chain(IndexLoops& loops) {
    used.clear();
    std::vector<std::uint8_t> done(border.size());
    for (std::size_t k = 1; k < border.size(); ++k)
      if (border[k][0] == border[k - 1][0]) return false;
    for (std::size_t start = 0; start < border.size(); ++start) {
      if (done[start]) continue;
      auto& loop = loops.emplace_back();
      for (std::size_t k = start; !done[k];) {
        done[k] = 1;
        loop.push_back(static_cast<std::uint32_t>(used.size()));
        used.push_back(border[k][0]);
        k = static_cast<std::size_t>(std::ranges::lower_bound(border, Link{border[k][1], 0}) -
                                     border.begin());
      }
    }
    return true;
  }

  // Barycentric coordinates, those of points on the triangle's edges exactly on them: three points
  // of an edge are straight, and make no triangle.
  void flatten(std::uint32_t source) {
    constexpr double kOnEdge = 1e-9;
    const auto& t = surface.triangles[source];
    const Vec3 at[3] = {surface.vertices[t[0]], surface.vertices[t[1]], surface.vertices[t[2]]};
    const Vec3 n = cross(at[1] - at[0], at[2] - at[0]);
    points.clear();
    for (const std::uint32_t i : used) {
      double share[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 p = at[(k + 1) % 3] - partition.vertices[i],
                   q = at[(k + 2) % 3] - partition.vertices[i];
        const double exact = dot(cross(p, q), n) / dot(n, n);
        share[k] = exact < kOnEdge ? 0 : std::round(exact * 0x1p52) * 0x1p-52;
      }
      if (share[0] == 0) share[2] = 1 - share[1];
      points.push_back({share[1], share[2]});
    }
  }

  void add_group(std::span<const Triangle> group) {
    find_border(group);
    IndexLoops loops;
    if (group.size() < 2 || std::ranges::binary_search(kept, group[0].source) ||
        !has_inner_corner(group) || !chain(loops)) {
      merged.insert(merged.end(), group.begin(), group.end());
      return;
    }
    flatten(group[0].source);
    const auto area = [&](const std::vector<std::uint32_t>& loop) {
      double sum = 0;
      for (std::size_t k = 0; k < loop.size(); ++k)
        sum += cross(points[loop[k]], points[loop[(k + 1) % loop.size()]]);
      return sum;
    };
    std::ranges::stable_sort(loops, std::greater{}, area);
    for (const auto& c : triangulate(points, loops))
      merged.push_back({{used[c[0]], used[c[1]], used[c[2]]}, group[0].source});
  }

  void add_chunk(std::span<const Triangle> chunk) {
    for (std::size_t i = 0, j = 0; i < chunk.size(); i = j) {
      while (j < chunk.size() && chunk[j].source == chunk[i].source) ++j;
      if (chunk[i].is_inner())
        merged.insert(merged.end(), chunk.begin() + static_cast<std::ptrdiff_t>(i),
                      chunk.begin() + static_cast<std::ptrdiff_t>(j));
      else
        add_group(chunk.subspan(i, j - i));
    }
  }

  // Sources of outer triangles with an edge that another triangle of the chunk has the same way: a
  // new edge across a polygon can be one that a crack's face has already.
  std::vector<std::uint32_t> doubled(std::size_t first) const {
    std::vector<std::pair<Link, std::uint32_t>> edges;
    for (std::size_t t = first; t < merged.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        edges.push_back({{merged[t].corners[k], merged[t].corners[(k + 1) % 3]}, merged[t].source});
    std::ranges::sort(edges);
    std::vector<std::uint32_t> sources;
    for (std::size_t k = 1; k < edges.size(); ++k)
      if (edges[k].first == edges[k - 1].first)
        for (const std::uint32_t source : {edges[k].second, edges[k - 1].second})
          if (!(source & SolidPartition::kInner)) sources.push_back(source);
    return sources;
  }

  void run() {
    std::vector<std::uint32_t> begin{0};
    for (std::uint32_t c = 0; c < partition.chunk_count(); ++c) {
      const std::span<Triangle> chunk =
          std::span(partition.triangles)
              .subspan(partition.chunk_begin[c],
                       partition.chunk_begin[c + 1] - partition.chunk_begin[c]);
      std::ranges::stable_sort(chunk, {}, &Triangle::source);  // the inner ones last
      kept.clear();
      for (bool again = true; again;) {
        merged.resize(begin.back());
        add_chunk(chunk);
        const std::size_t before = kept.size();
        const auto more = doubled(begin.back());
        kept.insert(kept.end(), more.begin(), more.end());
        std::ranges::sort(kept);
        kept.erase(std::ranges::unique(kept).begin(), kept.end());
        again = kept.size() > before;
      }
      begin.push_back(static_cast<std::uint32_t>(merged.size()));
    }
    partition.triangles = std::move(merged);
    partition.chunk_begin = std::move(begin);
  }

  void drop_unused_vertices() {
    std::vector<std::uint32_t> number(partition.vertices.size(), kNone);
    std::vector<Vec3> places;
    for (Triangle& t : partition.triangles)
      for (std::uint32_t& v : t.corners) {
        if (number[v] == kNone) {
          number[v] = static_cast<std::uint32_t>(places.size());
          places.push_back(partition.vertices[v]);
        }
        v = number[v];
      }
    partition.vertices = std::move(places);
  }
};

}  // namespace

void merge_outer_triangles(const TriMesh& surface, SolidPartition& partition) {
  Merger merger{surface, partition};
  merger.run();
  merger.drop_unused_vertices();
}

}  // namespace sunder
