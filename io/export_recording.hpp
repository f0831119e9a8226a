// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "sim/recording.hpp"

namespace sunder {

/// How a recording is written.
struct RecordingParams {
  int frames = 6;            ///< of a picture strip, 1 … 60
  bool has_ground = true;    ///< a picture shows the ground …
  double ground_height = 0;  ///< … at this height, m
  int threads = 1;
};

/// Suffixes export_recording writes: .glb .gltf .svg
bool is_recording_suffix(const std::string& suffix);

/// Writes a recording in the format of the path's suffix; whole or not at all (a .gltf with its
/// .bin). GLB and glTF hold what export_asset writes of the walls, a node per projectile and one
/// animation, "impact"; SVG is a strip of pictures (see draw_strip). Throws Error{usage} for
/// another suffix or frames out of range, Error{output} on failure. Same recording, same bytes.
void export_recording(const Recording& recording, const std::filesystem::path& path,
                      const RecordingParams& params = {});

}  // namespace sunder
