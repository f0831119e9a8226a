// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/run_report.hpp"
#include "sim/collapse.hpp"

namespace sunder {

/// The numbers of a collapse, as `--report` writes them; refers to scene and result. Names of
/// joints and nodes are those of the scene's frame.
struct CollapseReport {
  std::string version;
  const CollapseScene& scene;
  const CollapseResult& result;
  double wall_s = 0;  ///< time of the whole run, s
  RunTimes times;
  RunSettings settings;
};

/// JSON text; numbers read back as the same doubles, one that is not finite is null.
std::string collapse_report_json(const CollapseReport& report);

/// Of the scene's frame, or where a member divided: see Recording.
const std::string& joint_name(const Frame& frame, const CollapseResult& result,
                              std::uint32_t joint);
/// Every mode of JointBreak, in the order of the report's "broken_by".
inline constexpr std::array<std::string_view, 8> kBreakModes = {
    "strength", "hit", "buckling", "unbraced", "removed", "unheld", "panel", "mechanism"};
/// Broken joints of each mode.
std::array<std::uint64_t, kBreakModes.size()> count_by_mode(const CollapseResult& result);

}  // namespace sunder
