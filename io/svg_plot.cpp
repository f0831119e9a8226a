// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/svg_plot.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <limits>

namespace sunder {
namespace {

constexpr double kWidth = 520;  // units of the picture
constexpr double kLeft = 54, kRight = 14, kTop = 22, kBottom = 24;
constexpr double kEnd = kWidth - kRight;
constexpr double kMostDecades = 5;

/// A number of the picture, a tenth of a unit exactly enough.
std::string place(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, std::round(10 * value) / 10).ptr;
  return {text, end};
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value), high = std::max(high, value);
  }
};

/// Where values lie in the picture.
class Axes {
 public:
  explicit Axes(const Plot& plot) : foot(plot.height - kBottom), log_(plot.is_log) {
    times_ = {plot.times.front(), plot.times.back()};
    if (times_.high <= times_.low) times_.high = times_.low + 1;
    x_ticks = nice_ticks(times_.low, times_.high);
    std::erase_if(x_ticks, [&](double t) { return t < times_.low || t > times_.high; });
    log_ ? take_decades(plot) : take_values(plot);
  }
  double x(double time) const {
    return kLeft + (time - times_.low) / (times_.high - times_.low) * (kEnd - kLeft);
  }
  double y(double value) const {
    if (log_) value = std::log10(std::max(value, std::pow(10.0, values_.low)));
    return foot - (value - values_.low) / (values_.high - values_.low) * (foot - kTop);
  }
  /// Where areas begin.
  double base() const { return log_ ? foot : y(std::clamp(0.0, values_.low, values_.high)); }

  double foot;  ///< where the axis of times lies
  std::vector<double> x_ticks, y_ticks;
  Prefix prefix;

 private:
  void take_values(const Plot& plot) {
    Range range;
    range.add(0);
    for (const PlotLine& line : plot.lines)
      for (const double value : line.values) range.add(value);
    if (plot.mark) range.add(*plot.mark);
    if (range.high <= range.low) range.high = range.low + 1;
    y_ticks = nice_ticks(range.low, range.high, plot.is_count);
    values_ = {y_ticks.front(), y_ticks.back()};
    if (!plot.unit.empty()) prefix = prefix_for(std::max(-values_.low, values_.high));
  }
  void take_decades(const Plot& plot) {
    Range range;
    const auto add = [&](double value) {
      if (value > 0) range.add(value);
    };
    for (const PlotLine& line : plot.lines) std::ranges::for_each(line.values, add);
    if (plot.mark) add(0.5 * *plot.mark);
    if (range.high < range.low) range = {0.1, 1};
    y_ticks =
        decade_ticks(std::max(range.low, range.high / std::pow(10.0, kMostDecades)), range.high);
    values_ = {std::log10(y_ticks.front()), std::log10(y_ticks.back())};
  }
  bool log_;
  Range times_, values_;
};

std::string text_at(double x, double y, std::string_view anchor, std::string_view text) {
  return joined({R"(<text x=")", place(x), R"(" y=")", place(y), R"(" text-anchor=")", anchor,
                 "\">", escaped(text).text, "</text>"});
}

std::string straight(std::string_view style, double x0, double y0, double x1, double y1) {
  return joined({R"(<line class=")", style, R"(" x1=")", place(x0), R"(" y1=")", place(y0),
                 R"(" x2=")", place(x1), R"(" y2=")", place(y1), R"("/>)"});
}

std::string draw_axes(const Plot& plot, const Axes& axes) {
  std::string out;
  const double scale = std::pow(10.0, -axes.prefix.power);
  for (const double tick : axes.y_ticks) {
    const double y = axes.y(tick);
    out += straight(tick == 0 && !plot.is_log ? "axis" : "grid", kLeft, y, kEnd, y);
    out += text_at(kLeft - 7, y + 4, "end", digits_text(scale * tick));
  }
  for (const double tick : axes.x_ticks) {
    out += straight("axis", axes.x(tick), axes.foot, axes.x(tick), axes.foot + 4);
    const std::string_view unit = tick == axes.x_ticks.back() ? "\u00a0s" : "";
    out += text_at(axes.x(tick), axes.foot + 18, "middle", joined({digits_text(tick), unit}));
  }
  out += straight("axis", kLeft, axes.foot, kEnd, axes.foot);
  if (!plot.unit.empty())
    out += text_at(kLeft - 7, 11, "end", std::string(axes.prefix.text) + plot.unit);
  return out;
}

