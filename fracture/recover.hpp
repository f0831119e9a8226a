// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fracture/asset.hpp"
#include "fracture/measure.hpp"

namespace sunder {

/// The wall that a file's float32 chunks describe: pattern, mass properties and bonds, from the
/// corners' bits (two corners are one when their bits are; -0 is 0), no tolerance. The order of
/// triangles and vertices in a chunk does not matter, so a wall in memory becomes the same by way
/// of its render meshes (soup_of): a simulation gives the same result for both.
///
/// `wall` gives name, material, anchors, place; its thickness and its outline come from the chunks.
/// Chunk c becomes cell c; its loop starts at its lexicographically smallest corner. The region has
/// one edge per straight run of border edges, its counter-clockwise loops first, each kind in the
/// order of the cells that have them; lattice and lattice corners are left as they are by default.
/// Border edges on one side of the bounding box all belong to the first run there, and are anchored
/// when wall.anchors names that side. wall.region has the first loop as its outline and the
/// clockwise ones as openings.
///
/// Throws Error{geometry} naming the chunk when a chunk is not one prism between two planes
/// z = ±t/2, all chunks one t, or an edge belongs to more than two chunks.
WallAsset recover_wall(const SoupWall& soup, Wall wall, double density);

/// A wall at the precision of a file, as if it had been written and read.
WallAsset at_file_precision(const WallAsset& asset, int threads = 1);

/// A cell that replaces another: loops of vertex indices, the outer one counter-clockwise first.
struct NewCell {
  std::vector<std::vector<std::uint32_t>> loops;
};
/// The wall with `removed` cells replaced by `added` ones that tile the same area. new_vertices[i]
/// (float32 values) becomes vertex pattern.vertices.size() + i; added cells may have one on an edge
/// that two of them share and exactly on a border edge, never on an edge shared with a cell that
/// stays. Cells that stay keep their order and come first; `old_cell[c]` of the result is the cell
/// it was, or 0xFFFFFFFF - i for added[i]. Mass properties and bonds are recomputed where they
/// change; anchors are as in recover_wall. Throws Error{geometry} when the edges of the added cells
/// and those of what stays do not pair up.
struct ReplacedCells {
  WallAsset asset;
  std::vector<std::uint32_t> old_cell;
};
ReplacedCells replace_cells(const WallAsset& asset, std::span<const std::uint32_t> removed,
                            std::span<const Vec2> new_vertices, std::span<const NewCell> added);

/// Corners of a strictly convex, counter-clockwise polygon to cut it along spokes from `point`,
/// strictly inside it, into convex sectors; ascending. `count` of them, at least 3, spread as
/// evenly as they can be; one more when the point lies so that no `count` of them will do; all
/// corners when there are fewer. Empty if the point is not strictly inside.
std::vector<std::uint32_t> choose_spokes(std::span<const Vec2> polygon, Vec2 point,
                                         std::uint32_t count);

/// The nearest point whose coordinates a file can hold.
Vec2 rounded_to_float(Vec2 point);

}  // namespace sunder
