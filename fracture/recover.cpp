// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/recover.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <unordered_map>
#include <utility>

#include "fracture/chunk_mesh.hpp"
#include "fracture/recover_detail.hpp"
#include "meshing/error.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

struct FloatPoint {
  float x = 0, y = 0;
  friend auto operator<=>(const FloatPoint&, const FloatPoint&) = default;
};

// Loops of corners; the outer one counter-clockwise first, then holes, clockwise, each from its
// smallest corner on and in the order of these.
using FloatLoops = std::vector<std::vector<FloatPoint>>;

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

// --- one chunk
// ------------------------------------------------------------------------------------

// Reads chunks as prisms. A chunk is one if all its corners lie in the two planes, its triangles
// are each in one plane or upright over one edge, it is closed, and there are two upright triangles
// per edge of the front's boundary: what closes an upright triangle then is the other half of its
// quad, so the back mirrors the front.
class PrismReader {
 public:
  /// Empty when the chunk is one prism; else what it is instead.
  std::string read(const SoupChunk& chunk, FloatLoops& loops) {
    loops.clear();
    if (std::string fault = number_corners(chunk); !fault.empty()) return fault;
    if (std::string fault = sort_triangles(); !fault.empty()) return fault;
    return trace_loops(loops);
  }
  /// Half of the chunks' thickness; 0 before the first chunk.
  float half() const { return half_; }

 private:
  std::string number_corners(const SoupChunk& chunk) {
    points_.clear();
    corners_.clear();
    if (chunk.triangles.empty()) return "it has no triangles";
    for (const std::uint32_t v : chunk.triangles) {
      const float* p = chunk.positions.data() + std::size_t{3} * v;
      if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
        return "it has a corner that is not finite";
      if (half_ == 0) half_ = std::abs(p[2]);
      if (half_ == 0 || std::abs(p[2]) != half_) return fault_at(p);
      points_.push_back({p[0] + 0.f, p[1] + 0.f});  // -0 becomes 0
    }
    std::vector<FloatPoint> all = points_;
    std::ranges::sort(points_);
    points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto at = std::ranges::lower_bound(points_, all[i]) - points_.begin();
      const bool front = chunk.positions[std::size_t{3} * chunk.triangles[i] + 2] > 0;
      corners_.push_back(2 * static_cast<std::uint32_t>(at) + front);
    }
    return {};
  }

  std::string fault_at(const float* p) const {
    char text[160];
    std::snprintf(text, sizeof text,
                  "it has a corner at (%.9g, %.9g, %.9g), but the planes of the wall's faces are "
                  "z = -%.9g and z = %.9g",
                  double{p[0]}, double{p[1]}, double{p[2]}, double{half_}, double{half_});
    return text;
  }

  std::string sort_triangles() {
    edges_.clear();
    front_.clear();
    upright_count_ = 0;
    for (std::size_t t = 0; t < corners_.size(); t += 3) {
      const std::uint32_t* c = corners_.data() + t;
      const std::uint32_t fronts = (c[0] & 1) + (c[1] & 1) + (c[2] & 1);
      const std::array<std::uint32_t, 3> at{c[0] / 2, c[1] / 2, c[2] / 2};
      const bool upright = fronts == 1 || fronts == 2;
      if (upright && at[0] != at[1] && at[1] != at[2] && at[2] != at[0])
        return "it has a face that is neither in front nor at the back nor upright";
      upright_count_ += upright;
      for (std::size_t i = 0; i < 3; ++i) {
        if (c[i] == c[(i + 1) % 3]) return "it has a triangle with two equal corners";
        edges_.push_back(key(c[i], c[(i + 1) % 3]));
        if (fronts == 3) front_.push_back(key(at[i], at[(i + 1) % 3]));
      }
    }
    std::ranges::sort(edges_);
    std::ranges::sort(front_);
    if (std::ranges::adjacent_find(edges_) != edges_.end())
      return "it has an edge that two of its faces run along in the same direction";
    for (const std::uint64_t edge : edges_)
      if (!std::ranges::binary_search(edges_, reversed(edge))) return "it is not closed";
    return {};
  }

  std::string trace_loops(FloatLoops& loops) const {
    std::vector<std::uint32_t> next(points_.size(), kNone);
    std::size_t count = 0;
    for (const std::uint64_t edge : front_) {
      if (std::ranges::binary_search(front_, reversed(edge))) continue;
      next[edge >> 32] = static_cast<std::uint32_t>(edge);
      ++count;
    }
    if (upright_count_ != 2 * count) return "its back does not mirror its front";
    for (std::uint32_t start = 0; start < next.size(); ++start) {
      if (next[start] == kNone) continue;
      std::vector<FloatPoint>& loop = loops.emplace_back();
      for (std::uint32_t at = start; next[at] != kNone; --count) {
        loop.push_back(points_[at]);
        at = std::exchange(next[at], kNone);
      }
      if (loops.size() == 1 && !(area(loop) > 0)) return "it is inside out";
      if (loops.size() > 1 && !(area(loop) < 0)) return "it is not one solid";
    }
    if (count != 0) return "its front meets itself in a corner";
    return loops.empty() ? "it has no front" : std::string();
  }

  static double area(const std::vector<FloatPoint>& loop) {
    std::vector<Vec2> places;
    for (const FloatPoint& p : loop) places.push_back({p.x, p.y});
    return sunder::area(std::span<const Vec2>(places));
  }

  static std::uint64_t key(std::uint32_t from, std::uint32_t to) {
    return std::uint64_t{from} << 32 | to;
  }
  static std::uint64_t reversed(std::uint64_t edge) { return edge << 32 | edge >> 32; }

  float half_ = 0;
  std::vector<FloatPoint> points_;      // ascending
  std::vector<std::uint32_t> corners_;  // of triangles: 2 × point, + 1 in front
  std::vector<std::uint64_t> edges_, front_;
  std::size_t upright_count_ = 0;
};

