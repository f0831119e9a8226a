// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json_value.hpp"

#include <cassert>

#include "io/printable.hpp"

namespace sunder {

JsonValue::JsonValue() = default;
JsonValue::JsonValue(JsonValue&& other) noexcept = default;
JsonValue& JsonValue::operator=(JsonValue&& other) noexcept = default;
JsonValue::~JsonValue() = default;
JsonValue::JsonValue(bool value) : data_(value) {}
JsonValue::JsonValue(std::int64_t value) : data_(value) {}
JsonValue::JsonValue(std::uint64_t value) : data_(value) {}
JsonValue::JsonValue(double value) : data_(value) {}
JsonValue::JsonValue(std::string value) : data_(std::make_unique<std::string>(std::move(value))) {}

JsonValue JsonValue::list() {
  JsonValue value;
  value.data_ = std::make_unique<List>();
  return value;
}

JsonValue JsonValue::object() {
  JsonValue value;
  value.data_ = std::make_unique<Object>();
  return value;
}

bool JsonValue::is_number() const {
  return natural() || negative_integer() || std::holds_alternative<double>(data_);
}

double JsonValue::number() const {
  assert(is_number());
  if (const std::uint64_t* value = natural()) return static_cast<double>(*value);
  if (const std::int64_t* value = negative_integer()) return static_cast<double>(*value);
  return std::get<double>(data_);
}

const std::string* JsonValue::text() const {
  const auto* held = std::get_if<std::unique_ptr<std::string>>(&data_);
  return held ? held->get() : nullptr;
}

const JsonValue::List* JsonValue::items() const {
  const auto* held = std::get_if<std::unique_ptr<List>>(&data_);
  return held ? held->get() : nullptr;
}

const JsonValue::Object* JsonValue::members() const {
  const auto* held = std::get_if<std::unique_ptr<Object>>(&data_);
  return held ? held->get() : nullptr;
}

JsonValue::List* JsonValue::items() {
  return const_cast<List*>(static_cast<const JsonValue*>(this)->items());
}

JsonValue::Object* JsonValue::members() {
  return const_cast<Object*>(static_cast<const JsonValue*>(this)->members());
}

const JsonValue* JsonValue::find(std::string_view key) const {
  if (const Object* object = members()) {
    for (const JsonMember& member : *object) {
      if (member.key == key) return &member.value;
    }
  }
  return nullptr;
}

JsonValue* JsonValue::find(std::string_view key) {
  return const_cast<JsonValue*>(static_cast<const JsonValue*>(this)->find(key));
}

std::string describe(const JsonValue& value) {
  if (const std::uint64_t* natural = value.natural()) return std::to_string(*natural);
  if (const std::int64_t* integer = value.negative_integer()) return std::to_string(*integer);
  if (value.is_number()) return number_text(value.number());
  if (const bool* boolean = value.boolean()) return *boolean ? "true" : "false";
  if (const std::string* text = value.text()) return '"' + printable(*text, 40) + '"';
  if (const JsonValue::List* items = value.items()) {
    return items->empty() ? "an empty list" : "a list of " + std::to_string(items->size());
  }
  return value.members() ? "an object" : "null";
}

std::string kind_of(const JsonValue& value) {
  if (value.is_number()) return "a number";
  if (value.text()) return "a text";
  if (value.boolean()) return "a truth value";
  return value.items() ? "a list" : value.members() ? "an object" : "null";
}

std::string pointer_step(std::string_view key) {
  std::string escaped = "/";
  for (const char c : printable(key, 40)) {
    if (c == '~') {
      escaped += "~0";
    } else if (c == '/') {
      escaped += "~1";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

}  // namespace sunder
