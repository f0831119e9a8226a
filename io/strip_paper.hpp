// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "meshing/vec.hpp"

namespace sunder {

/// sRGB, 0 … 255.
using StripColour = std::array<double, 3>;
StripColour mix_colours(const StripColour& a, const StripColour& b, double t);

/// Text of a strip. Coordinates are whole picture units, written relative to the point before.
class StripPaper {
 public:
  StripPaper& text(std::string_view part) {
    out_ += part;
    return *this;
  }
  StripPaper& integer(std::int64_t value);
  /// A value of at most three decimals.
  StripPaper& number(double value);
  StripPaper& colour(const StripColour& c);
  /// A subpath in a `d` attribute.
  void line(std::span<const Vec2> points, bool is_closed);
  std::string take() { return std::move(out_); }

 private:
  void step(std::int64_t x, std::int64_t y);
  std::string out_;
};

}  // namespace sunder
