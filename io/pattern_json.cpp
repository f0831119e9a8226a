// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "io/patterns.hpp"
#include "io/printable.hpp"

namespace sunder {
namespace {

/// Fails for the pair of keys when low > high; either may be left at its default.
void check_order(const Place& object, std::string_view low_key, double low,
                 std::string_view high_key, double high) {
  if (low <= high) return;
  const JsonValue* given = object.value.find(high_key);
  const std::string_view key = given ? high_key : low_key;
  const Place place(object, key, given ? *given : *object.value.find(low_key));
  place.fail(std::string(low_key) + " = " + number_text(low) + " must not be above " +
             std::string(high_key) + " = " + number_text(high));
}

template <class Params>
void check_together(const Params&, const Place&) {}

void check_together(const SpiderwebParams& params, const Place& place) {
  check_order(place, "min_points", static_cast<double>(params.min_points), "max_points",
              static_cast<double>(params.max_points));
  check_order(place, "min_radius", params.min_radius, "max_radius", params.max_radius);
}

template <class Params>
PatternParams read_pattern_params(const Place& place) {
  check_keys(place, keys_of<Params>({"type"}));
  Params params;
  read_fields(params, place);
  check_together(params, place);
  return params;
}

/// The reader of pattern type i, for every i: the variant and kPatternTypes have one order.
template <std::size_t... i>
PatternParams read_pattern_of(std::size_t type, const Place& place, std::index_sequence<i...>) {
  using Reader = PatternParams (*)(const Place&);
  constexpr Reader kReaders[] = {
      &read_pattern_params<std::variant_alternative_t<i, PatternParams>>...};
  return kReaders[type](place);
}

}  // namespace

PatternParams read_pattern(const Place& place) {
  constexpr std::size_t kTypes = std::variant_size_v<PatternParams>;
  static_assert(std::size(kPatternTypes) == kTypes);
  object_at(place);
  require_key(place, "type", "\"type\": \"voronoi-grid\"");
  const std::string type = text_at(Place(place, "type", *place.value.find("type")), kPatternTypes);
  const auto found = std::find(std::begin(kPatternTypes), std::end(kPatternTypes), type);
  return read_pattern_of(static_cast<std::size_t>(found - std::begin(kPatternTypes)), place,
                         std::make_index_sequence<kTypes>());
}

}  // namespace sunder
