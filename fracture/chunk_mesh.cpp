// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/chunk_mesh.hpp"

#include <algorithm>
#include <cassert>
#include <map>

#include "meshing/error.hpp"
#include "meshing/parallel.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

// The flat outline of a chunk: its loops one after the other, corner by corner.
struct FlatCell {
  std::vector<Vec2> places;             // per corner
  std::vector<std::uint32_t> vertices;  // per corner: identity, equal where a loop meets itself
  std::vector<std::uint32_t> sides;     // per corner: corner of the pattern whose edge starts here
  std::vector<LoopRange> loops;
};

FlatCell flat_cell(const Pattern& pattern, std::uint32_t cell) {
  FlatCell flat;
  for (const LoopRange loop : loops_of(pattern, cell)) {
    const auto begin = static_cast<std::uint32_t>(flat.places.size());
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      flat.places.push_back(pattern.vertices[pattern.corners[k]]);
      flat.vertices.push_back(pattern.corners[k]);
      flat.sides.push_back(k);
    }
    flat.loops.push_back({begin, static_cast<std::uint32_t>(flat.places.size())});
  }
  return flat;
}

// Triangles over local vertices, and which local vertex each corner is.
struct LocalLoops {
  std::vector<Vec2> points;
  IndexLoops loops;
};

LocalLoops local_loops(const FlatCell& flat) {
  LocalLoops local;
  std::map<std::uint32_t, std::uint32_t> index;
  for (const LoopRange loop : flat.loops) {
    local.loops.emplace_back();
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      const auto [it, added] =
          index.try_emplace(flat.vertices[k], static_cast<std::uint32_t>(local.points.size()));
      if (added) local.points.push_back(flat.places[k]);
      local.loops.back().push_back(it->second);
    }
  }
  return local;
}

// Where a loop meets itself at a vertex, each visit is a corner of its own: the triangles between
// its outgoing and incoming edge belong to it. Turns vertex triangles into corner triangles.
std::vector<Triangle> split_touching_corners(const FlatCell& flat, const LocalLoops& local,
                                             const std::vector<Triangle>& triangles) {
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> triangle_at;  // directed edge → triangle
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::uint32_t i = 0; i < 3; ++i)
      triangle_at[{triangles[t][i], triangles[t][(i + 1) % 3]}] = t;
  std::vector<Triangle> result(triangles.size());
  for (std::size_t l = 0; l < flat.loops.size(); ++l)
    for (std::uint32_t k = flat.loops[l].begin; k < flat.loops[l].end; ++k) {
      const auto& loop = local.loops[l];
      const std::uint32_t v = loop[k - flat.loops[l].begin];
      std::uint32_t to = loop[flat.loops[l].next(k) - flat.loops[l].begin];
      // Around the vertex until the border; once round at most, should the loops be overturned.
      std::size_t turns = 0;
      for (auto it = triangle_at.find({v, to}); it != triangle_at.end() && turns < triangles.size();
           it = triangle_at.find({v, to}), ++turns) {
        const Triangle& t = triangles[it->second];
        const auto i = static_cast<std::size_t>(std::ranges::find(t, v) - t.begin());
        result[it->second][i] = k;
        to = t[(i + 2) % 3];
      }
    }
  return result;
}

std::vector<Triangle> triangulate_cell(const FlatCell& flat) {
  const LocalLoops local = local_loops(flat);
  return split_touching_corners(flat, local, triangulate(local.points, local.loops));
}

bool fan_is_sound(const FlatCell& flat) {
  if (flat.loops.size() != 1) return false;
  for (std::size_t i = 2; i < flat.places.size(); ++i)
    if (orientation(flat.places[0], flat.places[i - 1], flat.places[i]) <= 0) return false;
  return true;
}

std::vector<Triangle> fan(std::uint32_t size) {
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 2; i < size; ++i) triangles.push_back({0, i - 1, i});
  return triangles;
}

