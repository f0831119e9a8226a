// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sim/collapse.hpp"

namespace sunder {

/// Prints on standard error what the building is, how it stood at rest, what broke, and how far the
/// numbers can be trusted.
void print_collapse(const CollapseScene& scene, const CollapseResult& result);

}  // namespace sunder
