// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "io/asset_path.hpp"
#include "io/json_place.hpp"
#include "sim/collapse.hpp"

namespace sunder {

/// Reads what happens to a building. Throws as Place::fail.
Scenario read_scenario(const Place& place, const Frame& building, const SceneFolder& folder);

/// Reads a CSV file of rows `time, a`, along x, or `time, ax, ay, az`: s and m/s², times ascending
/// from 0 or later. One line of headings, empty lines and lines that start with # may be there. At
/// most 64 MiB and a million rows. Throws Error{input} `file:line: what`.
GroundMotion read_ground_motion(const std::filesystem::path& path);

}  // namespace sunder
