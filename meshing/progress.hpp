// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

namespace sunder {

/// Told how much of the work is done, 0 … 1; may throw to stop.
using Progress = std::function<void(double)>;

}  // namespace sunder
