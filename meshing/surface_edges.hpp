// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "meshing/surface_predicates.hpp"

namespace sunder {

/// A triangle at an edge.
struct EdgeUse {
  std::uint32_t low = 0, high = 0;  ///< the edge's vertices, low < high
  std::uint32_t triangle = 0;
  bool forward = false;  ///< the triangle runs from low to high
  friend auto operator<=>(const EdgeUse&, const EdgeUse&) = default;
};
/// All uses of all edges, ascending; triangles that `keep` does not say are left out.
std::vector<EdgeUse> edge_uses(std::span<const Corners> triangles, const std::vector<bool>& keep);

/// Calls visit(uses of one edge) for each edge, ascending.
template <class Visit>
void for_each_edge(std::span<const EdgeUse> uses, Visit visit) {
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].low == uses[begin].low &&
           uses[end].high == uses[begin].high)
      ++end;
    visit(uses.subspan(begin, end - begin));
  }
}

/// Sets that are joined, with a parity of each element against its set's first.
class ParitySets {
 public:
  explicit ParitySets(std::size_t count);
  struct Place {
    std::uint32_t root = 0;
    bool odd = false;
  };
  Place find(std::uint32_t element);
  /// Joins the sets of a and b, whose parities differ if `odd`; false if they are known to relate
  /// the other way. The smaller root stays.
  bool join(std::uint32_t a, std::uint32_t b, bool odd = false);

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<bool> odd_;  // against the parent
};

/// Triangles joined over edges that two of them have, as they would have to turn to face one way.
struct Orientation {
  std::vector<std::uint32_t> shell;  ///< per triangle: the shell's first triangle
  std::vector<bool> flipped;         ///< per triangle: turn it; of each shell the fewer
  std::vector<bool> one_sided;       ///< per first triangle: no turning makes all edges right
};
Orientation orient(std::span<const Corners> triangles, std::span<const EdgeUse> uses);

/// Per corner (3 triangle + k) the first corner of its fan: the triangles at its vertex that hang
/// together by edges.
std::vector<std::uint32_t> find_fans(std::span<const Corners> triangles,
                                     std::span<const EdgeUse> uses);

}  // namespace sunder
