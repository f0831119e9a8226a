// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/hull_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace sunder {
namespace {

constexpr int kMostSamplesPerHull = 2000;

Vec3 place(HullPoint p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

std::optional<HullPoint> rounded(Vec3 p) {
  const auto is_far = [](double x) { return !(std::abs(x) <= kHullReach); };
  if (is_far(p.x) || is_far(p.y) || is_far(p.z)) return {};
  return HullPoint{static_cast<std::int32_t>(std::lround(p.x)),
                   static_cast<std::int32_t>(std::lround(p.y)),
                   static_cast<std::int32_t>(std::lround(p.z))};
}

TriMesh mesh_of(std::span<const HullTriangle> triangles) {
  TriMesh mesh;
  std::map<HullPoint, std::uint32_t> index;
  for (const HullTriangle& t : triangles) {
    auto& corners = mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [at, is_new] =
          index.try_emplace(t[k], static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(place(t[k]));
      corners[k] = at->second;
    }
  }
  return mesh;
}

// Where a plane cuts an edge: both its triangles find the same place.
HullPoint crossing(HullPoint a, HullPoint b, const HullPlane& plane) {
  if (b < a) std::swap(a, b);
  const double from = static_cast<double>(plane.side(a)), to = static_cast<double>(plane.side(b));
  const Vec3 start = place(a);
  return *rounded(start + from / (from - to) * (place(b) - start));
}

// The polygon of a triangle that lies above a plane: at most four corners.
struct Clipped {
  std::array<HullPoint, 4> corners{};
  std::array<bool, 4> is_on_plane{};
  std::size_t count = 0;
  void add(HullPoint p, bool on) {
    corners[count] = p;
    is_on_plane[count++] = on;
  }
};

Clipped clip(const HullTriangle& t, const HullPlane& plane) {
  Clipped result;
  const std::array side{plane.side(t[0]), plane.side(t[1]), plane.side(t[2])};
  if (side[0] <= 0 && side[1] <= 0 && side[2] <= 0) return result;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (side[k] >= 0) result.add(t[k], side[k] == 0);
    if ((side[k] > 0 && side[next] < 0) || (side[k] < 0 && side[next] > 0))
      result.add(crossing(t[k], t[next], plane), true);
  }
  return result;
}

// Adds what lies above the plane to `kept`, and to `caps` what closes it in the plane.
void cut(std::span<const HullTriangle> triangles, const HullPlane& plane,
         std::vector<HullTriangle>& kept, std::vector<HullTriangle>& caps) {
  for (const HullTriangle& t : triangles) {
    const Clipped above = clip(t, plane);
    for (std::size_t k = 2; k < above.count; ++k)
      kept.push_back({above.corners[0], above.corners[k - 1], above.corners[k]});
    for (std::size_t k = 0; k < above.count && above.count >= 3; ++k) {
      const std::size_t next = (k + 1) % above.count;
      if (above.is_on_plane[k] && above.is_on_plane[next])
        caps.push_back({plane.at, above.corners[next], above.corners[k]});
    }
  }
}

std::optional<HullPoint> meeting(const HullPlane& p, const HullPlane& q, const HullPlane& r) {
  const auto normal = [](const HullPlane& plane) {
    const Vec3 n{static_cast<double>(plane.normal[0]), static_cast<double>(plane.normal[1]),
                 static_cast<double>(plane.normal[2])};
    return (1 / length(n)) * n;
  };
  const Vec3 a = normal(p), b = normal(q), c = normal(r);
  const double det = dot(a, cross(b, c));
  if (std::abs(det) < 1e-6) return {};
  const Vec3 at =
      (1 / det) * (dot(a, place(p.at)) * cross(b, c) + dot(b, place(q.at)) * cross(c, a) +
                   dot(c, place(r.at)) * cross(a, b));
  return rounded(at);
}

}  // namespace

HullChunk::HullChunk(std::vector<HullTriangle> triangles)
    : surface(std::move(triangles)), mesh(mesh_of(surface)), tree(mesh) {
  volume = signed_volume(surface);
  diagonal = sunder::diagonal(box_of(mesh));
}

std::vector<ReflexEdge> HullChunk::reflex_edges() const {
  std::map<std::array<HullPoint, 2>, std::uint32_t> triangle_at;  // directed edge → triangle
  for (std::uint32_t t = 0; t < surface.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) triangle_at[{surface[t][k], surface[t][(k + 1) % 3]}] = t;
  std::vector<ReflexEdge> edges;
  for (const auto& [edge, t] : triangle_at) {
    if (edge[1] < edge[0]) continue;
    const auto other = triangle_at.find({edge[1], edge[0]});
    if (other == triangle_at.end()) continue;
    const HullTriangle &s = surface[t], &r = surface[other->second];
    const HullPlane left = plane_through(s[0], s[1], s[2]);
    const HullPlane right = plane_through(r[0], r[1], r[2]);
    // A corner of the other face more than a step above this one.
    const auto is_above = [](const HullPlane& plane, const HullTriangle& face) {
      return std::ranges::any_of(
          face, [&](HullPoint p) { return static_cast<double>(plane.side(p)) > 2 * plane.size(); });
    };
    if (is_above(left, r) && is_above(right, s)) edges.push_back({edge[0], edge[1], left, right});
  }
  return edges;
}

