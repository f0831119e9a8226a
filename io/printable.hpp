// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace sunder {

/// Text fit for one line of a terminal: control characters, writing-direction marks and bytes that
/// are not UTF-8 are written as escapes, what lies beyond `limit` characters becomes "…".
std::string printable(std::string_view text, std::size_t limit = 60);

/// Shortest text that reads back as the same number; whole numbers below 1e7 without exponent.
std::string number_text(double value);

}  // namespace sunder
