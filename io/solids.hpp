// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <unordered_set>
#include <vector>

#include "fracture/solid_model.hpp"
#include "io/asset_path.hpp"
#include "io/json_place.hpp"
#include "sim/material.hpp"

namespace sunder {

/// Reads a list of solids; `names`: those that other things of the scene have already. Their files
/// are there but not opened. Throws as Place::fail.
std::vector<SolidModel> read_solids(const Place& list, const std::vector<Material>& materials,
                                    const SceneFolder& folder,
                                    std::unordered_set<std::string> names);

}  // namespace sunder
