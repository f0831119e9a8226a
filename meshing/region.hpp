// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "meshing/lattice.hpp"
#include "meshing/vec.hpp"

namespace sunder {

/// Closed polygon without self-intersection, first corner not repeated, metres.
using Loop = std::vector<Vec2>;

/// A simple polygon with openings, in the wall's plane, metres. Windings are free.
/// Openings may touch the outline and each other but neither cross nor overlap.
struct Region {
  Loop outline;
  std::vector<Loop> openings;
};

/// Rectangle with its lower left corner at `at`, counter-clockwise: bottom, right, top, left edge.
Loop rectangle(Vec2 size, Vec2 at = {});

/// Signed area, m², positive when counter-clockwise; relative error below 1e-15 per corner.
double area(std::span<const Vec2> loop);
/// Area of the outline less the openings, m².
double area(const Region& region);
/// Lower left and upper right corner of a loop.
struct Box {
  Vec2 low, high;
};
Box bounding_box(std::span<const Vec2> loop);

/// A region on the lattice: boundary edge k runs from corner k to corner `next(k)`, the region on
/// its left (outline counter-clockwise, openings clockwise). `places` are the same corners in
/// metres, exactly as given. Edges of the outline come first, in the order given (reversed when the
/// outline was clockwise), then those of opening 0, 1, …
struct LatticeRegion {
  Lattice lattice;
  std::vector<LatticePoint> corners;
  std::vector<Vec2> places;
  std::vector<std::uint32_t> loop_begin{0};  ///< loop l has corners loop_begin[l] … loop_begin[l+1]

  std::uint32_t edge_count() const { return static_cast<std::uint32_t>(corners.size()); }
  std::uint32_t loop_count() const { return static_cast<std::uint32_t>(loop_begin.size()) - 1; }
  std::uint32_t loop_of(std::uint32_t corner) const;
  std::uint32_t next(std::uint32_t corner) const;
  /// True when the region is exactly its bounding box.
  bool is_box() const;
};

/// Most corners of outline and openings together; checking them takes time with their square.
constexpr std::size_t kMaxCorners = 20000;

/// Puts a region on a lattice over its bounding box and checks it: exact, O(edges²). Loops that
/// come nearer than 2^-20 of the region's size touch: a corner that near to another loop's corner
/// takes its place, one that near to another loop's edge becomes a corner of that loop too. Throws
/// Error{geometry} naming the loops, corners and coordinates at fault: fewer than 3 corners, a
/// value that is not finite, corners nearer than a lattice step, a loop that meets itself, loops
/// that cross or overlap, an opening outside the outline. `what` names the wall in the message.
LatticeRegion make_lattice_region(const Region& region, const Lattice& lattice,
                                  const std::string& what);

/// Area of the region with its corners in their places, m².
double area(const LatticeRegion& region);

/// +1 inside, 0 on the boundary, -1 outside the region; exact. O(edges).
int locate(const LatticeRegion& region, LatticePoint point);

}  // namespace sunder
