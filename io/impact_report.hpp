// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "io/run_report.hpp"
#include "sim/impact.hpp"

namespace sunder {

/// The numbers of an impact test, as `--report` writes them; refers to the result.
struct ImpactReport {
  std::string version;
  std::uint64_t seed = 0;
  const ImpactResult& result;
  double wall_s = 0;  ///< time of the whole run, s
  RunTimes times;
  RunSettings settings;
};

/// JSON text; numbers read back as the same doubles, one that is not finite is null.
std::string impact_report_json(const ImpactReport& report);

}  // namespace sunder
