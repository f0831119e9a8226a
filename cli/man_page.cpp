// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <string_view>

#include "cli/command_table.hpp"

namespace sunder {
namespace {

constexpr std::string_view kEnd = R"(.SH EXIT STATUS
.TP
0
Everything is done.
.TP
1
It ran, but an asset is not sound.
.TP
2
The command line is wrong, also a value on it.
.TP
3
A file, field or mesh is wrong.
.TP
4
A result cannot be written.
.TP
70
A bug of the program.
.TP
129, 130, 143
Hung up, interrupted, terminated; no file is half-written.
.SH EXAMPLES
.EX
sunder fracture \-\-wall 6x3x0.2 \-\-cell 0.3 \-o wall.glb \-o wall.png
sunder fracture vase.obj \-\-chunks 120 \-\-hulls ucx \-o vase.glb
sunder impact scene.json \-o run.glb \-o run.png \-\-report run.json
sunder collapse building.json \-o fall.png \-\-at 1.5 \-\-width 3000
sunder check wall.glb
.EE
)";

// Of UTF-8, the code of the character at `at`, which moves behind it.
unsigned next_code(const std::string& text, std::size_t& at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(at++);
  if (first < 0x80) return first;
  const int more = first < 0xE0 ? 1 : first < 0xF0 ? 2 : 3;
  unsigned code = first & (0x3Fu >> more);
  for (int i = 0; i < more && at < text.size(); ++i) code = code << 6 | (byte(at++) & 0x3F);
  return code;
}

// A line of text, in ASCII: nothing of it is a request of roff.
std::string roff(const std::string& text) {
  std::string result = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (std::size_t at = 0; at < text.size();) {
    const unsigned code = next_code(text, at);
    char character[16];
    std::snprintf(character, sizeof character, code < 0x80 ? "%c" : "\\[u%04X]", code);
    result += code == '\\' ? "\\e" : code == '-' ? "\\-" : character;
  }
  return result;
}

void add_option(const CommandOption& option, std::string& page) {
  page += ".TP\n";
  for (std::size_t i = 0; i < option.names.size(); ++i)
    page += (i > 0 ? ", " : "") + std::string("\\fB") + roff(option.names[i]) + "\\fR";
  if (!option.is_positional && !option.value.empty()) page += " \\fI" + roff(option.value) + "\\fR";
  page += "\n" + roff(option.text) + "\n";
  if (option.choices.empty()) return;
  page += ".br\nOne of";
  for (const std::string& word : option.choices) page += " " + roff(word);
  page += ".\n";
}

std::string synopsis_of(const CommandVerb& verb) {
  std::string line = ".B sunder " + verb.name + "\n.RI [ options ]";
  for (const CommandOption& option : verb.options) {
    if (!option.is_positional) continue;
    const std::string dots = option.is_repeatable ? "\\ ..." : "";
    line += option.is_required ? "\n.IR " + option.names[0] + dots
                               : "\n.RI [ " + option.names[0] + " ]" + dots;
  }
  return line + "\n.br\n";
}

}  // namespace

std::string man_page(const CommandTable& table) {
  std::string page = ".\\\" Printed by: sunder schema man\n.TH SUNDER 1 \"\" \"" +
                     roff(table.version) + "\" \"User Commands\"\n.SH NAME\nsunder \\- " +
                     "break walls, meshes and frame buildings\n.SH SYNOPSIS\n";
  for (const CommandVerb& verb : table.verbs) page += synopsis_of(verb);
  page += ".SH DESCRIPTION\n" + roff(table.text) + "\n.SH OPTIONS\n";
  for (const CommandOption& option : table.options) add_option(option, page);
  for (const CommandVerb& verb : table.verbs) {
    page += ".SH \"sunder " + verb.name + "\"\n" + roff(verb.text) + ".\n";
    std::string group = "Options";
    for (const CommandOption& option : verb.options) {
      if (option.group != group && !option.is_positional) {
        group = option.group;
        page += ".SS " + roff(group) + "\n";
      }
      add_option(option, page);
    }
  }
  page += kEnd;
  return page;
}

}  // namespace sunder
