// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/part_mesh.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

constexpr double kSmoothCosine = 0.8;  // of the angle by which a smooth edge turns at most
constexpr double kLongestZone = 0.5;   // m

// A cross-section of the prism, and how near it is to its ends.
struct Ring {
  double z = 0;
  float near_first = 0, near_last = 0;
};

class PrismBuilder {
 public:
  explicit PrismBuilder(const RecordedPart& part)
      : region_(lattice_outline(part.outline, part.name)), half_length_(part.half_length) {
    const double h = half_length_, zone = std::min(kLongestZone, 0.5 * h);
    rings_ = {{-h, 1, 0}, {h, 0, 1}};
    if (part.has_ends) rings_ = {{-h, 1, 0}, {zone - h, 0, 0}, {h - zone, 0, 0}, {h, 0, 1}};
  }

  PartMesh build() {
    for (std::uint32_t loop = 0; loop < region_.loop_count(); ++loop) {
      double along = 0;
      for (std::uint32_t k = region_.loop_begin[loop]; k < region_.loop_begin[loop + 1]; ++k) {
        add_side(k, along);
        along += length(edge(k));
      }
    }
    add_caps();
    return std::move(mesh_);
  }

 private:
  Vec2 edge(std::uint32_t k) const { return region_.places[region_.next(k)] - region_.places[k]; }
  // The region lies on the left of its edges.
  Vec2 normal(std::uint32_t k) const {
    const Vec2 e = edge(k);
    return 1 / length(e) * Vec2{e.y, -e.x};
  }
  std::uint32_t before(std::uint32_t k) const {
    const std::uint32_t loop = region_.loop_of(k);
    return k > region_.loop_begin[loop] ? k - 1 : region_.loop_begin[loop + 1] - 1;
  }
  // Normal of side `k` at the corner it shares with side `other`. The longer side counts for more,
  // so that a plate beside a fillet stays flat.
  Vec2 corner_normal(std::uint32_t k, std::uint32_t other) const {
    const Vec2 a = normal(k), b = normal(other);
    if (dot(a, b) < kSmoothCosine) return a;
    const Vec2 sum = length(edge(k)) * a + length(edge(other)) * b;
    return 1 / length(sum) * sum;
  }

  void add_vertex(Vec2 at, const Ring& ring, Vec3 normal, Vec2 uv) {
    for (const double x : {at.x, at.y, ring.z}) mesh_.positions.push_back(static_cast<float>(x));
    for (const double x : {normal.x, normal.y, normal.z}) {
      mesh_.normals.push_back(static_cast<float>(x));
    }
    for (const double x : {uv.x, uv.y}) mesh_.uvs.push_back(static_cast<float>(x));
    mesh_.nearness.push_back(ring.near_first);
    mesh_.nearness.push_back(ring.near_last);
  }

  void add_side(std::uint32_t k, double along) {
    const std::uint32_t next = region_.next(k);
    const Vec2 a = corner_normal(k, before(k)), b = corner_normal(k, next);
    const double end = along + length(edge(k));
    for (std::size_t r = 0; r < rings_.size(); ++r) {
      const Ring& ring = rings_[r];
      const std::uint32_t first = mesh_.vertex_count();
      add_vertex(region_.places[k], ring, {a.x, a.y, 0}, {along, ring.z + half_length_});
      add_vertex(region_.places[next], ring, {b.x, b.y, 0}, {end, ring.z + half_length_});
      if (r == 0) continue;
      mesh_.indices.insert(mesh_.indices.end(),
                           {first - 2, first - 1, first + 1, first - 2, first + 1, first});
    }
  }

  void add_caps() {
    IndexLoops loops;
    for (std::uint32_t loop = 0; loop < region_.loop_count(); ++loop) {
      auto& corners = loops.emplace_back(region_.loop_begin[loop + 1] - region_.loop_begin[loop]);
      std::iota(corners.begin(), corners.end(), region_.loop_begin[loop]);
    }
    const auto triangles = triangulate(region_.places, loops);
    for (const double side : {-1.0, 1.0}) {
      const Ring& ring = side < 0 ? rings_.front() : rings_.back();
      const std::uint32_t first = mesh_.vertex_count();
      for (const Vec2 at : region_.places) add_vertex(at, ring, {0, 0, side}, {side * at.x, at.y});
      for (auto [a, b, c] : triangles) {
        if (side < 0) std::swap(b, c);
        mesh_.indices.insert(mesh_.indices.end(), {first + a, first + b, first + c});
      }
    }
  }

  LatticeRegion region_;
  double half_length_ = 0;
  std::vector<Ring> rings_;
  PartMesh mesh_;
};

}  // namespace

LatticeRegion lattice_outline(const Region& outline, const std::string& what) {
  const Box box = bounding_box(outline.outline);
  return make_lattice_region(outline, make_lattice(box.low, box.high - box.low), what);
}

PartMesh part_mesh(const RecordedPart& part) {
  return PrismBuilder(part).build();
}

}  // namespace sunder
