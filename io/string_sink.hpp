// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cassert>
#include <cstring>
#include <string>
#include <string_view>

#include "io/text_writer.hpp"

namespace sunder {

/// Appends to a text, which must outlive it.
class StringSink : public ByteSink {
 public:
  explicit StringSink(std::string& text) : text_(text) {}
  void write(std::span<const std::byte> bytes) override {
    text_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  void rewrite_front(std::span<const std::byte> bytes) override {
    assert(bytes.size() <= text_.size());
    std::memcpy(text_.data(), bytes.data(), bytes.size());
  }

 private:
  std::string& text_;
};

/// A text as JSON has it, with its quotation marks.
inline std::string json_quoted(std::string_view text) {
  std::string result;
  StringSink sink(result);
  TextWriter out(sink);
  out.quoted(text);
  out.flush();
  return result;
}

}  // namespace sunder
