// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "io/strip_camera.hpp"
#include "io/strip_paper.hpp"
#include "io/strip_svg.hpp"
#include "sim/recording.hpp"

namespace sunder {

/// A convex part of a chunk; a convex chunk is its own only part. A building is one more wall,
/// after the others: its members, slabs and walls are the chunks.
struct StripPart {
  static constexpr std::uint32_t kBorder = UINT32_MAX, kInside = UINT32_MAX - 1;
  std::uint32_t wall = 0, chunk = 0;
  std::vector<Vec2> outline;          ///< m, wall frame, counter-clockwise
  std::vector<std::uint32_t> across;  ///< per edge: a chunk, kBorder, or kInside of its own chunk
  double half = 0;                    ///< extruded over z = middle ± half, m
  double end = 0;                     ///< length of a member's ends that show stress, m
  double middle = 0;
  bool has_back = true, has_front = true;  ///< caps; not where it was divided
};
std::vector<StripPart> strip_parts(const Recording& recording);

/// Whether a material is seen through: its name has "glass" or "pmma" in it.
bool is_glass(std::string_view material);

/// What all pictures of a strip share.
struct StripScene {
  const Recording& recording;
  StripParams params;
  std::vector<StripPart> parts;
  StripCamera camera;
};

/// Gradients (of glass walls: "glass0", by wall), filters and the empty scenery, inside a <defs>.
void draw_strip_defs(const StripScene& scene, StripPaper& paper);

}  // namespace sunder