// A fan from corner 0 of a convex cell, unless a corner is so nearly straight that its triangle
// could have no area.
std::vector<Triangle> face_triangles(const Pattern& pattern, std::uint32_t cell,
                                     const FlatCell& flat) {
  bool clear = flat.loops.size() == 1;
  for (std::size_t i = 2; clear && i < flat.places.size(); ++i) {
    const Vec2 a = flat.places[i - 1] - flat.places[0], b = flat.places[i] - flat.places[0];
    clear = cross(a, b) > 1e-12 * length(a) * length(b);
  }
  if (clear && is_strictly_convex(pattern, cell))
    return fan(static_cast<std::uint32_t>(flat.places.size()));
  return triangulate_cell(flat);
}

// Neighbours must cut their common face along the same diagonal: from the back of the end that is
// lexicographically smaller to the front of the other.
template <class Point>
bool starts_at_first(const Point& from, const Point& to) {
  return from.x < to.x || (from.x == to.x && from.y < to.y);
}

}  // namespace

ChunkMesh chunk_mesh(const WallAsset& asset, std::uint32_t chunk) {
  const Pattern& pattern = asset.pattern;
  const FlatCell flat = flat_cell(pattern, chunk);
  const auto size = static_cast<std::uint32_t>(flat.places.size());
  const double half = asset.wall.thickness / 2;
  ChunkMesh result;
  for (const double z : {-half, half})
    for (const Vec2& p : flat.places) result.mesh.vertices.push_back({p.x, p.y, z});
  const auto add = [&](Triangle t, FaceKind kind) {
    result.mesh.triangles.push_back(t);
    result.kinds.push_back(kind);
  };
  const std::vector<Triangle> face = face_triangles(pattern, chunk, flat);
  for (const Triangle& t : face) add({size + t[0], size + t[1], size + t[2]}, FaceKind::front);
  for (const Triangle& t : face) add({t[0], t[2], t[1]}, FaceKind::back);
  for (const LoopRange loop : flat.loops)
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      const std::uint32_t l = loop.next(k);
      const FaceKind kind =
          pattern.across[flat.sides[k]].is_border() ? FaceKind::border : FaceKind::inner;
      const bool first = starts_at_first(flat.places[k], flat.places[l]);
      const std::uint32_t quad[4] = {k, l, size + l, size + k};
      const int s = first ? 0 : 1;
      add({quad[s], quad[s + 1], quad[s + 2]}, kind);
      add({quad[s], quad[s + 2], quad[(s + 3) % 4]}, kind);
    }
  return result;
}

std::vector<std::vector<std::uint32_t>> convex_parts(const WallAsset& asset, std::uint32_t chunk) {
  const Pattern& pattern = asset.pattern;
  const FlatCell flat = flat_cell(pattern, chunk);
  if (is_strictly_convex(pattern, chunk)) return {flat.vertices};
  const LocalLoops local = local_loops(flat);
  std::vector<std::uint32_t> vertex_at(local.points.size());
  for (std::size_t l = 0; l < flat.loops.size(); ++l)
    for (std::uint32_t k = flat.loops[l].begin; k < flat.loops[l].end; ++k)
      vertex_at[local.loops[l][k - flat.loops[l].begin]] = flat.vertices[k];
  std::vector<std::vector<std::uint32_t>> parts = convex_parts(local.points, local.loops);
  for (auto& part : parts)
    for (std::uint32_t& v : part) v = vertex_at[v];
  return parts;
}

