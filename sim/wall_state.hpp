// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "fracture/recover.hpp"
#include "fracture/support_graph.hpp"
#include "sim/impact.hpp"
#include "sim/rigid_world.hpp"

namespace sunder {

constexpr std::uint32_t kNoCell = 0xFFFFFFFFu;
constexpr std::uint32_t kNoIsland = 0xFFFFFFFFu;

/// A chunk during a run; its number never changes, whatever becomes of the wall's cells.
struct ChunkState {
  std::uint32_t cell = kNoCell;      ///< of the wall's pattern; kNoCell: a part, see `loop`
  std::vector<std::uint32_t> loop;   ///< convex outline of a part: vertices, see WallState::place
  MassProperties mass;               ///< at density 1, wall frame
  std::uint32_t island = kNoIsland;  ///< that it belongs to; kNoIsland: it was replaced
  BodyId collider = kNoBody;         ///< while it stands and something is near
  std::uint8_t depth = 0;            ///< how often it broke since it was a cell
  bool has_hull = false;             ///< a collision shape was ever made of it
};

/// Connected chunks: what stands of a wall, or a body in motion.
struct Island {
  std::uint32_t wall = 0;
  std::vector<std::uint32_t> chunks;  ///< ascending
  std::vector<Bond> bonds;            ///< a and b count in `chunks`
  std::optional<SupportGraph> graph;  ///< of those; none for a single chunk
  BodyId body = kNoBody;              ///< kNoBody: it stands
  std::uint32_t track = kNoTrack;
};

/// Axis-aligned bounds of a box that is moved.
RigidWorld::Bounds bounds_of(const Pose& pose, Vec3 low, Vec3 high);

/// Finds the cells of a pattern near a point: bins over its bounding box.
class CellBins {
 public:
  CellBins() = default;  ///< of a wall without cells: finds none
  explicit CellBins(const Pattern& pattern);
  /// Cells whose bounding box meets the given box, ascending.
  std::vector<std::uint32_t> cells_in(Vec2 low, Vec2 high) const;
  /// The cell that contains the point, kNoCell if none does.
  std::uint32_t cell_at(const Pattern& pattern, Vec2 point) const;

 private:
  std::uint32_t column(double x) const;
  std::uint32_t row(double y) const;
  Vec2 low_;
  double size_ = 1;
  std::uint32_t columns_ = 1, rows_ = 1;
  std::vector<std::uint32_t> begin_, cells_;
};

/// One wall of a run.
struct WallState {
  WallState() = default;  ///< one that waits
  explicit WallState(const ImpactWall& wall);

  bool is_waiting = true;  ///< nowhere yet: no cells, no chunks
  WallAsset asset;
  Material material;
  Pose standing;  ///< the wall's frame at the start
  double half_thickness = 0;
  Vec3 low, high;            ///< bounds of the standing wall, world
  Vec2 size_low, size_high;  ///< the same in its own plane
  CellBins bins;
  std::vector<ChunkState> chunks;
  std::vector<std::uint32_t> chunk_of_cell;
  std::vector<Vec2> split_points;  ///< vertices that parts have and the pattern has not
  /// Edges of the pattern along which bonds broke: their vertices, the smaller first; ascending.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> cracked_edges;
  std::uint32_t hits = 0;  ///< that broke something
  bool touched = false;

  /// Position of a chunk's vertex: of the pattern, or (top bit set) of `split_points`.
  Vec2 place(std::uint32_t vertex) const;
  std::vector<Prism> prisms(std::uint32_t chunk) const;
  /// Mass, centre and inertia of chunks together, at the material's density; design frame.
  BodyParams body_of(const std::vector<std::uint32_t>& members) const;
  double area(std::uint32_t chunk) const;
  Surface surface() const { return {material.friction, material.restitution}; }
  const SpiderwebParams* web() const { return std::get_if<SpiderwebParams>(&asset.wall.pattern); }

  /// Notes that a bond between these chunks, or to the world, broke.
  void crack(Bond bond);
  /// Whether most of a bond of the asset lies along edges that cracked, whatever cells they
  /// belonged to then.
  bool is_cracked(const Bond& bond) const;

  /// Replaces cells; chunks of those that stay keep their numbers, new ones get the next. Returns
  /// the chunks of `added`.
  std::vector<std::uint32_t> replace(std::span<const std::uint32_t> removed,
                                     std::span<const Vec2> new_vertices,
                                     std::span<const NewCell> added);
  /// Splits a free, convex chunk around a point inside it into `count` parts at most; empty if it
  /// cannot be split there.
  std::vector<std::uint32_t> split(std::uint32_t chunk, Vec2 point, std::uint32_t count);
  /// Vertices of a convex chunk, counter-clockwise; empty for another.
  std::vector<std::uint32_t> outline_of(const ChunkState& state) const;
  std::vector<Vec2> places(std::span<const std::uint32_t> loop) const;
  void crack_parts_of_borders(std::span<const std::uint32_t> fresh);
  std::vector<std::uint32_t> add_parts(std::uint32_t chunk,
                                       std::span<const std::vector<std::uint32_t>> parts);
  /// The wall with all parts in the place of what they came from, and each chunk's island.
  RecordedWall recorded(const std::function<std::uint32_t(std::uint32_t)>& track_of) const;
};

/// Bonds among `members` (ascending chunks), counted within them; of bonds between chunks.
std::vector<Bond> bonds_among(const std::vector<std::uint32_t>& members,
                              std::span<const Bond> bonds);

/// An island of these chunks, `bonds` counted within them.
Island make_island(const WallState& wall, std::uint32_t wall_index,
                   std::vector<std::uint32_t> chunks, std::span<const Bond> bonds);

}  // namespace sunder
