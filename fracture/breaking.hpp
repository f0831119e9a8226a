// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fracture/pattern.hpp"
#include "meshing/raw_vector.hpp"

namespace sunder {

/// Which cells of a wall still stand, and which faces that opens. A corner of the pattern stands
/// for the face over its edge; the face shows when its own cell is intact and the cell across is
/// broken (border faces always show while their cell is intact and are not listed).
///
/// The pattern must outlive the object. Memory: one byte per cell and per corner.
class BreakableWall {
 public:
  explicit BreakableWall(const Pattern& pattern);

  /// What one call changed, each list sorted. `shown` and `hidden` are corners.
  struct Change {
    std::vector<std::uint32_t> broken;
    std::vector<std::uint32_t> shown;
    std::vector<std::uint32_t> hidden;
    std::uint64_t cells_touched = 0;  ///< cells looked at: the broken ones and their neighbours
  };
  /// Breaks the cells that are still intact among `cells`. O(corners of those and their
  /// neighbours), whatever the size of the wall; the state equals that of a full rebuild
  /// (shown_faces).
  Change break_cells(std::span<const std::uint32_t> cells);

  bool is_intact(std::uint32_t cell) const { return intact_[cell] != 0; }
  bool is_shown(std::uint32_t corner) const { return shown_[corner] != 0; }
  std::span<const std::uint8_t> intact() const { return intact_; }
  std::span<const std::uint8_t> shown() const { return shown_; }

 private:
  const Pattern& pattern_;
  RawVector<std::uint8_t> intact_, shown_;
};

/// The flags of all faces from the cells' flags, the whole wall anew: the definition that
/// BreakableWall is tested against. O(corners).
std::vector<std::uint8_t> shown_faces(const Pattern& pattern, std::span<const std::uint8_t> intact);

/// Whether the closed cell contains the point (metres, wall frame), decided exactly.
bool contains(const Pattern& pattern, std::uint32_t cell, Vec2 point);

/// The cell whose closed polygon contains the point (metres, wall frame), or cell_count() when
/// none does; of several that share a border the first. O(cells).
std::uint32_t cell_at(const Pattern& pattern, Vec2 point);

/// The cells that a disc meets, found from `start` (the cell of its centre) across edges that the
/// disc meets; sorted. What only an opening connects is not found. Touches only cells near the
/// disc.
std::vector<std::uint32_t> cells_near(const Pattern& pattern, std::uint32_t start, Vec2 centre,
                                      double radius);

}  // namespace sunder
