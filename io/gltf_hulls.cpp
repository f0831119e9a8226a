// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf_hulls.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "sim/principal_axes.hpp"

namespace sunder {
namespace {

// Of a rotation matrix: the largest component from the diagonal, the others by it (Shepperd 1978).
Quaternion rotation_of(const Axes& r) {
  const std::array squares{1 + r.x.x - r.y.y - r.z.z, 1 - r.x.x + r.y.y - r.z.z,
                           1 - r.x.x - r.y.y + r.z.z, 1 + r.x.x + r.y.y + r.z.z};
  const double yz = r.y.z + r.z.y, xz = r.x.z + r.z.x, xy = r.x.y + r.y.x;
  const double wx = r.y.z - r.z.y, wy = r.z.x - r.x.z, wz = r.x.y - r.y.x;
  switch (std::ranges::max_element(squares) - squares.begin()) {
    case 0: return normalised({squares[0], xy, xz, wx});
    case 1: return normalised({xy, squares[1], yz, wy});
    case 2: return normalised({xz, yz, squares[2], wz});
    default: return normalised({wx, wy, wz, squares[3]});
  }
}

}  // namespace

GltfHulls::GltfHulls(std::span<const WallView> walls, const GltfLayout& layout, First first,
                     GltfText& out)
    : walls_(walls), layout_(layout), first_(first), out_(out) {
  std::uint64_t count = 0;
  for (const WallView& wall : walls_) {
    wall_hull_.push_back(count);
    count += wall.hulls.count();
  }
  std::uint64_t node = first_.node + count;
  for (const WallView& wall : walls_) {
    auto& nodes = collider_.emplace_back();
    for (std::uint32_t c = 0; wall.hulls.physics && c < wall.chunk_count(); ++c) {
      nodes.push_back(node);
      if (wall.hulls.count(c) > 1) node += wall.hulls.count(c);
    }
  }
}

bool GltfHulls::has_physics() const {
  return std::ranges::any_of(walls_, [](const WallView& wall) { return wall.hulls.physics; });
}

// Calls visit(wall, chunk, chunk's name, number in the chunk, number in the wall).
template <class Visit>
void GltfHulls::for_each_hull(const Visit& visit) const {
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    ChunkNames name(walls_[w].first_chunk);
    const HullView& hulls = walls_[w].hulls;
    for (std::uint32_t c = 0; hulls.set && c < walls_[w].chunk_count(); ++c, ++name)
      for (std::uint32_t i = 0; i < hulls.count(c); ++i) visit(w, c, *name, i, hulls.begin(c) + i);
  }
}

void GltfHulls::write_extensions() {
  if (!has_physics()) return;
  out_.text(R"("extensionsUsed":["KHR_physics_rigid_bodies"],)");
  out_.text(R"("extensions":{"KHR_physics_rigid_bodies":{"physicsMaterials":[)");
  bool first = true;
  for (const WallView& wall : walls_) {
    out_.separate(first);
    out_.key(R"({"staticFriction":)", wall.hulls.friction);
    out_.key(R"(,"dynamicFriction":)", wall.hulls.friction);
    out_.key(R"(,"restitution":)", wall.hulls.restitution);
    out_.text("}");
  }
  out_.text("]}},");
}

void GltfHulls::add_to_wall(std::size_t w, bool& first) {
  const HullView& hulls = walls_[w].hulls;
  if (hulls.nodes != HullNodes::ucx) return;
  for (std::uint32_t h = 0; h < hulls.count(); ++h) {
    out_.separate(first);
    out_.integer(first_.node + wall_hull_[w] + h);
  }
}

void GltfHulls::write_in_chunk(std::size_t w, std::uint32_t chunk) {
  const WallView& wall = walls_[w];
  const HullView& hulls = wall.hulls;
  if (!hulls.set) return;
  const std::uint32_t count = hulls.count(chunk);
  const std::uint64_t hull = wall_hull_[w] + hulls.begin(chunk);
  const bool has_colliders = hulls.physics && count > 1;
  if (count > 0 && (hulls.nodes == HullNodes::convcol || has_colliders)) {
    out_.text(R"(,"children":[)");
    bool first = true;
    for (std::uint32_t i = 0; i < count && hulls.nodes == HullNodes::convcol; ++i) {
      out_.separate(first);
      out_.integer(first_.node + hull + i);
    }
    for (std::uint32_t i = 0; i < count && has_colliders; ++i) {
      out_.separate(first);
      out_.integer(collider_[w][chunk] + i);
    }
    out_.text("]");
  }
  if (!hulls.physics) return;
  out_.text(R"(,"extensions":{"KHR_physics_rigid_bodies":{)");
  write_motion(wall, chunk);
  if (count == 1) {
    out_.text(",");
    write_collider(w, hull);
  }
  out_.text("}}");
}

