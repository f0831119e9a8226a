// SPDX-License-Identifier: GPL-3.0-or-later
// C. B. Barber, D. P. Dobkin and H. Huhdanpaa, "The quickhull algorithm for convex hulls", 1996.
// All signs are exact, so a plane counts as seen only from strictly above it and nothing is ever
// merged.
#include "fracture/convex_hull.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

namespace sunder {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

struct Facet {
  std::array<std::uint32_t, 3> corners{};   // of the points
  std::array<std::uint32_t, 3> adjacent{};  // facet beyond the edge from corner k to the next
  HullPlane plane;
  double size = 0;                     // of the plane's normal
  std::vector<std::uint32_t> outside;  // points above it that no other facet has
  std::uint32_t farthest = kNone;
  double distance = 0;  // of the farthest
  bool is_alive = true;
};

double squared(const HullPlane& plane) {
  double sum = 0;
  for (const std::int64_t n : plane.normal) sum += static_cast<double>(n) * static_cast<double>(n);
  return sum;
}

class Quickhull {
 public:
  explicit Quickhull(std::span<const HullPoint> points) : points_(points) {}

  ConvexHull run(std::size_t most) {
    const auto simplex = first_simplex();
    if (!simplex) return {};
    start(*simplex);
    for (std::size_t count = 4; count < most; ++count) {
      const std::uint32_t top = highest();
      if (top == kNone) break;
      add(top);
    }
    return result();
  }

 private:
  // Four of the points that are not in a plane: far apart, and the same whatever their order.
  std::optional<std::array<std::uint32_t, 4>> first_simplex() const {
    if (points_.size() < 4) return {};
    const auto [low, high] = std::ranges::minmax_element(points_);
    const auto a = static_cast<std::uint32_t>(low - points_.begin());
    const auto b = static_cast<std::uint32_t>(high - points_.begin());
    const std::uint32_t c =
        best([&](HullPoint p) { return squared(plane_through(points_[a], points_[b], p)); });
    const HullPlane base = plane_through(points_[a], points_[b], points_[c]);
    if (base.normal == std::array<std::int64_t, 3>{}) return {};
    const std::uint32_t d =
        best([&](HullPoint p) { return std::abs(static_cast<double>(base.side(p))); });
    const Int128 side = base.side(points_[d]);
    if (side == 0) return {};
    return side < 0 ? std::array{a, b, c, d} : std::array{a, c, b, d};
  }

  // Point with the largest value, the last in lexicographic order of several.
  template <class Value>
  std::uint32_t best(const Value& value) const {
    std::uint32_t found = 0;
    double most = -1;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      const double v = value(points_[i]);
      if (v < most || (v == most && points_[i] < points_[found])) continue;
      found = i;
      most = v;
    }
    return found;
  }