namespace {

struct FloatPoint {
  float x = 0, y = 0;
  friend bool operator==(const FloatPoint&, const FloatPoint&) = default;
};

// Writes vertices of one chunk one after the other.
struct VertexWriter {
  float *position, *normal, *uv;
  void put(FloatPoint p, float z, Vec3 n, double u, double v) {
    *position++ = p.x, *position++ = p.y, *position++ = z;
    *normal++ = static_cast<float>(n.x), *normal++ = static_cast<float>(n.y);
    *normal++ = static_cast<float>(n.z);
    *uv++ = static_cast<float>(u), *uv++ = static_cast<float>(v);
  }
};

class RenderMesher {
 public:
  explicit RenderMesher(const WallAsset& asset)
      : asset_(asset),
        pattern_(asset.pattern),
        half_(static_cast<float>(asset.wall.thickness / 2)) {
    points_.reserve(pattern_.vertices.size());
    for (const Vec2& v : pattern_.vertices)
      points_.push_back({static_cast<float>(v.x), static_cast<float>(v.y)});
    for (std::uint32_t f = 0; f < asset.region.edge_count(); ++f) {
      const Vec2 a = asset.region.places[f], b = asset.region.places[asset.region.next(f)];
      border_.push_back({a, (1 / length(b - a)) * (b - a)});
    }
  }

