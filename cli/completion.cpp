// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cassert>
#include <string_view>

#include "cli/command_table.hpp"

namespace sunder {
namespace {

std::string joined(const std::vector<std::string>& words, std::string_view separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : std::string(separator)) + word;
  return text;
}

std::string replaced(std::string text, std::string_view what, std::string_view with) {
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
  return text;
}

// Inside '…' of a POSIX shell.
std::string quoted(const std::string& text) {
  return replaced(text, "'", "'\\''");
}

std::vector<std::string> names_of(const std::vector<CommandOption>& options) {
  std::vector<std::string> names;
  for (const CommandOption& option : options)
    if (!option.is_positional) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

std::vector<std::string> names_of(const std::vector<CommandVerb>& verbs) {
  std::vector<std::string> names;
  for (const CommandVerb& verb : verbs) names.push_back(verb.name);
  return names;
}

// --- bash

constexpr std::string_view kBashStart = R"(_sunder_files() {  # suffixes…
  local file suffix
  while IFS= read -r file; do
    [[ -d $file ]] && COMPREPLY+=("$file")
    for suffix; do [[ -f $file && $file == *"$suffix" ]] && COMPREPLY+=("$file"); done
  done < <(compgen -f -- "$cur")
}
_sunder_new_files() {  # suffixes…: of a file that need not be there
  local suffix
  _sunder_files "$@"
  [[ $cur == *.* ]] || return
  for suffix; do
    [[ ${cur%.*}$suffix == "$cur"* && ! -e ${cur%.*}$suffix ]] && COMPREPLY+=("${cur%.*}$suffix")
  done
}
_sunder() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} verb='' i
  COMPREPLY=()
  [[ $prev == = ]] && prev=${COMP_WORDS[COMP_CWORD-2]}
  [[ $cur == = ]] && cur=''
)";

// What completes the value of an option, or a positional; empty: nothing does.
std::string bash_values(const CommandOption& option) {
  if (!option.choices.empty())
    return "COMPREPLY=($(compgen -W '" + joined(option.choices, " ") + "' -- \"$cur\"))";
  if (option.suffixes.empty())
    return option.takes_file() || option.is_positional ? "_sunder_files ''" : "";
  return (option.is_positional ? "_sunder_files " : "_sunder_new_files ") +
         joined(option.suffixes, " ");
}

void add_bash_verb(const CommandVerb& verb, std::string& script) {
  script += "    " + verb.name + ")\n      case $prev in\n";
  std::vector<std::string> of_any_text;
  for (const CommandOption& option : verb.options) {
    if (option.is_positional || option.value.empty()) continue;
    const std::string values = bash_values(option);
    if (values.empty())
      of_any_text.push_back(joined(option.names, "|"));
    else
      script += "        " + joined(option.names, "|") + ") " + values + "; return ;;\n";
  }
  if (!of_any_text.empty()) script += "        " + joined(of_any_text, "|") + ") return ;;\n";
  script += "      esac\n      if [[ $cur == -* ]]; then\n        COMPREPLY=($(compgen -W '" +
            joined(names_of(verb.options), " ") + "' -- \"$cur\"))\n";
  for (const CommandOption& option : verb.options)
    if (option.is_positional) script += "      else\n        " + bash_values(option) + "\n";
  script += "      fi ;;\n";
}

std::string bash_script(const CommandTable& table) {
  const std::string verbs = joined(names_of(table.verbs), "|");
  std::string script =
      "# Completes sunder's command line in bash; printed by: sunder completion bash\n";
  script += kBashStart;
  script += "  for ((i = 1; i < COMP_CWORD; i++)); do\n    case ${COMP_WORDS[i]} in\n      " +
            verbs + ") verb=${COMP_WORDS[i]}; break ;;\n    esac\n  done\n  case $verb in\n";
  script += "    '') COMPREPLY=($(compgen -W '" + joined(names_of(table.verbs), " ") + " " +
            joined(names_of(table.options), " ") + "' -- \"$cur\")) ;;\n";
  for (const CommandVerb& verb : table.verbs) add_bash_verb(verb, script);
  return script + "  esac\n}\ncomplete -o filenames -F _sunder sunder\n";
}

// --- zsh

// Inside […] of a spec of _arguments.
std::string zsh_text(const std::string& text) {
  std::string result = replaced(quoted(text), "\\", "\\\\");
  result = replaced(result, "'\\\\''", "'\\''");
  for (const char* special : {"[", "]", ":"})
    result = replaced(result, special, std::string("\\") + special);
  return result;
}

