// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gltf_layout.hpp"

#include <algorithm>

#include "io/gltf_series.hpp"
#include "io/image_file.hpp"
#include "meshing/trig.hpp"

namespace sunder {
namespace {

constexpr std::uint64_t kBondBytes = 8 + 4 + 12 + 12;

std::uint32_t id_of(std::vector<ViewMaterial>& materials, const ViewMaterial& material) {
  const auto id = std::ranges::find(materials, material) - materials.begin();
  if (id == std::ssize(materials)) materials.push_back(material);
  return static_cast<std::uint32_t>(id);
}

void lay_out_materials(std::span<const WallView> walls, GltfLayout& layout) {
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const WallView& wall = walls[w];
    const std::vector<std::uint32_t>& lists = layout.lists.of_wall[w];
    std::vector<std::uint32_t>& ids =
        layout.materials_of.emplace_back(wall.materials.size(), kUnused);
    for (std::uint32_t c = 0; c < wall.chunk_count(); ++c) {
      bool is_drawn = false;
      for (const ViewPart& part : wall.parts_of(c)) {
        if (lists[part.list] == kUnused) continue;
        is_drawn = true;
        std::uint32_t& id = ids[part.material];
        if (id == kUnused) id = id_of(layout.materials, wall.materials[part.material]);
      }
      if (is_drawn) ++layout.mesh_count;
      if (is_drawn && !wall.colours.empty()) ++layout.coloured_count;
    }
  }
}

void lay_out_images(GltfLayout& layout, bool embeds) {
  for (const ViewMaterial& material : layout.materials) {
    if (material.image.empty() ||
        std::ranges::find(layout.images, material.image, &GltfImage::image) != layout.images.end())
      continue;
    GltfImage image{material.image, material.uri, {}, mime_of_image(material.image), 0};
    if (embeds) image.bytes = read_bytes(material.image);
    layout.images.push_back(std::move(image));
  }
}

void lay_out_spheres(const Recording& recording, GltfLayout& layout) {
  for (const RecordedProjectile& recorded : recording.projectiles) {
    const double radius = recorded.projectile.radius;
    const auto found = std::ranges::find(layout.radii, radius);
    layout.mesh_of.push_back(static_cast<std::uint32_t>(found - layout.radii.begin()));
    if (found == layout.radii.end()) layout.radii.push_back(radius);
  }
  if (!layout.radii.empty()) {
    layout.sphere_material = id_of(layout.materials, outer_material("steel"));
  }
}

void lay_out_parts(const Recording& recording, GltfLayout& layout) {
  layout.parts = plan_parts(recording, layout.step);
  for (GltfParts::Shape& shape : layout.parts.shapes) {
    const RecordedPart& part = recording.parts[shape.part];
    shape.material = id_of(layout.materials, part.has_ends ? member_material(part.material)
                                                           : outer_material(part.material));
  }
}

struct Sizes {
  std::uint64_t vertices = 0, coloured = 0, bonds = 0, indices = 0;  // the last two in bytes
  std::uint64_t hull_vertices = 0, hull_indices = 0;                 // the last in bytes
};

Sizes lay_out_walls(std::span<const WallView> walls, GltfLayout& layout) {
  Sizes sizes;
  for (const WallView& wall : walls) {
    layout.first_vertex.push_back(sizes.vertices);
    layout.first_colour.push_back(sizes.coloured);
    layout.bonds_begin.push_back(sizes.bonds);
    sizes.vertices += wall.vertex_begin.back();
    if (!wall.colours.empty()) sizes.coloured += wall.vertex_begin.back();
    sizes.bonds += wall.bonds.size() * kBondBytes;
    if (!wall.hulls.set) continue;
    sizes.hull_vertices += wall.hulls.set->vertex_begin.back();
    sizes.hull_indices += 2 * wall.hulls.set->indices.size();
  }
  for (const UniqueLists::List& list : layout.lists.lists) {
    layout.list_begin.push_back(sizes.indices);
    const std::uint64_t width = list.largest <= kLargestShortIndex ? 2 : 4;
    sizes.indices += (list.indices.size() * width + 3) / 4 * 4;
  }
  return sizes;
}

// Where spheres and parts begin in the blocks, and how large the blocks are, bytes.
std::array<std::uint64_t, kGltfBlocks> lay_out_blocks(const Sizes& walls, GltfLayout& layout) {
  const std::uint64_t spheres = layout.radii.size();
  const GltfParts& parts = layout.parts;
  const GltfAnimation& animation = layout.animation;
  layout.first_sphere_vertex = walls.vertices;
  layout.sphere_list_begin = walls.indices;
  layout.first_part_position = walls.vertices + spheres * kSphereVertices;
  layout.first_part_normal = walls.vertices + (spheres > 0 ? kSphereVertices : 0);
  layout.first_part_uv = walls.vertices;
  layout.part_list_begin = walls.indices + (spheres > 0 ? 2 * kSphereIndices : 0);
  layout.first_hull_vertex = layout.first_part_position + parts.vertex_count + parts.still_count;
  layout.hull_list_begin = layout.part_list_begin + parts.index_bytes;
  return {12 * (layout.first_hull_vertex + walls.hull_vertices),
          12 * (layout.first_part_normal + parts.vertex_count),
          8 * (layout.first_part_uv + parts.vertex_count),
          12 * (walls.coloured + parts.colour_count),
          layout.hull_list_begin + walls.hull_indices,
          walls.bonds,
          4 * (layout.common_times() + parts.key_count),
          12 * (animation.pose_count + animation.scale_count()),
          16 * animation.pose_count,
          4 * kLights * parts.key_count,
          series_bytes(layout)};
}

}  // namespace

GltfLayout lay_out_gltf(std::span<const WallView> walls, const Recording* recording,
                        std::optional<std::uint32_t> step, bool embeds) {
  GltfLayout layout;
  layout.recording = recording;
  layout.step = step;
  layout.lists = unique_lists(walls);
  lay_out_materials(walls, layout);
  const Sizes of_walls = lay_out_walls(walls, layout);
  if (recording) {
    lay_out_spheres(*recording, layout);
    lay_out_parts(*recording, layout);
    if (!step) layout.animation = plan_animation(*recording);
  }
  const std::array<std::uint64_t, kGltfBlocks> sizes = lay_out_blocks(of_walls, layout);
  std::uint32_t views = 0;
  for (std::size_t i = 0; i < kGltfBlocks; ++i) {
    layout.blocks[i] = {layout.binary_size, sizes[i], sizes[i] > 0 ? views++ : kUnused};
    layout.binary_size += sizes[i];
  }
  lay_out_images(layout, embeds);
  for (GltfImage& image : layout.images) {
    image.begin = layout.binary_size;
    layout.binary_size += (image.bytes.size() + 3) / 4 * 4;
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
