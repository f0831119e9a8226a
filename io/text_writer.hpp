// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string_view>

namespace sunder {

/// Where a format's writer puts its bytes: an OutputFile, or a stream of assimp's.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  virtual void write(std::span<const std::byte> bytes) = 0;
  /// Replaces the first bytes of what was written, as a length that is known late.
  virtual void rewrite_front(std::span<const std::byte> bytes) = 0;
};

/// Decimal text of a number with 9 significant digits, trailing zeros dropped: reading it back as
/// float32 gives the same float32. No locale, same bytes on every machine. Returns the end; needs
/// kNumberRoom bytes. The value is finite.
constexpr std::size_t kNumberRoom = 40;
char* put_number(char* out, double value);
/// The shortest text that reads back as the same float32.
char* put_shortest(char* out, float value);
/// The shortest text that reads back as the same double.
char* put_exact(char* out, double value);
char* put_integer(char* out, std::uint64_t value);

/// Appends text to a sink through one buffer; the only allocation is that buffer.
class TextWriter {
 public:
  explicit TextWriter(ByteSink& sink)
      : sink_(sink), buffer_(new char[kSize]), at_(buffer_.get()), end_(at_ + kSize) {}

  // Inlined, the copy of a literal is a few stores instead of a call.
  [[gnu::always_inline]] void text(std::string_view part) {
    if (part.size() > static_cast<std::size_t>(end_ - at_)) {
      flush();
      if (part.size() > kSize) return pass(part);
    }
    std::memcpy(at_, part.data(), part.size());
    at_ += part.size();
  }
  void number(double value) { at_ = put_number(room(), value); }
  void shortest(float value) { at_ = put_shortest(room(), value); }
  void exact(double value) { at_ = put_exact(room(), value); }
  void integer(std::uint64_t value) { at_ = put_integer(room(), value); }
  /// A JSON string with its quotes.
  void quoted(std::string_view content);
  void flush() {
    pass({buffer_.get(), static_cast<std::size_t>(at_ - buffer_.get())});
    at_ = buffer_.get();
  }
  /// Bytes of text so far.
  std::uint64_t size() const { return passed_ + static_cast<std::uint64_t>(at_ - buffer_.get()); }

 private:
  static constexpr std::size_t kSize = std::size_t{1} << 18;
  void pass(std::string_view part) {
    sink_.write(std::as_bytes(std::span(part)));
    passed_ += part.size();
  }
  char* room() {
    if (static_cast<std::size_t>(end_ - at_) < kNumberRoom) flush();
    return at_;
  }

  ByteSink& sink_;
  std::unique_ptr<char[]> buffer_;
  char* at_;
  char* end_;
  std::uint64_t passed_ = 0;
};

}  // namespace sunder
