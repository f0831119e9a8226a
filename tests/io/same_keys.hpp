// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sunder {

/// Every object that is written has exactly the keys its schema describes, all the way down.
inline void expect_same_keys(const nlohmann::ordered_json& schema,
                             const nlohmann::ordered_json& value, const std::string& where) {
  if (value.is_array()) {
    for (const auto& each : value) expect_same_keys(schema["items"], each, where + "[]");
  }
  if (!value.is_object() || where == "/time") return;
  ASSERT_TRUE(schema.contains("properties")) << where;
  std::vector<std::string> written, described;
  for (const auto& [key, each] : value.items()) {
    written.push_back(key);
    if (schema["properties"].contains(key)) {
      expect_same_keys(schema["properties"][key], each, where + '/' + key);
    }
  }
  for (const auto& [key, each] : schema["properties"].items()) {
    described.push_back(key);
    EXPECT_FALSE(each.value("description", "").empty()) << where << '/' << key;
  }
  EXPECT_EQ(written, described) << where;
  EXPECT_EQ(schema["required"].get<std::vector<std::string>>(), described) << where;
}

}  // namespace sunder
