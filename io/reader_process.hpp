// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "io/import.hpp"

namespace sunder {

constexpr std::size_t kLongestAnswerText = 4096;

/// Writes a child's answer into its pipe.
class AnswerWriter {
 public:
  explicit AnswerWriter(int descriptor) : descriptor_(descriptor) { buffer_.reserve(kSize); }
  ~AnswerWriter() { flush(); }
  template <class T>
  void value(T value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(&value, sizeof value);
  }
  void text(std::string_view text) {
    text = text.substr(0, kLongestAnswerText);
    value(static_cast<std::uint32_t>(text.size()));
    bytes(text.data(), text.size());
  }
  template <class T>
  void array(const std::vector<T>& values) {
    value(static_cast<std::uint64_t>(values.size()));
    bytes(values.data(), values.size() * sizeof(T));
  }

 private:
  static constexpr std::size_t kSize = std::size_t{1} << 18;
  void bytes(const void* data, std::size_t size) {
    if (size == 0) return;
    if (buffer_.size() + size > kSize) flush();
    if (size > kSize) return send(static_cast<const char*>(data), size);
    const auto* begin = static_cast<const char*>(data);
    buffer_.insert(buffer_.end(), begin, begin + size);
  }
  void flush() {
    send(buffer_.data(), buffer_.size());
    buffer_.clear();
  }
  void send(const char* data, std::size_t size);
  int descriptor_;
  std::vector<char> buffer_;
};

/// Reads what the child sent; every size is checked against what really came.
class AnswerReader {
 public:
  explicit AnswerReader(std::span<const char> bytes) : left_(bytes) {}
  template <class T>
  T value() {
    T result{};
    std::memcpy(&result, take(sizeof result).data(), sizeof result);
    return result;
  }
  std::string text() {
    const auto size = value<std::uint32_t>();
    if (size > kLongestAnswerText) fail();
    const auto part = take(size);
    std::string result(part.begin(), part.end());
    for (char& c : result) {
      if (static_cast<unsigned char>(c) < ' ' || c == 0x7F) c = '?';
    }
    return result;
  }
  template <class T>
  std::vector<T> array() {
    const auto count = value<std::uint64_t>();
    if (count > left_.size() / sizeof(T)) fail();
    std::vector<T> result(count);
    const auto part = take(count * sizeof(T));
    if (count > 0) std::memcpy(result.data(), part.data(), part.size());
    return result;
  }
  /// Number of items that follow, each at least `least` bytes long.
  std::uint64_t count(std::size_t least) {
    const auto result = value<std::uint64_t>();
    if (result > left_.size() / least) fail();
    return result;
  }
  bool at_end() const { return left_.empty(); }
  [[noreturn]] static void fail();

 private:
  std::span<const char> take(std::size_t size) {
    if (size > left_.size()) fail();
    const auto part = left_.first(size);
    left_ = left_.subspan(size);
    return part;
  }
  std::span<const char> left_;
};

/// What a child does: reads a file, and gives back what then sends the result.
using ChildWork = std::function<std::function<void(AnswerWriter&)>()>;

/// Runs `read` in a child process that may use no more than the limits, and hands its answer to
/// `receive`; whatever the child does to itself, this process only sees an Error{input} that starts
/// with `name`. Threads of this process do not exist in the child: call it when none holds a lock.
void run_reader(const std::string& name, const ImportLimits& limits, const ChildWork& read,
                const std::function<void(AnswerReader&)>& receive);

}  // namespace sunder
