// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "fracture/solid_asset.hpp"
#include "meshing/parallel.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
using Float3 = std::array<float, 3>;

Float3 rounded(Vec3 v) {
  // Adding 0 turns -0 into 0: equal places have equal bits.
  return {static_cast<float>(v.x) + 0.0f, static_cast<float>(v.y) + 0.0f,
          static_cast<float>(v.z) + 0.0f};
}
Vec3 wide(const Float3& v) {
  return {v[0], v[1], v[2]};
}
Vec3 unit_or(Vec3 v, Vec3 fallback) {
  const double size = length(v);
  return size > 0 ? (1 / size) * v : fallback;
}

// What a vertex of the output carries.
struct Look {
  Float3 normal{};
  std::array<float, 2> uv{};
  std::array<float, 4> colour{1, 1, 1, 1};
  friend bool operator==(const Look&, const Look&) = default;
};

Look blend(const Corner& a, double p, const Corner& b, double q, const Corner& c, double r,
           Vec3 flat) {
  Look look;
  look.normal =
      rounded(unit_or(p * wide(a.normal) + q * wide(b.normal) + r * wide(c.normal), flat));
  for (std::size_t k = 0; k < 2; ++k)
    look.uv[k] = static_cast<float>(p * a.uv[k] + q * b.uv[k] + r * c.uv[k]);
  for (std::size_t k = 0; k < 4; ++k)
    look.colour[k] = static_cast<float>(p * a.colour[k] + q * b.colour[k] + r * c.colour[k]);
  return look;
}

// The surface's look at a point of one of its triangles. On an edge it depends on the edge's ends
// only, so that both of its triangles find the same.
Look look_at(const ModelSurface& surface, std::uint32_t triangle, Vec3 place) {
  constexpr double kOnEdge = 1e-9;
  const auto& t = surface.mesh.triangles[triangle];
  const Vec3 at[3] = {surface.mesh.vertices[t[0]], surface.mesh.vertices[t[1]],
                      surface.mesh.vertices[t[2]]};
  const Vec3 normal = cross(at[1] - at[0], at[2] - at[0]);
  const Vec3 flat = unit_or(normal, {0, 0, 1});
  const Corner none{rounded(flat), {}, {1, 1, 1, 1}};
  const auto corner = [&](std::size_t k) -> const Corner& {
    return surface.corners.empty() ? none : surface.corners[3 * triangle + k];
  };
  for (std::size_t k = 0; k < 3; ++k)
    if (place == at[k]) return blend(corner(k), 1, corner(k), 0, corner(k), 0, flat);
  double share[3];
  const double square = dot(normal, normal);
  for (std::size_t k = 0; k < 3; ++k)
    share[k] = dot(cross(at[(k + 1) % 3] - place, at[(k + 2) % 3] - place), normal) / square;
  for (std::size_t k = 0; k < 3; ++k) {
    if (share[k] > kOnEdge) continue;
    std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    if (t[i] > t[j]) std::swap(i, j);
    const double p = std::clamp(length(place - at[i]) / length(at[j] - at[i]), 0.0, 1.0);
    return blend(corner(i), 1 - p, corner(j), p, corner(j), 0, flat);
  }
  return blend(corner(0), share[0], corner(1), share[1], corner(2), share[2], flat);
}

// Directions of a plane's texture, as seen against its normal.
std::array<Vec3, 2> texture_axes(Vec3 n) {
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const Vec3 up = y <= x || y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 u = unit_or(cross(up, n), {1, 0, 0});
  return {u, cross(n, u)};
}

// Makes chunk meshes one after the other; one per thread.
struct Maker {
  const SolidAsset& asset;
  const std::vector<Float3>& places;
  const std::vector<std::uint32_t>& same;  // first vertex of equal float place
  const std::vector<Vec3>& smooth;         // per triangle corner of inner faces; empty: flat
  SolidMeshes out{};
  std::vector<std::uint32_t> head{}, next{};  // vertices of this chunk at each place
  std::vector<Look> looks{};
  std::vector<std::uint32_t> touched{};

