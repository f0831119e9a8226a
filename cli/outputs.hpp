// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "cli/options.hpp"

namespace sunder {

/// Checks the files that a command line names, before any work is done: suffixes that the verb
/// writes, no file written twice, none of the inputs overwritten. Throws Error{usage}.
void check_outputs(const Options& options);

/// Throws Error{usage} when -o, --report or --history would overwrite one of these files, by
/// whatever name: what a scene reads is known only after reading it.
void check_not_written(const Options& options, std::span<const std::filesystem::path> inputs);

/// Writes a report to where the command line wants it: --json, --report and every -o FILE.json.
void write_report(const Options& options, std::string_view text);

}  // namespace sunder
