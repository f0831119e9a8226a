// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "io/gltf_layout.hpp"
#include "io/text_writer.hpp"

namespace sunder {

/// Writes the binary buffer of a glTF file: layout.binary_size bytes. Poses are worked out on the
/// way, so that no copy of them is held.
void write_gltf_binary(std::span<const WallView> walls, const GltfLayout& layout, ByteSink& sink);

}  // namespace sunder
