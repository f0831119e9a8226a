// SPDX-License-Identifier: GPL-3.0-or-later
#include "fracture/measure.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "meshing/random.hpp"
#include "meshing/region.hpp"
#include "meshing/self_crossing.hpp"
#include "meshing/surface_defects.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

constexpr double kVolumeTolerance = 1e-6;  // float32 positions round to 6e-8 of the wall
constexpr double kThinnest = 1.0 / 50;

// Numbers points by their bits; open addressing, so that a million points cost no allocations.
class PointTable {
 public:
  std::uint32_t id(const float* p) {
    if (2 * (points_.size() + 1) > slots_.size()) grow();
    const std::array<float, 3> key{p[0] + 0.f, p[1] + 0.f, p[2] + 0.f};  // -0 becomes 0
    std::uint32_t& slot = find(key);
    if (slot == kEmpty) {
      slot = static_cast<std::uint32_t>(points_.size());
      points_.push_back(key);
    }
    return slot;
  }
  std::size_t size() const { return points_.size(); }
  Vec3 point(std::uint32_t id) const { return {points_[id][0], points_[id][1], points_[id][2]}; }

 private:
  static constexpr std::uint32_t kEmpty = 0xFFFFFFFFu;

  std::uint32_t& find(const std::array<float, 3>& key) {
    const auto bits = [&](int i) { return std::uint64_t{std::bit_cast<std::uint32_t>(key[i])}; };
    std::size_t at = mix_bits(mix_bits(bits(0) << 32 | bits(1)) ^ bits(2));
    for (;; ++at) {
      std::uint32_t& slot = slots_[at & (slots_.size() - 1)];
      if (slot == kEmpty || points_[slot] == key) return slot;
    }
  }

  void grow() {
    slots_.assign(std::max<std::size_t>(64, 2 * slots_.size()), kEmpty);
    for (std::uint32_t i = 0; i < points_.size(); ++i) find(points_[i]) = i;
  }

  std::vector<std::array<float, 3>> points_;
  std::vector<std::uint32_t> slots_;
};

struct CrackTriangle {
  std::array<std::uint32_t, 3> points;  // ascending
  bool even;                            // orientation of the ascending order
  std::uint32_t chunk;
};

struct FrontTriangle {
  std::array<Vec2, 3> at;  // counter-clockwise
  std::uint32_t chunk;
};

// Triangles over the table's points, as a mesh of the points that they use.
class PointTriangles {
 public:
  void clear() { triangles_.clear(); }
  void add(const std::array<std::uint32_t, 3>& points) { triangles_.push_back(points); }
  TriMesh mesh(const PointTable& table) {
    TriMesh result;
    local_.resize(table.size(), kNone);
    for (const auto& t : triangles_) {
      auto& triangle = result.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        if (local_[t[k]] == kNone) {
          local_[t[k]] = static_cast<std::uint32_t>(result.vertices.size());
          result.vertices.push_back(table.point(t[k]));
        }
        triangle[k] = local_[t[k]];
      }
    }
    for (const auto& t : triangles_)
      for (const std::uint32_t id : t) local_[id] = kNone;
    return result;
  }

 private:
  static constexpr std::uint32_t kNone = ~0u;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> local_;  // vertex of each point while a mesh is made
};

// Measures one wall into a Soundness.
class WallMeasure {
 public:
  WallMeasure(const SoupWall& wall, Soundness& result) : wall_(wall), result_(result) {}

  void run(const std::function<void(double)>& progress) {
    is_solid_ = wall_.kind == SoupWall::Kind::solid;
    if (wall_.has_chunks && !is_solid_) {
      const bool is_prism = choose_front();
      is_solid_ = wall_.kind == SoupWall::Kind::unknown && !is_prism;
    }
    for (std::uint32_t c = 0; c < wall_.chunk_count; ++c) {
      const SoupChunk chunk = wall_.chunk(c);
      measure_chunk(c, chunk);
      if (c % 4096 == 0) progress(0.8 * c / wall_.chunk_count);
    }
    match_cracks();
    progress(0.9);
    if (wall_.has_chunks) is_solid_ ? find_repeated_faces() : find_overlaps();
    if (is_solid_ && wall_.has_chunks)
      result_.crossing_surfaces += is_tangled(surface_.mesh(points_));
    result_.chunks += wall_.chunk_count;
    result_.bonds += wall_.bonds;
  }

