// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace sunder {

/// Content of a regular file of at most 2 GiB. Throws Error{input}.
std::string read_page_file(const std::filesystem::path& path);

/// Throws Error{input} unless the bytes are a glTF 2.0 binary: its header, chunks of the right
/// length, well-formed JSON. O(bytes).
void check_glb(const std::string& bytes, const std::string& name);

/// The one file that a .gltf's text refers to, in the .gltf's own folder. Throws Error{input} if
/// the text is no glTF, or refers to none, several, or a file elsewhere.
std::filesystem::path companion_in(const std::string& text, const std::filesystem::path& path);

}  // namespace sunder
