// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include "fracture/solid_model.hpp"
#include "meshing/repair.hpp"

namespace sunder {

/// A model as it is fractured: sound, in metres, with its craters.
struct PreparedSolid {
  ModelSurface surface;
  std::optional<Repair> repair;  ///< what was done, without its surface; none: it was sound
};

/// Scales a model, checks it, repairs it if that is asked for and needed, and takes its craters
/// away. Throws Error{geometry} with what is wrong, and where, if it is not a solid and is not to be
/// repaired, or as repair and carve do. `seed`: of the craters' roughness.
PreparedSolid prepare_solid(const SolidModel& solid, ModelSurface model, std::uint64_t seed);

}  // namespace sunder
