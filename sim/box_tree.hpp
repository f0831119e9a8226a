// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "meshing/vec.hpp"

namespace sunder {

/// Axis-aligned box.
struct Box3 {
  Vec3 low, high;
};
inline Box3 grown(const Box3& box, double by) {
  const Vec3 d{by, by, by};
  return {box.low - d, box.high + d};
}
inline bool overlap(const Box3& a, const Box3& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

/// Boxes with a number each, in Bullet's dynamic tree (btDbvt): insertion, removal and queries in
/// O(log n). The order in which a query finds boxes depends on the tree's history: sort.
class BoxTree {
 public:
  using Leaf = void*;
  BoxTree();
  ~BoxTree();
  BoxTree(const BoxTree&) = delete;
  BoxTree& operator=(const BoxTree&) = delete;

  Leaf insert(const Box3& box, std::uint32_t number);
  void remove(Leaf leaf);
  /// Makes the leaf's box cover `box`, with room for `slack` before it has to move again.
  void update(Leaf leaf, const Box3& box, double slack);
  /// Appends the numbers of all boxes that may overlap.
  void find(const Box3& box, std::vector<std::uint32_t>& found) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sunder