// --- all chunks
// -----------------------------------------------------------------------------------

// Side of the box that holds the edge: 0 bottom, 1 right, 2 top, 3 left; 4: none.
std::uint32_t side_with(const Box& box, Vec2 a, Vec2 b) {
  if (a.y == box.low.y && b.y == box.low.y) return 0;
  if (a.x == box.high.x && b.x == box.high.x) return 1;
  if (a.y == box.high.y && b.y == box.high.y) return 2;
  return a.x == box.low.x && b.x == box.low.x ? 3 : 4;
}

class WallRecovery {
 public:
  WallRecovery(const SoupWall& soup, Wall wall, double density) : soup_(soup) {
    asset_.wall = std::move(wall);
    asset_.density = density;
  }

  WallAsset run() {
    read_chunks();
    pair_edges();
    trace_border();
    make_region();
    pattern_.all_convex = all_convex(pattern_);
    for (std::uint32_t c = 0; c < pattern_.cell_count(); ++c) {
      asset_.chunks.push_back(measured_chunk(asset_, c));
      asset_.volume_expected += asset_.chunks.back().volume;
    }
    asset_.bonds = find_bonds(pattern_, asset_.wall.thickness,
                              edges_on_anchored_sides(asset_.wall, asset_.region));
    return std::move(asset_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorCode::geometry, "wall " + asset_.wall.name + ": " + message);
  }
  std::string name_of(std::uint32_t chunk) const {
    WallAsset named;
    named.wall.name = asset_.wall.name;
    named.pattern.cell_begin.resize(soup_.chunk_count + std::size_t{1});
    return named.chunk_name(chunk);
  }

  void read_chunks() {
    if (!soup_.has_chunks) fail("the file keeps no chunks apart; use .glb, .gltf or .obj");
    if (soup_.chunk_count == 0) fail("it has no chunks");
    PrismReader reader;
    FloatLoops loops;
    for (std::uint32_t c = 0; c < soup_.chunk_count; ++c) {
      const std::string fault = reader.read(soup_.chunk(c), loops);
      if (!fault.empty())
        fail(name_of(c) + " is not a prism between two planes z = -t/2 and z = t/2: " + fault);
      add_cell(loops);
    }
    asset_.wall.thickness = 2 * double{reader.half()};
    pattern_.across.resize(pattern_.corners.size());
  }

