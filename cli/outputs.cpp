// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/outputs.hpp"

#include <cstdio>
#include <map>

#include "cli/usage.hpp"
#include "io/export.hpp"
#include "io/export_recording.hpp"
#include "io/joint_history.hpp"
#include "io/output.hpp"
#include "io/page.hpp"

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

void check_suffix(const fs::path& path, const Options& options) {
  const std::string suffix = path.extension();
  if (suffix == ".html") return require_page();  // before the work is done
  if (options.verb == Verb::view) usage("-o " + path.string() + ": view writes .html");
  if (suffix == ".json") return;
  if (options.verb == Verb::collapse || options.verb == Verb::impact) {
    if (is_recording_suffix(suffix, options.at.has_value())) return;
    usage("-o " + path.string() + ": " + (options.verb == Verb::collapse ? "collapse" : "impact") +
          " writes .glb .gltf .svg .png .html .json, and .obj with --at");
  }
  if (!is_export_suffix(suffix))
    usage("-o " + path.string() +
          ": the suffix says the format, one of .glb .gltf .obj .stl .ply .svg .png .html .json");
}

std::vector<fs::path> written_files(const Options& options) {
  std::vector<fs::path> files = options.outputs;
  if (!options.report.empty()) files.push_back(options.report);
  if (!options.history.empty()) files.push_back(options.history);
  return files;
}

}  // namespace

void check_outputs(const Options& options) {
  for (const fs::path& path : options.outputs) check_suffix(path, options);
  if (!options.report.empty() && options.report.extension() != ".json")
    usage("--report " + options.report.string() + ": a report is a .json file");
  if (!options.history.empty() && !is_history_suffix(options.history.extension()))
    usage("--history " + options.history.string() + ": a history is a .csv or .json file");
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

void write_report(const Options& options, std::string_view text) {
  if (options.json) std::fwrite(text.data(), 1, text.size(), stdout);
  if (!options.report.empty()) write_file(options.report, text);
  for (const fs::path& path : options.outputs)
    if (path.extension() == ".json") write_file(path, text);
}

}  // namespace sunder
