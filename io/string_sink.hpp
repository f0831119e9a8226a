// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cassert>
#include <cstring>
#include <string>

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

}  // namespace sunder