  // (a, b, c) is seen from outside, d is behind it.
  void start(const std::array<std::uint32_t, 4>& simplex) {
    const auto [a, b, c, d] = simplex;
    facets_.push_back(facet({a, b, c}, {3, 1, 2}));
    facets_.push_back(facet({b, d, c}, {3, 2, 0}));
    facets_.push_back(facet({a, c, d}, {0, 1, 3}));
    facets_.push_back(facet({a, d, b}, {2, 1, 0}));
    std::vector<std::uint32_t> all(points_.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    share(all, 0);
  }

  Facet facet(std::array<std::uint32_t, 3> corners, std::array<std::uint32_t, 3> adjacent) const {
    Facet made{corners, adjacent, {}, 0, {}, kNone, 0, true};
    made.plane = plane_through(points_[corners[0]], points_[corners[1]], points_[corners[2]]);
    made.size = made.plane.size();
    return made;
  }

  // Gives each point to the first facet from `first` on that it is above; the others are inside.
  void share(const std::vector<std::uint32_t>& points, std::size_t first) {
    for (const std::uint32_t i : points) {
      for (std::size_t f = first; f < facets_.size(); ++f) {
        Facet& facet = facets_[f];
        const Int128 side = facet.plane.side(points_[i]);
        if (side <= 0) continue;
        facet.outside.push_back(i);
        const double distance = static_cast<double>(side) / facet.size;
        if (facet.farthest == kNone || distance > facet.distance ||
            (distance == facet.distance && points_[facet.farthest] < points_[i])) {
          facet.farthest = i;
          facet.distance = distance;
        }
        break;
      }
    }
  }

  // Facet whose farthest point is the farthest out of all.
  std::uint32_t highest() const {
    std::uint32_t found = kNone;
    for (std::uint32_t f = 0; f < facets_.size(); ++f) {
      const Facet& facet = facets_[f];
      if (!facet.is_alive || facet.farthest == kNone) continue;
      if (found == kNone || facet.distance > facets_[found].distance ||
          (facet.distance == facets_[found].distance &&
           points_[facets_[found].farthest] < points_[facet.farthest])) {
        found = f;
      }
    }
    return found;
  }

  struct HorizonEdge {
    std::uint32_t from = 0, to = 0, beyond = 0;
  };

  // Replaces what the facet's farthest point sees by a cone to it.
  void add(std::uint32_t top) {
    const std::uint32_t eye = facets_[top].farthest;
    std::vector<HorizonEdge> horizon;
    std::vector<std::uint32_t> orphans;
    std::vector<std::uint32_t> queue{top};
    facets_[top].is_alive = false;
    for (std::size_t at = 0; at < queue.size(); ++at) {
      const Facet& facet = facets_[queue[at]];
      orphans.insert(orphans.end(), facet.outside.begin(), facet.outside.end());
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t beyond = facet.adjacent[k];
        if (!facets_[beyond].is_alive) continue;
        if (facets_[beyond].plane.side(points_[eye]) > 0) {
          facets_[beyond].is_alive = false;
          queue.push_back(beyond);
        }
      }
    }
    for (const std::uint32_t seen : queue) {
      const Facet& facet = facets_[seen];
      for (std::size_t k = 0; k < 3; ++k) {
        if (facets_[facet.adjacent[k]].is_alive)
          horizon.push_back({facet.corners[k], facet.corners[(k + 1) % 3], facet.adjacent[k]});
      }
    }
    const std::size_t first = facets_.size();
    raise_cone(horizon, eye);
    std::erase(orphans, eye);
    share(orphans, first);
    for (const std::uint32_t seen : queue) facets_[seen].outside = {};
  }

  void raise_cone(const std::vector<HorizonEdge>& horizon, std::uint32_t eye) {
    const auto first = static_cast<std::uint32_t>(facets_.size());
    for (std::uint32_t i = 0; i < horizon.size(); ++i) {
      const auto [from, to, beyond] = horizon[i];
      // The edges to and from the eye belong to the cone's facets before and after.
      std::uint32_t before = kNone, after = kNone;
      for (std::uint32_t j = 0; j < horizon.size(); ++j) {
        if (horizon[j].from == to) after = first + j;
        if (horizon[j].to == from) before = first + j;
      }
      assert(before != kNone && after != kNone);
      facets_.push_back(facet({from, to, eye}, {beyond, after, before}));
      Facet& other = facets_[beyond];
      for (std::size_t k = 0; k < 3; ++k)
        if (other.corners[k] == to && other.corners[(k + 1) % 3] == from)
          other.adjacent[k] = first + i;
    }
  }

  ConvexHull result() const {
    ConvexHull hull;
    std::vector<std::uint32_t> index(points_.size(), kNone);
    for (const Facet& facet : facets_) {
      if (!facet.is_alive) continue;
      auto& triangle = hull.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t& id = index[facet.corners[k]];
        if (id == kNone) {
          id = static_cast<std::uint32_t>(hull.vertices.size());
          hull.vertices.push_back(points_[facet.corners[k]]);
        }
        triangle[k] = id;
      }
      for (const std::uint32_t i : facet.outside) hull.missed.push_back(points_[i]);
    }
    return hull;
  }

  std::span<const HullPoint> points_;
  std::vector<Facet> facets_;
};

}  // namespace

double HullPlane::size() const {
  return std::sqrt(squared(*this));
}

HullPlane plane_through(HullPoint a, HullPoint b, HullPoint c) {
  const std::int64_t ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
  const std::int64_t vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  return {{uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx}, a};
}

double ConvexHull::volume() const {
  double sum = 0;
  for (const auto& t : triangles)
    sum -= static_cast<double>(
        plane_through(vertices[t[0]], vertices[t[1]], vertices[t[2]]).side(vertices[0]));
  return sum / 6;
}

ConvexHull convex_hull(std::span<const HullPoint> points, std::size_t most) {
  return Quickhull(points).run(most);
}

}  // namespace sunder
