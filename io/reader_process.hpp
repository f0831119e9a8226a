// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "io/import.hpp"

namespace sunder {

/// Runs `read` in a child process that may use no more than the limits, and brings its result back;
/// whatever the child does to itself, this process only sees an Error{input} that starts with
/// `name`. Threads of this process do not exist in the child: call it when none holds a lock.
ImportedAsset run_reader(const std::string& name, const ImportLimits& limits,
                         const std::function<ImportedAsset()>& read);

}  // namespace sunder