 private:
  static Vec3 point(const SoupChunk& chunk, std::uint32_t v) {
    const float* p = chunk.positions.data() + std::size_t{3} * v;
    return {p[0], p[1], p[2]};
  }

  static bool is_outer(const SoupChunk& chunk, std::size_t t) {
    return chunk.inner.empty() || !chunk.inner[t];
  }

  // Crack faces all contain the direction of the wall's thickness: it is perpendicular to any two
  // of them that are not parallel. With fewer, it is the direction of most of the outer area that
  // is left to choose from. Looks at some of the chunks only. False: there is no such direction.
  bool choose_front() {
    std::vector<Vec3> cracks, outer;  // unit normals; area vectors, one per direction
    const std::uint32_t step = 1 + wall_.chunk_count / 64;
    for (std::uint32_t c = 0; c < wall_.chunk_count; c += step) {
      const SoupChunk chunk = wall_.chunk(c);
      for (std::size_t t = 0; 3 * t < chunk.triangles.size(); ++t) {
        const Vec3 n = twice_area(chunk, t);
        if (!(length(n) > 0)) continue;
        if (!is_outer(chunk, t))
          cracks.push_back((1 / length(n)) * n);
        else
          add_direction(outer, n);
      }
    }
    if (is_axis({0, 0, 1}, cracks, outer)) return true;  // the frame that walls are written in
    Vec3 axis;
    for (const Vec3& crack : cracks)
      if (const Vec3 n = cross(cracks[0], crack); length(n) > length(axis)) axis = n;
    if (length(axis) < 1e-3) {
      axis = {};
      for (const Vec3& n : outer)
        if (is_axis((1 / length(n)) * n, cracks, outer) && length(n) > length(axis)) axis = n;
    }
    if (!(length(axis) > 0)) return false;
    normal_ = (1 / length(axis)) * axis;
    if (std::abs(normal_.z) > 1 - 1e-12) {
      normal_.z > 0 ? (right_ = {1, 0, 0}, up_ = {0, 1, 0}) : (right_ = {0, 1, 0}, up_ = {1, 0, 0});
      return is_axis(normal_, cracks, outer);
    }
    right_ = cross(std::abs(normal_.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, normal_);
    right_ = (1 / length(right_)) * right_;
    up_ = cross(normal_, right_);
    return is_axis(normal_, cracks, outer);
  }

  // Whether all cracks contain the direction and every outer face either contains or faces it.
  static bool is_axis(Vec3 axis, const std::vector<Vec3>& cracks, const std::vector<Vec3>& outer) {
    constexpr double kTilt = 1e-4;
    bool faced = false;
    for (const Vec3& n : cracks)
      if (std::abs(dot(n, axis)) > kTilt) return false;
    for (const Vec3& n : outer) {
      const double share = std::abs(dot(n, axis)) / length(n);
      if (share > kTilt && share < 1 - kTilt) return false;
      faced |= share >= 1 - kTilt;
    }
    return faced;
  }

  static void add_direction(std::vector<Vec3>& sums, Vec3 n) {
    const auto same = std::ranges::find_if(
        sums, [&](const Vec3& sum) { return dot(sum, n) > 0.999 * length(sum) * length(n); });
    if (same != sums.end())
      *same = *same + n;
    else if (sums.size() < 64)
      sums.push_back(n);
  }

  static Vec3 twice_area(const SoupChunk& chunk, std::size_t t) {
    const Vec3 a = point(chunk, chunk.triangles[3 * t]);
    return cross(point(chunk, chunk.triangles[3 * t + 1]) - a,
                 point(chunk, chunk.triangles[3 * t + 2]) - a);
  }

  void measure_chunk(std::uint32_t c, const SoupChunk& chunk) {
    ids_.resize(chunk.positions.size() / 3);
    for (std::size_t v = 0; v < ids_.size(); ++v)
      ids_[v] = points_.id(chunk.positions.data() + 3 * v);
    const std::size_t count = chunk.triangles.size() / 3;
    result_.triangles += count;
    edges_.clear();
    chunk_.clear();
    double volume = 0;
    const Vec3 base = count > 0 ? point(chunk, chunk.triangles[0]) : Vec3{};
    for (std::size_t t = 0; t < count; ++t) {
      const std::uint32_t* v = chunk.triangles.data() + 3 * t;
      const std::array<std::uint32_t, 3> id{ids_[v[0]], ids_[v[1]], ids_[v[2]]};
      for (int i = 0; i < 3; ++i) edges_.push_back(std::uint64_t{id[i]} << 32 | id[(i + 1) % 3]);
      volume += dot(point(chunk, v[0]) - base,
                    cross(point(chunk, v[1]) - base, point(chunk, v[2]) - base)) /
                6;
      add_to_hash(chunk, v);
      if (!is_outer(chunk, t)) {
        add_triangle(id, c, cracks_);
      } else if (is_solid_) {
        add_triangle(id, c, outer_);
        surface_.add(id);
      }
      if (is_solid_) chunk_.add(id);
    }
    count_edges(volume);
    if (wall_.has_chunks && is_solid_)
      result_.self_crossing_chunks += is_tangled(chunk_.mesh(points_));
    result_.volume += volume;
    result_.min_chunk_volume = std::min(result_.min_chunk_volume, volume);
    if (wall_.has_chunks) is_solid_ ? judge_thickness(chunk, volume) : add_front(c, chunk);
  }

  void judge_thickness(const SoupChunk& chunk, double volume) {
    constexpr double kLeastShare = 1e-3;
    if (chunk.triangles.empty()) return;
    Vec3 low = point(chunk, chunk.triangles[0]), high = low;
    for (const std::uint32_t v : chunk.triangles) {
      const Vec3 p = point(chunk, v);
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const double diagonal = length(high - low);
    result_.slivers += volume < kLeastShare * diagonal * diagonal * diagonal;
  }

  void add_to_hash(const SoupChunk& chunk, const std::uint32_t* triangle) {
    for (int i = 0; i < 3; ++i)
      for (int axis = 0; axis < 3; ++axis) {
        const float value = chunk.positions[std::size_t{3} * triangle[i] + axis] + 0.f;
        result_.hash = mix_bits(result_.hash ^ std::bit_cast<std::uint32_t>(value)) + 1;
      }
  }

  static void add_triangle(std::array<std::uint32_t, 3> id, std::uint32_t chunk,
                           std::vector<CrackTriangle>& triangles) {
    const auto least = std::ranges::min_element(id) - id.begin();
    std::ranges::rotate(id, id.begin() + least);
    const bool even = id[1] < id[2];
    if (!even) std::swap(id[1], id[2]);
    triangles.push_back({id, even, chunk});
  }

  void count_edges(double volume) {
    std::ranges::sort(edges_);
    bool open = false, repeated = false;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const std::uint64_t reverse = edges_[i] << 32 | edges_[i] >> 32;
      repeated |= i > 0 && edges_[i] == edges_[i - 1];
      const auto [first, last] = std::ranges::equal_range(edges_, reverse);
      if (wall_.has_chunks) {
        open |= first == last;
      } else {
        const auto [own, own_end] = std::ranges::equal_range(edges_, edges_[i]);
        open |= last - first != own_end - own;
      }
    }
    result_.open_chunks += open;
    result_.nonmanifold_chunks += wall_.has_chunks && repeated;
    result_.inverted_chunks += !open && !(volume > 0);
  }

  void match_cracks() {
    std::ranges::sort(cracks_, {},
                      [](const CrackTriangle& t) { return std::tuple(t.points, t.even, t.chunk); });
    for (std::size_t i = 0; i < cracks_.size();) {
      std::size_t end = i;
      while (end < cracks_.size() && cracks_[end].points == cracks_[i].points) ++end;
      const bool matched = end - i == 2 && cracks_[i].even != cracks_[i + 1].even &&
                           cracks_[i].chunk != cracks_[i + 1].chunk;
      if (!matched) result_.unmatched_faces += end - i;
      i = end;
    }
  }

  // Outer faces of a sound partition are parts of one surface, each there once.
  void find_repeated_faces() {
    std::ranges::sort(outer_, {},
                      [](const CrackTriangle& t) { return std::tuple(t.points, t.chunk); });
    for (std::size_t i = 1; i < outer_.size(); ++i) {
      const CrackTriangle &a = outer_[i - 1], &b = outer_[i];
      if (a.points == b.points && a.chunk != b.chunk) pairs_.push_back({a.chunk, b.chunk});
    }
    count_pairs();
  }

  void count_pairs() {
    std::ranges::sort(pairs_);
    result_.overlapping_pairs +=
        static_cast<std::uint64_t>(std::unique(pairs_.begin(), pairs_.end()) - pairs_.begin());
  }

  void add_front(std::uint32_t c, const SoupChunk& chunk) {
    Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
    double area = 0;
    for (std::size_t t = 0; 3 * t < chunk.triangles.size(); ++t) {
      if (!is_outer(chunk, t)) continue;
      const Vec3 n = twice_area(chunk, t);
      if (!(dot(n, normal_) > 0.99 * length(n))) continue;
      FrontTriangle front{{}, c};
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 p = point(chunk, chunk.triangles[3 * t + i]);
        front.at[i] = {dot(p, right_), dot(p, up_)};
        if (!std::isfinite(front.at[i].x + front.at[i].y))
          return;  // the volume is not finite either
        low = {std::min(low.x, front.at[i].x), std::min(low.y, front.at[i].y)};
        high = {std::max(high.x, front.at[i].x), std::max(high.y, front.at[i].y)};
      }
      if (orientation(front.at[0], front.at[1], front.at[2]) <= 0) continue;
      fronts_.push_back(front);
      area += length(n) / 2;
    }
    const double extent = dot(high - low, high - low);
    result_.slivers += area > 0 && area < kThinnest * extent;
    front_area_ += area;
  }

