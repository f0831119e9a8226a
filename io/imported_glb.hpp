// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "io/import.hpp"

namespace sunder {

/// An imported asset as a GLB of a node per chunk with positions and triangles alone; `_outer` and
/// `_inner` faces keep their materials apart. Throws Error{input} if there is nothing to show.
std::string glb_of(const ImportedAsset& asset);

}  // namespace sunder
