// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdio>
#include <string>

#include "fracture/measure.hpp"

namespace sunder {

/// Prints "`name`: NOT SOUND" and a line per kind of fault; for a sound asset "`name`: sound".
/// `details`: what stands between the two, may be empty.
void print_soundness(std::FILE* to, const std::string& name, const Soundness& soundness,
                     const std::string& details = "");

}  // namespace sunder