  // Whether an edge of a has all of b on its far side; boxes first.
  static bool separates(const FrontTriangle& a, const FrontTriangle& b) {
    for (std::size_t i = 0; i < 3; ++i) {
      bool apart = true;
      for (const Vec2& p : b.at) apart &= orientation(a.at[i], a.at[(i + 1) % 3], p) <= 0;
      if (apart) return true;
    }
    return false;
  }

  struct Entry {
    std::int64_t bucket;
    std::uint32_t triangle;
    friend auto operator<=>(const Entry&, const Entry&) = default;
  };

  // Pairs of front triangles that share a bucket of a grid, then separating edges, exactly. A
  // triangle over many buckets is compared with all others by its box instead, so that no file can
  // ask for more memory than a multiple of its size.
  void find_overlaps() {
    if (fronts_.empty()) return;
    Vec2 low = fronts_[0].at[0], high = low;
    for (const FrontTriangle& t : fronts_) {
      const Box box = bounding_box(t.at);
      low = {std::min(low.x, box.low.x), std::min(low.y, box.low.y)};
      high = {std::max(high.x, box.high.x), std::max(high.y, box.high.y)};
    }
    constexpr double kMostBuckets = 4096;  // per axis
    const double size =
        std::max({2 * std::sqrt(front_area_ / static_cast<double>(fronts_.size())),
                  (high.x - low.x) / kMostBuckets, (high.y - low.y) / kMostBuckets});
    std::vector<Entry> entries;
    std::vector<std::uint32_t> large;
    for (std::uint32_t t = 0; t < fronts_.size(); ++t) {
      const Box box = bounding_box(fronts_[t].at);
      const auto bucket = [&](double v) { return static_cast<std::int64_t>(v / size); };
      const std::int64_t x0 = bucket(box.low.x - low.x), x1 = bucket(box.high.x - low.x);
      const std::int64_t y0 = bucket(box.low.y - low.y), y1 = bucket(box.high.y - low.y);
      if ((x1 - x0 + 1) * (y1 - y0 + 1) > 64) {
        large.push_back(t);
        continue;
      }
      for (std::int64_t x = x0; x <= x1; ++x)
        for (std::int64_t y = y0; y <= y1; ++y) entries.push_back({x << 32 | y, t});
    }
    std::ranges::sort(entries);
    for (std::size_t i = 0; i < entries.size(); ++i)
      for (std::size_t j = i + 1; j < entries.size() && entries[j].bucket == entries[i].bucket; ++j)
        compare_fronts(entries[i].triangle, entries[j].triangle);
    for (const std::uint32_t a : large)
      for (std::uint32_t b = 0; b < fronts_.size(); ++b) compare_fronts(a, b);
    count_pairs();
  }

