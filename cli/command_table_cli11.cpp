// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/command_table.hpp"

namespace sunder {
namespace {

// The words of a text that are suffixes: ".glb".
std::vector<std::string> suffixes_in(const std::string& text) {
  std::vector<std::string> result;
  for (std::size_t at = text.find(" ."); at != std::string::npos; at = text.find(" .", at + 1)) {
    const std::size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz", at + 2);
    const std::string suffix = text.substr(at + 1, end - at - 1);
    if (suffix.size() > 1) result.push_back(suffix);
  }
  return result;
}

CommandOption option_of(const CLI::Option& given) {
  CommandOption option;
  for (const std::string& name : given.get_snames()) option.names.push_back("-" + name);
  for (const std::string& name : given.get_lnames()) option.names.push_back("--" + name);
  option.is_positional = option.names.empty();
  if (option.is_positional) option.names.push_back(given.get_name());
  option.text = given.get_description();
  option.group = given.get_group();
  option.is_required = given.get_required();
  const bool takes_value = given.get_items_expected_max() > 0;
  if (takes_value) option.value = given.get_type_name();
  option.is_repeatable = takes_value && given.get_expected_max() > 1;
  if (option.takes_file()) option.suffixes = suffixes_in(" " + option.text);
  return option;
}

std::vector<CommandOption> options_of(const CLI::App& app) {
  std::vector<CommandOption> result;
  for (const CLI::Option* option : app.get_options()) result.push_back(option_of(*option));
  return result;
}

}  // namespace

CommandTable table_of(const CLI::App& app) {
  CommandTable table{app.get_description(), app.version(), options_of(app), {}};
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    table.verbs.push_back({verb->get_name(), verb->get_description(), options_of(*verb)});
  return table;
}

}  // namespace sunder