void GltfHulls::write_motion(const WallView& wall, std::uint32_t chunk) {
  const MassProperties& p = wall.chunks[chunk];
  const PrincipalAxes axes = principal_axes(p.inertia);
  const Quaternion q = rotation_of(axes.axes);
  out_.text(R"("motion":{"mass":)");
  out_.number(wall.density * p.volume);
  out_.text(R"(,"centerOfMass":)");
  out_.numbers({p.centroid.x, p.centroid.y, p.centroid.z});
  out_.text(R"(,"inertiaDiagonal":)");
  out_.numbers({wall.density * axes.moments.x, wall.density * axes.moments.y,
                wall.density * axes.moments.z});
  out_.text(R"(,"inertiaOrientation":)");
  out_.numbers({q.x, q.y, q.z, q.w});
  out_.text("}");
}

void GltfHulls::write_collider(std::size_t w, std::uint64_t hull) {
  out_.key_integer(R"("collider":{"geometry":{"node":)", first_.node + hull);
  out_.key_integer(R"(,"convexHull":true},"physicsMaterial":)", w);
  out_.text("}");
}

void GltfHulls::write_nodes() {
  std::uint64_t mesh = first_.mesh;
  for_each_hull(
      [&](std::size_t w, std::uint32_t, std::string_view chunk, std::uint32_t i, std::uint32_t) {
        out_.text(R"(,{"name":)");
        out_.quoted(hull_name(walls_[w].hulls.nodes, chunk, i));
        out_.key_integer(R"(,"mesh":)", mesh++);
        out_.text("}");
      });
  for_each_hull([&](std::size_t w, std::uint32_t c, std::string_view chunk, std::uint32_t i,
                    std::uint32_t hull) {
    if (!walls_[w].hulls.physics || walls_[w].hulls.count(c) < 2) return;
    out_.text(R"(,{"name":)");
    const std::string number = std::string(i < 10 ? "0" : "") + std::to_string(i);
    out_.quoted(std::string(chunk) + "_body_" + number);
    out_.text(R"(,"extensions":{"KHR_physics_rigid_bodies":{)");
    write_collider(w, wall_hull_[w] + hull);
    out_.text("}}}");
  });
}

void GltfHulls::write_meshes() {
  std::uint64_t accessor = first_.accessor;
  for_each_hull(
      [&](std::size_t w, std::uint32_t, std::string_view chunk, std::uint32_t i, std::uint32_t) {
        out_.text(R"(,{"name":)");
        out_.quoted(hull_name(walls_[w].hulls.nodes, chunk, i));
        out_.key_integer(R"(,"primitives":[{"attributes":{"POSITION":)", accessor);
        out_.key_integer(R"(},"indices":)", accessor + 1);
        out_.text("}]}");
        accessor += 2;
      });
}

void GltfHulls::write_accessors(bool& first) {
  std::uint64_t vertex = layout_.first_hull_vertex, index = layout_.hull_list_begin;
  for_each_hull(
      [&](std::size_t w, std::uint32_t, std::string_view, std::uint32_t, std::uint32_t h) {
        const HullSet& set = *walls_[w].hulls.set;
        const std::size_t begin = set.vertex_begin[h], count = set.vertex_begin[h + 1] - begin;
        const std::size_t indices = set.index_begin[h + 1] - set.index_begin[h];
        out_.accessor(layout_[GltfBlock::positions].view, 12 * vertex, count,
                      R"(,"componentType":5126,"type":"VEC3",)", first);
        out_.bounds(std::span(set.positions).subspan(3 * begin, 3 * count));
        out_.text("}");
        out_.accessor(layout_[GltfBlock::indices].view, index, indices,
                      R"(,"componentType":5123,"type":"SCALAR"})", first);
        vertex += count;
        index += 2 * indices;  // a closed mesh has an even number of triangles: whole words
      });
}

}  // namespace sunder