  void compare_fronts(std::uint32_t i, std::uint32_t j) {
    const FrontTriangle& a = fronts_[i];
    const FrontTriangle& b = fronts_[j];
    if (a.chunk == b.chunk || separates(a, b) || separates(b, a)) return;
    pairs_.push_back({std::min(a.chunk, b.chunk), std::max(a.chunk, b.chunk)});
  }

  const SoupWall& wall_;
  Soundness& result_;
  PointTable points_;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint64_t> edges_;
  std::vector<CrackTriangle> cracks_, outer_;
  PointTriangles chunk_, surface_;
  bool is_solid_ = false;
  std::vector<FrontTriangle> fronts_;
  std::vector<std::array<std::uint32_t, 2>> pairs_;
  Vec3 normal_{0, 0, 1}, right_{1, 0, 0}, up_{0, 1, 0};
  double front_area_ = 0;
};

}  // namespace

double Soundness::volume_error() const {
  return std::abs(volume - volume_expected) / volume_expected;
}

bool Soundness::is_sound() const {
  const bool volume_ok = std::isnan(volume_expected) || volume_error() <= kVolumeTolerance;
  return chunks > 0 && open_chunks == 0 && nonmanifold_chunks == 0 && inverted_chunks == 0 &&
         unmatched_faces == 0 && overlapping_pairs == 0 && self_crossing_chunks == 0 &&
         crossing_surfaces == 0 && volume_ok;
}

