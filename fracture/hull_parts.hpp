// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "fracture/convex_hull.hpp"
#include "meshing/triangle_tree.hpp"

namespace sunder {

using HullTriangle = std::array<HullPoint, 3>;

/// An edge of a chunk at which it is not convex, and the planes of its two faces.
struct ReflexEdge {
  HullPoint a, b;
  HullPlane left, right;
};

/// A chunk on the lattice, in steps.
struct HullChunk {
  explicit HullChunk(std::vector<HullTriangle> triangles);
  std::vector<HullTriangle> surface;
  TriMesh mesh;  ///< the same for the tree
  TriangleTree tree;
  double volume = 0, diagonal = 0;
  std::vector<ReflexEdge> reflex_edges() const;
  /// 0 inside.
  double distance(Vec3 p) const;
  bool contains(Vec3 p) const;
};

/// What planes left of a chunk, and its hull. Caps are fans about any point of their plane, so they
/// may overlap themselves: only their signed volume counts.
struct HullPart {
  std::vector<HullTriangle> surface, caps;
  std::vector<HullPlane> planes;     ///< that cut it, it lies above them
  std::vector<HullPoint> junctions;  ///< corners where three of them meet inside the chunk
  double volume = 0;
  ConvexHull hull;
  double excess = 0;     ///< of the hull's volume
  double distance = -1;  ///< as HullSet::Error, in steps; < 0: not measured
};

/// What of a part lies above the plane. No hull yet.
HullPart part_above(const HullPart& part, const HullPlane& plane);
/// Corners of a part's surface and junctions without repeats.
std::vector<HullPoint> corners_of(const HullPart& part);
/// Adds the corners that the part's last plane makes with the others inside the chunk.
void add_junctions(const HullChunk& chunk, HullPart& part);
double signed_volume(std::span<const HullTriangle> triangles);
HullPlane flipped(HullPlane plane);

/// How far the hull's surface is from the chunk at most, in steps: an upper bound, above the true
/// value by less than a tenth of it or of `limit` unless it took too many samples.
double distance_bound(const ConvexHull& hull, const HullChunk& chunk, double limit);

}  // namespace sunder
