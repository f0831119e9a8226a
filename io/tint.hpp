// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace sunder {

/// sRGB, 0 … 255. A little of a hue and a little light of the cell's own, so that neighbours can be
/// told apart and the whole still looks like its material.
std::array<double, 3> tinted(const std::array<double, 3>& base, std::uint32_t cell);

}  // namespace sunder
