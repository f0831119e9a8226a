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
    flipped_face,        ///< faces the other way than most of its shell; in a one-sided shell: a
                         ///< pair of neighbours that run along their edge in one direction
    self_intersection,   ///< two triangles cross, or touch without sharing corners there
    duplicate_face,      ///< the same three corners again, in any order
    degenerate_face,     ///< no area
    inside_out,          ///< a closed shell that meets nothing, not even itself, and whose volume
                         ///< has the wrong sign for where it lies; a: its first triangle
    bad_number,          ///< a coordinate that is not finite, or a corner that is not there
  };
  Kind kind = Kind::open_edge;
  std::uint32_t a = 0, b = 0;  ///< triangles (b: the other one of a pair, else a)
  Vec3 place;                  ///< m
};
inline constexpr std::size_t kSurfaceDefectKinds = 9;
const char* name_of(SurfaceDefect::Kind kind);  ///< "open edge", …

/// All that is wrong with a surface; empty for a sound solid. Ascending by kind, then triangle; of
/// each kind `counts` tells all, `defects` the first `most` only. Exact: equal indices and exact
/// predicates, no tolerance. A shell is what hangs together by edges: several are sound, each
/// outside the others, or facing inwards as the wall of a cavity, or facing outwards in a cavity.
/// Bad numbers, faces of two equal corners and duplicates are told once and not looked at further.
/// O((triangles + pairs of triangles whose boxes overlap) log triangles).
struct SurfaceDiagnosis {
  std::vector<SurfaceDefect> defects;
  std::array<std::uint64_t, kSurfaceDefectKinds> counts{};  ///< by kind
  bool is_solid() const;
  /// "12 open edges, first near (0.1, 0.2, 0.3) m at triangle 7; 2 self-intersections, …"
  std::string text() const;
};
SurfaceDiagnosis diagnose(const TriMesh& mesh, std::size_t most = 20);
SurfaceDiagnosis diagnose(const ModelSurface& surface, std::size_t most = 20);

}  // namespace sunder
