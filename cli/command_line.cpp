// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command_line.hpp"

namespace sunder {
namespace {

std::string quoted(const std::string& word) {
  constexpr const char* kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=.,:/@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string result = "'";
  for (const char c : word) c == '\'' ? result += "'\\''" : result += c;
  result += '\'';
  return result;
}

}  // namespace

std::string command_line(int argc, const char* const* argv) {
  std::string line = "sunder";
  for (int i = 1; i < argc; ++i) line.append(" ").append(quoted(argv[i]));
  return line;
}

}  // namespace sunder
