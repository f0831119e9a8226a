// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "fracture/solid_asset.hpp"
#include "io/wall_view.hpp"

namespace sunder {

/// View of a solid and its meshes, which must outlive it, for a file at `path`. Its materials are
/// those of the model under portable names (one without a name looks as the solid's material), then
/// "<material>_inner". Textures that are not PNG or JPEG files are left out.
WallView view_of(const SolidAsset& asset, const SolidMeshes& meshes,
                 const std::filesystem::path& path);

/// Materials that differ get names that differ, by a number behind the later one's; formats without
/// material numbers mix them up else.
void make_names_differ(std::vector<WallView>& views);

}  // namespace sunder
