// SPDX-License-Identifier: GPL-3.0-or-later
// Approximate convex decomposition: cuts at reflex edges, the most useful first, then joins. After
// J.-M. Lien and N. M. Amato, "Approximate convex decomposition of polyhedra", 2007 (cuts at
// notches by depth), and K. Mamou and F. Ghorbel, "A simple and efficient approach for 3D mesh
// approximate convex decomposition", 2009 (joining).
#include "fracture/hulls.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <future>
#include <limits>

#include "fracture/chunk_mesh.hpp"
#include "fracture/hull_parts.hpp"

namespace sunder {
namespace {

constexpr std::size_t kMostCandidates = 24;
// Triangles times planes that one search for a cut may clip.
constexpr std::size_t kMostClips = 400000;
// A cut that leaves less of a chunk than this share of its volume is none.
constexpr double kDust = 1e-9;

using Triangles = std::vector<HullTriangle>;

Vec3 unit(const HullPlane& plane) {
  const Vec3 n{static_cast<double>(plane.normal[0]), static_cast<double>(plane.normal[1]),
               static_cast<double>(plane.normal[2])};
  return (1 / length(n)) * n;
}

HullPlane plane_of(Vec3 normal, HullPoint at) {
  constexpr double kSize = 1 << 20;
  return {{std::llround(kSize * normal.x), std::llround(kSize * normal.y),
           std::llround(kSize * normal.z)},
          at};
}

// Makes the hulls of one chunk.
class Decomposer {
 public:
  Decomposer(const HullChunk& chunk, const HullParams& params)
      : chunk_(chunk),
        most_hulls_(static_cast<std::size_t>(params.max_hulls)),
        most_vertices_(static_cast<std::size_t>(params.max_vertices)),
        most_volume_(params.error * chunk.volume),
        most_distance_(params.error * chunk.diagonal) {}

  // `tiles`: parts that fill the chunk, if some are known.
  std::vector<HullPart> run(std::vector<HullPart> tiles) {
    HullPart whole;
    whole.surface = chunk_.surface;
    whole.volume = chunk_.volume;
    finish(whole);
    if (whole.hull.triangles.empty()) return {};
    parts_.push_back(std::move(whole));
    if (is_good(total_excess())) return std::move(parts_);
    if (tiles.size() > 1 && tiles.size() <= 4 * most_hulls_) {
      for (HullPart& tile : tiles) finish(tile);
      parts_ = std::move(tiles);
    } else if (most_hulls_ > 1) {
      edges_ = chunk_.reflex_edges();
      split_all();
    }
    join_all();
    return std::move(parts_);
  }

  // What a hull H has beyond its part is at least a copy of H smaller by distance over diameter, so
  // little volume means little distance.
  double measured(HullPart& part) const {
    if (part.distance >= 0) return part.distance;
    const double all = part.hull.volume(), share = std::max(part.excess, 0.0) / all;
    part.distance = chunk_.diagonal * std::cbrt(share);
    if (part.distance > most_distance_ / 2)
      part.distance = std::min(part.distance, distance_bound(part.hull, chunk_, most_distance_));
    if (part.hull.missed.empty()) return part.distance;
    TriMesh mesh;
    for (const HullPoint p : part.hull.vertices)
      mesh.vertices.push_back({double(p.x), double(p.y), double(p.z)});
    mesh.triangles = part.hull.triangles;
    const TriangleTree tree(mesh);
    for (const HullPoint p : part.hull.missed) {
      const Vec3 at{double(p.x), double(p.y), double(p.z)};
      part.distance = std::max(part.distance, tree.nearest(at).distance);
    }
    return part.distance;
  }

 private:
  double total_excess() const {
    double sum = 0;
    for (const HullPart& part : parts_) sum += part.excess;
    return sum;
  }

  void finish(HullPart& part) const {
    if (part.planes.size() > 2) add_junctions(chunk_, part);
    part.hull = convex_hull(corners_of(part), most_vertices_);
    part.excess = part.hull.volume() - part.volume;
  }

  bool is_good(double excess) {
    return excess <= most_volume_ && std::ranges::all_of(parts_, [&](HullPart& part) {
             return measured(part) <= most_distance_;
           });
  }

