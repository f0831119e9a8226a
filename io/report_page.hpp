// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "io/collapse_report.hpp"
#include "io/impact_report.hpp"
#include "io/report.hpp"
#include "sim/simulation_params.hpp"

namespace sunder {

/// Where the numbers of a page come from.
struct PageSource {
  std::string input;    ///< name of the scene file, or what stands for it
  std::string command;  ///< the line that makes the numbers again; empty: not known
};

// Reports as pages to read and to print: one HTML file each, without scripts, that loads nothing.
// Same numbers, same bytes. `--report FILE.html` writes them.

/// The plots need the recording's series.
std::string impact_page(const ImpactReport& report, const PageSource& source);
std::string collapse_page(const CollapseReport& report, const PageSource& source);
/// Of `fracture` and `check`.
std::string soundness_page(const Report& report, const PageSource& source);

}  // namespace sunder
