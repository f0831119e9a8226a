// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <initializer_list>
#include <string_view>

#include "io/text_writer.hpp"

namespace sunder {

/// A TextWriter with what the parts of a glTF document have in common.
class GltfText : public TextWriter {
 public:
  using TextWriter::TextWriter;
  /// Commas between the items of an array.
  void separate(bool& first) {
    if (!first) text(",");
    first = false;
  }
  void key(std::string_view name, double value) {
    text(name);
    exact(value);
  }
  void key_integer(std::string_view name, std::uint64_t value) {
    text(name);
    integer(value);
  }
  void numbers(std::initializer_list<double> values) {
    bool first = true;
    text("[");
    for (const double value : values) {
      separate(first);
      number(value);
    }
    text("]");
  }
};

}  // namespace sunder
