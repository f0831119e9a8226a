// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/asset_path.hpp"

#include <algorithm>

namespace sunder {
namespace {

namespace fs = std::filesystem;

/// True when `path` lies in `folder` or below; both canonical.
bool is_inside(const fs::path& path, const fs::path& folder) {
  const auto [folder_end, ignored] =
      std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return folder_end == folder.end();
}

}  // namespace

std::string path_at(const Place& place, std::string_view what, const SceneFolder& folder) {
  const fs::path given = text_at(place);
  const std::string word(what);
  if (given.empty()) place.fail("the " + word + " is the path of a file, got an empty text");
  const std::string shown = "the " + word + ' ' + describe(place.value);
  const fs::path path = (folder.path / given).lexically_normal();
  std::error_code fault;
  const fs::path home =
      fs::weakly_canonical(fs::absolute(folder.path.empty() ? "." : folder.path, fault), fault);
  if (fault) place.fail("the scene's folder cannot be read: " + fault.message());
  const fs::path real = fs::weakly_canonical(fs::absolute(path, fault), fault);
  if (fault) place.fail(shown + " cannot be found: " + fault.message());
  if (!folder.allow_outside && (given.is_absolute() || !is_inside(real, home))) {
    place.fail(shown +
               " is not in the scene's folder; move it there or allow it with --allow-outside");
  }
  if (!fs::is_regular_file(real, fault)) {
    place.fail(shown + (fs::exists(real, fault) ? " is not a regular file" : " does not exist") +
               ", paths are relative to the scene file");
  }
  return path.string();
}

}  // namespace sunder
