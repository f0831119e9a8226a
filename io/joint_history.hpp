// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "sim/recording.hpp"

namespace sunder {

/// Suffixes write_joint_history writes: .csv .json
bool is_history_suffix(const std::string& suffix);

/// Writes the loads of a recording's joints over time in the format of the path's suffix, whole or
/// not at all; a joint's values end before it breaks. CSV has a row for each sampling time and
/// joint that holds, by time; JSON a list of values for each joint, the first ones of "times".
/// Loads read back as the same float32, times as the same double; what is not finite is inf or nan
/// in CSV, null in JSON. Never the whole text in memory. Throws Error{usage} for another suffix,
/// Error{output} on failure. Same recording, same bytes.
void write_joint_history(const Recording& recording, const std::filesystem::path& path);

}  // namespace sunder
