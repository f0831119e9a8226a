// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "meshing/error.hpp"

namespace sunder {

/// A shared object that stands inside the library (sunder_embedded_module in
/// cmake/SunderTarget.cmake), so that there is no place where it must be found. It is linked to a
/// heavy library whose loading takes longer than the rest of the program.
struct EmbeddedModule {
  std::string name;       ///< it exports the object `sunder_<name>_module`
  std::string_view file;  ///< its bytes
  std::string needs;      ///< "level sets need OpenVDB's library (libopenvdb 10)"
  ErrorCode code = ErrorCode::input;
};

/// Loads it and returns the address of the object that it exports; it stays loaded. To be called
/// once for each. Throws Error{module.code} when the heavy library is not there.
const void* load_module(const EmbeddedModule& module);

}  // namespace sunder
