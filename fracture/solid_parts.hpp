// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fracture/solid_asset.hpp"
#include "fracture/solid_cut.hpp"

namespace sunder {

/// Chunks of a cut solid: cells of one label together, parts that do not hang together apart, what
/// is below a millionth of the mean chunk joined to the neighbour it shares most area with (none,
/// if that made a chunk meet itself along an edge). Adds to `stats`. `parents`: triangle of the
/// surface that each triangle of the mesh is part of; empty: itself.
SolidPartition partition_solid(const TriMesh& mesh, std::span<const std::uint32_t> parents,
                               const SolidComplex& complex, const CutSolid& cut, int threads,
                               SolidStats& stats);

/// Triangles of a chunk that are parts of one of the surface's triangles, made anew without the
/// corners between them. Chunks stay as they are but for that.
void merge_outer_triangles(const TriMesh& surface, SolidPartition& partition);

/// Where the local frame of a surface is to be (SolidAsset::origin), a place of float32
/// coordinates: those of a model that has such stay exact.
Vec3 origin_for(const TriMesh& surface);

/// Whether a chunk crosses itself as a file holds it, with float32 positions from `origin`: see
/// is_tangled.
bool has_crossings(const SolidPartition& partition, Vec3 origin = {});

/// Mass properties of every chunk at density 1, and bonds of all pairs that share faces.
std::vector<MassProperties> solid_masses(const SolidPartition& partition, int threads);
std::vector<Bond> solid_bonds(const SolidPartition& partition);

}  // namespace sunder
