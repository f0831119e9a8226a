// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/options.hpp"
#include "io/export_recording.hpp"
#include "io/scene.hpp"

namespace sunder {

/// Throws Error{usage} when --at is after the end of the run.
void check_moment(const Options& options, const Scene& scene);

/// How the files of a run are written, by --at, --width and --threads.
RecordingParams recording_params(const Options& options, const SimulationParams& simulation,
                                 const Recording& recording);

}  // namespace sunder