  void add_cell(const FloatLoops& loops) {
    const auto cell = pattern_.cell_count();
    for (const auto& loop : loops) {
      const auto begin = static_cast<std::uint32_t>(pattern_.corners.size());
      if (&loop != &loops.front()) pattern_.hole_begin.push_back(begin);
      for (const FloatPoint& p : loop) {
        pattern_.corners.push_back(vertex_at(p));
        next_.push_back(static_cast<std::uint32_t>(pattern_.corners.size()));
        cell_.push_back(cell);
      }
      next_.back() = begin;
    }
    pattern_.cell_begin.push_back(static_cast<std::uint32_t>(pattern_.corners.size()));
  }

  std::uint32_t vertex_at(FloatPoint p) {
    const std::uint64_t key =
        std::uint64_t{std::bit_cast<std::uint32_t>(p.x)} << 32 | std::bit_cast<std::uint32_t>(p.y);
    const auto [it, added] =
        vertex_.try_emplace(key, static_cast<std::uint32_t>(pattern_.vertices.size()));
    if (added) pattern_.vertices.push_back({p.x, p.y});
    return it->second;
  }

  struct Edge {
    std::uint32_t low, high, corner;  // vertices; where it starts
    bool same_ends(const Edge& other) const { return low == other.low && high == other.high; }
    friend auto operator<=>(const Edge&, const Edge&) = default;
  };

  void pair_edges() {
    std::vector<Edge> edges;
    for (std::uint32_t k = 0; k < next_.size(); ++k) {
      const std::uint32_t a = pattern_.corners[k], b = pattern_.corners[next_[k]];
      edges.push_back({std::min(a, b), std::max(a, b), k});
    }
    std::ranges::sort(edges);
    twin_.assign(next_.size(), kNone);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (i + 1 == edges.size() || !edges[i].same_ends(edges[i + 1])) continue;
      const std::uint32_t k = edges[i].corner, l = edges[i + 1].corner;
      if (i + 2 < edges.size() && edges[i].same_ends(edges[i + 2])) fail_at(k, l, "more than two");
      if (pattern_.corners[k] == pattern_.corners[l]) fail_at(k, l, "two, on the same side,");
      twin_[k] = l, twin_[l] = k;
      pattern_.across[k] = Across::cell(cell_[l]);
      pattern_.across[l] = Across::cell(cell_[k]);
      ++i;
    }
  }

  [[noreturn]] void fail_at(std::uint32_t k, std::uint32_t l, const char* how_many) const {
    const Vec2 a = place(k), b = place(next_[k]);
    char text[128];
    std::snprintf(text, sizeof text, "the edge from (%.9g, %.9g) to (%.9g, %.9g) belongs to %s",
                  a.x, a.y, b.x, b.y, how_many);
    fail(text + std::string(" chunks, among them ") + name_of(cell_[k]) + " and " +
         name_of(cell_[l]));
  }

  Vec2 place(std::uint32_t corner) const { return pattern_.vertices[pattern_.corners[corner]]; }

  // Where loops touch in a vertex, the border goes on along the next edge around it that has the
  // same part of the wall on its left.
  void trace_border() {
    std::vector<std::uint8_t> seen(next_.size(), 0);
    for (std::uint32_t start = 0; start < next_.size(); ++start) {
      if (twin_[start] != kNone || seen[start]) continue;
      std::vector<std::uint32_t>& loop = border_.emplace_back();
      for (std::uint32_t k = start; !seen[k];) {
        seen[k] = 1;
        loop.push_back(k);
        k = next_[k];
        while (twin_[k] != kNone) k = next_[twin_[k]];
      }
    }
    std::ranges::stable_partition(border_, [&](const auto& loop) { return loop_area(loop) > 0; });
  }

  double loop_area(const std::vector<std::uint32_t>& loop) const {
    Loop places;
    for (const std::uint32_t k : loop) places.push_back(place(k));
    return area(std::span<const Vec2>(places));
  }

  void make_region() {
    LatticeRegion& region = asset_.region;
    for (const auto& loop : border_) {
      const std::size_t first = region.places.size();
      add_runs(loop);
      region.loop_begin.push_back(region.edge_count());
      const Loop places(region.places.begin() + static_cast<std::ptrdiff_t>(first),
                        region.places.end());
      const double loop_area = area(std::span<const Vec2>(places));
      if (first == 0) asset_.wall.region = {places, {}};
      if (loop_area < 0) asset_.wall.region.openings.push_back(places);
    }
    join_sides();
  }

  // One edge of the region per straight run of the loop's edges.
  void add_runs(const std::vector<std::uint32_t>& loop) {
    LatticeRegion& region = asset_.region;
    const auto turns_at = [&](std::size_t i) {
      const Vec2 a = place(loop[(i + loop.size() - 1) % loop.size()]), b = place(loop[i]);
      const Vec2 c = place(next_[loop[i]]);
      return orientation(a, b, c) != 0 || dot(b - a, c - b) <= 0;
    };
    std::size_t first = 0;
    while (first + 1 < loop.size() && !turns_at(first)) ++first;
    for (std::size_t step = 0; step < loop.size(); ++step) {
      const std::size_t i = (first + step) % loop.size();
      if (step == 0 || turns_at(i)) {
        region.corners.emplace_back();
        region.places.push_back(place(loop[i]));
      }
      pattern_.across[loop[i]] = Across::border(region.edge_count() - 1);
    }
  }

  // A cell that touches a side of the box twice has one anchor there.
  void join_sides() {
    const LatticeRegion& region = asset_.region;
    const Box box = bounding_box(region.places);
    std::uint32_t first[4] = {kNone, kNone, kNone, kNone};
    std::vector<std::uint32_t> stands_for(region.edge_count());
    for (std::uint32_t f = 0; f < region.edge_count(); ++f) {
      const std::uint32_t side = side_with(box, region.places[f], region.places[region.next(f)]);
      if (side < 4 && first[side] == kNone) first[side] = f;
      stands_for[f] = side < 4 ? first[side] : f;
    }
    for (Across& across : pattern_.across)
      if (across.is_border()) across = Across::border(stands_for[across.border()]);
  }

  const SoupWall& soup_;
  WallAsset asset_;
  Pattern& pattern_ = asset_.pattern;
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_;  // looked up only
  std::vector<std::uint32_t> next_, cell_, twin_;            // per corner
  std::vector<std::vector<std::uint32_t>> border_;           // loops of corners
};

}  // namespace