Soundness measure(const std::vector<SoupWall>& walls, const Progress& progress) {
  Soundness result;
  double expected = 0;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    WallMeasure(walls[w], result).run([&](double done) {
      if (progress) progress((static_cast<double>(w) + done) / static_cast<double>(walls.size()));
    });
    expected += walls[w].volume_expected;
  }
  result.volume_expected = expected;
  if (progress) progress(1);
  return result;
}

SoupWall soup_of(const WallAsset& asset, const RenderMeshes& meshes) {
  SoupWall wall;
  wall.chunk_count = meshes.chunk_count();
  wall.kind = SoupWall::Kind::wall;
  wall.bonds = asset.bonds.size();
  wall.volume_expected = asset.volume_expected;
  wall.chunk = [&meshes](std::uint32_t c) {
    SoupChunk chunk;
    const std::size_t begin = meshes.vertex_begin[c], end = meshes.vertex_begin[c + 1];
    chunk.positions.assign(meshes.positions.data() + 3 * begin, meshes.positions.data() + 3 * end);
    for (const bool inner : {false, true}) {
      const std::uint32_t id = inner ? meshes.inner[c] : meshes.outer[c];
      if (id == RenderMeshes::kNoList) continue;
      const auto first = meshes.indices.begin() + meshes.lists[id].begin;
      chunk.triangles.insert(chunk.triangles.end(), first, first + meshes.lists[id].count);
      chunk.inner.insert(chunk.inner.end(), meshes.lists[id].count / 3, inner);
    }
    return chunk;
  };
  return wall;
}

SoupWall soup_of(const SolidAsset& asset, const SolidMeshes& meshes) {
  SoupWall wall;
  wall.chunk_count = asset.partition.chunk_count();
  wall.kind = SoupWall::Kind::solid;
  wall.bonds = asset.bonds.size();
  wall.volume_expected = asset.volume_expected;
  wall.chunk = [&meshes](std::uint32_t c) {
    SoupChunk chunk;
    const std::size_t begin = meshes.vertex_begin[c], end = meshes.vertex_begin[c + 1];
    chunk.positions.assign(meshes.positions.data() + 3 * begin, meshes.positions.data() + 3 * end);
    for (std::uint32_t p = meshes.part_begin[c]; p < meshes.part_begin[c + 1]; ++p) {
      const SolidMeshes::Part& part = meshes.parts[p];
      const auto first = meshes.indices.begin() + part.begin;
      chunk.triangles.insert(chunk.triangles.end(), first, first + part.count);
      chunk.inner.insert(chunk.inner.end(), part.count / 3,
                         part.material == SolidMeshes::kInnerMaterial);
    }
    return chunk;
  };
  return wall;
}

}  // namespace sunder
