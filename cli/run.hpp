// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/options.hpp"

namespace sunder {

/// Exit codes (see docs/guide.md); a signal that stops the program gives 128 + its number.
enum ExitCode : int {
  kExitOk = 0,
  kExitCheckFailed = 1,
  kExitUsage = 2,
  kExitInput = 3,
  kExitOutput = 4,
  kExitBug = 70,
};

/// One verb each; returns the exit code, throws Error.
int run_fracture(const Options& options);
int run_impact(const Options& options);
int run_collapse(const Options& options);
int run_check(const Options& options);
int run_schema(const Options& options);
int run_view(const Options& options);
int run_completion(const Options& options);

}  // namespace sunder
