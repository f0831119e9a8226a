// SPDX-License-Identifier: GPL-3.0-or-later
// Halving of all edges above a length until none is left: who shares an edge shares its middle.
#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "fracture/solid_warp.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr std::size_t kMostTriangles = std::size_t{1} << 24;

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
}

// Triangles with what they are part of, and the places of their corners.
struct Refiner {
  double longest;
  std::vector<Vec3>& places;
  std::unordered_set<std::uint64_t> fixed{};                   // edges that stay
  std::unordered_map<std::uint64_t, std::uint32_t> middles{};  // of this round
  std::vector<Triangle> triangles{};
  std::vector<std::uint32_t> parents{};

  std::uint32_t middle(std::uint32_t a, std::uint32_t b) {
    if (length(places[b] - places[a]) <= longest) return kNone;
    if (!fixed.empty() && fixed.contains(edge_key(a, b))) return kNone;
    const auto [it, added] =
        middles.try_emplace(edge_key(a, b), static_cast<std::uint32_t>(places.size()));
    if (added) places.push_back(0.5 * (places[std::min(a, b)] + places[std::max(a, b)]));
    return it->second;
  }

  // The triangle's parts; the first edge is one with a middle if any has.
  void split(Triangle t, std::array<std::uint32_t, 3> m, std::vector<Triangle>& out) const {
    while (m[0] == kNone || (m[2] != kNone && m[1] == kNone)) {
      if (m[0] == kNone && m[1] == kNone && m[2] == kNone) break;
      std::ranges::rotate(t, t.begin() + 1);
      std::ranges::rotate(m, m.begin() + 1);
    }
    if (m[0] == kNone) {
      out.push_back(t);
    } else if (m[1] == kNone) {
      out.push_back({t[0], m[0], t[2]});
      out.push_back({m[0], t[1], t[2]});
    } else if (m[2] == kNone) {
      out.push_back({m[0], t[1], m[1]});
      const auto square = [&](std::uint32_t a, std::uint32_t b) {
        return dot(places[b] - places[a], places[b] - places[a]);
      };
      const bool first = square(t[0], m[1]) < square(m[0], t[2]);
      out.push_back({t[0], m[0], first ? m[1] : t[2]});
      out.push_back({first ? t[0] : m[0], m[1], t[2]});
    } else {
      out.insert(out.end(), {{t[0], m[0], m[2]}, {m[0], t[1], m[1]}, {m[2], m[1], t[2]}, m});
    }
  }

  void run() {
    for (bool any = true; any;) {
      any = false;
      middles.clear();
      std::vector<Triangle> next;
      std::vector<std::uint32_t> next_parents;
      for (std::size_t k = 0; k < triangles.size(); ++k) {
        const Triangle& t = triangles[k];
        const std::array<std::uint32_t, 3> m{middle(t[0], t[1]), middle(t[1], t[2]),
                                             middle(t[2], t[0])};
        any |= m[0] != kNone || m[1] != kNone || m[2] != kNone;
        split(t, m, next);
        next_parents.resize(next.size(), parents[k]);
      }
      if (next.size() > kMostTriangles)
        throw Error(ErrorCode::geometry,
                    "solid: bumps of this size need more than 2^24 triangles; valid are a greater "
                    "roughness_size or wavelength");
      triangles = std::move(next);
      parents = std::move(next_parents);
    }
  }
};

}  // namespace

FineMesh refined(const TriMesh& mesh, double edge) {
  FineMesh fine{mesh, {}};
  Refiner work{edge, fine.mesh.vertices};
  work.triangles = mesh.triangles;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) work.parents.push_back(t);
  work.run();
  fine.mesh.triangles = std::move(work.triangles);
  fine.parents = std::move(work.parents);
  return fine;
}

void refine_facets(CutSolid& cut, double edge) {
  Refiner work{edge, cut.places};
  for (const auto& polygon : cut.polygons)
    for (std::uint32_t k = polygon.begin; k < polygon.end; ++k) {
      const std::uint32_t next = k + 1 == polygon.end ? polygon.begin : k + 1;
      if (cut.polygon_lines[k] != CutSolid::kOutline)
        work.fixed.insert(edge_key(cut.polygon_vertices[k], cut.polygon_vertices[next]));
    }
  work.triangles = cut.facet_triangles;
  for (std::uint32_t f = 0; f + 1 < cut.facet_triangle_begin.size(); ++f)
    work.parents.resize(cut.facet_triangle_begin[f + 1], f);
  work.run();
  // The parts of a facet have stayed together.
  std::ranges::fill(cut.facet_triangle_begin, 0);
  for (const std::uint32_t f : work.parents) ++cut.facet_triangle_begin[f + 1];
  for (std::size_t f = 1; f < cut.facet_triangle_begin.size(); ++f)
    cut.facet_triangle_begin[f] += cut.facet_triangle_begin[f - 1];
  cut.facet_triangles = std::move(work.triangles);
  cut.vertices.resize(cut.places.size(), {CutVertex::Kind::inner_corner, kNone, 0});
}

}  // namespace sunder
