// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "fracture/solid_asset.hpp"
#include "fracture/solid_shapes.hpp"

namespace sunder {

/// A gear of two materials and colours, in Voronoi chunks.
inline SolidAsset sample_solid(const std::string& name = "gear", std::int64_t chunks = 12,
                               int threads = 1) {
  ModelSurface surface = test::as_surface(test::gear());
  surface.materials.resize(2);
  surface.materials[0].name = "blue paint";
  surface.materials[0].base_colour = {0.1f, 0.2f, 0.75f, 1};
  surface.materials[1].name = "";
  surface.has_colours = true;
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t) {
    surface.material[t] = t % 3 == 0;
    for (std::size_t k = 0; k < 3; ++k)
      surface.corners[3 * t + k].colour = {1, 0.5f, static_cast<float>(t % 2), 1};
  }
  SolidModel solid;
  solid.name = name;
  solid.file = "gear.obj";
  solid.material = "steel";
  SolidVoronoiParams pattern;
  pattern.count = chunks;
  solid.pattern = pattern;
  return fracture_solid(solid, std::move(surface), 7850, {.seed = 3, .threads = threads});
}

}  // namespace sunder
