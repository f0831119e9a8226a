// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "io/text_writer.hpp"
#include "io/wall_view.hpp"

namespace sunder {

/// Writes Wavefront OBJ as docs/formats.md describes it: one object per chunk, in the world's frame
/// (OBJ has no nodes), and its materials. The walls are valid (see validate). `material_file` is
/// the .mtl's name without folder.
void write_obj(std::span<const WallView> walls, const std::string& material_file, ByteSink& out);
void write_mtl(std::span<const WallView> walls, ByteSink& out);

}  // namespace sunder
