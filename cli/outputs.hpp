// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "cli/options.hpp"
#include "io/report_page.hpp"

namespace sunder {

/// Checks the files that a command line names, before any work is done: suffixes that the verb
/// writes, no file written twice, none of the inputs overwritten. Throws Error{usage}.
void check_outputs(const Options& options);

/// Throws Error{usage} when -o, --report or --history would overwrite one of these files, by
/// whatever name: what a scene reads is known only after reading it.
void check_not_written(const Options& options, std::span<const std::filesystem::path> inputs);

/// Writes a report to where the command line wants it: --json, every --report and -o FILE.json; the
/// page is made if one is wanted.
void write_report(const Options& options, std::string_view text,
                  const std::function<std::string()>& page);

/// What a report's page says of its origin.
PageSource page_source(const Options& options);

}  // namespace sunder
