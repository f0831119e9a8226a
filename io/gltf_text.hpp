// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>

#include "io/text_writer.hpp"
#include "sim/pose.hpp"

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
  /// A node's `,"translation":…,"rotation":…`, where they are not trivial.
  void place(const Pose& pose) {
    const auto& [at, turn] = pose;
    if (at != Vec3{}) {
      text(R"(,"translation":)");
      numbers({at.x, at.y, at.z});
    }
    if (turn != Quaternion{}) {
      text(R"(,"rotation":)");
      numbers({turn.x, turn.y, turn.z, turn.w});
    }
  }
  /// `"min":[…],"max":[…]` of positions, three numbers each.
  void bounds(std::span<const float> positions);
  /// An item of "accessors" up to its count; `rest` closes it, or leaves that to the caller.
  void accessor(std::uint32_t view, std::uint64_t offset, std::uint64_t count,
                std::string_view rest, bool& first) {
    separate(first);
    key_integer(R"({"bufferView":)", view);
    key_integer(R"(,"byteOffset":)", offset);
    key_integer(R"(,"count":)", count);
    text(rest);
  }
};

}  // namespace sunder
