// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "io/strip_paper.hpp"
#include "io/strip_scene.hpp"

namespace sunder {

/// Everything at one step: shadows, then solids from far to near.
void draw_strip_picture(const StripScene& scene, std::uint32_t step, StripPaper& paper);

}  // namespace sunder