bool HullChunk::contains(Vec3 p) const {
  return tree.winding_number(p) > 0.5;
}

double HullChunk::distance(Vec3 p) const {
  return contains(p) ? 0 : tree.nearest(p).distance;
}

double signed_volume(std::span<const HullTriangle> triangles) {
  if (triangles.empty()) return 0;
  const Vec3 origin = place(triangles[0][0]);
  double sum = 0;
  for (const HullTriangle& t : triangles) {
    const Vec3 a = place(t[0]) - origin, b = place(t[1]) - origin, c = place(t[2]) - origin;
    sum += dot(a, cross(b, c));
  }
  return sum / 6;
}

HullPlane flipped(HullPlane plane) {
  for (std::int64_t& n : plane.normal) n = -n;
  return plane;
}

HullPart part_above(const HullPart& part, const HullPlane& plane) {
  HullPart above;
  above.planes = part.planes;
  above.planes.push_back(plane);
  std::vector<HullTriangle> caps;
  cut(part.surface, plane, above.surface, caps);
  cut(part.caps, plane, above.caps, caps);
  above.caps.insert(above.caps.end(), caps.begin(), caps.end());
  std::vector<HullTriangle> all = above.surface;
  all.insert(all.end(), above.caps.begin(), above.caps.end());
  above.volume = signed_volume(all);
  for (const HullPoint p : part.junctions)
    if (plane.side(p) >= 0) above.junctions.push_back(p);
  return above;
}

std::vector<HullPoint> corners_of(const HullPart& part) {
  std::vector<HullPoint> corners = part.junctions;
  for (const HullTriangle& t : part.surface) corners.insert(corners.end(), t.begin(), t.end());
  std::ranges::sort(corners);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

void add_junctions(const HullChunk& chunk, HullPart& part) {
  const std::size_t last = part.planes.size() - 1;
  for (std::size_t i = 0; i < last; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto at = meeting(part.planes[last], part.planes[i], part.planes[j]);
      const auto is_above = [&](const HullPlane& plane) {
        return static_cast<double>(plane.side(*at)) > -2 * plane.size();  // rounded
      };
      if (at && std::ranges::all_of(part.planes, is_above) && chunk.contains(place(*at)))
        part.junctions.push_back(*at);
    }
}

double distance_bound(const ConvexHull& hull, const HullChunk& chunk, double limit) {
  struct Sample {
    std::array<Vec3, 3> corners;
    double bound = 0;
  };
  const auto is_below = [](const Sample& a, const Sample& b) { return a.bound < b.bound; };
  std::vector<Sample> open;  // a heap
  double found = 0;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 middle = (1.0 / 3) * (a + b + c);
    const double reach = std::max({length(a - middle), length(b - middle), length(c - middle)});
    const auto nearest = chunk.tree.nearest(middle);
    double bound = nearest.distance + reach;
    if (bound > limit / 8) {
      // The distance from one triangle is greatest at a corner.
      for (const double near : {limit / 8, 0.9 * limit})
        if (bound > near && chunk.tree.is_within(a, near, nearest.triangle) &&
            chunk.tree.is_within(b, near, nearest.triangle) &&
            chunk.tree.is_within(c, near, nearest.triangle))
          bound = near;
    }
    if (bound > std::max(0.9 * limit, 1.1 * found)) {
      // As deep inside as it is near the surface, so is all around it.
      if (chunk.contains(middle))
        bound = std::max(0.0, reach - nearest.distance);
      else
        found = std::max(found, nearest.distance);
    }
    open.push_back({{a, b, c}, bound});
    std::ranges::push_heap(open, is_below);
  };
  for (const auto& t : hull.triangles)
    add(place(hull.vertices[t[0]]), place(hull.vertices[t[1]]), place(hull.vertices[t[2]]));
  for (int samples = 0; samples < kMostSamplesPerHull; samples += 4) {
    if (open.front().bound <= std::max(0.9 * limit, 1.1 * found)) break;
    std::ranges::pop_heap(open, is_below);
    const auto [a, b, c] = open.back().corners;
    open.pop_back();
    const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    add(a, ab, ca);
    add(b, bc, ab);
    add(c, ca, bc);
    add(ab, bc, ca);
  }
  return open.front().bound;
}

}  // namespace sunder
