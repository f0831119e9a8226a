// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/solid_view.hpp"

#include <algorithm>
#include <map>

#include "io/image_file.hpp"

namespace sunder {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kLongestMaterial = 50;  // leaves room for a number

// What every program keeps of a material's name. A name that ends like those of inner faces would
// be taken for one.
std::string portable(const std::string& given) {
  std::string name = given.substr(0, kLongestMaterial);
  for (char& c : name) {
    if (!is_portable(std::string_view(&c, 1))) c = '_';
  }
  return name.ends_with("_inner") ? name + "_outer" : name;
}

void add_image(const fs::path& image, const fs::path& path, ViewMaterial& material) {
  if (mime_of_image(image.string()).empty()) return;
  std::error_code fault;
  const fs::path folder = fs::absolute(path, fault).parent_path();
  const fs::path uri = fs::proximate(image, folder, fault);
  if (fault) return;
  material.image = image.string();
  material.uri = uri.generic_string();
}

ViewMaterial material_of(const SurfaceMaterial& surface, const SolidModel& solid,
                         const fs::path& path) {
  if (surface.name.empty()) return outer_material(solid.material);
  const auto channel = [&](std::size_t k) { return static_cast<double>(surface.base_colour[k]); };
  ViewMaterial material{.name = portable(surface.name),
                        .colour = {channel(0), channel(1), channel(2)},
                        .alpha = channel(3),
                        .metallic = static_cast<double>(surface.metallic),
                        .roughness = static_cast<double>(surface.roughness)};
  if (!surface.texture.empty())
    add_image(fs::path(solid.file).parent_path() / surface.texture, path, material);
  return material;
}

}  // namespace

WallView view_of(const SolidAsset& asset, const SolidMeshes& meshes, const fs::path& path) {
  WallView view{.name = asset.solid.name,
                .first_chunk = asset.chunk_name(0),
                .material = asset.solid.material,
                .position = asset.solid.position,
                .rotation = asset.solid.rotation,
                .is_solid = true,
                .origin = asset.origin,
                .density = asset.density,
                .volume_expected = asset.volume_expected,
                .positions = meshes.positions,
                .normals = meshes.normals,
                .uvs = meshes.uvs,
                .colours = meshes.colours,
                .vertex_begin = meshes.vertex_begin,
                .indices = meshes.indices,
                .part_begin = meshes.part_begin,
                .chunks = asset.chunks,
                .bonds = asset.bonds};
  for (const SurfaceMaterial& material : asset.surface.materials)
    view.materials.push_back(material_of(material, asset.solid, path));
  const auto inner = static_cast<std::uint32_t>(view.materials.size());
  view.materials.push_back(inner_material(asset.solid.material));
  for (const SolidMeshes::Part& part : meshes.parts) {
    const bool is_inner = part.material == SolidMeshes::kInnerMaterial;
    view.parts.push_back(
        {is_inner ? inner : part.material, static_cast<std::uint32_t>(view.lists.size())});
    view.lists.push_back({part.begin, part.count});
  }
  return view;
}

void make_names_differ(std::vector<WallView>& views) {
  std::map<std::string, ViewMaterial> known;
  for (WallView& view : views) {
    for (ViewMaterial& material : view.materials) {
      const std::string name = material.name;
      for (int number = 2;; ++number) {
        const auto [found, is_new] = known.emplace(material.name, material);
        if (is_new || found->second == material) break;
        material.name = name + '_' + std::to_string(number);
      }
    }
  }
}

}  // namespace sunder
