// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/options.hpp"
#include "io/scene.hpp"

namespace sunder {

/// The scene of the command line: its file, or the one made of --wall …; with --set and --seed.
Scene read_scene(const Options& options);

/// --threads, or as many as the machine has.
int thread_count(const Options& options);

}  // namespace sunder
