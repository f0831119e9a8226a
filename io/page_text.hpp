// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace sunder {

/// Markup that may stand in a page as it is.
struct Html {
  std::string text;
};
/// Texts one after the other.
std::string joined(std::initializer_list<std::string_view> texts);
/// Text as markup, in elements and in attributes.
Html escaped(std::string_view text);

// Numbers for readers: three significant digits, no locale. What is not finite is "–".

/// 738, 1 234 567 (narrow spaces that do not break).
std::string count_text(std::uint64_t count);
/// 0.276, 24.7, 1 230, 2.8 × 10⁻¹⁵.
std::string digits_text(double value);
/// With a prefix of the unit: 12.3 MJ, 1.96 mm. For units that take one (J, N, m, W), not kg or m².
std::string quantity_text(double value, std::string_view unit);
/// A relative error: 0.31 %, below a millionth 2.8 × 10⁻¹⁵.
std::string share_text(double share);
/// A time of a run: 0.25 s.
std::string moment_text(double seconds);
/// With four decimals: 0.2500, for columns.
std::string moment_cell(double seconds);
/// How long something takes: 3.21 ms, 4.2 s, 3 min 12 s.
std::string time_text(double seconds);

/// The power of ten that a prefix stands for, so that `largest` has one to three digits before its
/// point; 0 for 0.
struct Prefix {
  int power = 0;          ///< a multiple of 3, -9 … 12
  std::string_view text;  ///< "k"
};
Prefix prefix_for(double largest);

}  // namespace sunder