  std::uint32_t material_of(const SolidPartition::Triangle& t) const {
    if (t.is_inner()) return SolidMeshes::kInnerMaterial;
    return asset.surface.material.empty() ? 0 : asset.surface.material[t.source];
  }

  std::uint32_t vertex(std::uint32_t v, const Look& look) {
    v = same[v];
    if (head[v] == kNone) touched.push_back(v);
    for (std::uint32_t i = head[v]; i != kNone; i = next[i])
      if (looks[i] == look) return i;
    const auto id = static_cast<std::uint32_t>(looks.size());
    looks.push_back(look);
    next.push_back(head[v]);
    head[v] = id;
    out.positions.insert(out.positions.end(), places[v].begin(), places[v].end());
    out.normals.insert(out.normals.end(), look.normal.begin(), look.normal.end());
    out.uvs.insert(out.uvs.end(), look.uv.begin(), look.uv.end());
    if (asset.surface.has_colours)
      out.colours.insert(out.colours.end(), look.colour.begin(), look.colour.end());
    return id;
  }

  Look inner_look(std::uint32_t chunk, std::uint32_t triangle, std::size_t k) const {
    const auto& p = asset.partition;
    const auto& t = p.triangles[triangle];
    const auto& face = p.faces[t.face()];
    const Vec3 flat = (face.a == chunk ? 1.0 : -1.0) * face.normal;
    const auto [u, v] = texture_axes(flat);
    const Vec3 at = (1 / asset.solid.uv_scale) * p.vertices[t.corners[k]];
    Look look;
    look.normal = rounded(smooth.empty() ? flat : unit_or(smooth[3 * triangle + k], flat));
    look.uv = {static_cast<float>(dot(at, u)), static_cast<float>(dot(at, v))};
    return look;
  }

  void add(std::uint32_t chunk, std::uint32_t triangle) {
    const auto& t = asset.partition.triangles[triangle];
    const auto& c = t.corners;
    if (same[c[0]] == same[c[1]] || same[c[1]] == same[c[2]] || same[c[2]] == same[c[0]]) return;
    for (std::size_t k = 0; k < 3; ++k)
      out.indices.push_back(vertex(
          c[k], t.is_inner() ? inner_look(chunk, triangle, k)
                             : look_at(asset.surface, t.source, asset.partition.vertices[c[k]])));
  }

  void make(std::uint32_t chunk) {
    const auto& p = asset.partition;
    std::vector<std::uint32_t> materials;
    for (std::uint32_t t = p.chunk_begin[chunk]; t < p.chunk_begin[chunk + 1]; ++t)
      if (materials.empty() || materials.back() != material_of(p.triangles[t]))
        materials.push_back(material_of(p.triangles[t]));
    std::ranges::sort(materials);
    materials.erase(std::ranges::unique(materials).begin(), materials.end());
    looks.clear();
    next.clear();
    for (const std::uint32_t material : materials) {
      const auto begin = static_cast<std::uint32_t>(out.indices.size());
      for (std::uint32_t t = p.chunk_begin[chunk]; t < p.chunk_begin[chunk + 1]; ++t)
        if (material_of(p.triangles[t]) == material) add(chunk, t);
      const auto count = static_cast<std::uint32_t>(out.indices.size()) - begin;
      if (count > 0) out.parts.push_back({material, begin, count});
    }
    for (const std::uint32_t v : touched) head[v] = kNone;
    touched.clear();
    out.vertex_begin.push_back(static_cast<std::uint32_t>(out.positions.size() / 3));
    out.part_begin.push_back(static_cast<std::uint32_t>(out.parts.size()));
  }
};

