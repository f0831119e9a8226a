// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/export_recording.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "fracture/chunk_mesh.hpp"
#include "io/background_sink.hpp"
#include "io/export_files.hpp"
#include "io/gltf.hpp"
#include "io/gltf_animation.hpp"
#include "io/strip_svg.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

constexpr std::string_view kSuffixes[] = {".glb", ".gltf", ".svg"};
constexpr int kMostFrames = 60;

void check_params(const std::string& suffix, const RecordingParams& params) {
  if (!is_recording_suffix(suffix)) {
    throw Error(ErrorCode::usage,
                "suffix \"" + suffix + "\" of a recording is not one of .glb .gltf .svg");
  }
  if (params.frames < 1 || params.frames > kMostFrames) {
    throw Error(ErrorCode::usage, "frames = " + std::to_string(params.frames) + " is outside [1, " +
                                      std::to_string(kMostFrames) + "]");
  }
}

void write_animated(const Recording& recording, const std::filesystem::path& path,
                    const std::string& suffix, int threads) {
  std::vector<RenderMeshes> meshes;
  meshes.reserve(recording.walls.size());
  std::vector<WallView> walls;
  for (const RecordedWall& wall : recording.walls) {
    meshes.push_back(render_meshes(wall.asset, threads));
    walls.push_back(view_of(wall.asset, meshes.back()));
  }
  validate(walls);
  OutputFile file(path);
  if (suffix == ".glb") {
    BackgroundSink sink(file);
    write_glb(walls, sink, &recording);
    sink.finish();
    return file.commit();
  }
  OutputFile companion(companion_of(path));
  FileSink sink(file), companion_sink(companion);
  write_gltf(walls, companion_of(path).filename().string(), sink, companion_sink, &recording);
  commit_pair(companion, file);
}

}  // namespace

bool is_recording_suffix(const std::string& suffix) {
  return std::ranges::find(kSuffixes, suffix) != std::end(kSuffixes);
}

void export_recording(const Recording& recording, const std::filesystem::path& path,
                      const RecordingParams& params) {
  const std::string suffix = suffix_of(path);
  check_params(suffix, params);
  try {
    validate(recording);
    if (suffix != ".svg") return write_animated(recording, path, suffix, params.threads);
    write_file(path, draw_strip(recording, {.frames = params.frames,
                                            .has_ground = params.has_ground,
                                            .ground_height = params.ground_height}));
  } catch (const Error& error) {
    const std::string message = error.what();
    if (message.starts_with(path.string())) throw;
    throw Error(error.code(), path.string() + ": " + message);
  }
}

}  // namespace sunder
