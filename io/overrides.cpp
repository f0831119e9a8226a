// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/overrides.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

#include "io/printable.hpp"
#include "io/strict_json.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

[[noreturn]] void fail(const std::string& override_text, const std::string& what) {
  throw Error(ErrorCode::usage, "--set " + printable(override_text) + ": " + what);
}

std::vector<std::string_view> split(std::string_view path) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t dot = path.find('.');
    parts.push_back(path.substr(0, dot));
    if (dot == std::string_view::npos) return parts;
    path.remove_prefix(dot + 1);
  }
}

void mark_as_given(JsonValue& value) {
  value.line = 0;
  if (JsonValue::List* items = value.items()) {
    for (JsonValue& item : *items) mark_as_given(item);
  } else if (JsonValue::Object* members = value.members()) {
    for (JsonMember& member : *members) mark_as_given(member.value);
  }
}

JsonValue value_from(std::string_view text) {
  JsonValue value{std::string(text)};
  try {
    value = parse_json(text, "--set");
  } catch (const Error&) {
    // Not JSON, so it is the text itself: `--set walls.0.name=facade` needs no quotes.
  }
  mark_as_given(value);
  return value;
}

/// The entry of `from` that one part of the path names.
JsonValue& step(JsonValue& from, std::string_view part, const std::string& override_text) {
  const std::string shown = '"' + printable(part, 40) + '"';
  if (JsonValue::List* items = from.items()) {
    std::size_t index = 0;
    const char* end = part.data() + part.size();
    const std::from_chars_result read = std::from_chars(part.data(), end, index);
    if (read.ec != std::errc() || read.ptr != end || index >= items->size()) {
      fail(override_text, shown + " is no entry of a list of " + std::to_string(items->size()) +
                              (items->empty() ? "" : ", 0 is the first"));
    }
    return (*items)[index];
  }
  if (!from.members()) {
    fail(override_text, describe(from) + " has no entry " + shown + ", it is " + kind_of(from));
  }
  if (JsonValue* found = from.find(part)) return *found;
  from.members()->push_back({std::string(part), JsonValue::object()});
  return from.members()->back().value;
}

}  // namespace

void apply_override(JsonValue& root, const std::string& path_and_value) {
  const std::size_t equals = path_and_value.find('=');
  if (equals == std::string::npos) {
    fail(path_and_value, "must be PATH=VALUE, for example walls.0.pattern.jitter=0.5");
  }
  const std::vector<std::string_view> parts =
      split(std::string_view(path_and_value).substr(0, equals));
  if (std::find(parts.begin(), parts.end(), "") != parts.end()) {
    fail(path_and_value, "the path has an empty part, write it as walls.0.pattern.jitter");
  }
  if (parts.size() > kMaxJsonDepth) {
    fail(path_and_value, "the path has more than " + std::to_string(kMaxJsonDepth) + " parts");
  }
  JsonValue* place = &root;
  for (const std::string_view part : parts) place = &step(*place, part, path_and_value);
  *place = value_from(std::string_view(path_and_value).substr(equals + 1));
}

}  // namespace sunder
