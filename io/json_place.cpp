// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json_place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/printable.hpp"
#include "io/suggest.hpp"
#include "meshing/error.hpp"

namespace sunder {
namespace {

/// What a value out of range says: `7 is outside [0, 1] m`.
[[noreturn]] void fail_range(const Place& place, const Range& range, std::string_view unit) {
  place.fail(describe(place.value) + " is outside " + range_text(range, unit));
}

std::string wanted_pair(std::size_t size, std::string_view unit) {
  std::string text = "a list of " + std::to_string(size) + " numbers";
  if (!unit.empty()) text += " (" + std::string(unit) + ")";
  return text;
}

}  // namespace

Place::Place(const Place& list, std::size_t item)
    : file(list.file), value((*list.value.items())[item]), parent(&list), index(item) {}

std::string Place::pointer() const {
  if (!parent) return {};
  return parent->pointer() +
         (parent->value.items() ? '/' + std::to_string(index) : pointer_step(key));
}

void Place::fail(const std::string& what) const {
  const std::string where = pointer();
  throw Error(ErrorCode::input,
              printable(file, std::string::npos) +
                  (value.line ? ':' + std::to_string(value.line) + ": " : ": --set: ") +
                  (where.empty() ? "" : where + ": ") + what);
}

void Place::fail_kind(const std::string& wanted) const {
  const bool says_itself = value.is_null() || value.items() || value.members();
  fail("must be " + wanted + ", got " + (says_itself ? "" : kind_of(value) + ", ") +
       describe(value));
}

std::string range_text(const Range& range, std::string_view unit) {
  const bool has_low = std::isfinite(range.low), has_high = std::isfinite(range.high);
  std::string text;
  if (range.low == range.high) {
    text = number_text(range.low);
  } else if (has_low && has_high) {
    text += range.open ? '(' : '[';
    text += number_text(range.low) + ", " + number_text(range.high) + ']';
  } else if (has_low) {
    text += range.open ? "above " : "at least ";
    text += number_text(range.low);
  } else if (has_high) {
    text += "at most ";
    text += number_text(range.high);
  }
  if (!text.empty() && !unit.empty()) {
    text += ' ';
    text += unit;
  }
  return text;
}

const JsonValue::Object& object_at(const Place& place) {
  if (!place.value.members()) place.fail_kind("an object {…}");
  return *place.value.members();
}

const JsonValue::List& list_at(const Place& place) {
  if (!place.value.items()) place.fail_kind("a list […]");
  return *place.value.items();
}

double number_at(const Place& place, const Range& range, std::string_view unit) {
  if (!place.value.is_number()) {
    const std::string valid = range_text(range, unit);
    place.fail_kind("a number" + (valid.empty() ? "" : " in " + valid));
  }
  const double value = place.value.number();
  if (!range.contains(value)) fail_range(place, range, unit);
  return value;
}

std::int64_t integer_at(const Place& place, const Range& range, std::string_view unit) {
  constexpr double kExact = 9007199254740992;  // 2^53: every integer up to here is a double
  const std::string valid = range_text(range, unit);
  const std::string wanted = "a whole number" + (valid.empty() ? "" : " in " + valid);
  if (!place.value.is_number()) place.fail_kind(wanted);
  const double value = place.value.number();
  if (value != std::floor(value)) place.fail_kind(wanted);
  if (!range.contains(value) || std::abs(value) > kExact) {
    fail_range(place, {std::max(range.low, -kExact), std::min(range.high, kExact), range.open},
               unit);
  }
  return static_cast<std::int64_t>(value);
}

std::uint64_t natural_at(const Place& place) {
  if (const std::uint64_t* value = place.value.natural()) return *value;
  constexpr double kEnd = 18446744073709551616.0;  // 2^64
  const bool is_number = place.value.is_number();
  const double value = is_number ? place.value.number() : -1;
  if (value < 0 || value >= kEnd || value != std::floor(value)) {
    const std::string wanted = "a whole number in [0, 18446744073709551615]";
    if (is_number) place.fail("must be " + wanted + ", got " + describe(place.value));
    place.fail_kind(wanted);
  }
  return static_cast<std::uint64_t>(value);
}

bool truth_at(const Place& place) {
  if (!place.value.boolean()) place.fail_kind("true or false");
  return *place.value.boolean();
}

std::string text_at(const Place& place, std::span<const std::string_view> choices) {
  const std::string* text = place.value.text();
  if (!text) {
    std::string wanted = "a text";
    for (std::size_t i = 0; i < choices.size(); ++i) {
      wanted += (i ? ", \"" : ": \"") + std::string(choices[i]) + '"';
    }
    place.fail_kind(wanted);
  }
  if (!choices.empty() && std::find(choices.begin(), choices.end(), *text) == choices.end()) {
    place.fail("unknown word " + describe(place.value) + hint_for(*text, choices));
  }
  return *text;
}

std::vector<std::string> texts_at(const Place& place, std::span<const std::string_view> choices) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < list_at(place).size(); ++i) {
    const Place item(place, i);
    std::string text = text_at(item, choices);
    // Quadratic only in the number of choices: each may occur once.
    if (std::find(texts.begin(), texts.end(), text) != texts.end()) {
      item.fail(describe(item.value) + " occurs twice, give it once");
    }
    texts.push_back(std::move(text));
  }
  return texts;
}

Vec2 pair_at(const Place& place, const Range& range, std::string_view unit) {
  if (!place.value.items() || place.value.items()->size() != 2) {
    place.fail_kind(wanted_pair(2, unit));
  }
  return {number_at(Place(place, 0), range, unit), number_at(Place(place, 1), range, unit)};
}

Vec3 triple_at(const Place& place, const Range& range, std::string_view unit) {
  if (!place.value.items() || place.value.items()->size() != 3) {
    place.fail_kind(wanted_pair(3, unit));
  }
  return {number_at(Place(place, 0), range, unit), number_at(Place(place, 1), range, unit),
          number_at(Place(place, 2), range, unit)};
}

std::vector<Vec2> pairs_at(const Place& place, std::size_t least, const Range& range,
                           std::string_view unit) {
  if (list_at(place).size() < least) {
    place.fail_kind("a list of at least " + std::to_string(least) + " points [x, y]");
  }
  std::vector<Vec2> pairs;
  pairs.reserve(place.value.items()->size());
  for (std::size_t i = 0; i < place.value.items()->size(); ++i) {
    pairs.push_back(pair_at(Place(place, i), range, unit));
  }
  return pairs;
}

std::vector<Vec3> triples_at(const Place& place, std::size_t least, const Range& range,
                             std::string_view unit) {
  if (list_at(place).size() < least) {
    place.fail_kind("a list of at least " + std::to_string(least) + " points [x, y, z]");
  }
  std::vector<Vec3> triples;
  triples.reserve(place.value.items()->size());
  for (std::size_t i = 0; i < place.value.items()->size(); ++i) {
    triples.push_back(triple_at(Place(place, i), range, unit));
  }
  return triples;
}

void check_keys(const Place& object, std::span<const std::string_view> valid) {
  for (const JsonMember& member : object_at(object)) {
    if (std::find(valid.begin(), valid.end(), member.key) == valid.end()) {
      Place(object, member)
          .fail("unknown key \"" + printable(member.key, 40) + '"' + hint_for(member.key, valid));
    }
  }
}

void require_key(const Place& object, std::string_view key, std::string_view example) {
  if (object.value.find(key)) return;
  object.fail("the key \"" + std::string(key) + "\" is missing" +
              (example.empty() ? "" : ", for example " + std::string(example)));
}

}  // namespace sunder
