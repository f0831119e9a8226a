// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fracture/recover.hpp"
#include "fracture/spiderweb.hpp"

namespace sunder {

/// Damage that one hit makes in a wall that stands, in the place of the cells around it.
struct LocalWeb {
  std::vector<std::uint32_t> removed;  ///< cells that are replaced, ascending
  std::vector<Vec2> new_vertices;      ///< float32 values; indices go on after the pattern's
  std::vector<NewCell> added;
  /// Per added cell: 1 inside the damage polygon, 0 what is left of a removed cell outside it.
  std::vector<std::uint8_t> is_damaged;
};

/// The spiderweb of `spiderweb` around one impact point, drawn only into the cells it meets: the
/// damage polygon's sectors and rings, radial cracks that run on (`params.radial`, `params.reach`)
/// and what they leave of the old cells. `params.impacts` and `rest_cell` are not used. Cells that
/// the damage does not meet keep every vertex; no new vertex lies on an edge that such a cell has.
/// Only cells with `intact` set are used: earlier holes are borders, so hits merge into one hole.
/// Where the wall's border or a hole cuts the polygon, so are the cells.
/// Some edges may get no vertex: those of a cell that stays, intact or not, and borders along no
/// axis, on which no float32 point lies. Cracks that meet one end at an end of it; on a border
/// along an axis they end where they meet it. All added cells are topological discs. Returns no
/// cells when no intact cell is at the point. Deterministic; cost by the cells met, and a search of
/// all cells for the point unless `start` is an intact cell that contains it. Throws Error{input}
/// when parameters contradict each other, Error{geometry} when min_radius is below 2^-14 of the
/// wall's size.
LocalWeb local_web(const WallAsset& asset, std::span<const std::uint8_t> intact, Vec2 impact,
                   const SpiderwebParams& params, std::uint64_t seed,
                   std::uint32_t start = ~std::uint32_t{0});

}  // namespace sunder
