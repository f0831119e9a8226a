// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/wall_state.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "fracture/chunk_mesh.hpp"
#include "meshing/triangulate.hpp"

namespace sunder {
namespace {

constexpr std::uint32_t kSplitPoint = 0x80000000u;
/// Parts smaller than this are not made: m, and as a share of the thickness.
constexpr double kLeastPart = 0.01;

struct Extent {
  Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
  void add(Vec2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
};

Extent extent_of(const Pattern& pattern, std::uint32_t cell) {
  Extent extent;
  for (std::uint32_t k = pattern.cell_begin[cell]; k < pattern.cell_begin[cell + 1]; ++k)
    extent.add(pattern.vertices[pattern.corners[k]]);
  return extent;
}

bool contains(const Pattern& pattern, std::uint32_t cell, Vec2 p) {
  bool inside = false;
  for (const LoopRange loop : loops_of(pattern, cell))
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      const Vec2 a = pattern.vertices[pattern.corners[k]];
      const Vec2 b = pattern.vertices[pattern.corners[loop.next(k)]];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      // The same arithmetic in both cells that share the edge, so one of them has the point.
      const Vec2 low = a.y < b.y ? a : b, high = a.y < b.y ? b : a;
      inside ^= cross(high - low, p - low) > 0;
    }
  return inside;
}

double polygon_area(std::span<const Vec2> p) {
  double twice = 0;
  for (std::size_t i = 2; i < p.size(); ++i) twice += cross(p[i - 1] - p[0], p[i] - p[0]);
  return twice / 2;
}

/// A prism's mass properties at density 1, by the polygon's moments about its first corner.
MassProperties prism_mass(std::span<const Vec2> p, double thickness) {
  double area = 0, xx = 0, yy = 0, xy = 0;
  Vec2 first_moment;
  for (std::size_t i = 2; i < p.size(); ++i) {
    const Vec2 a = p[i - 1] - p[0], b = p[i] - p[0];
    const double twice = cross(a, b);
    area += twice / 2;
    first_moment = first_moment + (twice / 6) * (a + b);
    xx += twice / 12 * (a.x * a.x + a.x * b.x + b.x * b.x);
    yy += twice / 12 * (a.y * a.y + a.y * b.y + b.y * b.y);
    xy += twice / 24 * (2 * a.x * a.y + a.x * b.y + b.x * a.y + 2 * b.x * b.y);
  }
  const Vec2 c = (1 / area) * first_moment;
  xx -= area * c.x * c.x, yy -= area * c.y * c.y, xy -= area * c.x * c.y;
  const double t = thickness, zz = area * t * t * t / 12;
  MassProperties m;
  m.volume = area * t;
  m.centroid = {p[0].x + c.x, p[0].y + c.y, 0};
  m.inertia = {yy * t + zz, xx * t + zz, (xx + yy) * t, -xy * t, 0, 0};
  return m;
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The edges of a cell that make its bond; `bond` counts in cells.
template <typename Visit>
void for_each_edge(const Pattern& pattern, const Bond& bond, Visit visit) {
  for (const LoopRange loop : loops_of(pattern, bond.a))
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      const std::uint32_t from = pattern.corners[k], to = pattern.corners[loop.next(k)];
      const Vec2 edge = pattern.vertices[to] - pattern.vertices[from];
      const Across across = pattern.across[k];
      // Anchored borders are sides of a box, so the normal tells them apart.
      const bool is_its =
          bond.b == kWorld ? across.is_border() && edge.y * bond.normal.x - edge.x * bond.normal.y >
                                                       0.9 * length(edge)
                           : across == Across::cell(bond.b);
      if (is_its) visit(Edge(std::minmax(from, to)), length(edge));
    }
}

/// Whether both ends of a border edge lie on another one.
bool lies_on(const Pattern& pattern, Edge part, Edge whole) {
  const Vec2 a = pattern.vertices[whole.first], b = pattern.vertices[whole.second];
  const auto on = [&](Vec2 p) {
    return orientation(a, b, p) == 0 && dot(p - a, b - a) >= 0 && dot(p - b, b - a) <= 0;
  };
  return on(pattern.vertices[part.first]) && on(pattern.vertices[part.second]);
}

/// Convex with room to spare, and not a splinter.
bool is_sturdy(std::span<const Vec2> polygon, double least) {
  if (!(polygon_area(polygon) >= least * least)) return false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const Vec2 c = polygon[(i + 2) % polygon.size()];
    if (!(cross(b - a, c - b) > 1e-9 * length(b - a) * length(c - b))) return false;
  }
  return true;
}

}  // namespace

