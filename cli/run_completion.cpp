// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>

#include "cli/command_table.hpp"
#include "cli/run.hpp"
#include "cli/usage.hpp"

namespace sunder {

int run_completion(const Options& options) {
  if (std::ranges::find(kShells, options.shell) == kShells.end())
    usage("there is no completion for \"" + options.shell + "\"; there is for bash, zsh and fish");
  std::fputs(completion_script(command_table(), options.shell).c_str(), stdout);
  return kExitOk;
}

}  // namespace sunder
