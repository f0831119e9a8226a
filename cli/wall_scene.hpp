// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "meshing/error.hpp"

namespace sunder {

/// Stands for the file in messages about a wall given by options.
inline constexpr const char* kCommandLine = "command line";

/// What a wall on the command line is made of, as given.
struct WallOptions {
  std::string size;                   ///< --wall
  std::string type = "voronoi-grid";  ///< --pattern
  std::vector<std::string> openings;
  std::string anchors;
  std::map<std::string, std::string> keys;  ///< name, material, min_cell; empty: not given
  std::map<std::string, std::vector<std::string>> pattern;  ///< key of a generator → values
  std::map<std::string, bool> is_points;                    ///< key of a generator → a point list
};

/// The text of a scene with that wall, so that one reader checks everything; always valid JSON.
/// Throws Error{usage} when a value has not the form its option wants.
std::string scene_text(const WallOptions& wall);

/// Option that gives a scene key: "min_cell" → "--min-cell".
std::string option_name(std::string_view key);

/// The same error about a value of the command line, named by its option: as Error{usage}
/// "--jitter: 1.4 is outside [0, 1]". `name` is the file parse_scene was told. An error about what
/// stands in a file comes back as it is.
Error named_by_option(const Error& error, const std::string& name);

}  // namespace sunder
