// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim/recording.hpp"

namespace sunder {

struct StripParams {
  int frames = 6;            ///< at most; fewer when the recording has fewer steps
  bool has_ground = true;    ///< the ground is drawn, with shadows …
  double ground_height = 0;  ///< … at this height, m
  /// A single picture of this step, from the same place, larger.
  std::optional<std::uint32_t> only = {};
};

/// Pictures of a recording, side by side in rows of three, as SVG: in perspective from one place,
/// with the time below each. Those of a building show the stress of its members' ends, with a
/// legend below. Same recording, same bytes. The recording is valid.
std::string draw_strip(const Recording& recording, const StripParams& params = {});

}  // namespace sunder
