// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "fracture/asset.hpp"
#include "fracture/solid_asset.hpp"

namespace sunder {

/// A picture of the asset's patterns, walls side by side: each flat, with border, openings, impact
/// points and anchored sides, and below it in an oblique view with its chunks pushed apart (flat
/// only above 5000 chunks); then solids, each as it stands and below with its chunks pushed apart.
/// What would be more than twice as high as wide has the second pictures beside the first.
/// Millimetres, y up turned to SVG's y down. Same asset, same bytes.
std::string draw_svg(const Asset& asset, std::span<const SolidAsset> solids = {});

}  // namespace sunder
