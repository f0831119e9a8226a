// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/recording.hpp"

namespace sunder {

/// Triangles of a part in its own frame, turned outward. Every face has vertices of its own; across
/// edges that turn by less than 37° (round tubes, fillets) normals are smooth. Texture coordinates
/// are in metres: along the outline and along z on the sides, x and y on the two ends; v goes up.
///
/// A member's sides have two rings more: between an end and the ring next to it, min(0.5 m, a
/// quarter of the length) away, lies the zone that shows the load of the end's joints.
struct PartMesh {
  std::vector<float> positions, normals;  ///< 3 per vertex, m
  std::vector<float> uvs;                 ///< 2 per vertex, m
  std::vector<float> nearness;  ///< 2 per vertex: 1 at end 0 (1), 0 from the end of its zone on
  std::vector<std::uint32_t> indices;

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(positions.size() / 3); }
};

/// Throws Error{geometry} unless the outline is valid (see make_lattice_region).
PartMesh part_mesh(const RecordedPart& part);

/// The outline and its openings as a region on a lattice of their own; `what` names the part in the
/// message of Error{geometry}.
LatticeRegion lattice_outline(const Region& outline, const std::string& what);

}  // namespace sunder