  // Cuts the worst part until all are good or there are twice as many as may stay.
  void split_all() {
    std::vector<bool> is_final(parts_.size(), false);
    while (parts_.size() < 2 * most_hulls_) {
      const bool by_volume = total_excess() > most_volume_;
      std::size_t worst = parts_.size();
      double most = by_volume ? 0 : most_distance_;
      for (std::size_t i = 0; i < parts_.size(); ++i) {
        const double value = is_final[i] ? 0 : by_volume ? parts_[i].excess : measured(parts_[i]);
        if (value <= most) continue;
        most = value;
        worst = i;
      }
      if (worst == parts_.size()) return;
      HullPart above, below;
      is_final[worst] = !split(parts_[worst], above, below);
      if (is_final[worst]) continue;
      parts_[worst] = std::move(above);
      parts_.push_back(std::move(below));
      is_final.push_back(false);
    }
  }

  bool split(const HullPart& part, HullPart& above, HullPart& below) const {
    double least = part.hull.volume();
    bool found = false;
    for (const HullPlane& plane : candidates(part)) {
      HullPart a = part_above(part, plane), b = part_above(part, flipped(plane));
      if (a.volume < kDust * chunk_.volume || b.volume < kDust * chunk_.volume) continue;
      a.hull = convex_hull(corners_of(a), most_vertices_);
      b.hull = convex_hull(corners_of(b), most_vertices_);
      if (a.hull.triangles.empty() || b.hull.triangles.empty()) continue;
      const double volume = a.hull.volume() + b.hull.volume();
      if (volume >= least && found) continue;
      least = volume;
      found = true;
      above = std::move(a);
      below = std::move(b);
    }
    if (!found) return false;
    finish(above);
    finish(below);
    return true;
  }

  // Planes of the faces at the deepest reflex edges inside the part and between them; the plane
  // across its longest side.
  std::vector<HullPlane> candidates(const HullPart& part) const {
    const std::size_t clips = std::max<std::size_t>(1, part.surface.size() + part.caps.size());
    const std::size_t count = std::clamp<std::size_t>(kMostClips / clips, 4, kMostCandidates);
    std::vector<HullPlane> planes;
    const auto add = [&](const HullPlane& plane) {
      const auto is_same = [&](const HullPlane& other) {
        return std::abs(dot(unit(plane), unit(other))) > 1 - 1e-9 &&
               std::abs(static_cast<double>(other.side(plane.at))) < 4 * other.size();
      };
      if (planes.size() < count && std::ranges::none_of(planes, is_same)) planes.push_back(plane);
    };
    add(middle_plane(part));
    for (const ReflexEdge* edge : deepest(part)) {
      const Vec3 left = unit(edge->left), right = unit(edge->right);
      // The bisector holds the edge: its normal is across it.
      add(plane_of(left - right, edge->a));
      add(edge->left);
      add(edge->right);
    }
    return planes;
  }

  std::vector<const ReflexEdge*> deepest(const HullPart& part) const {
    std::vector<std::pair<double, const ReflexEdge*>> order;
    for (const ReflexEdge& edge : edges_) {
      const HullPoint middle{(edge.a.x + edge.b.x) / 2, (edge.a.y + edge.b.y) / 2,
                             (edge.a.z + edge.b.z) / 2};
      const auto is_inside = [&](const HullPlane& plane) {
        return static_cast<double>(plane.side(middle)) > 2 * plane.size();
      };
      if (!std::ranges::all_of(part.planes, is_inside)) continue;
      double depth = chunk_.diagonal;
      for (const auto& t : part.hull.triangles) {
        const HullPlane face = plane_through(part.hull.vertices[t[0]], part.hull.vertices[t[1]],
                                             part.hull.vertices[t[2]]);
        depth = std::min(depth, -static_cast<double>(face.side(middle)) / face.size());
      }
      order.emplace_back(-depth, &edge);
    }
    std::ranges::stable_sort(order, {}, [](const auto& each) { return each.first; });
    std::vector<const ReflexEdge*> edges;
    for (const auto& [depth, edge] : order) {
      edges.push_back(edge);
      if (edges.size() == kMostCandidates) break;
    }
    return edges;
  }

