// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/outputs.hpp"

#include <map>

#include "cli/usage.hpp"
#include "io/export.hpp"

namespace sunder {
namespace {

namespace fs = std::filesystem;

// The file a path leads to, whatever links and dots are on the way; it need not exist.
fs::path canonical_of(fs::path path) {
  constexpr int kMostLinks = 40;  // as Linux
  std::error_code fault;
  for (int i = 0; i < kMostLinks && fs::is_symlink(path, fault); ++i) {
    // weakly_canonical does not follow a link whose file is not there yet.
    const fs::path target = fs::read_symlink(path, fault);
    if (fault) break;
    path = path.parent_path() / target;
  }
  const fs::path result = fs::weakly_canonical(fs::absolute(path, fault), fault);
  return fault ? path.lexically_normal() : result;
}

void check_suffix(const fs::path& path, Verb verb) {
  const std::string suffix = path.extension();
  if (verb == Verb::impact) {
    for (const char* own : {".glb", ".gltf", ".svg", ".json"})
      if (suffix == own) return;
    usage("-o " + path.string() + ": impact writes .glb .gltf .svg .json");
  }
  if (suffix != ".json" && !is_export_suffix(suffix))
    usage("-o " + path.string() +
          ": the suffix says the format, one of .glb .gltf .obj .stl .ply .svg .json");
}

std::vector<fs::path> written_files(const Options& options) {
  std::vector<fs::path> files = options.outputs;
  if (!options.report.empty()) files.push_back(options.report);
  return files;
}

}  // namespace

void check_outputs(const Options& options) {
  for (const fs::path& path : options.outputs) check_suffix(path, options.verb);
  if (!options.report.empty() && options.report.extension() != ".json")
    usage("--report " + options.report.string() + ": a report is a .json file");
  std::map<fs::path, fs::path> written;  // canonical → as given
  for (const fs::path& path : written_files(options)) {
    const auto [other, is_new] = written.emplace(canonical_of(path), path);
    if (!is_new) usage(path.string() + " is written twice, also as " + other->second.string());
  }
  check_not_written(options, options.inputs);
}

void check_not_written(const Options& options, std::span<const fs::path> inputs) {
  for (const fs::path& path : written_files(options)) {
    for (const fs::path& input : inputs) {
      std::error_code ignored;
      if (canonical_of(path) == canonical_of(input) || fs::equivalent(path, input, ignored))
        usage(path.string() + " would overwrite the input");
    }
  }
}

}  // namespace sunder
