// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/level_set_module.hpp"

#include "meshing/embedded_module.hpp"

namespace sunder {

std::string_view level_set_file();

const LevelSetModule& level_set_module() {
  static const void* const module = load_module(
      {"level_set", level_set_file(), "level sets need OpenVDB's library (libopenvdb 10)"});
  return *static_cast<const LevelSetModule*>(module);
}

}  // namespace sunder
