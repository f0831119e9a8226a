// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "io/text_writer.hpp"
#include "io/wall_view.hpp"
#include "sim/recording.hpp"

namespace sunder {

/// Writes Wavefront OBJ as docs/formats.md describes it: one object per chunk, in the world's frame
/// (OBJ has no nodes), and its materials. The walls are valid (see validate). `material_file` is
/// the .mtl's name without folder.
void write_obj(std::span<const WallView> walls, const std::string& material_file, ByteSink& out);
void write_mtl(std::span<const WallView> walls, ByteSink& out);

/// A step of a valid recording.
struct RecordedMoment {
  const Recording& recording;
  std::uint32_t step = 0;
};
/// The same of the recording's walls as they are then, with its projectiles and parts, an object
/// each. What is not there is left out. With parts, corners have colours ("v x y z r g b", sRGB
/// 0 … 1): members those that show the loads of their ends, all else white.
void write_obj(std::span<const WallView> walls, const RecordedMoment& moment,
               const std::string& material_file, ByteSink& out);
void write_mtl(std::span<const WallView> walls, const RecordedMoment& moment, ByteSink& out);

}  // namespace sunder
