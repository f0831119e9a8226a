// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "meshing/error.hpp"

namespace sunder {

/// Ends the program with what is wrong on the command line.
[[noreturn]] inline void usage(const std::string& message) {
  throw Error(ErrorCode::usage, message + " (see sunder --help)");
}

}  // namespace sunder
