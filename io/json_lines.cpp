// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json_lines.hpp"

#include <cmath>

#include "io/string_sink.hpp"

namespace sunder {
void JsonLines::open(char bracket) {
  begin();
  out_.text(bracket == '{' ? "{" : "[");
  levels_.push_back({bracket});
}

void JsonLines::open(std::string_view key, char bracket) {
  name(key);
  open(bracket);
}

void JsonLines::close() {
  const Level level = levels_.back();
  if (level.count > 0 && has_lines()) line(levels_.size() - 1);
  levels_.pop_back();
  out_.text(level.bracket == '{' ? "}" : "]");
}

void JsonLines::number(double value) {
  if (!std::isfinite(value)) return word("null");
  begin();
  out_.exact(value);
}

void JsonLines::float32(float value) {
  if (!std::isfinite(value)) return word("null");
  begin();
  out_.number(value);
}

void JsonLines::count(std::uint64_t value) {
  begin();
  out_.integer(value);
}

void JsonLines::text(std::string_view value) {
  begin();
  out_.quoted(value);
}

void JsonLines::number(std::string_view key, double value) {
  name(key);
  number(value);
}

void JsonLines::count(std::string_view key, std::uint64_t value) {
  name(key);
  count(value);
}

void JsonLines::text(std::string_view key, std::string_view value) {
  name(key);
  text(value);
}

void JsonLines::truth(std::string_view key, bool value) {
  name(key);
  word(value ? "true" : "false");
}

void JsonLines::null(std::string_view key) {
  name(key);
  word("null");
}

void JsonLines::point(std::string_view key, Vec3 value) {
  open(key, '[');
  for (const double each : {value.x, value.y, value.z}) number(each);
  close();
}

bool JsonLines::has_lines() const {
  return levels_.size() == 1 || (levels_.size() == 2 && levels_.back().bracket == '[');
}

void JsonLines::line(std::size_t depth) {
  out_.text("\n");
  for (std::size_t i = 0; i < depth; ++i) out_.text("  ");
}

// What stands before an entry; nothing more after its key.
void JsonLines::begin() {
  if (levels_.empty() || named_) {
    named_ = false;
    return;
  }
  if (levels_.back().count++ > 0) out_.text(has_lines() ? "," : ", ");
  if (has_lines()) line(levels_.size());
}

void JsonLines::name(std::string_view key) {
  text(key);
  out_.text(": ");
  named_ = true;
}

void JsonLines::word(std::string_view value) {
  begin();
  out_.text(value);
}

std::string json_text(const std::function<void(JsonLines&)>& write) {
  std::string text;
  StringSink sink(text);
  TextWriter out(sink);
  JsonLines json(out);
  write(json);
  out.text("\n");
  out.flush();
  return text;
}

}  // namespace sunder