struct Spot {
  double x = 0, y = 0;
};

/// First, lowest, highest and last of those that share a third of a unit.
std::vector<Spot> thinned(const std::vector<Spot>& spots) {
  if (spots.size() < 3 * static_cast<std::size_t>(kWidth)) return spots;
  std::vector<Spot> kept;
  for (std::size_t begin = 0, end = 0; begin < spots.size(); begin = end) {
    while (end < spots.size() && std::floor(3 * spots[end].x) == std::floor(3 * spots[begin].x))
      ++end;
    std::size_t low = begin, high = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (spots[i].y < spots[low].y) low = i;
      if (spots[i].y > spots[high].y) high = i;
    }
    std::array<std::size_t, 4> which = {begin, std::min(low, high), std::max(low, high), end - 1};
    const auto last = std::ranges::unique(which).begin();
    for (auto at = which.begin(); at != last; ++at) kept.push_back(spots[*at]);
  }
  return kept;
}

/// The points of a line without those that are not finite.
std::vector<Spot> spots_of(const Plot& plot, const PlotLine& line, const Axes& axes) {
  assert(line.values.size() == plot.times.size());
  std::vector<Spot> spots;
  for (std::size_t i = 0; i < line.values.size(); ++i) {
    if (!std::isfinite(line.values[i])) continue;
    const Spot spot{axes.x(plot.times[i]), axes.y(line.values[i])};
    if (plot.is_count && !spots.empty() && spots.back().y != spot.y)
      spots.push_back({spot.x, spots.back().y});
    spots.push_back(spot);
  }
  return thinned(spots);
}

std::string draw_line(const Plot& plot, const PlotLine& line, const Axes& axes) {
  const std::vector<Spot> spots = spots_of(plot, line, axes);
  if (spots.empty()) return "";
  std::string points;
  for (const Spot& spot : spots) points += joined({place(spot.x), ",", place(spot.y), " "});
  points.pop_back();
  const std::string colour = std::to_string(line.colour), base = place(axes.base());
  std::string out;
  if (plot.lines.size() == 1)
    out = joined({R"(<polygon class="area c)", colour, R"(" points=")", place(spots.front().x), ",",
                  base, " ", points, " ", place(spots.back().x), ",", base, R"("/>)"});
  return out + joined({R"(<polyline class="line c)", colour, R"(" points=")", points, R"("/>)"});
}

}  // namespace

std::vector<double> nice_ticks(double low, double high, bool whole) {
  assert(low < high);
  const double rough = (high - low) / 5;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0})
    if (factor * power >= 0.999 * rough) step = factor * power;
  if (whole) step = std::max(step, 1.0);
  std::vector<double> ticks;
  const auto first = static_cast<long>(std::floor(low / step + 1e-9));
  const auto last = static_cast<long>(std::ceil(high / step - 1e-9));
  for (long i = first; i <= last; ++i) ticks.push_back(static_cast<double>(i) * step);
  return ticks;
}

std::vector<double> decade_ticks(double low, double high) {
  assert(0 < low && low <= high);
  const auto first = static_cast<int>(std::floor(std::log10(low) + 1e-9));
  const auto last = std::max(static_cast<int>(std::ceil(std::log10(high) - 1e-9)), first + 1);
  std::vector<double> ticks;
  for (int i = first; i <= last; ++i) ticks.push_back(std::pow(10.0, i));
  return ticks;
}

Html svg_plot(const Plot& plot) {
  assert(!plot.times.empty());
  const Axes axes(plot);
  std::string out =
      joined({R"(<svg class="plot" viewBox="0 0 )", place(kWidth), " ", place(plot.height),
              R"(" role="img" aria-label=")", escaped(plot.title).text, "\">"});
  out += draw_axes(plot, axes);
  if (plot.mark) out += straight("mark", kLeft, axes.y(*plot.mark), kEnd, axes.y(*plot.mark));
  for (const PlotLine& line : plot.lines) out += draw_line(plot, line, axes);
  return {out + "</svg>"};
}

Html plot_legend(const Plot& plot) {
  if (plot.lines.size() < 2) return {};
  std::string out = R"(<ul class="legend">)";
  for (const PlotLine& line : plot.lines)
    out += joined({R"(<li><i class="c)", std::to_string(line.colour), R"("></i>)",
                   escaped(line.name).text, "</li>"});
  return {out + "</ul>"};
}

}  // namespace sunder
