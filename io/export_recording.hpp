// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/png.hpp"
#include "sim/recording.hpp"

namespace sunder {

/// How a recording is written.
struct RecordingParams {
  int frames = 6;            ///< of a picture strip, 1 … 60
  bool has_ground = true;    ///< a picture shows the ground …
  double ground_height = 0;  ///< … at this height, m
  /// s: the file holds the nearest step as it was, without motion; .svg and .png one picture.
  std::optional<double> at = {};
  int picture_width = kPictureWidth;  ///< pixels, of a .png
  int threads = 1;
};

/// Suffixes export_recording writes: .glb .gltf .svg .png .html; of a moment (`at` is given) .obj
/// too.
bool is_recording_suffix(const std::string& suffix, bool of_moment = false);

/// Writes a recording in the format of the path's suffix; whole or not at all (a .gltf with its
/// .bin, an .obj with its .mtl). GLB and glTF hold what export_asset writes of the walls, a node
/// per projectile and part and one animation, "impact" or, with parts, "collapse"; SVG and PNG
/// are a strip of pictures (see draw_strip), HTML a page with the GLB in it. Throws Error{usage}
/// for another suffix, frames or a time out of range, Error{output} on failure. Same recording,
/// same bytes.
void export_recording(const Recording& recording, const std::filesystem::path& path,
                      const RecordingParams& params = {});

}  // namespace sunder