  RenderMeshes run(int threads) {
    const std::uint32_t count = pattern_.cell_count();
    result_.outer.resize(count);
    result_.inner.resize(count);
    result_.vertex_begin.resize(count + 1);
    for (std::uint32_t c = 0; c < count; ++c) plan(c);
    const std::size_t total = result_.vertex_begin.back();
    result_.positions.resize(3 * total);
    result_.normals.resize(3 * total);
    result_.uvs.resize(2 * total);
    for_each_range(count, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) write(static_cast<std::uint32_t>(c));
    });
    return std::move(result_);
  }

 private:
  struct BorderEdge {
    Vec2 start, direction;
  };

  LoopRange range(std::uint32_t c) const {
    return {pattern_.cell_begin[c], pattern_.cell_begin[c + 1]};
  }

  // True when the rounded cell is one loop of distinct corners whose fan has no flat triangle.
  bool is_plain(std::uint32_t c) const {
    if (!pattern_.hole_begin.empty() && loops_of(pattern_, c).size() > 1) return false;
    const LoopRange loop = range(c);
    const auto at = [&](std::uint32_t k) {
      const FloatPoint p = points_[pattern_.corners[k]];
      return Vec2{p.x, p.y};
    };
    const Vec2 base = at(loop.begin);
    Vec2 before = at(loop.end - 1), here = base;
    bool convex = true;
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      const Vec2 after = at(loop.next(k));
      // Differences of floats are exact in double, the products' error is far below 1e-12.
      const double turn = cross(here - before, after - here);
      convex &= turn > 1e-12 * (length_bound(here - before) * length_bound(after - here));
      before = here, here = after;
    }
    return convex && (pattern_.all_convex || winds_once(loop));
  }

  static double length_bound(Vec2 v) { return std::abs(v.x) + std::abs(v.y); }

  bool winds_once(LoopRange loop) const {
    int descents = 0;
    const auto leftward = [&](std::uint32_t k) {
      const FloatPoint a = points_[pattern_.corners[k]];
      const FloatPoint b = points_[pattern_.corners[loop.next(k)]];
      return b.x < a.x || (b.x == a.x && b.y < a.y);
    };
    for (std::uint32_t k = loop.begin; k < loop.end; ++k)
      descents += leftward(k) && !leftward(loop.next(k));
    return descents == 1;
  }

  void plan(std::uint32_t c) {
    std::uint32_t corners = 0;
    if (is_plain(c)) {
      const LoopRange loop = range(c);
      corners = loop.size();
      std::uint32_t borders = 0;
      for (std::uint32_t k = loop.begin; k < loop.end; ++k)
        borders += pattern_.across[k].is_border();
      result_.outer[c] = plain_list(corners, borders, true);
      result_.inner[c] = plain_list(corners, borders, false);
    } else {
      odd_.emplace(c, rounded_cell(c));
      const FlatCell& flat = odd_.at(c);
      corners = static_cast<std::uint32_t>(flat.places.size());
      plan_odd(c, flat);
    }
    const std::uint64_t next = std::uint64_t{result_.vertex_begin[c]} + 6 * corners;
    if (next > 0xFFFFFFFFu)
      throw Error(ErrorCode::geometry, "wall " + asset_.wall.name + " has too many chunks to mesh");
    result_.vertex_begin[c + 1] = static_cast<std::uint32_t>(next);
  }

  // The cell in float coordinates, edges dropped whose ends became one point.
  FlatCell rounded_cell(std::uint32_t c) {
    const FlatCell exact = flat_cell(pattern_, c);
    FlatCell flat;
    for (const LoopRange loop : exact.loops) {
      const auto begin = static_cast<std::uint32_t>(flat.places.size());
      for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
        const FloatPoint p = points_[exact.vertices[k]];
        if (p == points_[exact.vertices[loop.next(k)]]) {
          ++result_.edges_dropped;
          continue;
        }
        flat.places.push_back({p.x, p.y});
        flat.vertices.push_back(exact.vertices[k]);
        flat.sides.push_back(exact.sides[k]);
      }
      flat.loops.push_back({begin, static_cast<std::uint32_t>(flat.places.size())});
      if (flat.loops.back().size() >= 3) continue;
      if (flat.loops.size() == 1)
        throw Error(ErrorCode::geometry,
                    "wall " + asset_.wall.name + ": " + asset_.chunk_name(c) +
                        " is smaller than float32 can tell apart in a file; use larger cells or "
                        "a larger min_cell");
      flat.places.resize(begin);
      flat.vertices.resize(begin);
      flat.sides.resize(begin);
      flat.loops.pop_back();
    }
    return flat;
  }

  bool is_border(const FlatCell& flat, std::uint32_t k) const {
    return pattern_.across[flat.sides[k]].is_border();
  }

  void plan_odd(std::uint32_t c, const FlatCell& flat) {
    const auto size = static_cast<std::uint32_t>(flat.places.size());
    std::vector<std::uint32_t> outer, inner;
    const std::vector<Triangle> face = fan_is_sound(flat) ? fan(size) : triangulate_cell(flat);
    for (const Triangle& t : face) outer.insert(outer.end(), t.begin(), t.end());
    for (const Triangle& t : face)
      for (const std::uint32_t k : {t[0], t[2], t[1]}) outer.push_back(size + k);
    std::uint32_t next = 2 * size;
    for (std::uint32_t k = 0; k < size; ++k)
      if (is_border(flat, k)) add_quad(outer, next);
    for (std::uint32_t k = 0; k < size; ++k)
      if (!is_border(flat, k)) add_quad(inner, next);
    result_.outer[c] = list_of(outer);
    result_.inner[c] = inner.empty() ? RenderMeshes::kNoList : list_of(inner);
  }

  static void add_quad(std::vector<std::uint32_t>& list, std::uint32_t& next) {
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) list.push_back(next + i);
    next += 4;
  }

  // Index lists of convex chunks depend only on the numbers of corners and border edges.
  std::uint32_t plain_list(std::uint32_t corners, std::uint32_t borders, bool outer) {
    if (!outer && corners == borders) return RenderMeshes::kNoList;
    const std::size_t key = (corners * std::size_t{64} + borders) * 2 + outer;
    if (borders < 64) {
      if (plain_.size() <= key) plain_.resize(key + 1, RenderMeshes::kNoList);
      if (plain_[key] != RenderMeshes::kNoList) return plain_[key];
    }
    std::vector<std::uint32_t> list;
    std::uint32_t next = 2 * corners;
    if (outer) {
      for (const Triangle& t : fan(corners)) list.insert(list.end(), t.begin(), t.end());
      for (const Triangle& t : fan(corners))
        for (const std::uint32_t k : {t[0], t[2], t[1]}) list.push_back(corners + k);
      for (std::uint32_t i = 0; i < borders; ++i) add_quad(list, next);
    } else {
      next += 4 * borders;
      for (std::uint32_t i = borders; i < corners; ++i) add_quad(list, next);
    }
    const std::uint32_t id = list_of(list);
    if (borders < 64) plain_[key] = id;
    return id;
  }

  std::uint32_t list_of(const std::vector<std::uint32_t>& list) {
    const auto [it, added] =
        list_id_.try_emplace(list, static_cast<std::uint32_t>(result_.lists.size()));
    if (added) {
      result_.lists.push_back({static_cast<std::uint32_t>(result_.indices.size()),
                               static_cast<std::uint32_t>(list.size())});
      result_.indices.insert(result_.indices.end(), list.begin(), list.end());
    }
    return it->second;
  }

  VertexWriter writer(std::uint32_t c) {
    const std::size_t at = result_.vertex_begin[c];
    return {result_.positions.data() + 3 * at, result_.normals.data() + 3 * at,
            result_.uvs.data() + 2 * at};
  }

  void write(std::uint32_t c) {
    VertexWriter out = writer(c);
    if (!odd_.empty())
      if (const auto it = odd_.find(c); it != odd_.end()) return write_odd(it->second, out);
    const LoopRange loop = range(c);
    for (const float side : {1.f, -1.f})
      for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
        const FloatPoint p = points_[pattern_.corners[k]];
        out.put(p, side * half_, {0, 0, side}, p.x, p.y);
      }
    for (const bool border : {true, false})
      for (std::uint32_t k = loop.begin; k < loop.end; ++k)
        if (pattern_.across[k].is_border() == border)
          put_quad(out, pattern_.corners[k], pattern_.corners[loop.next(k)], pattern_.across[k]);
  }

  void write_odd(const FlatCell& flat, VertexWriter out) {
    for (const float side : {1.f, -1.f})
      for (const std::uint32_t v : flat.vertices)
        out.put(points_[v], side * half_, {0, 0, side}, points_[v].x, points_[v].y);
    for (const bool border : {true, false})
      for (const LoopRange loop : flat.loops)
        for (std::uint32_t k = loop.begin; k < loop.end; ++k)
          if (is_border(flat, k) == border)
            put_quad(out, flat.vertices[k], flat.vertices[loop.next(k)],
                     pattern_.across[flat.sides[k]]);
  }

  // Counter-clockwise seen from outside, started so that its first diagonal is the common one.
  void put_quad(VertexWriter& out, std::uint32_t from, std::uint32_t to, Across across) const {
    const Vec2 a = pattern_.vertices[from], b = pattern_.vertices[to];
    const FloatPoint p = points_[from], q = points_[to];
    const Vec2 edge = b - a;
    const double size = length(edge);
    const Vec3 normal{edge.y / size, -edge.x / size, 0};
    double u = 0, w = size;
    const bool first = starts_at_first(p, q);
    if (across.is_border()) {
      const BorderEdge& line = border_[across.border()];
      u = dot(a - line.start, line.direction);
      w = dot(b - line.start, line.direction);
    } else if (!first) {
      std::swap(u, w);  // both sides of a crack measure from the same end
    }
    const double depth = 2 * double{half_};
    if (first) out.put(p, -half_, normal, u, 0);
    out.put(q, -half_, normal, w, 0);
    out.put(q, half_, normal, w, depth);
    out.put(p, half_, normal, u, depth);
    if (!first) out.put(p, -half_, normal, u, 0);
  }

  const WallAsset& asset_;
  const Pattern& pattern_;
  float half_;
  std::vector<FloatPoint> points_;
  std::vector<BorderEdge> border_;
  std::map<std::uint32_t, FlatCell> odd_;
  std::vector<std::uint32_t> plain_;
  std::map<std::vector<std::uint32_t>, std::uint32_t> list_id_;
  RenderMeshes result_;
};

}  // namespace

RenderMeshes render_meshes(const WallAsset& asset, int threads) {
  return RenderMesher(asset).run(threads);
}

}  // namespace sunder
