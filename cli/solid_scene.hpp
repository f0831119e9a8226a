// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cli/scene_text.hpp"

namespace sunder {

/// What a solid on the command line is made of, as given.
struct SolidOptions {
  std::map<std::string, std::string> keys;  ///< plain ones; empty: not given
  bool repair = false;
  std::vector<std::string> craters;  ///< --carve X,Y,Z:RADIUS[:DEPTH]
  KeyForms forms;                    ///< of the patterns' keys
};

/// As scene_text of a wall, of the solid in the file `model`.
std::string scene_text(const std::string& model, const SolidOptions& solid,
                       const PatternOptions& pattern);

}  // namespace sunder
