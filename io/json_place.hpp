// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "io/json_value.hpp"
#include "meshing/field.hpp"
#include "meshing/vec.hpp"

namespace sunder {

/// A value and how it was reached: a linked list up the stack of the functions that visit it, so
/// that a pointer is only spelt out for a message. Refers to its parent and its key.
struct Place {
  const std::string& file;  ///< as messages name it
  const JsonValue& value;
  const Place* parent = nullptr;
  std::string_view key = {};  ///< in the parent, when that is an object
  std::size_t index = 0;      ///< in the parent, when that is a list

  Place(const std::string& name, const JsonValue& root) : file(name), value(root) {}
  Place(const Place& object, const JsonMember& member)
      : file(object.file), value(member.value), parent(&object), key(member.key) {}
  Place(const Place& object, std::string_view member, const JsonValue& found)
      : file(object.file), value(found), parent(&object), key(member) {}
  Place(const Place& list, std::size_t item);

  /// JSON pointer, "" for the root.
  std::string pointer() const;
  /// Throws Error{input} "file:line: /json/pointer: what"; for a value from the command line
  /// "file: --set: /json/pointer: what".
  [[noreturn]] void fail(const std::string& what) const;
  /// fail() with "must be `wanted`, got …".
  [[noreturn]] void fail_kind(const std::string& wanted) const;
};

/// "[0, 1]", "(0, 5] m", "at least 3"; "" for a range without limits.
std::string range_text(const Range& range, std::string_view unit = "");

// Each checks the kind and the valid values, and throws as Place::fail does.
const JsonValue::Object& object_at(const Place& place);
const JsonValue::List& list_at(const Place& place);
double number_at(const Place& place, const Range& range = {}, std::string_view unit = "");
std::int64_t integer_at(const Place& place, const Range& range = {}, std::string_view unit = "");
std::uint64_t natural_at(const Place& place);  ///< any of the 64 bits
bool truth_at(const Place& place);
std::string text_at(const Place& place, std::span<const std::string_view> choices = {});
/// List of different texts.
std::vector<std::string> texts_at(const Place& place, std::span<const std::string_view> choices);
/// A list of exactly two or three numbers.
Vec2 pair_at(const Place& place, const Range& range, std::string_view unit);
Vec3 triple_at(const Place& place, const Range& range, std::string_view unit);
/// List of at least `least` pairs or triples.
std::vector<Vec2> pairs_at(const Place& place, std::size_t least, const Range& range,
                           std::string_view unit);
std::vector<Vec3> triples_at(const Place& place, std::size_t least, const Range& range,
                             std::string_view unit);

/// Throws at the first member whose key is not valid, with "did you mean".
void check_keys(const Place& object, std::span<const std::string_view> valid);
/// Throws for the object when it has no such member.
void require_key(const Place& object, std::string_view key, std::string_view example);

/// Reads one member of a parameter struct as its field says.
template <class Params>
void read_field(Params& params, const Field<Params>& field, const Place& place) {
  const auto read = [&](auto member) {
    using T = std::remove_reference_t<decltype(params.*member)>;
    if constexpr (std::is_same_v<T, double>) {
      params.*member = number_at(place, field.range, field.unit);
    } else if constexpr (std::is_same_v<T, std::int64_t>) {
      params.*member = integer_at(place, field.range, field.unit);
    } else if constexpr (std::is_same_v<T, bool>) {
      params.*member = truth_at(place);
    } else if constexpr (std::is_same_v<T, std::string>) {
      params.*member = text_at(place, field.choices);
    } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
      params.*member = texts_at(place, field.choices);
    } else if constexpr (std::is_same_v<T, Vec3>) {
      params.*member = triple_at(place, field.range, field.unit);
    } else if constexpr (std::is_same_v<T, std::vector<Vec3>>) {
      params.*member = triples_at(place, field.required ? 1 : 0, field.range, field.unit);
    } else {
      params.*member = pairs_at(place, field.required ? 1 : 0, field.range, field.unit);
    }
  };
  std::visit(read, field.member);
}

/// What a member that must be there could look like.
template <class Params>
std::string example_of(const Field<Params>& field) {
  const bool is_pairs = std::holds_alternative<std::vector<Vec2> Params::*>(field.member);
  return '"' + std::string(field.name) + (is_pairs ? "\": [[0.5, 1], [2, 0.3]]" : "\": \"…\"");
}

/// Reads the members of `object` that are in the struct's table; others are left alone.
template <class Params>
void read_fields(Params& params, const Place& object) {
  for (const Field<Params>& field : fields<Params>()) {
    if (const JsonValue* value = object.value.find(field.name)) {
      read_field(params, field, Place(object, field.name, *value));
    } else if (field.required) {
      require_key(object, field.name, example_of(field));
    }
  }
}

/// The keys of a struct's table, after those given.
template <class Params>
std::vector<std::string_view> keys_of(std::initializer_list<std::string_view> first = {}) {
  std::vector<std::string_view> keys(first);
  for (const Field<Params>& field : fields<Params>()) keys.push_back(field.name);
  return keys;
}

}  // namespace sunder
