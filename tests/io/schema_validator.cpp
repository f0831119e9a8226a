// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/schema_validator.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <stdexcept>

namespace sunder {

class SchemaValidator::Rules {
 public:
  using Json = nlohmann::json;
  explicit Rules(Json root) : root_(std::move(root)) {}
  bool accepts(const Json& value) const { return accepts(root_, value); }

 private:
  static bool is_type(const std::string& type, const Json& value) {
    if (type == "integer") {
      return value.is_number_integer() ||
             (value.is_number() && value.get<double>() == std::floor(value.get<double>()));
    }
    if (type == "number") return value.is_number();
    if (type == "string") return value.is_string();
    if (type == "array") return value.is_array();
    if (type == "object") return value.is_object();
    if (type == "boolean") return value.is_boolean();
    return type == "null" && value.is_null();
  }

  bool accepts(const Json& schema, const Json& value) const {
    if (schema.is_boolean()) return schema.get<bool>();
    return std::all_of(schema.items().begin(), schema.items().end(), [&](const auto& keyword) {
      return holds(keyword.key(), keyword.value(), schema, value);
    });
  }

  long matches(const Json& schemas, const Json& value) const {
    return std::count_if(schemas.begin(), schemas.end(),
                         [&](const Json& each) { return accepts(each, value); });
  }

  bool holds(const std::string& key, const Json& rule, const Json& schema,
             const Json& value) const {
    static const std::set<std::string> comments{"$schema", "title",       "description",
                                                "default", "definitions", "then"};
    static const std::set<std::string> known{"type",
                                             "$ref",
                                             "enum",
                                             "const",
                                             "oneOf",
                                             "anyOf",
                                             "allOf",
                                             "if",
                                             "not",
                                             "minimum",
                                             "maximum",
                                             "minItems",
                                             "maxItems",
                                             "uniqueItems",
                                             "items",
                                             "exclusiveMinimum",
                                             "pattern",
                                             "required",
                                             "properties",
                                             "additionalProperties",
                                             "patternProperties",
                                             "propertyNames"};
    if (comments.contains(key)) return true;
    if (!known.contains(key)) throw std::logic_error("unknown schema keyword " + key);
    if (key == "type") {
      const Json types = rule.is_array() ? rule : Json::array({rule});
      return std::any_of(types.begin(), types.end(),
                         [&](const Json& type) { return is_type(type, value); });
    }
    if (key == "$ref") {
      return accepts(root_.at(Json::json_pointer(rule.get<std::string>().substr(1))), value);
    }
    if (key == "enum") return std::find(rule.begin(), rule.end(), value) != rule.end();
    if (key == "const") return value == rule;
    if (key == "oneOf") return matches(rule, value) == 1;
    if (key == "anyOf") return matches(rule, value) >= 1;
    if (key == "allOf") return matches(rule, value) == static_cast<long>(rule.size());
    if (key == "not") return !accepts(rule, value);
    if (key == "if") return !accepts(rule, value) || accepts(schema.at("then"), value);
    if (value.is_number()) return holds_for_number(key, rule, value);
    if (value.is_string()) return holds_for_text(key, rule, value);
    if (value.is_array()) return holds_for_list(key, rule, value);
    if (value.is_object()) return holds_for_object(key, rule, schema, value);
    return true;
  }

  static bool holds_for_number(const std::string& key, const Json& rule, const Json& value) {
    if (key == "minimum") return value >= rule;
    if (key == "maximum") return value <= rule;
    return key != "exclusiveMinimum" || value > rule;
  }

  /// Kept: to compile one takes longer than all the rest.
  static const std::regex& compiled(const std::string& pattern) {
    static std::map<std::string, std::regex> all;
    return all.try_emplace(pattern, pattern).first->second;
  }

  static bool holds_for_text(const std::string& key, const Json& rule, const Json& value) {
    return key != "pattern" ||
           std::regex_search(value.get<std::string>(), compiled(rule.get<std::string>()));
  }

  bool holds_for_list(const std::string& key, const Json& rule, const Json& value) const {
    if (key == "minItems") return value.size() >= rule.get<std::size_t>();
    if (key == "maxItems") return value.size() <= rule.get<std::size_t>();
    if (key == "uniqueItems")
      return std::set<Json>(value.begin(), value.end()).size() == value.size();
    if (key == "items") return matches_each(rule, value);
    return true;
  }

  bool matches_each(const Json& rule, const Json& list) const {
    return std::all_of(list.begin(), list.end(),
                       [&](const Json& item) { return accepts(rule, item); });
  }

  bool holds_for_object(const std::string& key, const Json& rule, const Json& schema,
                        const Json& value) const {
    for (const auto& member : value.items()) {
      const bool is_known =
          schema.contains("properties") && schema["properties"].contains(member.key());
      if (key == "properties" && rule.contains(member.key()) &&
          !accepts(rule.at(member.key()), member.value())) {
        return false;
      }
      if (key == "additionalProperties" && !is_known && !accepts(rule, member.value())) {
        return false;
      }
      if (key == "propertyNames" && !accepts(rule, Json(member.key()))) return false;
      if (key == "patternProperties") {
        for (const auto& pattern : rule.items()) {
          const bool applies = std::regex_search(member.key(), compiled(pattern.key()));
          if (applies && !accepts(pattern.value(), member.value())) return false;
        }
      }
    }
    if (key != "required") return true;
    return std::all_of(rule.begin(), rule.end(),
                       [&](const Json& name) { return value.contains(name.get<std::string>()); });
  }

  Json root_;
};

SchemaValidator::SchemaValidator(const std::string& schema)
    : rules_(std::make_unique<const Rules>(nlohmann::json::parse(schema))) {}
SchemaValidator::~SchemaValidator() = default;

bool SchemaValidator::accepts(const std::string& text) const {
  return rules_->accepts(nlohmann::json::parse(text));
}

}  // namespace sunder
