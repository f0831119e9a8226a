// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/page_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace sunder {
namespace {

constexpr std::string_view kNarrowSpace = "\u202f", kNone = "–", kMinus = "−";
constexpr int kDigits = 3;

std::string fixed(double value, int decimals) {
  char text[64];
  const std::to_chars_result end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals);
  std::string result(text, end.ptr);
  if (result.find('.') == std::string::npos) return result;
  result.erase(result.find_last_not_of('0') + 1);
  if (result.back() == '.') result.pop_back();
  return result;
}

/// Decimal exponent of a number once it is rounded to three digits.
int exponent_of(double size) {
  char text[64];
  const std::to_chars_result end =
      std::to_chars(text, text + sizeof text, size, std::chars_format::scientific, kDigits - 1);
  const std::string_view written(text, static_cast<std::size_t>(end.ptr - text));
  const std::string_view power = written.substr(written.find('e') + 1);
  int exponent = 0;
  std::from_chars(power.data() + (power[0] == '+'), power.data() + power.size(), exponent);
  return exponent;
}

std::string grouped(std::string digits) {
  const std::size_t whole = std::min(digits.find('.'), digits.size());
  if (whole < 5) return digits;
  for (std::size_t at = whole; at > 3; at -= 3) digits.insert(at - 3, kNarrowSpace);
  return digits;
}

/// Three digits of a size below a million.
std::string plain(double size) {
  const int exponent = exponent_of(size);
  const double unit = std::pow(10.0, std::max(exponent - kDigits + 1, 0));
  return grouped(fixed(std::round(size / unit) * unit, std::max(kDigits - 1 - exponent, 0)));
}
std::string rounded(double size) {
  return exponent_of(size) >= kDigits ? plain(size) : fixed(size, kDigits - 1 - exponent_of(size));
}

std::string superscript(int number) {
  constexpr std::string_view kDigit[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string result = number < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(number))) result += kDigit[c - '0'];
  return result;
}

std::string with_sign(double value, const std::string& size) {
  return (value < 0 ? std::string(kMinus) : "") + size;
}

}  // namespace

std::string joined(std::initializer_list<std::string_view> texts) {
  std::string result;
  for (const std::string_view text : texts) result += text;
  return result;
}

Html escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      case '\'': result += "&#39;"; break;
      default: result += c;
    }
  }
  return {result};
}

std::string count_text(std::uint64_t count) {
  return grouped(std::to_string(count));
}

std::string digits_text(double value) {
  if (!std::isfinite(value)) return std::string(kNone);
  if (value == 0) return "0";
  const double size = std::abs(value);
  const int exponent = exponent_of(size);
  if (exponent >= -4 && exponent < 6) return with_sign(value, rounded(size));
  return with_sign(value, fixed(size / std::pow(10.0, exponent), kDigits - 1)) + " × 10" +
         superscript(exponent);
}

Prefix prefix_for(double largest) {
  constexpr std::string_view kPrefixes[] = {"n", "µ", "m", "", "k", "M", "G", "T"};
  if (largest == 0 || !std::isfinite(largest)) return {};
  const int exponent = exponent_of(std::abs(largest));
  const int step = std::clamp(static_cast<int>(std::floor(exponent / 3.0)), -3, 4);
  return {3 * step, kPrefixes[step + 3]};
}

std::string quantity_text(double value, std::string_view unit) {
  if (!std::isfinite(value)) return std::string(kNone);
  const Prefix prefix = prefix_for(value);
  return digits_text(value / std::pow(10.0, prefix.power)) + "\u00a0" + std::string(prefix.text) +
         std::string(unit);
}

std::string share_text(double share) {
  if (!std::isfinite(share)) return std::string(kNone);
  if (share == 0 || std::abs(share) >= 1e-6) return digits_text(100 * share) + "\u00a0%";
  return digits_text(share);
}

std::string moment_text(double seconds) {
  return fixed(seconds, 4) + "\u00a0s";
}

std::string moment_cell(double seconds) {
  char text[64];
  const auto end =
      std::to_chars(text, text + sizeof text, seconds, std::chars_format::fixed, 4).ptr;
  return {text, end};
}

std::string time_text(double seconds) {
  if (!(seconds >= 60)) return quantity_text(seconds, "s");
  const auto whole = static_cast<std::uint64_t>(std::llround(seconds));
  return count_text(whole / 60) + "\u00a0min " + std::to_string(whole % 60) + "\u00a0s";
}

}  // namespace sunder
