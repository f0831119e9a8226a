// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "meshing/vec.hpp"

namespace sunder {

/// Point on the unit circle at `turns` full turns (1 = 360°) from the x axis: {cos, sin}.
/// Error below 2e-16 per coordinate. The same bits on every processor, unlike the C library's
/// sin and cos, which change with the processor's instruction set.
Vec2 unit_at_turns(double turns);

/// Replaces angles in turns by their sines: the bits of unit_at_turns(…).y, in a fraction of its
/// time for each.
constexpr std::size_t kSines = 6;
void sines_at_turns(std::span<double, kSines> values);

}  // namespace sunder
