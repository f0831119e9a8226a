// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "fracture/solid_model.hpp"
#include "fracture/wall.hpp"
#include "meshing/field.hpp"

namespace sunder {

/// A Field without its struct: what the schema and the documentation say about a key.
struct FieldRow {
  using Value = std::variant<double, std::int64_t, bool, std::string, std::vector<std::string>,
                             std::vector<Vec2>, Vec3, std::vector<Vec3>>;
  std::string_view name, unit, effect;
  Value default_value;
  Range range;
  std::span<const std::string_view> choices;
  bool required = false;

  /// False for a default that a file cannot give: it stands for "left out".
  bool has_default() const {
    const double* number = std::get_if<double>(&default_value);
    const std::string* text = std::get_if<std::string>(&default_value);
    return !required && !(number && !range.contains(*number)) && !(text && text->empty());
  }
};

/// Not inlined: GCC 12 then takes the members of other types for reads beyond a small struct.
template <class Params>
[[gnu::noinline]] FieldRow::Value value_of(const Params& params, const Field<Params>& field) {
  return std::visit([&](auto member) { return FieldRow::Value(params.*member); }, field.member);
}

/// The table of a struct, with the defaults it is made with.
template <class Params>
std::vector<FieldRow> field_rows() {
  const Params defaults{};
  std::vector<FieldRow> rows;
  for (const Field<Params>& field : fields<Params>()) {
    rows.push_back({field.name, field.unit, field.effect, value_of(defaults, field), field.range,
                    field.choices, field.required});
  }
  return rows;
}

/// The tables of every pattern type, in the order of kPatternTypes or kSolidPatternTypes.
template <class Patterns, std::size_t i = 0>
std::vector<std::vector<FieldRow>> pattern_rows() {
  if constexpr (i == std::variant_size_v<Patterns>) {
    return {};
  } else {
    auto rows = pattern_rows<Patterns, i + 1>();
    rows.insert(rows.begin(), field_rows<std::variant_alternative_t<i, Patterns>>());
    return rows;
  }
}

}  // namespace sunder
