// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/scene_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "cli/usage.hpp"
#include "io/printable.hpp"

namespace sunder {
namespace {

// The number as JSON spells it: people also write .5, 6. and +6, which JSON refuses.
std::optional<std::string> number_json(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const char* const end = text.data() + text.size();
  const std::from_chars_result read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc() || read.ptr != end || !std::isfinite(value)) return {};
  char buffer[32];
  return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

std::string point_json(const std::string& key, const std::string& text) {
  const auto xy = numbers(option_name(key), text, text, ',', 2, "X,Y in metres");
  return "[" + xy[0] + ", " + xy[1] + "]";
}

std::string key_json(const std::string& key, const std::vector<std::string>& values, KeyForm form) {
  const std::string option = option_name(key);
  const bool is_list = form == KeyForm::pairs || form == KeyForm::triples;
  if (!is_list && values.size() > 1) usage(option + " is given twice");
  if (form == KeyForm::value) return value_json(values.front());
  if (form == KeyForm::triple)
    return triple_json(option, values.front(), values.front(), "X,Y,Z or XxYxZ");
  std::vector<std::string> items;
  for (const std::string& value : values) {
    if (form == KeyForm::pairs) {
      items.push_back(point_json(key, value));
      continue;
    }
    for (const std::string& part : split(value, ';'))
      items.push_back(triple_json(option, value, part, "X,Y,Z in metres"));
  }
  return list_json(items);
}

// Option that a key of the made text came from; `pointer` is below /walls/0/ or /solids/0/.
std::string option_of(std::string_view pointer, bool is_solid) {
  constexpr std::string_view kPattern = "pattern/";
  if (pointer.starts_with(kPattern)) {
    pointer.remove_prefix(kPattern.size());
    const std::string_view key = pointer.substr(0, pointer.find('/'));
    return key == "type" ? "--pattern" : option_name(key);
  }
  const std::string_view key = pointer.substr(0, pointer.find('/'));
  if (key == "openings") return "--opening";
  if (key == "craters") return "--carve";
  if (key == "file") return "MODEL";
  if (is_solid) return option_name(key);
  for (const std::string_view own : {"pattern", "anchors", "name", "material", "min_cell"})
    if (key == own) return option_name(key);
  return "--wall";
}

}  // namespace

std::string pattern_json(const std::string& default_type, const PatternOptions& pattern,
                         const KeyForms& forms) {
  std::string text = "{\"type\": " + quoted(pattern.type.empty() ? default_type : pattern.type);
  for (const auto& [key, values] : pattern.values) {
    if (values.empty()) continue;
    const auto form = forms.find(key);
    text += ", \"" + key +
            "\": " + key_json(key, values, form == forms.end() ? KeyForm::value : form->second);
  }
  return text + "}";
}

std::string option_name(std::string_view key) {
  std::string name = "--" + std::string(key);
  std::ranges::replace(name, '_', '-');
  return name;
}

std::string quoted(const std::string& text) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string result = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20) {
      result += {'\\', 'u', '0', '0', kDigits[code >> 4], kDigits[code & 15]};
      continue;
    }
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string value_json(const std::string& text) {
  return number_json(text).value_or(quoted(text));
}

std::string list_json(const std::vector<std::string>& items) {
  std::string list;
  for (const std::string& item : items) list += (list.empty() ? "" : ", ") + item;
  return "[" + list + "]";
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1)
    parts.push_back(text.substr(begin, end - begin));
  parts.push_back(text.substr(begin));
  return parts;
}

std::vector<std::string> numbers(const std::string& option, const std::string& given,
                                 const std::string& text, char separator, std::size_t count,
                                 const char* form) {
  std::vector<std::string> parts = split(text, separator);
  for (std::string& part : parts) {
    const auto number = number_json(part);
    if (!number || parts.size() != count) usage(option + " " + given + ": expected " + form);
    part = *number;
  }
  return parts;
}

std::string triple_json(const std::string& option, const std::string& given,
                        const std::string& text, const char* form) {
  const char separator = text.find(',') == std::string::npos ? 'x' : ',';
  return list_json(numbers(option, given, text, separator, 3, form));
}

Error named_by_option(const Error& error, const std::string& name) {
  const std::string message = error.what();
  if (error.code() != ErrorCode::input) return error;
  // The forms Place::fail writes: `name: --set: /pointer: what`, `name:1: /pointer: what`.
  const std::string file = printable(name, std::string::npos);
  if (message.starts_with(file + ": --set: "))
    return {ErrorCode::usage, message.substr(file.size() + 2)};
  const std::string prefix = kCommandLine + std::string(":1: ");
  if (name != kCommandLine || !message.starts_with(prefix)) return error;
  const std::string rest = message.substr(prefix.size());
  const std::size_t end = rest.find(": ");
  for (const std::string_view place : {"/walls/0/", "/solids/0/"}) {
    if (!rest.starts_with(place) || end == std::string::npos) continue;
    const std::string_view pointer =
        std::string_view(rest).substr(place.size(), end - place.size());
    return {ErrorCode::usage, option_of(pointer, place[1] == 's') + rest.substr(end)};
  }
  return {ErrorCode::usage, rest};
}

}  // namespace sunder
