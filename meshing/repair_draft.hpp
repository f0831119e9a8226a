// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "meshing/model_surface.hpp"
#include "meshing/triangle_tree.hpp"

namespace sunder {

/// A surface under repair. Each function below does one thing and tells it in `steps` if there was
/// something to do.
struct Draft {
  ModelSurface surface;
  std::vector<bool> is_new;  ///< per triangle: what it carries is not known yet
  std::vector<std::string> steps;
  TriMesh& mesh() { return surface.mesh; }
};
Draft make_draft(const ModelSurface& surface);

/// "1 hole", "3 holes".
std::string counted(std::uint64_t count, const std::string& one, const std::string& many);
/// Keeps the triangles that `keep` says.
void keep_triangles(Draft& draft, const std::vector<bool>& keep);
/// Turns the triangles that `turn` says over, with their normals.
void turn_triangles(Draft& draft, const std::vector<bool>& turn);

void drop_bad_numbers(Draft& draft);
/// Joins vertices with equal coordinates, then drops faces with two equal corners and duplicates.
void join_equal_vertices(Draft& draft);
/// Joins vertices of open edges that are no further apart than `distance`, m.
void weld_open_edges(Draft& draft, double distance);
/// Takes faces whose corners lie on a line out, and cuts the neighbour over their longest edge.
void take_out_flat_faces(Draft& draft);
/// Turns the fewer faces of each shell, so that neighbours face one way.
void turn_flipped_faces(Draft& draft);
/// Closes holes of up to kMostHoleEdges edges with the triangles that bend least, then are
/// smallest (Liepa 2003). No new vertices.
void fill_holes(Draft& draft);
inline constexpr std::size_t kMostHoleEdges = 300;
/// Gives fans that meet in a vertex only a vertex each, drawn `apart` (m) towards its fan.
void split_vertices(Draft& draft, double apart);
/// Turns whole shells over that are inside out.
void turn_shells(Draft& draft);
/// Drops closed shells that are no thicker than `thickness` (m), unless all are: what is left of a few
/// faces, closed by faces over them.
void drop_empty_shells(Draft& draft, double thickness);
void drop_unused_vertices(Draft& draft);
/// Cuts faces that cross or meet others wrongly out, with up to three rings about them, and fills
/// the holes; true if the surface is a solid's by that and the new faces are within max_error (m)
/// of the surface in `tree`. Otherwise nothing is changed: folds and spikes are mended so, bodies
/// that run through each other are not.
bool cut_out_crossings(Draft& draft, const TriangleTree& tree, double max_error);

/// Open edges in the direction in which a face beside them would run, as closed loops of vertices.
std::vector<std::vector<std::uint32_t>> open_loops(const TriMesh& mesh);

/// The mesh with fans over what is open, so that every edge is run along as often in one direction
/// as in the other; shells that are open and outside all others face outwards.
TriMesh closed_by_fans(const TriMesh& mesh);

/// Gives the new triangles of `made` their face's normal, and material, UVs and colours of the
/// points of `given` that are nearest to their middles and corners.
void carry_over(const ModelSurface& given, const TriangleTree& tree, ModelSurface& made,
                const std::vector<bool>& is_new);

}  // namespace sunder
