// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "meshing/tri_mesh.hpp"

namespace sunder {

struct Box3 {
  Vec3 low, high;
  bool overlaps(const Box3& other) const;  ///< touching counts
  double distance2(Vec3 p) const;          ///< m²; 0 inside
};
Box3 box_of(const TriMesh& mesh);  ///< of the triangles' corners
inline double diagonal(const Box3& box) {
  return length(box.high - box.low);
}

/// Tree of boxes over a mesh's triangles (median splits) that answers what is near what. Refers to
/// the mesh, which must outlive it and have finite coordinates. O(n log n) to build.
class TriangleTree {
 public:
  explicit TriangleTree(const TriMesh& mesh) : TriangleTree(mesh, {}) {}
  /// Of the triangles that `keep` says only; empty: all.
  TriangleTree(const TriMesh& mesh, const std::vector<bool>& keep);

  struct Nearest {
    double distance = 0;  ///< m
    std::uint32_t triangle = 0;
    std::array<double, 3> weights{};  ///< of its corners
  };
  /// The surface's point that is nearest to p; of several triangles the first by index. The tree
  /// must not be empty. O(log n) as a rule.
  Nearest nearest(Vec3 p) const;

  /// Whether p is no further than `distance` from one triangle; false if there is no such triangle.
  bool is_within(Vec3 p, double distance, std::uint32_t triangle) const;

  /// How often the surface winds around p (Jacobson et al. 2013): a whole number off a closed
  /// surface. Far parts count as dipoles (Barill et al. 2018), which errs by some hundredths.
  double winding_number(Vec3 p) const;

  /// Whether `wanted` holds for a pair of triangles whose boxes overlap; asked in no order that
  /// tells anything, until it does.
  bool any_overlapping(const std::function<bool(std::uint32_t, std::uint32_t)>& wanted) const;
  /// Pairs a < b of triangles whose boxes overlap, ascending.
  std::vector<std::array<std::uint32_t, 2>> overlapping_boxes() const;
  /// Triangles whose boxes the ray from p along +x touches, in no order.
  std::vector<std::uint32_t> along_x(Vec3 p) const;

 private:
  struct Node {
    Box3 box;
    std::uint32_t begin = 0, end = 0;   // of order_
    std::uint32_t left = 0, right = 0;  // 0: a leaf
    Vec3 centre, normal;                // area-weighted centre; sum of area normals, m²
    double radius = 0, area = 0;        // of all corners about the centre; m²
  };
  std::uint32_t build(std::uint32_t begin, std::uint32_t end);
  void summarise(Node& node) const;
  double distance2(Vec3 p, std::uint32_t triangle, std::array<double, 3>& weights) const;
  Vec3 corner(std::uint32_t triangle, int k) const {
    return mesh_->vertices[mesh_->triangles[triangle][static_cast<std::size_t>(k)]];
  }

  const TriMesh* mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<Box3> boxes_;  // per triangle
  std::vector<Node> nodes_;
};

/// How far surface a is from surface b at most, m: the greatest distance to b of points on a
/// lattice in each triangle of a (its corners among them), exact for each point. Neighbours on the
/// lattice are `spacing` apart at most, or more where that takes above kMostSamples points; the
/// true distance is greater by `spacing` / √3 at most. O(points log triangles).
double farthest(const TriMesh& a, const TriangleTree& b, double spacing);
inline constexpr double kMostSamples = 2e6;

}  // namespace sunder
