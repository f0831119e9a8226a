// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/text_writer.hpp"
#include "meshing/vec.hpp"

namespace sunder {

/// Writes JSON as it comes, nested objects and lists: a line for each key of the outer object and
/// for each entry of a list there, everything below on that line. A number that is not finite is
/// null.
class JsonLines {
 public:
  explicit JsonLines(TextWriter& out) : out_(out) {}

  void open(char bracket);  ///< '{' or '['
  void open(std::string_view key, char bracket);
  void close();

  void number(double value);  ///< reads back as the same double
  void float32(float value);  ///< reads back as the same float32
  void count(std::uint64_t value);
  void text(std::string_view value);

  void number(std::string_view key, double value);
  void count(std::string_view key, std::uint64_t value);
  void text(std::string_view key, std::string_view value);
  void truth(std::string_view key, bool value);
  void null(std::string_view key);
  void point(std::string_view key, Vec3 value);  ///< [x, y, z]

 private:
  struct Level {
    char bracket = '{';
    std::size_t count = 0;  ///< entries so far
  };

  bool has_lines() const;
  void line(std::size_t depth);
  void begin();
  void name(std::string_view key);
  void word(std::string_view value);

  TextWriter& out_;
  std::vector<Level> levels_;
  bool named_ = false;
};

/// The document that `write` makes, and a line end.
std::string json_text(const std::function<void(JsonLines&)>& write);

}  // namespace sunder
