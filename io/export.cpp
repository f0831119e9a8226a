// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/export.hpp"

#include <algorithm>
#include <string_view>

#include "io/background_sink.hpp"
#include "io/export_files.hpp"
#include "io/gltf.hpp"
#include "io/obj.hpp"
#include "io/page.hpp"
#include "io/scene.hpp"
#include "io/solid_view.hpp"
#include "io/string_sink.hpp"
#include "io/svg.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr std::string_view kSuffixes[] = {".glb", ".gltf", ".obj", ".stl",
                                          ".ply", ".svg",  ".png", ".html"};

void write_pair(std::span<const WallView> walls, const std::filesystem::path& path,
                const std::string& suffix) {
  OutputFile file(path), companion(companion_of(path));
  FileSink sink(file), companion_sink(companion);
  const std::string name = companion_of(path).filename().string();
  if (suffix == ".gltf") {
    write_gltf(walls, name, sink, companion_sink);
  } else {
    write_obj(walls, name, sink);
    write_mtl(walls, companion_sink);
  }
  commit_pair(companion, file);
}

void write_picture(const MeshedAsset& asset, const std::filesystem::path& path,
                   const std::string& suffix) {
  const std::string svg = draw_svg(asset.asset, asset.solids);
  try {
    write_file(path, suffix == ".png" ? png_of(svg, asset.picture_width) : svg);
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.starts_with(path.string())) throw;
    throw Error(error.code(), path.string() + ": " + message);
  }
}

}  // namespace

bool is_export_suffix(const std::string& suffix) {
  return std::ranges::find(kSuffixes, suffix) != std::end(kSuffixes);
}

std::string suffix_of(const std::filesystem::path& path) {
  std::string suffix = path.extension().string();
  for (char& c : suffix) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return suffix;
}

std::filesystem::path companion_of(const std::filesystem::path& path) {
  const std::string suffix = suffix_of(path);
  std::filesystem::path other = path;
  if (suffix == ".gltf") return other.replace_extension(".bin");
  if (suffix == ".obj") return other.replace_extension(".mtl");
  return {};
}

void commit_pair(OutputFile& companion, OutputFile& file) {
  companion.flush();
  file.flush();
  companion.commit();
  try {
    file.commit();
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(companion.path(), ignored);
    throw;
  }
}

std::vector<WallView> views_of(const MeshedAsset& asset, const std::filesystem::path& path) {
  std::vector<WallView> views;
  views.reserve(asset.meshes.size() + asset.solid_meshes.size());
  for (std::size_t i = 0; i < asset.meshes.size(); ++i) {
    views.push_back(view_of(asset.asset.walls[i], asset.meshes[i]));
  }
  for (std::size_t i = 0; i < asset.solid_meshes.size(); ++i) {
    views.push_back(view_of(asset.solids[i], asset.solid_meshes[i], path));
  }
  for (std::size_t i = 0; i < asset.hulls.size(); ++i) {
    views[i].hulls = {&asset.hulls[i], hull_nodes(asset.hull_params.nodes),
                      asset.hull_params.physics, asset.hull_materials[i].friction,
                      asset.hull_materials[i].restitution};
  }
  make_names_differ(views);
  return views;
}

MeshedAsset mesh_asset(const Asset& asset, int threads, std::span<const SolidAsset> solids) {
  MeshedAsset result{asset, {}, solids, {}};
  for (const WallAsset& wall : asset.walls) {
    result.meshes.push_back(render_meshes(wall, threads));
  }
  for (const SolidAsset& solid : solids) {
    result.solid_meshes.push_back(solid_meshes(solid, threads));
  }
  return result;
}

void add_hulls(MeshedAsset& asset, const HullParams& params, const std::vector<Material>& materials,
               int threads) {
  asset.hull_params = params;
  if (!params.is_wanted()) return;
  for (const WallAsset& wall : asset.asset.walls) {
    asset.hull_materials.push_back(find_material(materials, wall.wall.material));
    asset.hulls.push_back(wall_hulls(wall, params, threads));
  }
  for (const SolidAsset& solid : asset.solids) {
    asset.hull_materials.push_back(find_material(materials, solid.solid.material));
    asset.hulls.push_back(solid_hulls(solid, params, threads));
  }
}

void export_asset(const MeshedAsset& asset, const std::filesystem::path& path) {
  const std::string suffix = suffix_of(path);
  if (suffix == ".svg" || suffix == ".png") {
    return write_picture(asset, path, suffix);
  }
  if (suffix != ".glb" && suffix != ".gltf" && suffix != ".obj" && suffix != ".html") {
    return export_through_assimp(asset, path);
  }
  const std::vector<WallView> walls = views_of(asset, path);
  try {
    validate(walls);
    if (suffix == ".html") {
      PageModel model{path.stem().string(), {}, {}, {}};
      StringSink sink(model.file);
      write_glb(walls, sink);
      return write_page(path, {&model, 1});
    }
    if (suffix != ".glb") return write_pair(walls, path, suffix);
    OutputFile file(path);
    BackgroundSink sink(file);
    write_glb(walls, sink);
    sink.finish();
    file.commit();
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.starts_with(path.string())) throw;
    throw Error(error.code(), path.string() + ": " + message);
  }
}

}  // namespace sunder
