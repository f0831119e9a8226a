// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/text_writer.hpp"

#include <array>
#include <bit>
#include <cassert>
#include <charconv>
#include <cmath>

namespace sunder {
namespace {

// Powers of ten that a double holds exactly.
constexpr double kPower[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                             1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

constexpr auto kPairs = [] {
  std::array<char, 200> pairs{};
  for (std::size_t i = 0; i < 100; ++i) {
    pairs[2 * i] = static_cast<char>('0' + i / 10);
    pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return pairs;
}();

void put_pair(char* out, std::uint32_t value) {
  std::memcpy(out, &kPairs[2 * value], 2);
}

// Nine digits of value < 10^9.
void put_nine(char* out, std::uint32_t value) {
  const std::uint32_t high = value / 10000, low = value % 10000;
  put_pair(out + 7, low % 100);
  put_pair(out + 5, low / 100);
  put_pair(out + 3, high % 100);
  put_pair(out + 1, high / 100 % 100);
  out[0] = static_cast<char>('0' + high / 10000);
}

// Places nine significant digits, the first one worth 10^exponent.
char* put_decimal(char* out, const char* digits, int exponent) {
  int count = 9;
  while (count > 1 && digits[count - 1] == '0') --count;
  if (exponent >= 9 || exponent < -4) {
    *out++ = digits[0];
    if (count > 1) *out++ = '.';
    std::memcpy(out, digits + 1, 8);
    out += count - 1;
    *out++ = 'e';
    if (exponent < 0) *out++ = '-';
    return put_integer(out, static_cast<std::uint64_t>(exponent < 0 ? -exponent : exponent));
  }
  if (exponent < 0) {
    std::memcpy(out, "0.00000", 8);
    std::memcpy(out + 1 - exponent, digits, 9);
    return out + 1 - exponent + count;
  }
  const int whole = exponent + 1;
  std::memcpy(out, digits, 9);
  if (count <= whole) return out + whole;
  out[whole] = '.';
  std::memcpy(out + whole + 1, digits + whole, static_cast<std::size_t>(count - whole));
  return out + count + 1;
}

}  // namespace

char* put_integer(char* out, std::uint64_t value) {
  char digits[20];
  int at = 20;
  while (value >= 100) {
    at -= 2;
    put_pair(digits + at, static_cast<std::uint32_t>(value % 100));
    value /= 100;
  }
  if (value >= 10) {
    at -= 2;
    put_pair(digits + at, static_cast<std::uint32_t>(value));
  } else {
    digits[--at] = static_cast<char>('0' + value);
  }
  std::memcpy(out, digits + at, static_cast<std::size_t>(20 - at));
  return out + (20 - at);
}

// One multiplication or division by an exact power of ten: the nine digits are the nearest but for
// ties within 1e-7 of a digit, far inside the sixfold margin that nine digits leave to float32.
char* put_number(char* out, double value) {
  assert(std::isfinite(value));
  if (value == 0) {
    *out = '0';
    return out + 1;
  }
  if (value < 0) *out++ = '-';
  const double size = std::abs(value);
  if (size < 1e-13 || size >= 1e22) {
    return std::to_chars(out, out + kNumberRoom - 1, size, std::chars_format::scientific, 8).ptr;
  }
  // floor(log10) from the binary exponent, then corrected by comparison.
  const int binary = static_cast<int>(std::bit_cast<std::uint64_t>(size) >> 52) - 1023;
  int exponent = (binary * 1233) >> 12;
  const auto scaled_to = [size](int e) {
    return e <= 8 ? size * kPower[8 - e] : size / kPower[e - 8];
  };
  double scaled = scaled_to(exponent);
  if (scaled >= 999999999.5) scaled = scaled_to(++exponent);
  if (scaled < 99999999.95) scaled = scaled_to(--exponent);
  std::uint32_t whole = static_cast<std::uint32_t>(scaled + 0.5);
  if (whole >= 1000000000) whole = 100000000, ++exponent;
  char digits[9];
  put_nine(digits, whole);
  return put_decimal(out, digits, exponent);
}

char* put_shortest(char* out, float value) {
  assert(std::isfinite(value));
  return std::to_chars(out, out + kNumberRoom, value).ptr;
}

char* put_exact(char* out, double value) {
  assert(std::isfinite(value));
  return std::to_chars(out, out + kNumberRoom, value).ptr;
}

void TextWriter::quoted(std::string_view content) {
  constexpr char kHex[] = "0123456789abcdef";
  text("\"");
  for (const char c : content) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      const char escaped[] = {'\\', c};
      text({escaped, 2});
    } else if (code < 0x20 || code == 0x7F) {
      const char escaped[] = {'\\', 'u', '0', '0', kHex[code >> 4], kHex[code & 15]};
      text({escaped, 6});
    } else {
      text({&c, 1});
    }
  }
  text("\"");
}

}  // namespace sunder