RigidWorld::Bounds bounds_of(const Pose& pose, Vec3 low, Vec3 high) {
  RigidWorld::Bounds box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  for (int i = 0; i < 8; ++i) {
    const Vec3 p =
        pose * Vec3{i & 1 ? low.x : high.x, i & 2 ? low.y : high.y, i & 4 ? low.z : high.z};
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

CellBins::CellBins(const Pattern& pattern) {
  Extent all;
  for (std::uint32_t c = 0; c < pattern.cell_count(); ++c)
    for (std::uint32_t k = pattern.cell_begin[c]; k < pattern.cell_begin[c + 1]; ++k)
      all.add(pattern.vertices[pattern.corners[k]]);
  const Vec2 size = all.high - all.low;
  low_ = all.low;
  size_ =
      std::max({std::sqrt(size.x * size.y / pattern.cell_count()), 1e-4 * size.x, 1e-4 * size.y});
  columns_ = static_cast<std::uint32_t>(size.x / size_) + 1;
  rows_ = static_cast<std::uint32_t>(size.y / size_) + 1;
  begin_.assign(std::size_t{columns_} * rows_ + 1, 0);
  const auto for_each_bin = [&](std::uint32_t c, auto visit) {
    const Extent e = extent_of(pattern, c);
    for (std::uint32_t j = row(e.low.y); j <= row(e.high.y); ++j)
      for (std::uint32_t i = column(e.low.x); i <= column(e.high.x); ++i) visit(j * columns_ + i);
  };
  for (std::uint32_t c = 0; c < pattern.cell_count(); ++c)
    for_each_bin(c, [&](std::uint32_t bin) { ++begin_[bin + 1]; });
  for (std::size_t b = 1; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
  cells_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t c = 0; c < pattern.cell_count(); ++c)
    for_each_bin(c, [&](std::uint32_t bin) { cells_[next[bin]++] = c; });
}

std::uint32_t CellBins::column(double x) const {
  return static_cast<std::uint32_t>(std::clamp((x - low_.x) / size_, 0.0, columns_ - 1.0));
}
std::uint32_t CellBins::row(double y) const {
  return static_cast<std::uint32_t>(std::clamp((y - low_.y) / size_, 0.0, rows_ - 1.0));
}

std::vector<std::uint32_t> CellBins::cells_in(Vec2 low, Vec2 high) const {
  std::vector<std::uint32_t> found;
  for (std::uint32_t j = row(low.y); j <= row(high.y); ++j)
    for (std::uint32_t i = column(low.x); i <= column(high.x); ++i) {
      const std::size_t bin = std::size_t{j} * columns_ + i;
      found.insert(found.end(), cells_.begin() + begin_[bin], cells_.begin() + begin_[bin + 1]);
    }
  std::ranges::sort(found);
  found.erase(std::ranges::unique(found).begin(), found.end());
  return found;
}

std::uint32_t CellBins::cell_at(const Pattern& pattern, Vec2 point) const {
  const std::size_t bin = std::size_t{row(point.y)} * columns_ + column(point.x);
  for (std::uint32_t i = begin_[bin]; i < begin_[bin + 1]; ++i)
    if (contains(pattern, cells_[i], point)) return cells_[i];
  return kNoCell;
}

WallState::WallState(const ImpactWall& wall)
    : is_waiting(false),
      asset(wall.asset),
      material(wall.material),
      standing{wall.asset.wall.position, wall.asset.wall.rotation},
      half_thickness(wall.asset.wall.thickness / 2),
      bins(wall.asset.pattern) {
  const std::uint32_t count = asset.pattern.cell_count();
  chunks.resize(count);
  chunk_of_cell.resize(count);
  Extent extent;
  for (std::uint32_t c = 0; c < count; ++c) {
    chunks[c].cell = c;
    chunks[c].mass = asset.chunks[c];
    chunk_of_cell[c] = c;
    const Extent e = extent_of(asset.pattern, c);
    extent.add(e.low), extent.add(e.high);
  }
  size_low = extent.low, size_high = extent.high;
  const RigidWorld::Bounds box = bounds_of(standing, {size_low.x, size_low.y, -half_thickness},
                                           {size_high.x, size_high.y, half_thickness});
  low = box.low, high = box.high;
}

Vec2 WallState::place(std::uint32_t vertex) const {
  return vertex & kSplitPoint ? split_points[vertex & ~kSplitPoint]
                              : asset.pattern.vertices[vertex];
}

std::vector<Prism> WallState::prisms(std::uint32_t chunk) const {
  const ChunkState& state = chunks[chunk];
  const auto prism = [&](std::span<const std::uint32_t> loop) {
    Prism p{{}, half_thickness};
    for (const std::uint32_t v : loop) p.outline.push_back(place(v));
    return p;
  };
  if (state.cell == kNoCell) return {prism(state.loop)};
  std::vector<Prism> parts;
  for (const auto& part : convex_parts(asset, state.cell)) parts.push_back(prism(part));
  return parts;
}

double WallState::area(std::uint32_t chunk) const {
  return chunks[chunk].mass.volume / (2 * half_thickness);
}

BodyParams WallState::body_of(const std::vector<std::uint32_t>& members) const {
  BodyParams body;
  double volume = 0;
  Vec3 moment;
  for (const std::uint32_t c : members) {
    volume += chunks[c].mass.volume;
    moment = moment + chunks[c].mass.volume * chunks[c].mass.centroid;
  }
  body.centroid = (1 / volume) * moment;
  SymMat3 sum;
  for (const std::uint32_t c : members) {
    const MassProperties& m = chunks[c].mass;
    const Vec3 d = m.centroid - body.centroid;
    const double v = m.volume;
    sum.xx += m.inertia.xx + v * (d.y * d.y + d.z * d.z);
    sum.yy += m.inertia.yy + v * (d.x * d.x + d.z * d.z);
    sum.zz += m.inertia.zz + v * (d.x * d.x + d.y * d.y);
    sum.xy += m.inertia.xy - v * d.x * d.y;
    sum.xz += m.inertia.xz - v * d.x * d.z;
    sum.yz += m.inertia.yz - v * d.y * d.z;
  }
  const double density = material.density;
  body.mass = density * volume;
  body.inertia = {density * sum.xx, density * sum.yy, density * sum.zz,
                  density * sum.xy, density * sum.xz, density * sum.yz};
  body.pose = standing;
  body.surface = surface();
  return body;
}

void WallState::crack(Bond bond) {
  bond.a = chunks[bond.a].cell;
  if (bond.b != kWorld) bond.b = chunks[bond.b].cell;
  for_each_edge(asset.pattern, bond, [&](Edge edge, double) {
    const auto at = std::ranges::lower_bound(cracked_edges, edge);
    if (at == cracked_edges.end() || *at != edge) cracked_edges.insert(at, edge);
  });
}

bool WallState::is_cracked(const Bond& bond) const {
  double cracked = 0, all = 0;
  for_each_edge(asset.pattern, bond, [&](Edge edge, double size) {
    all += size;
    if (std::ranges::binary_search(cracked_edges, edge)) cracked += size;
  });
  return cracked > 0.5 * all;
}

// A border that cracked stays so when new cells cut it into several edges.
void WallState::crack_parts_of_borders(std::span<const std::uint32_t> fresh) {
  const std::vector<Edge> before = cracked_edges;
  if (before.empty()) return;
  const Pattern& pattern = asset.pattern;
  for (const std::uint32_t chunk : fresh)
    for (const LoopRange loop : loops_of(pattern, chunks[chunk].cell))
      for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
        if (!pattern.across[k].is_border()) continue;
        const Edge edge = std::minmax(pattern.corners[k], pattern.corners[loop.next(k)]);
        if (std::ranges::any_of(before, [&](Edge e) { return lies_on(pattern, edge, e); }))
          cracked_edges.push_back(edge);
      }
  std::ranges::sort(cracked_edges);
  cracked_edges.erase(std::ranges::unique(cracked_edges).begin(), cracked_edges.end());
}

std::vector<std::uint32_t> WallState::replace(std::span<const std::uint32_t> removed,
                                              std::span<const Vec2> new_vertices,
                                              std::span<const NewCell> added) {
  ReplacedCells replaced = replace_cells(asset, removed, new_vertices, added);
  std::vector<std::uint32_t> chunk_of(replaced.old_cell.size()), fresh(added.size());
  for (const std::uint32_t cell : removed) chunks[chunk_of_cell[cell]].island = kNoIsland;
  for (std::uint32_t cell = 0; cell < replaced.old_cell.size(); ++cell) {
    const std::uint32_t old = replaced.old_cell[cell];
    const bool is_new = old >= kNoCell - added.size();
    if (is_new) {
      fresh[kNoCell - old] = static_cast<std::uint32_t>(chunks.size());
      chunks.emplace_back();
      chunks.back().mass = replaced.asset.chunks[cell];
    }
    chunk_of[cell] = is_new ? fresh[kNoCell - old] : chunk_of_cell[old];
    chunks[chunk_of[cell]].cell = cell;
  }
  for (const std::uint32_t cell : removed) chunks[chunk_of_cell[cell]].cell = kNoCell;
  asset = std::move(replaced.asset);
  chunk_of_cell = std::move(chunk_of);
  bins = CellBins(asset.pattern);
  crack_parts_of_borders(fresh);
  return fresh;
}

std::vector<std::uint32_t> WallState::outline_of(const ChunkState& state) const {
  if (state.cell == kNoCell) return state.loop;
  if (!is_strictly_convex(asset.pattern, state.cell)) return {};
  const auto begin = asset.pattern.corners.begin() + asset.pattern.cell_begin[state.cell];
  return {begin, asset.pattern.corners.begin() + asset.pattern.cell_begin[state.cell + 1]};
}

std::vector<Vec2> WallState::places(std::span<const std::uint32_t> loop) const {
  std::vector<Vec2> result;
  for (const std::uint32_t v : loop) result.push_back(place(v));
  return result;
}

std::vector<std::uint32_t> WallState::split(std::uint32_t chunk, Vec2 point, std::uint32_t count) {
  const std::vector<std::uint32_t> loop = outline_of(chunks[chunk]);
  const auto centre = static_cast<std::uint32_t>(split_points.size()) | kSplitPoint;
  const Vec2 middle = rounded_to_float(point);
  const std::vector<std::uint32_t> spokes = choose_spokes(places(loop), middle, count);
  if (spokes.empty()) return {};
  split_points.push_back(middle);
  const double least = std::max(kLeastPart, 0.1 * half_thickness);
  std::vector<std::vector<std::uint32_t>> parts;
  for (std::size_t s = 0; s < spokes.size(); ++s) {
    std::vector<std::uint32_t> part{centre};
    const std::size_t end = s + 1 < spokes.size() ? spokes[s + 1] : spokes[0] + loop.size();
    for (std::size_t i = spokes[s]; i <= end; ++i) part.push_back(loop[i % loop.size()]);
    if (!is_sturdy(places(part), least)) {
      split_points.pop_back();
      return {};
    }
    parts.push_back(std::move(part));
  }
  return add_parts(chunk, parts);
}

std::vector<std::uint32_t> WallState::add_parts(std::uint32_t chunk,
                                                std::span<const std::vector<std::uint32_t>> parts) {
  std::vector<std::uint32_t> made;
  for (const std::vector<std::uint32_t>& part : parts) {
    ChunkState state;
    state.mass = prism_mass(places(part), 2 * half_thickness);
    state.loop = part;
    state.depth = static_cast<std::uint8_t>(chunks[chunk].depth + 1);
    made.push_back(static_cast<std::uint32_t>(chunks.size()));
    chunks.push_back(std::move(state));
  }
  chunks[chunk].island = kNoIsland;
  return made;
}

RecordedWall WallState::recorded(
    const std::function<std::uint32_t(std::uint32_t)>& track_of) const {
  std::vector<std::uint32_t> removed, parts;
  std::vector<NewCell> added;
  const auto base = static_cast<std::uint32_t>(asset.pattern.vertices.size());
  for (std::uint32_t c = 0; c < chunks.size(); ++c) {
    const ChunkState& state = chunks[c];
    if (state.cell != kNoCell && state.island == kNoIsland) removed.push_back(state.cell);
    if (state.cell != kNoCell || state.island == kNoIsland) continue;
    NewCell cell{{state.loop}};
    for (std::uint32_t& v : cell.loops.front())
      if (v & kSplitPoint) v = base + (v & ~kSplitPoint);
    added.push_back(std::move(cell));
    parts.push_back(c);
  }
  RecordedWall wall;
  std::vector<std::uint32_t> chunk_of = chunk_of_cell;
  if (removed.empty()) {
    wall.asset = asset;
  } else {
    std::ranges::sort(removed);
    ReplacedCells replaced = replace_cells(asset, removed, split_points, added);
    wall.asset = std::move(replaced.asset);
    chunk_of.clear();
    for (const std::uint32_t old : replaced.old_cell)
      chunk_of.push_back(old >= kNoCell - added.size() ? parts[kNoCell - old] : chunk_of_cell[old]);
  }
  for (const std::uint32_t chunk : chunk_of) wall.track.push_back(track_of(chunk));
  return wall;
}

std::vector<Bond> bonds_among(const std::vector<std::uint32_t>& members,
                              std::span<const Bond> bonds) {
  const auto local = [&](std::uint32_t chunk) {
    const auto at = std::ranges::lower_bound(members, chunk);
    return at != members.end() && *at == chunk ? static_cast<std::uint32_t>(at - members.begin())
                                               : kNoCell;
  };
  std::vector<Bond> result;
  for (Bond bond : bonds) {
    bond.a = local(bond.a);
    if (bond.b != kWorld) bond.b = local(bond.b) == kNoCell ? kNoCell - 1 : local(bond.b);
    if (bond.a != kNoCell && bond.b != kNoCell - 1) result.push_back(bond);
  }
  return result;
}

Island make_island(const WallState& wall, std::uint32_t wall_index,
                   std::vector<std::uint32_t> chunks, std::span<const Bond> bonds) {
  assert(!chunks.empty());
  Island island;
  island.wall = wall_index;
  island.chunks = std::move(chunks);
  island.bonds.assign(bonds.begin(), bonds.end());
  if (island.chunks.size() > 1 || !wall.asset.wall.anchors.empty())
    island.graph.emplace(static_cast<std::uint32_t>(island.chunks.size()), island.bonds);
  return island;
}

}  // namespace sunder
