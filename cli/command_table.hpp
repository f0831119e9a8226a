// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace sunder {

/// An option or positional of a verb, as completion scripts and the manual page need it.
struct CommandOption {
  std::vector<std::string> names;  ///< "-o", "--output"; of a positional its one name, "scene"
  std::string text;                ///< description
  std::string group;               ///< "Options", "Wall" …
  std::string value;               ///< "FILE", "TEXT"; empty: a flag
  bool is_positional = false, is_repeatable = false, is_required = false;
  std::vector<std::string> choices;   ///< words it takes; empty: any
  std::vector<std::string> suffixes;  ///< of files, ".glb"; empty: any file, or no file

  bool takes_file() const { return value == "FILE"; }
};

struct CommandVerb {
  std::string name, text;
  std::vector<CommandOption> options;  ///< positionals among them, in the order of --help
};

/// Everything that the command line takes, read from its parser.
struct CommandTable {
  std::string text, version;
  std::vector<CommandOption> options;  ///< without a verb
  std::vector<CommandVerb> verbs;
};
CommandTable command_table();

/// The table of a parser; choices are left out, suffixes are those that a description of a FILE
/// names.
CommandTable table_of(const CLI::App& app);

/// Script that completes the command in a shell: "bash", "zsh" or "fish".
std::string completion_script(const CommandTable& table, const std::string& shell);
inline const std::vector<std::string> kShells{"bash", "zsh", "fish"};

/// Manual page of section 1, in roff.
std::string man_page(const CommandTable& table);

}  // namespace sunder
