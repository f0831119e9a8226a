// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "meshing/tri_mesh.hpp"

namespace sunder {

/// The project's own models in data/models: what is in the file, and the file's bytes. Coordinates
/// are metres that a float (gear, scan) or seven digits (vase) hold exactly as written.
struct SampleModel {
  TriMesh mesh;
  std::string bytes;
};

/// A vase of revolution, 0.3 m high with walls of 4 mm: smooth normals, UVs once around. OBJ.
SampleModel vase_model();
/// A spur gear of 12 teeth, 30 mm thick, with a bore and six holes: genus 7, sharp. Binary STL.
SampleModel gear_model();
/// A stone as a bad scan gives it: open below, a hole, a patch turned over, a crack of one step of
/// rounding, faces twice, folds that cross; vertex colours. Binary PLY.
SampleModel scan_model();

}  // namespace sunder
