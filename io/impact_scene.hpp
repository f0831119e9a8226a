// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "io/scene.hpp"
#include "sim/impact.hpp"

namespace sunder {

/// A wall from the file that its `asset` names, chunk by chunk, at the precision of the file.
/// Throws Error{input} with the file and the reason.
ImpactWall import_wall(const Scene& scene, Wall wall);

/// What an impact test needs of a scene: its walls fractured, or imported chunk by chunk from the
/// files that `asset` names; both at the precision of a file, so that they give the same run.
/// Throws Error{input} for an asset that is not one of ours, with the file and the reason.
ImpactScene impact_scene(const Scene& scene, int threads = 1, const Progress& progress = {});

}  // namespace sunder
