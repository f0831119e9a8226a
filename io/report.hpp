// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "fracture/measure.hpp"
#include "meshing/repair.hpp"

namespace sunder {

/// What was done to a solid's model before it was fractured.
struct ReportedRepair {
  std::string solid;  ///< its name
  Repair repair;      ///< the surface is not used
};

/// The numbers of one run, as `--report` writes them.
struct Report {
  std::string version;
  std::uint64_t seed = 0;
  Soundness soundness;
  std::uint64_t slivers_merged = 0;
  std::vector<std::pair<std::string, double>> times;           ///< "pattern" → seconds
  std::vector<std::pair<std::string, std::uint64_t>> skipped;  ///< what was not done, and how much
  std::vector<ReportedRepair> repairs = {};
};

/// JSON text; numbers read back as the same doubles, a measure that is not known is null.
std::string report_json(const Report& report);

}  // namespace sunder