  static HullPlane middle_plane(const HullPart& part) {
    HullPoint low = part.hull.vertices[0], high = low;
    for (const HullPoint p : part.hull.vertices) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const std::array size{high.x - low.x, high.y - low.y, high.z - low.z};
    const auto axis = std::ranges::max_element(size) - size.begin();
    HullPlane plane{{}, {(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2}};
    plane.normal[static_cast<std::size_t>(axis)] = 1;
    return plane;
  }

  // Joins the pair that adds least, while that leaves the chunk good or there are too many.
  void join_all() {
    const std::size_t count = parts_.size();
    std::vector<std::vector<HullPart>> joined(count);  // [i][j], j < i
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < i; ++j) joined[i].push_back(join(parts_[i], parts_[j]));
    while (parts_.size() > 1) {
      std::size_t a = 0, b = 0;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < parts_.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
          const double added = joined[i][j].excess - parts_[i].excess - parts_[j].excess;
          if (added >= least) continue;
          least = added;
          a = i, b = j;
        }
      if (a == 0) return;
      if (parts_.size() <= most_hulls_) {
        if (total_excess() + least > most_volume_) return;
        if (measured(joined[a][b]) > most_distance_) {
          joined[a][b].excess = std::numeric_limits<double>::infinity();
          continue;
        }
      }
      parts_[b] = std::move(joined[a][b]);
      parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(a));
      joined.erase(joined.begin() + static_cast<std::ptrdiff_t>(a));
      for (std::size_t i = a; i < joined.size(); ++i)
        joined[i].erase(joined[i].begin() + static_cast<std::ptrdiff_t>(a));
      for (std::size_t j = 0; j < b; ++j) joined[b][j] = join(parts_[b], parts_[j]);
      for (std::size_t i = b + 1; i < parts_.size(); ++i) joined[i][b] = join(parts_[i], parts_[b]);
    }
  }

  HullPart join(const HullPart& a, const HullPart& b) const {
    HullPart both;
    both.volume = a.volume + b.volume;
    std::vector<HullPoint> corners = a.hull.vertices;
    for (const std::vector<HullPoint>* more : {&b.hull.vertices, &a.hull.missed, &b.hull.missed})
      corners.insert(corners.end(), more->begin(), more->end());
    std::ranges::sort(corners);
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    both.hull = convex_hull(corners, most_vertices_);
    both.excess = both.hull.volume() - both.volume;
    return both;
  }

  const HullChunk& chunk_;
  std::size_t most_hulls_, most_vertices_;
  double most_volume_, most_distance_;
  std::vector<ReflexEdge> edges_;
  std::vector<HullPart> parts_;
};

struct ChunkHulls {
  std::vector<ConvexHull> hulls;
  HullSet::Error error;
};

