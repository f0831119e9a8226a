// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace sunder {

enum class Verb { fracture, impact, collapse, check, schema, view, completion };

/// The command line, as given.
struct Options {
  Verb verb = Verb::fracture;
  std::vector<std::filesystem::path> inputs;  ///< scene, or files to check or view
  std::string schema = "scene";
  std::string shell;       ///< of completion
  std::string made_scene;  ///< scene text made from --wall … or a model; empty: none
  bool is_model = false;   ///< the input is a model
  std::vector<std::filesystem::path> outputs;  ///< -o
  std::vector<std::filesystem::path> reports;  ///< --report
  std::filesystem::path history;               ///< --history; empty: none
  std::optional<double> at;                    ///< --at, s
  std::optional<int> picture_width;            ///< --width, pixels
  std::vector<std::string> overrides;          ///< --set, then --max-error
  bool asks_error = false;                     ///< --max-error is given
  std::optional<std::uint64_t> seed;
  int threads = 0;  ///< 0: as many as the machine has
  bool json = false, quiet = false, allow_outside = false;
  bool verbose = false;
  std::string command;  ///< the line as a shell takes it
  bool no_skip = false;  ///< does all the work, to prove that the outcome is the same
};

/// Parses the command line. Throws Error{usage} with "did you mean"; prints help or version and
/// returns nothing when that was asked for.
std::optional<Options> parse_options(int argc, char** argv);

}  // namespace sunder
