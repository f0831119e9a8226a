// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace sunder {

struct JsonMember;

/// A JSON value of a file that a person wrote: objects keep their order, and every value knows the
/// line it starts on, so that a message about its meaning can name it.
class JsonValue {
 public:
  using List = std::vector<JsonValue>;
  using Object = std::vector<JsonMember>;

  JsonValue();
  JsonValue(JsonValue&& other) noexcept;
  JsonValue& operator=(JsonValue&& other) noexcept;
  ~JsonValue();
  explicit JsonValue(bool value);
  explicit JsonValue(std::int64_t value);
  explicit JsonValue(std::uint64_t value);
  explicit JsonValue(double value);
  explicit JsonValue(std::string value);
  static JsonValue list();
  static JsonValue object();

  bool is_null() const { return std::holds_alternative<std::monostate>(data_); }
  bool is_number() const;
  /// Any number as a double; only if is_number().
  double number() const;
  /// The following are null when the value is of another kind. An integer is a natural number or a
  /// negative one; a number with a point or an exponent is neither.
  const bool* boolean() const { return std::get_if<bool>(&data_); }
  const std::uint64_t* natural() const { return std::get_if<std::uint64_t>(&data_); }
  const std::int64_t* negative_integer() const { return std::get_if<std::int64_t>(&data_); }
  const std::string* text() const;
  const List* items() const;
  const Object* members() const;
  List* items();
  Object* members();
  /// The member's value; null when there is none or this is no object. O(members).
  const JsonValue* find(std::string_view key) const;
  JsonValue* find(std::string_view key);

  std::uint32_t line = 0;  ///< 1 is the first; 0: the value came from the command line

 private:
  // What needs memory is behind a pointer to keep a number at 24 bytes: files are mostly numbers.
  std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double,
               std::unique_ptr<std::string>, std::unique_ptr<List>, std::unique_ptr<Object>>
      data_;
};

struct JsonMember {
  std::string key;
  JsonValue value;
};

/// A value as a message shows it: `1.5`, `"text"`, `a list of 3`, `an object`.
std::string describe(const JsonValue& value);
/// What kind of value it is: `a number`, `a text`, `null` …
std::string kind_of(const JsonValue& value);
/// "/key" as one step of a JSON pointer, escaped as RFC 6901 asks and fit for a terminal.
std::string pointer_step(std::string_view key);

}  // namespace sunder
