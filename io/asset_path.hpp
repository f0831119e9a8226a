// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "io/json_place.hpp"

namespace sunder {

/// Where a scene's other files may be.
struct SceneFolder {
  const std::filesystem::path& path;  ///< of the scene file
  bool allow_outside = false;         ///< files may lie anywhere
};

/// Path of the regular file that a scene names, relative to its folder; `what` is its word in
/// messages ("asset"). Symbolic links count as where they lead. Throws as Place::fail.
std::string path_at(const Place& place, std::string_view what, const SceneFolder& folder);

}  // namespace sunder
