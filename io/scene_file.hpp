// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "io/import.hpp"

struct aiScene;
namespace Assimp {
class Importer;
}

namespace sunder {

/// Checks a file that assimp is to read: its suffix, and that it is a regular file of at most
/// limits.file_size bytes. Lowers limits.seconds to what a sound file of its size could take.
/// Throws Error{usage} for the suffix, Error{input} for the rest.
void limit_to_file(const std::filesystem::path& path, ImportLimits& limits);

/// The file in triangles, read by the one reader that its suffix names; the importer owns it. Other
/// files are only opened inside the file's folder, wherever links lead. For a child process, see
/// run_reader. Throws Error{input}.
const aiScene& read_scene_file(Assimp::Importer& importer, const std::filesystem::path& path,
                               const ImportLimits& limits);

/// Path of the image that a model names, relative to the model's folder; empty when it is no
/// regular file in there.
std::string image_beside(const std::filesystem::path& model, std::string name);

}  // namespace sunder
