// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "meshing/error.hpp"

namespace sunder {

/// Stands for the file in messages about what is given by options.
inline constexpr const char* kCommandLine = "command line";

/// How an option gives a key of a pattern.
enum class KeyForm : std::uint8_t {
  value,
  pairs,    ///< X,Y repeatable
  triple,   ///< X,Y,Z or XxYxZ
  triples,  ///< X,Y,Z repeatable, or several with ; between
};
using KeyForms = std::map<std::string, KeyForm>;

/// --pattern and the options of its keys, as given.
struct PatternOptions {
  std::string type;                                        ///< empty: not given
  std::map<std::string, std::vector<std::string>> values;  ///< by key
};

/// The pattern as JSON; always valid. `forms`: of the keys there are; others are values. Throws
/// Error{usage} when a value has not the form its option wants, or one that is not a list is given
/// twice.
std::string pattern_json(const std::string& default_type, const PatternOptions& pattern,
                         const KeyForms& forms);

/// Option that gives a scene key: "min_cell" → "--min-cell".
std::string option_name(std::string_view key);

/// A text, a number or else a text, a list of them, as JSON.
std::string quoted(const std::string& text);
std::string value_json(const std::string& text);
std::string list_json(const std::vector<std::string>& items);

std::vector<std::string> split(const std::string& text, char separator);
/// `count` numbers of an option's value, as JSON; `given` is the whole value, for the message.
std::vector<std::string> numbers(const std::string& option, const std::string& given,
                                 const std::string& text, char separator, std::size_t count,
                                 const char* form);
/// Three numbers X,Y,Z or XxYxZ as a JSON list.
std::string triple_json(const std::string& option, const std::string& given,
                        const std::string& text, const char* form);

/// The same error about a value of the command line, named by its option: as Error{usage}
/// "--jitter: 1.4 is outside [0, 1]". `name` is the file parse_scene was told. An error about what
/// stands in a file comes back as it is.
Error named_by_option(const Error& error, const std::string& name);

}  // namespace sunder
