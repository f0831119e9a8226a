// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "io/text_writer.hpp"
#include "io/wall_view.hpp"
#include "sim/recording.hpp"

namespace sunder {

/// Writes glTF 2.0 as docs/formats.md describes it. The walls are valid (see validate). Bytes
/// depend on the walls' content only. Throws Error{output}: a GLB cannot hold more than 4 GiB.
/// `recording`, of the same walls and valid: its projectiles, parts and motion are written too;
/// with `step` all as they are then, and no motion.
void write_glb(std::span<const WallView> walls, ByteSink& out, const Recording* recording = nullptr,
               std::optional<std::uint32_t> step = {});
/// The same as JSON with its binary beside it; `binary_name` is that file's name without folder.
void write_gltf(std::span<const WallView> walls, const std::string& binary_name, ByteSink& json,
                ByteSink& binary, const Recording* recording = nullptr,
                std::optional<std::uint32_t> step = {});

}  // namespace sunder
