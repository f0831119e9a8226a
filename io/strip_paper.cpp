// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/strip_paper.hpp"

#include <algorithm>
#include <cmath>

#include "io/text_writer.hpp"

namespace sunder {

StripColour mix_colours(const StripColour& a, const StripColour& b, double t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

StripPaper& StripPaper::integer(std::int64_t value) {
  char text[kNumberRoom];
  if (value < 0) out_ += '-';
  const char* end = put_integer(text, static_cast<std::uint64_t>(value < 0 ? -value : value));
  out_.append(static_cast<const char*>(text), end);
  return *this;
}

StripPaper& StripPaper::number(double value) {
  char text[kNumberRoom];
  const char* end = put_exact(text, std::floor(value * 1000 + 0.5) / 1000);
  out_.append(static_cast<const char*>(text), end);
  return *this;
}

StripPaper& StripPaper::colour(const StripColour& c) {
  constexpr char kHex[] = "0123456789abcdef";
  out_ += '#';
  for (const double channel : c) {
    const int value = static_cast<int>(std::clamp(channel, 0.0, 255.0) + 0.5);
    out_ += kHex[value >> 4];
    out_ += kHex[value & 15];
  }
  return *this;
}

void StripPaper::step(std::int64_t x, std::int64_t y) {
  integer(x);
  if (y >= 0) out_ += ' ';
  integer(y);
}

void StripPaper::line(std::span<const Vec2> points, bool is_closed) {
  // Far outside the picture only the direction matters.
  constexpr double kFar = 1e6;
  std::int64_t last_x = 0, last_y = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto x =
        static_cast<std::int64_t>(std::floor(std::clamp(points[i].x, -kFar, kFar) + 0.5));
    const auto y =
        static_cast<std::int64_t>(std::floor(std::clamp(points[i].y, -kFar, kFar) + 0.5));
    if (i == 0) {
      out_ += 'M';
      step(x, y);
    } else if (x != last_x || y != last_y) {
      out_ += 'l';
      step(x - last_x, y - last_y);
    }
    last_x = x, last_y = y;
  }
  if (is_closed) out_ += 'z';
}

}  // namespace sunder
