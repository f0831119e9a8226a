// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace sunder {

/// The command line as it can be pasted into a POSIX shell, its first word "sunder".
std::string command_line(int argc, const char* const* argv);

}  // namespace sunder
