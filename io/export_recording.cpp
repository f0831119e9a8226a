// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/export_recording.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "fracture/chunk_mesh.hpp"
#include "io/background_sink.hpp"
#include "io/export_files.hpp"
#include "io/gltf.hpp"
#include "io/gltf_animation.hpp"
#include "io/moment.hpp"
#include "io/obj.hpp"
#include "io/page.hpp"
#include "io/string_sink.hpp"
#include "io/strip_svg.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr std::string_view kSuffixes[] = {".glb", ".gltf", ".svg", ".png", ".html"};
constexpr int kMostFrames = 60;

[[noreturn]] void refuse_suffix(const std::string& suffix, bool of_moment) {
  if (suffix == ".obj") {
    throw Error(ErrorCode::usage, "an .obj holds one moment of a recording: say at which time");
  }
  if (of_moment) {
    throw Error(
        ErrorCode::usage,
        "suffix \"" + suffix +
            "\" of one moment of a recording is not one of .glb .gltf .obj .svg .png .html");
  }
  throw Error(ErrorCode::usage,
              "suffix \"" + suffix + "\" of a recording is not one of .glb .gltf .svg .png .html");
}

void check_params(const std::string& suffix, const RecordingParams& params) {
  if (!is_recording_suffix(suffix, params.at.has_value())) {
    refuse_suffix(suffix, params.at.has_value());
  }
  if (params.frames < 1 || params.frames > kMostFrames) {
    throw Error(ErrorCode::usage, "frames = " + std::to_string(params.frames) + " is outside [1, " +
                                      std::to_string(kMostFrames) + "]");
  }
}

void write_solids(const Recording& recording, const std::filesystem::path& path,
                  const std::string& suffix, const RecordingParams& params) {
  std::optional<std::uint32_t> step;
  if (params.at) step = step_nearest(recording, *params.at);
  std::vector<RenderMeshes> meshes;
  meshes.reserve(recording.walls.size());
  std::vector<WallView> walls;
  for (const RecordedWall& wall : recording.walls) {
    meshes.push_back(render_meshes(wall.asset, params.threads));
    walls.push_back(view_of(wall.asset, meshes.back()));
  }
  if (!walls.empty() || recording.parts.empty()) validate(walls);
  if (suffix == ".html") {
    PageModel model{path.stem().string(), {}, {}, {}};
    StringSink sink(model.file);
    write_glb(walls, sink, &recording, step);
    return write_page(path, {&model, 1});
  }
  OutputFile file(path);
  if (suffix == ".glb") {
    BackgroundSink sink(file);
    write_glb(walls, sink, &recording, step);
    sink.finish();
    return file.commit();
  }
  OutputFile companion(companion_of(path));
  FileSink sink(file), companion_sink(companion);
  const std::string name = companion_of(path).filename().string();
  if (suffix == ".gltf") {
    write_gltf(walls, name, sink, companion_sink, &recording, step);
  } else {
    write_obj(walls, {recording, *step}, name, sink);
    write_mtl(walls, {recording, *step}, companion_sink);
  }
  commit_pair(companion, file);
}

std::string draw_pictures(const Recording& recording, const RecordingParams& params) {
  StripParams strip{.frames = params.frames,
                    .has_ground = params.has_ground,
                    .ground_height = params.ground_height};
  if (params.at) strip.only = step_nearest(recording, *params.at);
  return draw_strip(recording, strip);
}

}  // namespace

bool is_recording_suffix(const std::string& suffix, bool of_moment) {
  return (of_moment && suffix == ".obj") ||
         std::ranges::find(kSuffixes, suffix) != std::end(kSuffixes);
}

void export_recording(const Recording& recording, const std::filesystem::path& path,
                      const RecordingParams& params) {
  const std::string suffix = suffix_of(path);
  check_params(suffix, params);
  try {
    validate(recording);
    if (suffix != ".svg" && suffix != ".png") return write_solids(recording, path, suffix, params);
    const std::string svg = draw_pictures(recording, params);
    write_file(path, suffix == ".png" ? png_of(svg, params.picture_width) : svg);
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.starts_with(path.string())) throw;
    throw Error(error.code(), path.string() + ": " + message);
  }
}

}  // namespace sunder