std::string zsh_values(const CommandOption& option) {
  std::string end = ":";
  end += option.is_positional ? option.names[0] : "value";
  end += ":";
  if (!option.choices.empty()) return end + "(" + joined(option.choices, " ") + ")";
  if (!option.takes_file() && !option.is_positional) return end;
  if (option.suffixes.empty()) return end + "_files";
  std::string globs;
  for (const std::string& suffix : option.suffixes)
    globs += (globs.empty() ? "" : "|") + suffix.substr(1);
  return end + "_files -g \"*.(" + globs + ")\"";
}

std::string zsh_spec(const CommandOption& option) {
  const std::string values = option.value.empty() ? std::string() : zsh_values(option);
  std::string spec = "'";
  if (option.is_repeatable) spec += "*";
  if (option.is_positional) return spec + values + "'";
  if (!option.is_repeatable) spec += "(" + joined(option.names, " ") + ")";
  spec += "'";
  spec += option.names.size() == 1 ? option.names[0] : "{" + joined(option.names, ",") + "}";
  return spec + "'[" + zsh_text(option.text) + "]" + values + "'";
}

std::string zsh_script(const CommandTable& table) {
  std::string script =
      "#compdef sunder\n# Completes sunder's command line in zsh; printed by: sunder completion "
      "zsh\n"
      "_sunder() {\n  local curcontext=$curcontext state line\n  local -a verbs=(\n";
  for (const CommandVerb& verb : table.verbs)
    script += "    '" + verb.name + ":" + quoted(replaced(verb.text, ":", "\\:")) + "'\n";
  script += "  )\n  _arguments -C";
  for (const CommandOption& option : table.options) script += " \\\n    " + zsh_spec(option);
  script +=
      " \\\n    '1:verb:->verb' '*::option:->option'\n  case $state in\n"
      "    verb) _describe verb verbs ;;\n    option)\n      case $words[1] in\n";
  for (const CommandVerb& verb : table.verbs) {
    script += "        " + verb.name + ")\n          _arguments";
    for (const CommandOption& option : verb.options)
      script += " \\\n            " + zsh_spec(option);
    script += " ;;\n";
  }
  return script +
         "      esac ;;\n  esac\n}\n"
         "if [[ $zsh_eval_context[-1] == loadautofunc ]]; then\n  _sunder \"$@\"\n"
         "else\n  compdef _sunder sunder\nfi\n";
}

// --- fish

// Inside '…' of fish.
std::string fish_text(const std::string& text) {
  return replaced(replaced(text, "\\", "\\\\"), "'", "\\'");
}

std::string fish_values(const CommandOption& option) {
  if (!option.choices.empty()) return " -a '" + joined(option.choices, " ") + "'";
  if (!option.takes_file() && !option.is_positional) return "";
  if (option.suffixes.empty()) return " -F";
  return " -k -a '(__fish_complete_suffix " + joined(option.suffixes, " ") + ")'";
}

std::string fish_line(const CommandOption& option, const std::string& when) {
  std::string line = "complete -c sunder -n '" + when + "'";
  if (!option.is_positional) {
    for (const std::string& name : option.names)
      line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.value.empty()) line += " -x";
    line += " -d '" + fish_text(option.text) + "'";
  }
  return line + (option.value.empty() ? "" : fish_values(option)) + "\n";
}

std::string fish_script(const CommandTable& table) {
  std::string script =
      "# Completes sunder's command line in fish; printed by: sunder completion fish\n"
      "complete -c sunder -f\n";
  const std::string verbs = joined(names_of(table.verbs), " ");
  const std::string none = "not __fish_seen_subcommand_from " + verbs;
  for (const CommandVerb& verb : table.verbs)
    script += "complete -c sunder -n '" + none + "' -a " + verb.name + " -d '" +
              fish_text(verb.text) + "'\n";
  for (const CommandOption& option : table.options) script += fish_line(option, none);
  for (const CommandVerb& verb : table.verbs)
    for (const CommandOption& option : verb.options)
      script += fish_line(option, "__fish_seen_subcommand_from " + verb.name);
  return script;
}

}  // namespace

std::string completion_script(const CommandTable& table, const std::string& shell) {
  assert(std::ranges::find(kShells, shell) != kShells.end());
  return shell == "bash"  ? bash_script(table)
         : shell == "zsh" ? zsh_script(table)
                          : fish_script(table);
}

}  // namespace sunder
