// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "io/scene.hpp"
#include "sim/collapse.hpp"

namespace sunder {

/// What bringing a building down needs of a scene. Throws Error{input} without a building.
CollapseScene collapse_scene(const Scene& scene);

}  // namespace sunder
