// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "meshing/model_surface.hpp"

namespace sunder {

/// Something that keeps a surface from being a solid's, and where.
struct SurfaceDefect {
  enum class Kind : std::uint8_t {
    open_edge,           ///< one triangle only
    nonmanifold_edge,    ///< more than two triangles
    nonmanifold_vertex,  ///< fans of triangles that meet in a point only
    flipped_face,        ///< runs along a shared edge in its neighbour's direction
    self_intersection,   ///< two triangles cross, or touch without sharing corners there
    duplicate_face,      ///< the same three corners again
    degenerate_face,     ///< no area
    inside_out,          ///< a closed shell whose volume has the wrong sign for where it lies
    bad_number,          ///< a coordinate that is not finite
  };
  Kind kind = Kind::open_edge;
  std::uint32_t a = 0, b = 0;  ///< triangles (b: the other one of a pair, else a)
  Vec3 place;                  ///< m
};
const char* name_of(SurfaceDefect::Kind kind);

/// All that is wrong with a surface; empty for a sound solid. Ascending by kind, then triangle; of
/// each kind `counts` tells all, `defects` the first `most` only. Exact: equal indices and exact
/// predicates, no tolerance. O(triangles log triangles).
struct SurfaceDiagnosis {
  std::vector<SurfaceDefect> defects;
  std::array<std::uint64_t, 9> counts{};  ///< by kind
  bool is_solid() const;
  /// "12 open edges, first near (0.1, 0.2, 0.3) m at triangle 7; 2 self-intersections, …"
  std::string text() const;
};
SurfaceDiagnosis diagnose(const ModelSurface& surface, std::size_t most = 20);

}  // namespace sunder
