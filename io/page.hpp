// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace sunder {

/// One asset or run of a page.
struct PageModel {
  std::string name;       ///< shown to the reader, UTF-8
  std::string file;       ///< a GLB's bytes, or a .gltf's text
  std::string companion;  ///< bytes of the .gltf's .bin; empty: none
  std::string report;     ///< JSON of the run; empty: none
};

/// The page that the viewer's sources were built into, with two places to fill in; empty: this
/// build has none.
std::string_view page_template();

/// Throws Error{output}, which says what to install, unless this build has a page.
void require_page(std::string_view page = page_template());

/// A 3D page of the models in one file that loads nothing from elsewhere: their bytes are in it as
/// base64 of raw deflate, words byte by byte (see in_planes). Same models, same bytes. Throws
/// Error{output} unless there is a page, or if a model is larger than browsers take (512 MiB when
/// packed).
std::string page_text(std::span<const PageModel> models, std::string_view page = page_template());

/// Writes the page, whole or not at all.
void write_page(const std::filesystem::path& path, std::span<const PageModel> models);

/// A file as a page shows it: .glb and .gltf (with the .bin beside it) as they are, .obj, .stl and
/// .ply read by import_asset. Throws Error{usage} for another suffix, Error{input} for a file that
/// is not what its suffix says.
PageModel read_page_model(const std::filesystem::path& path);

/// The text of a report (see report.hpp, impact_report.hpp, collapse_report.hpp) for a model.
/// Throws Error{input} if it is something else.
std::string read_page_report(const std::filesystem::path& path);

}  // namespace sunder
