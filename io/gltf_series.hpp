// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "io/gltf_layout.hpp"
#include "io/gltf_text.hpp"

namespace sunder {

/// Whether a file tells how its run went: one of a recording with a series, not of one moment.
bool has_series(const GltfLayout& layout);

/// `,"extras":{"sunder":{"run":…,"joints":…,"events":…}}` of the document; "joints" where there are
/// any. `first_part`: node of part 0.
void write_series(const GltfLayout& layout, std::uint64_t first_part, GltfText& out);

/// Size of the block of joints' utilisations, with what fills it up to four bytes.
std::uint64_t series_bytes(const GltfLayout& layout);

/// In thousandths, at most 65535; 0 from the joint's break on.
std::uint16_t utilisation_at(const Recording& recording, std::size_t time, std::size_t joint);

/// Calls put(uint16) for that block: [time][joint].
template <class Put>
void for_each_utilisation(const GltfLayout& layout, const Put& put) {
  if (series_bytes(layout) == 0) return;
  const Recording& recording = *layout.recording;
  const std::size_t joints = recording.joints.size();
  for (std::size_t t = 0; t < recording.sample_times.size(); ++t)
    for (std::size_t j = 0; j < joints; ++j) put(utilisation_at(recording, t, j));
  if (recording.sample_times.size() * joints % 2 != 0) put(std::uint16_t{0});
}

}  // namespace sunder
