// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/printable.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace sunder {
namespace {

/// A code point and the bytes it takes; 0 bytes: not UTF-8 (overlong, surrogate, cut off …).
struct Decoded {
  std::uint32_t code = 0;
  std::size_t size = 0;
};

Decoded decode(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
  };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t size = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < size) return {};
  std::uint32_t code = lead & (0x7Fu >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3F);
  }
  constexpr std::array<std::uint32_t, 5> kSmallest{0, 0, 0x80, 0x800, 0x10000};
  if (code < kSmallest[size] || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return {};
  return {code, size};
}

/// Would change what the reader of a terminal sees around it.
bool is_treacherous(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x200B && code <= 0x200F) ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) || code == 0xFEFF;
}

std::string hex(std::uint32_t value, std::size_t digits) {
  std::string text(digits, '0');
  for (std::size_t i = digits; i-- > 0; value >>= 4) text[i] = "0123456789abcdef"[value & 15];
  return text;
}

}  // namespace

std::string printable(std::string_view text, std::size_t limit) {
  std::string shown;
  for (std::size_t count = 0; !text.empty(); ++count) {
    if (count == limit) return shown + "…";
    const Decoded next = decode(text);
    if (next.size == 0) {
      shown += "\\x" + hex(static_cast<unsigned char>(text[0]), 2);
    } else if (next.code == '\n' || next.code == '\t' || next.code == '\r') {
      shown += next.code == '\n' ? "\\n" : next.code == '\t' ? "\\t" : "\\r";
    } else if (is_treacherous(next.code)) {
      shown += "\\u" + hex(next.code, 4);
    } else {
      shown += text.substr(0, next.size);
    }
    text.remove_prefix(next.size ? next.size : 1);
  }
  return shown;
}

std::string number_text(double value) {
  std::array<char, 32> buffer;
  char* const begin = buffer.data();
  char* const last = begin + buffer.size();
  if (std::abs(value) < 1e7 && value == std::floor(value)) {
    return std::string(begin, std::to_chars(begin, last, static_cast<std::int64_t>(value)).ptr);
  }
  std::string text(begin, std::to_chars(begin, last, value).ptr);
  const std::size_t exponent = text.find('e');
  if (exponent != std::string::npos) {  // 1e+09 → 1e9, 1e-09 → 1e-9
    const std::size_t sign_end = exponent + (text[exponent + 1] == '-' ? 2 : 1);
    text.erase(sign_end, text.find_first_not_of("+0", sign_end) - sign_end);
  }
  return text;
}

}  // namespace sunder
