// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace sunder {

/// What librsvg does for pictures. It is linked to a module of its own, since loading it takes
/// longer than the rest of the program.
struct PngModule {
  struct Png {
    std::string bytes;
    std::string error;  ///< empty: none
  };
  /// `width` pixels wide, or narrower so that it is at most `most_height` high.
  Png (*render)(std::string_view svg, int width, int most_height);
};

}  // namespace sunder
