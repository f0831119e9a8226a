// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sunder::stress {

struct Limits {
  unsigned seconds = 120;
  std::size_t bytes = std::size_t{6} << 30;  ///< of address space
};

struct Outcome {
  int exit_code = -1;  ///< -1: ended by a signal
  int signal = 0;
  double seconds = 0;
  std::string talk;  ///< what it wrote to stderr, its first 4 KiB
};

/// Runs a program in a process of its own, so that whatever it does can be judged: a crash, a hang
/// (ended by SIGALRM after the limit), a runaway allocation. `scratch` takes its output.
Outcome run_command(const std::vector<std::string>& arguments, const std::filesystem::path& scratch,
                    const Limits& limits);

}  // namespace sunder::stress
