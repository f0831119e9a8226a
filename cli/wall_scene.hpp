// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cli/scene_text.hpp"

namespace sunder {

/// What a wall on the command line is made of, as given.
struct WallOptions {
  std::string size;  ///< --wall
  std::vector<std::string> openings;
  std::string anchors;
  std::map<std::string, std::string> keys;  ///< name, material, min_cell; empty: not given
  KeyForms forms;                           ///< of the generators' keys
};

/// The text of a scene with that wall, so that one reader checks everything; always valid JSON.
/// Throws Error{usage} when a value has not the form its option wants.
std::string scene_text(const WallOptions& wall, const PatternOptions& pattern);

}  // namespace sunder
