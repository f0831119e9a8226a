// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf_layout.hpp"

#include <algorithm>

#include "meshing/trig.hpp"

namespace sunder {
namespace {

constexpr std::uint64_t kBondBytes = 8 + 4 + 12 + 12;

std::uint32_t id_of(std::vector<std::pair<std::string, bool>>& materials, const std::string& name,
                    bool inner) {
  const auto found = std::ranges::find(materials, std::pair(name, inner));
  if (found == materials.end()) materials.emplace_back(name, inner);
  return static_cast<std::uint32_t>(std::ranges::find(materials, std::pair(name, inner)) -
                                    materials.begin());
}

void lay_out_materials(std::span<const WallView> walls, GltfLayout& layout) {
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const WallView& wall = walls[w];
    const auto& lists = layout.lists.of_wall[w];
    GltfLayout::MaterialIds ids;
    for (std::uint32_t c = 0; c < wall.chunk_count(); ++c) {
      const bool outer = is_drawn(wall, lists, wall.outer[c]);
      const bool inner = is_drawn(wall, lists, wall.inner[c]);
      if (outer && ids.outer == kUnused) ids.outer = id_of(layout.materials, wall.material, false);
      if (inner && ids.inner == kUnused) ids.inner = id_of(layout.materials, wall.material, true);
      if (outer || inner) ++layout.mesh_count;
    }
    layout.materials_of.push_back(ids);
  }
}

void lay_out_spheres(const Recording& recording, GltfLayout& layout) {
  for (const RecordedProjectile& recorded : recording.projectiles) {
    const double radius = recorded.projectile.radius;
    const auto found = std::ranges::find(layout.radii, radius);
    layout.mesh_of.push_back(static_cast<std::uint32_t>(found - layout.radii.begin()));
    if (found == layout.radii.end()) layout.radii.push_back(radius);
  }
  if (!layout.radii.empty()) layout.sphere_material = id_of(layout.materials, "steel", false);
}

}  // namespace

GltfLayout lay_out_gltf(std::span<const WallView> walls, const Recording* recording) {
  GltfLayout layout;
  layout.recording = recording;
  layout.lists = unique_lists(walls);
  lay_out_materials(walls, layout);
  std::uint64_t vertices = 0, bond_bytes = 0, index_bytes = 0;
  for (const WallView& wall : walls) {
    layout.first_vertex.push_back(vertices);
    layout.bonds_begin.push_back(bond_bytes);
    vertices += wall.vertex_begin.back();
    bond_bytes += wall.bonds.size() * kBondBytes;
  }
  for (const UniqueLists::List& list : layout.lists.lists) {
    layout.list_begin.push_back(index_bytes);
    const std::uint64_t width = list.largest <= kLargestShortIndex ? 2 : 4;
    index_bytes += (list.indices.size() * width + 3) / 4 * 4;
  }
  std::uint64_t keys = 0, poses = 0, scales = 0;
  if (recording) {
    lay_out_spheres(*recording, layout);
    layout.animation = plan_animation(*recording);
    if (!layout.animation.empty()) keys = layout.animation.steps.size();
    poses = layout.animation.pose_count;
    scales = layout.animation.arrivals.empty() ? 0 : 2;
  }
  layout.first_sphere_vertex = vertices;
  layout.sphere_list_begin = index_bytes;
  const std::uint64_t spheres = layout.radii.size();
  const bool any = spheres > 0;
  const std::uint64_t sizes[kGltfBlocks] = {12 * (vertices + spheres * kSphereVertices),
                                            12 * (vertices + (any ? kSphereVertices : 0)),
                                            8 * vertices,
                                            index_bytes + (any ? 2 * kSphereIndices : 0),
                                            bond_bytes,
                                            4 * keys,
                                            12 * (poses + scales),
                                            16 * poses};
  std::uint32_t views = 0;
  for (std::size_t i = 0; i < kGltfBlocks; ++i) {
    layout.blocks[i] = {layout.binary_size, sizes[i], sizes[i] > 0 ? views++ : kUnused};
    layout.binary_size += sizes[i];
  }
  return layout;
}

SphereMesh sphere_mesh() {
  SphereMesh mesh;
  mesh.vertices.push_back({0, 1, 0});
  for (std::uint32_t ring = 1; ring < kSphereRings; ++ring) {
    const Vec2 up = unit_at_turns(0.5 * ring / kSphereRings);  // {cos, sin} from the pole
    for (std::uint32_t sector = 0; sector < kSphereSectors; ++sector) {
      const Vec2 around = unit_at_turns(static_cast<double>(sector) / kSphereSectors);
      mesh.vertices.push_back({up.y * around.x, up.x, -up.y * around.y});
    }
  }
  mesh.vertices.push_back({0, -1, 0});
  const auto at = [](std::uint32_t ring, std::uint32_t sector) -> std::uint16_t {
    if (ring == 0) return 0;
    if (ring == kSphereRings) return kSphereVertices - 1;
    return static_cast<std::uint16_t>(1 + (ring - 1) * kSphereSectors + sector % kSphereSectors);
  };
  for (std::uint32_t r = 0; r < kSphereRings; ++r) {
    for (std::uint32_t s = 0; s < kSphereSectors; ++s) {
      const std::uint16_t a = at(r, s), b = at(r + 1, s), c = at(r + 1, s + 1), d = at(r, s + 1);
      if (r + 1 < kSphereRings) mesh.indices.insert(mesh.indices.end(), {a, b, c});
      if (r > 0) mesh.indices.insert(mesh.indices.end(), {a, c, d});
    }
  }
  return mesh;
}

}  // namespace sunder