WallAsset recover_wall(const SoupWall& soup, Wall wall, double density) {
  return WallRecovery(soup, std::move(wall), density).run();
}

MassProperties measured_chunk(const WallAsset& asset, std::uint32_t chunk) {
  MassProperties result = mass_properties(chunk_mesh(asset, chunk).mesh);
  result.centroid.z = 0;  // the mid-plane is one of symmetry
  result.inertia.xz = result.inertia.yz = 0;
  return result;
}

std::vector<std::uint8_t> edges_on_anchored_sides(const Wall& wall, const LatticeRegion& region) {
  constexpr const char* kSides[] = {"bottom", "right", "top", "left", ""};
  const Box box = bounding_box(region.places);
  std::vector<std::uint8_t> anchored(region.edge_count(), 0);
  for (std::uint32_t f = 0; f < region.edge_count(); ++f) {
    const std::uint32_t side = side_with(box, region.places[f], region.places[region.next(f)]);
    anchored[f] = std::ranges::find(wall.anchors, kSides[side]) != wall.anchors.end();
  }
  return anchored;
}

bool all_convex(const Pattern& pattern) {
  for (std::uint32_t c = 0; c < pattern.cell_count(); ++c)
    if (!is_strictly_convex(pattern, c)) return false;
  return true;
}

WallAsset at_file_precision(const WallAsset& asset, int threads) {
  const RenderMeshes meshes = render_meshes(asset, threads);
  return recover_wall(soup_of(asset, meshes), asset.wall, asset.density);
}

}  // namespace sunder
