// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/wall_scene.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "io/printable.hpp"

namespace sunder {
namespace {

[[noreturn]] void usage(const std::string& message) {
  throw Error(ErrorCode::usage, message + " (see sunder --help)");
}

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

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1)
    parts.push_back(text.substr(begin, end - begin));
  parts.push_back(text.substr(begin));
  return parts;
}

// `count` numbers of an option's value, as JSON; `given` is the whole value, for the message.
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

std::string opening_json(const std::string& text) {
  constexpr const char* kForm = "WxH@X,Y in metres";
  const std::vector<std::string> parts = split(text, '@');
  if (parts.size() != 2) usage("--opening " + text + ": expected " + kForm);
  const auto size = numbers("--opening", text, parts[0], 'x', 2, kForm);
  const auto at = numbers("--opening", text, parts[1], ',', 2, kForm);
  return "{\"rect\": [" + size[0] + ", " + size[1] + "], \"at\": [" + at[0] + ", " + at[1] + "]}";
}

std::string point_json(const std::string& key, const std::string& text) {
  const auto xy = numbers(option_name(key), text, text, ',', 2, "X,Y in metres");
  return "[" + xy[0] + ", " + xy[1] + "]";
}

template <class Make>
std::string list_json(const std::vector<std::string>& values, Make make) {
  std::string list;
  for (const std::string& value : values) list += (list.empty() ? "" : ", ") + make(value);
  return "[" + list + "]";
}

std::string pattern_json(const WallOptions& wall) {
  std::string text = "{\"type\": " + quoted(wall.type);
  for (const auto& entry : wall.pattern) {
    const auto& [key, values] = entry;
    if (values.empty()) continue;
    const auto point = [&](const std::string& value) { return point_json(entry.first, value); };
    text += ", \"" + key + "\": " +
            (wall.is_points.at(key) ? list_json(values, point) : value_json(values.front()));
  }
  return text + "}";
}

// Option that a key of the one wall's text came from; `pointer` is below /walls/0/.
std::string option_of(std::string_view pointer) {
  constexpr std::string_view kPattern = "pattern/";
  if (pointer.starts_with(kPattern)) {
    pointer.remove_prefix(kPattern.size());
    const std::string_view key = pointer.substr(0, pointer.find('/'));
    return key == "type" ? "--pattern" : option_name(key);
  }
  const std::string_view key = pointer.substr(0, pointer.find('/'));
  if (key == "openings") return "--opening";
  for (const std::string_view own : {"pattern", "anchors", "name", "material", "min_cell"})
    if (key == own) return option_name(key);
  return "--wall";
}

}  // namespace

std::string scene_text(const WallOptions& wall) {
  const auto size =
      numbers("--wall", wall.size, wall.size, 'x', 3, "WIDTHxHEIGHTxTHICKNESS in metres");
  std::string text = "{\"sunder\": 1, \"walls\": [{\"outline\": {\"rect\": [" + size[0] + ", " +
                     size[1] + "]}, \"thickness\": " + size[2];
  for (const auto& [key, value] : wall.keys)
    if (!value.empty())
      text += ", \"" + key + "\": " + (key == "min_cell" ? value_json(value) : quoted(value));
  if (!wall.openings.empty()) text += ", \"openings\": " + list_json(wall.openings, opening_json);
  if (!wall.anchors.empty())
    text += ", \"anchors\": " + list_json(split(wall.anchors, ','), quoted);
  return text + ", \"pattern\": " + pattern_json(wall) + "}]}";
}

std::string option_name(std::string_view key) {
  std::string name = "--" + std::string(key);
  std::ranges::replace(name, '_', '-');
  return name;
}

Error named_by_option(const Error& error, const std::string& name) {
  const std::string message = error.what();
  if (error.code() != ErrorCode::input) return error;
  // The forms Place::fail writes: `name: --set: /pointer: what`, `name:1: /pointer: what`.
  const std::string file = printable(name, std::string::npos);
  if (message.starts_with(file + ": --set: "))
    return {ErrorCode::usage, message.substr(file.size() + 2)};
  constexpr std::string_view kPlace = "/walls/0/";
  const std::string prefix = kCommandLine + std::string(":1: ");
  if (name != kCommandLine || !message.starts_with(prefix)) return error;
  const std::string rest = message.substr(prefix.size());
  const std::size_t end = rest.find(": ");
  if (!rest.starts_with(kPlace) || end == std::string::npos) return {ErrorCode::usage, rest};
  const std::string_view pointer =
      std::string_view(rest).substr(kPlace.size(), end - kPlace.size());
  return {ErrorCode::usage, option_of(pointer) + rest.substr(end)};
}

}  // namespace sunder
