// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/recording_params.hpp"

#include <algorithm>

#include "cli/read_scene.hpp"
#include "cli/usage.hpp"
#include "io/printable.hpp"

namespace sunder {

void check_moment(const Options& options, const Scene& scene) {
  const double duration = scene.simulation.duration;
  if (options.at && *options.at > duration)
    usage("--at " + number_text(*options.at) + " is after the end of the run, which lasts " +
          number_text(duration) + " s");
}

RecordingParams recording_params(const Options& options, const SimulationParams& simulation,
                                 const Recording& recording) {
  RecordingParams params{.has_ground = simulation.ground,
                         .ground_height = simulation.ground_height,
                         .at = options.at,
                         .picture_width = options.picture_width.value_or(kPictureWidth),
                         .threads = thread_count(options)};
  // The last step may end a rounding before the run does.
  if (params.at) params.at = std::min(*params.at, recording.times.back());
  return params;
}

}  // namespace sunder
