// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "io/scene.hpp"
#include "sim/impact.hpp"

namespace sunder {

/// What an impact test needs of a scene: its walls fractured, or imported chunk by chunk from the
/// files that `asset` names; both at the precision of a file, so that they give the same run. Throws
/// Error{input} for an asset that is not one of ours, with the file and the reason.
ImpactScene impact_scene(const Scene& scene, int threads = 1, const Progress& progress = {});

/// A wall at the precision of a file, as if it had been written and read.
WallAsset at_file_precision(const WallAsset& asset, int threads = 1);

}  // namespace sunder
