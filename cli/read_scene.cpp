// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/read_scene.hpp"

#include <algorithm>
#include <string_view>
#include <thread>

#include "cli/scene_text.hpp"
#include "meshing/error.hpp"

namespace sunder {

Scene read_scene(const Options& options) {
  // A model named on the command line may lie anywhere.
  const SceneParams params{options.overrides, options.allow_outside || options.is_model};
  const bool is_file = options.made_scene.empty();
  try {
    Scene scene = is_file ? read_scene(options.inputs.front(), params)
                          : parse_scene(options.made_scene, kCommandLine, params);
    if (options.seed) scene.seed = *options.seed;
    return scene;
  } catch (const Error& error) {
    const Error named =
        named_by_option(error, is_file ? options.inputs.front().string() : kCommandLine);
    constexpr std::string_view kSet = "--set: /simulation/max_error: ";
    const std::string message = named.what();
    if (!options.asks_error || !message.starts_with(kSet)) throw named;
    throw Error(named.code(), "--max-error: " + message.substr(kSet.size()));
  }
}

int thread_count(const Options& options) {
  if (options.threads > 0) return options.threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace sunder
