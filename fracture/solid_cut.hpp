// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fracture/solid_complex.hpp"
#include "meshing/tri_mesh.hpp"

namespace sunder {

/// What identifies a vertex of a cut solid, whoever finds it.
struct CutVertex {
  enum class Kind : std::uint8_t {
    corner,       ///< of the mesh: a
    edge_facet,   ///< mesh edge a through facet b
    face_edge,    ///< triangle a through edge b of the complex
    inner_corner  ///< of the complex, inside: a
  };
  Kind kind = Kind::corner;
  std::uint32_t a = 0, b = 0;
  friend bool operator==(const CutVertex&, const CutVertex&) = default;
};

/// A solid's surface cut by the cells of a complex, and the parts of facets inside it. Everything
/// is identified by what it is the meeting of, so that all who share a vertex share its index.
struct CutSolid {
  /// Part of a triangle in a cell: its corners are numbers `begin` … of polygon_vertices, counter-
  /// clockwise; polygon_lines has the facet that the side after each corner lies on, or kOutline.
  struct Polygon {
    std::uint32_t triangle = 0, cell = 0, begin = 0, end = 0;
  };
  static constexpr std::uint32_t kOutline = ~std::uint32_t{0};
  std::vector<CutVertex> vertices;
  std::vector<Vec3> places;          ///< m
  std::vector<Vec3> surface_places;  ///< of vertices on the surface, on `shown` (m)
  std::vector<Polygon> polygons;
  std::vector<std::uint32_t> polygon_vertices, polygon_lines;
  /// Triangles of facet f's part inside, counter-clockwise seen from its cell b, are
  /// facet_triangle_begin[f] …
  std::vector<std::uint32_t> facet_triangle_begin;
  std::vector<std::array<std::uint32_t, 3>> facet_triangles;
  std::uint64_t exact_predicates = 0;
};

/// Thrown when a corner or edge of the mesh lies exactly on a plane or edge of the complex: to be
/// tried again with another SolidFrame::shift.
struct ExactContact {
  std::uint32_t triangle = 0;
};

/// Cuts a closed mesh that does not meet itself. `steps`: its vertices in the complex' frame.
/// `shown`: a mesh of the same triangles with its vertices in other places, or the mesh itself.
/// Throws ExactContact; Error{geometry}, with a place, if the mesh turns out not to bound a solid.
CutSolid cut_solid(const TriMesh& mesh, const TriMesh& shown, std::span<const Vec3> steps,
                   const SolidFrame& frame, const SolidComplex& complex, int threads);

/// The steps of it: polygons and vertices on the surface; then the facets' parts inside.
CutSolid cut_surface(const TriMesh& mesh, const TriMesh& shown, std::span<const Vec3> steps,
                     const SolidFrame& frame, const SolidComplex& complex, int threads);
void cut_facets(const TriMesh& mesh, std::span<const Vec3> steps, const SolidFrame& frame,
                const SolidComplex& complex, int threads, CutSolid& cut);

/// Makes the facets' triangles that have no area into others, where they have neighbours to do it
/// with.
void flip_flat_triangles(CutSolid& cut);

/// Triangles of a convex polygon (indices into `loop`), short diagonals first; nothing if a corner
/// is so nearly straight that this could make one of no area.
bool triangulate_convex(std::span<const Vec2> points,
                        std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace sunder