// Per vertex the first one that has the same place in float32.
std::vector<std::uint32_t> first_of_equal(const std::vector<Float3>& places) {
  std::vector<std::uint32_t> order(places.size()), same(places.size());
  for (std::uint32_t v = 0; v < order.size(); ++v) order[v] = v;
  std::ranges::sort(order, [&](std::uint32_t p, std::uint32_t q) {
    return places[p] != places[q] ? places[p] < places[q] : p < q;
  });
  for (std::size_t k = 0; k < order.size(); ++k)
    same[order[k]] =
        k > 0 && places[order[k]] == places[order[k - 1]] ? same[order[k - 1]] : order[k];
  return same;
}

// Normals of faces that are not planes: the mean of the triangles around, per chunk, face, vertex.
std::vector<Vec3> smooth_normals(const SolidAsset& asset) {
  if (!asset.has_rough_faces()) return {};
  const auto& p = asset.partition;
  std::vector<Vec3> result(3 * p.triangles.size());
  std::vector<std::array<std::uint32_t, 3>> corners;  // face, vertex, corner
  for (std::uint32_t c = 0; c < p.chunk_count(); ++c) {
    corners.clear();
    for (std::uint32_t t = p.chunk_begin[c]; t < p.chunk_begin[c + 1]; ++t)
      if (p.triangles[t].is_inner())
        for (std::uint32_t k = 0; k < 3; ++k)
          corners.push_back({p.triangles[t].face(), p.triangles[t].corners[k], 3 * t + k});
    std::ranges::sort(corners);
    for (std::size_t i = 0, j = 0; i < corners.size(); i = j) {
      Vec3 sum;
      for (j = i;
           j < corners.size() && corners[j][0] == corners[i][0] && corners[j][1] == corners[i][1];
           ++j) {
        const auto& v = p.triangles[corners[j][2] / 3].corners;
        sum = sum + cross(p.vertices[v[1]] - p.vertices[v[0]], p.vertices[v[2]] - p.vertices[v[0]]);
      }
      for (std::size_t k = i; k < j; ++k) result[corners[k][2]] = sum;
    }
  }
  return result;
}

void append(SolidMeshes& all, const SolidMeshes& part) {
  const auto indices = static_cast<std::uint32_t>(all.indices.size());
  const std::uint32_t vertices = all.vertex_begin.back(), parts = all.part_begin.back();
  const auto add = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(all.positions, part.positions);
  add(all.normals, part.normals);
  add(all.uvs, part.uvs);
  add(all.colours, part.colours);
  add(all.indices, part.indices);
  for (std::size_t c = 1; c < part.vertex_begin.size(); ++c) {
    all.vertex_begin.push_back(vertices + part.vertex_begin[c]);
    all.part_begin.push_back(parts + part.part_begin[c]);
  }
  for (auto p : part.parts) {
    p.begin += indices;
    all.parts.push_back(p);
  }
}

}  // namespace

SolidMeshes solid_meshes(const SolidAsset& asset, int threads) {
  const auto& p = asset.partition;
  std::vector<Float3> places(p.vertices.size());
  for (std::size_t v = 0; v < places.size(); ++v) places[v] = rounded(p.vertices[v]);
  const std::vector<std::uint32_t> same = first_of_equal(places);
  const std::vector<Vec3> smooth = smooth_normals(asset);
  std::vector<std::pair<std::size_t, std::unique_ptr<Maker>>> makers;
  std::mutex lock;
  for_each_range(p.chunk_count(), threads, [&](std::size_t begin, std::size_t end) {
    auto maker = std::make_unique<Maker>(asset, places, same, smooth);
    maker->head.assign(p.vertices.size(), kNone);
    for (std::size_t c = begin; c < end; ++c) maker->make(static_cast<std::uint32_t>(c));
    const std::scoped_lock guard(lock);
    makers.emplace_back(begin, std::move(maker));
  });
  if (makers.size() == 1) return std::move(makers.front().second->out);
  std::ranges::sort(makers, {}, [](const auto& m) { return m.first; });
  SolidMeshes all;
  for (const auto& [begin, maker] : makers) append(all, maker->out);
  return all;
}

}  // namespace sunder
