// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "io/gltf_layout.hpp"
#include "io/text_writer.hpp"

namespace sunder {

/// Writes the JSON of a glTF file, padded to four bytes; returns its size. `binary_name`: URI of
/// the buffer; empty: the GLB's own.
std::uint64_t write_gltf_document(std::span<const WallView> walls, const GltfLayout& layout,
                                  const std::string& binary_name, ByteSink& sink);

}  // namespace sunder
