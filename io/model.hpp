// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "io/import.hpp"
#include "meshing/model_surface.hpp"

namespace sunder {

/// Reads a .obj, .glb, .gltf, .stl or .ply as one surface: all its meshes where their nodes put
/// them. Positions are those of the file in float32, moved in doubles where a node moves them;
/// corners of equal position (0 and -0 are equal) are one vertex. Normals the file does not give
/// are the triangle's. Colours are made linear (OBJ and PLY give sRGB). A texture is kept when it
/// is a file in the model's folder; images inside a .glb are not. Degenerate triangles stay.
/// assimp reads in a child process with limits, as import_asset. Throws Error{input} with the path
/// and the reason.
ModelSurface read_model(const std::filesystem::path& path, ImportLimits limits = {});

}  // namespace sunder