ChunkHulls hulls_of(Triangles surface, std::vector<HullPart> tiles, const HullParams& params) {
  std::erase_if(surface,
                [](const HullTriangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  if (surface.size() < 4) return {};
  const HullChunk chunk(std::move(surface));
  if (!(chunk.volume > 0)) return {};
  ChunkHulls result;
  double volume = 0, distance = 0;
  Decomposer decomposer(chunk, params);
  for (HullPart& part : decomposer.run(std::move(tiles))) {
    volume += part.hull.volume();
    distance = std::max(distance, decomposer.measured(part));
    result.hulls.push_back(std::move(part.hull));
  }
  result.error = {volume / chunk.volume - 1, distance / chunk.diagonal};
  return result;
}

// Lattice of a wall or solid: its farthest coordinate takes 24 bits, as in a float32.
class HullLattice {
 public:
  explicit HullLattice(double reach) {
    int exponent = 0;
    std::frexp(std::max(reach, 1e-30), &exponent);
    step_ = std::ldexp(1.0, exponent - 24);
  }
  HullPoint point(Vec3 p) const {
    const auto whole = [&](double x) { return static_cast<std::int32_t>(std::lround(x / step_)); };
    return {whole(p.x), whole(p.y), whole(p.z)};
  }
  float metres(std::int32_t x) const { return static_cast<float>(x * step_); }

 private:
  double step_ = 1;
};

double reach_of(std::span<const Vec3> points) {
  double reach = 0;
  for (const Vec3 p : points)
    reach = std::max({reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return reach;
}

void append(const ChunkHulls& chunk, const HullLattice& lattice, HullSet& set) {
  for (const ConvexHull& hull : chunk.hulls) {
    for (const HullPoint p : hull.vertices)
      for (const std::int32_t x : {p.x, p.y, p.z}) set.positions.push_back(lattice.metres(x));
    for (const auto& t : hull.triangles)
      for (const std::uint32_t v : t) set.indices.push_back(static_cast<std::uint16_t>(v));
    set.vertex_begin.push_back(static_cast<std::uint32_t>(set.positions.size() / 3));
    set.index_begin.push_back(static_cast<std::uint32_t>(set.indices.size()));
  }
  set.hull_begin.push_back(set.hull_count());
  set.errors.push_back(chunk.error);
}

// Chunks differ much in what they take, so each thread takes every so many-th.
HullSet all_hulls(std::uint32_t count, const HullLattice& lattice, int threads,
                  const std::function<ChunkHulls(std::uint32_t)>& make) {
  std::vector<ChunkHulls> chunks(count);
  const auto stride = static_cast<std::uint32_t>(std::max(threads, 1));
  const auto run = [&](std::uint32_t first) {
    for (std::uint32_t c = first; c < count; c += stride) chunks[c] = make(c);
  };
  std::vector<std::future<void>> others;
  for (std::uint32_t i = 1; i < stride; ++i)
    others.push_back(std::async(std::launch::async, run, i));
  run(0);
  for (std::future<void>& other : others) other.get();
  HullSet set;
  for (const ChunkHulls& chunk : chunks) append(chunk, lattice, set);
  return set;
}

// A convex polygon of a wall's pattern through the wall's thickness.
Triangles prism_of(const std::vector<HullPoint>& back, const std::vector<HullPoint>& front) {
  Triangles prism;
  const std::size_t count = back.size();
  for (std::size_t k = 2; k < count; ++k) {
    prism.push_back({front[0], front[k - 1], front[k]});
    prism.push_back({back[0], back[k], back[k - 1]});
  }
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t next = (k + 1) % count;
    prism.push_back({back[k], back[next], front[next]});
    prism.push_back({back[k], front[next], front[k]});
  }
  return prism;
}

std::vector<HullPart> tiles_of(const WallAsset& asset, std::uint32_t chunk,
                               const HullLattice& lattice) {
  const auto parts = convex_parts(asset, chunk);
  std::vector<HullPart> tiles;
  if (parts.size() == 1) return tiles;
  const double half = asset.wall.thickness / 2;
  for (const auto& polygon : parts) {
    std::vector<HullPoint> back, front;
    for (const std::uint32_t v : polygon) {
      const Vec2 p = asset.pattern.vertices[v];
      back.push_back(lattice.point({p.x, p.y, -half}));
      front.push_back(lattice.point({p.x, p.y, half}));
    }
    HullPart& tile = tiles.emplace_back();
    tile.surface = prism_of(back, front);
    tile.volume = signed_volume(tile.surface);
    if (!(tile.volume > 0)) return {};
  }
  return tiles;
}

constexpr std::string_view kNodes[] = {"none", "ucx", "convcol"};

}  // namespace

template <>
std::span<const Field<HullParams>> fields() {
  using P = HullParams;
  static const Field<P> table[] = {
      {.name = "nodes",
       .member = &P::nodes,
       .unit = "",
       .effect = "Convex hulls beside the chunks in .glb, .gltf and .obj, named as an engine wants "
                 "them: ucx (Unreal), convcol (Godot); none: no hulls.",
       .choices = kNodes},
      {"error",
       &P::error,
       "",
       "A chunk has several hulls where one is farther from it than this share of its bounding "
       "box's diagonal or exceeds its volume by this share.",
       {1e-4, 10}},
      {"max_hulls", &P::max_hulls, "", "Hulls per chunk at most, whatever their error.", {1, 64}},
      {"max_vertices", &P::max_vertices, "", "Vertices per hull at most.", {4, 255}},
      {"physics", &P::physics, "",
       "In .glb and .gltf every chunk is a rigid body with its hulls as colliders "
       "(KHR_physics_rigid_bodies)."},
  };
  return table;
}

HullSet wall_hulls(const WallAsset& asset, const HullParams& params, int threads) {
  double reach = asset.wall.thickness / 2;
  for (const Vec2 p : asset.pattern.vertices)
    reach = std::max({reach, std::abs(p.x), std::abs(p.y)});
  const HullLattice lattice(reach);
  return all_hulls(asset.pattern.cell_count(), lattice, threads, [&](std::uint32_t c) {
    const TriMesh mesh = chunk_mesh(asset, c).mesh;
    Triangles surface;
    for (const auto& t : mesh.triangles)
      surface.push_back({lattice.point(mesh.vertices[t[0]]), lattice.point(mesh.vertices[t[1]]),
                         lattice.point(mesh.vertices[t[2]])});
    return hulls_of(std::move(surface), tiles_of(asset, c, lattice), params);
  });
}

HullSet solid_hulls(const SolidAsset& asset, const HullParams& params, int threads) {
  const SolidPartition& all = asset.partition;
  const HullLattice lattice(reach_of(all.vertices));
  return all_hulls(all.chunk_count(), lattice, threads, [&](std::uint32_t c) {
    Triangles surface;
    for (std::uint32_t t = all.chunk_begin[c]; t < all.chunk_begin[c + 1]; ++t) {
      const auto& v = all.triangles[t].corners;
      surface.push_back({lattice.point(all.vertices[v[0]]), lattice.point(all.vertices[v[1]]),
                         lattice.point(all.vertices[v[2]])});
    }
    return hulls_of(std::move(surface), {}, params);
  });
}

}  // namespace sunder
