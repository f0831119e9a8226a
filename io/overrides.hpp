// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "io/json_value.hpp"

namespace sunder {

/// Sets a value of a tree as `--set` gives it: "walls.0.pattern.jitter=0.5", keys and list indices
/// joined by dots; the value is JSON, or else a text. Objects on the way are made when missing.
/// The new values have line 0. Throws Error{usage} for a path that leads nowhere.
void apply_override(JsonValue& root, const std::string& path_and_value);

}  // namespace sunder
