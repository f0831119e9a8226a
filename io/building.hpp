// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "io/asset_path.hpp"
#include "io/building_keys.hpp"
#include "io/json_place.hpp"
#include "sim/frame.hpp"
#include "sim/material.hpp"

namespace sunder {

/// Reads a building: the regular part, then what is given by itself, joined. Throws as Place::fail,
/// also for a frame with defects (see defects_of), before it makes more than kMaxParts parts.
Frame read_building(const Place& place, const std::vector<Material>& materials,
                    const SceneFolder& folder);

/// What `building` says of every storey; `tables` has the sections, steels and materials.
StoreyParams read_common_storey(const Place& building, const Frame& tables,
                                const SceneFolder& folder);

/// The regular part of a building, `common` changed by its overrides; none if it is all given by
/// itself. Has at most kMaxParts parts, without those of set-backs.
std::optional<RegularBuilding> read_regular(const Place& building, const Frame& tables,
                                            const StoreyParams& common, const SceneFolder& folder);

/// Adds the nodes, members, slabs and wall panels that are given by themselves; what they leave out
/// is as in `common`. Returns the connections that are asked for.
std::vector<GivenJoint> add_given_parts(Frame& frame, const Place& building,
                                        const StoreyParams& common);

/// Fails for what is no list, or one of more than kMaxBuildingList.
void check_count(const Place& list);

}  // namespace sunder
