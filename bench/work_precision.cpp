// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/work_precision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "bench/report.hpp"

namespace sunder {
namespace {

// The picture, px. Beside the axes there is a strip for errors of none, and one for failures.
constexpr double kWidth = 900, kHeight = 520, kLeft = 78, kRight = 652, kTop = 52, kBottom = 452;
constexpr double kStrip = 50, kKey = kRight + 22, kLetter = 6.3;

// Colours that most kinds of colour blindness tell apart (Okabe and Ito), and a shape each.
constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b08000",
                              "#3a9ad0", "#000000", "#808080", "#7b3294", "#a6611a"};
constexpr std::array kShapes{"M-5 0a5 5 0 1 0 10 0a5 5 0 1 0 -10 0z", "M-4.5 -4.5h9v9h-9z",
                             "M0 -6l5.5 9.5h-11z", "M0 -6l6 6l-6 6l-6 -6z", "M0 6l5.5 -9.5h-11z"};

struct Axis {
  double low = 0, high = 1;  // powers of ten
  double from = 0, to = 1;   // px
  double at(double value) const {
    const double power = std::clamp(std::log10(value), low, high);
    return from + (to - from) * (power - low) / (high - low);
  }
};

struct Box {
  double x = 0, y = 0, width = 0, height = 0;
  bool meets(const Box& o) const {
    return x < o.x + o.width && o.x < x + width && y < o.y + o.height && o.y < y + height;
  }
};

/// Everything that is known before anything is drawn.
struct Layout {
  Axis x, y;
  bool has_none = false, has_failed = false;
  std::vector<std::string> methods;
};

bool has_place(const WorkPlot& plot, const WorkPoint& point) {
  return !point.failed && std::isfinite(point.error) && point.error >= plot.least_error;
}

/// The next of 1, 2, 5, 10, 20 … that is not above (or below) the value, as a power of ten.
double nice_power(double value, bool above) {
  const double power = std::floor(std::log10(value));
  double nice = std::pow(10, power);
  for (const double step : {2.0, 5.0, 10.0}) {
    const double next = step * std::pow(10, power);
    if (above ? nice >= value : next > value) break;
    nice = next;
  }
  return std::log10(nice);
}

/// From and to nice numbers round the values, a power of ten at least.
void span_powers(Axis& axis, double least, double most) {
  axis.low = nice_power(0.93 * least, false);
  axis.high = std::max(axis.low + 1, nice_power(1.07 * most, true));
}

Layout layout_of(const WorkPlot& plot) {
  Layout layout;
  double least = 1e300, most = 0, fast = 1e300, slow = 0;
  const auto widen = [&](double error) {
    least = std::min(least, error), most = std::max(most, error);
  };
  for (const WorkPoint& p : plot.points) {
    fast = std::min(fast, p.time.least), slow = std::max(slow, p.time.most);
    if (std::ranges::find(layout.methods, p.method) == layout.methods.end())
      layout.methods.push_back(p.method);
    layout.has_failed |= p.failed || !std::isfinite(p.error);
    layout.has_none |= !p.failed && p.error < plot.least_error;
    if (has_place(plot, p)) widen(p.error);
  }
  for (const WorkPlot::Mark& mark : plot.marks) widen(mark.error);
  if (most == 0) least = most = plot.least_error;
  span_powers(layout.x, least, most);
  span_powers(layout.y, fast, slow);
  layout.x.from = kLeft + (layout.has_none ? kStrip : 0);
  layout.x.to = kRight - (layout.has_failed ? kStrip : 0);
  layout.y.from = kBottom, layout.y.to = kTop;
  return layout;
}

double x_of(const WorkPlot& plot, const Layout& layout, const WorkPoint& p) {
  if (p.failed || !std::isfinite(p.error)) return kRight - kStrip / 2;
  return p.error < plot.least_error ? kLeft + kStrip / 2 : layout.x.at(p.error);
}

std::string escaped(const std::string& given) {
  std::string out;
  for (const char c : given) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

std::string words(double x, double y, const std::string& what, const char* anchor,
                  const char* more = "") {
  return text("<text x='%.1f' y='%.1f' text-anchor='%s'%s>%s</text>\n", x, y, anchor, more,
              escaped(what).c_str());
}

std::string line(double x1, double y1, double x2, double y2, const char* style) {
  return text("<path d='M%.1f %.1fL%.1f %.1f' %s/>\n", x1, y1, x2, y2, style);
}

/// 0.01, 1, 1000, else 10 to a power.
std::string power_text(int power) {
  if (power >= -2 && power <= 3) return text("%g", std::pow(10, power));
  constexpr std::array kDigits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string digits;
  for (const char c : std::to_string(power))
    digits += c == '-' ? "⁻" : kDigits[static_cast<std::size_t>(c - '0')];
  return "10" + digits;
}

std::string grid(const Axis& axis, bool upright) {
  std::string svg;
  const double powers = axis.high - axis.low, first = std::ceil(axis.low - 1e-9);
  const int every = static_cast<int>(powers + 8) / 9;
  constexpr double kSlack = 1e-9;
  for (int power = static_cast<int>(std::floor(axis.low)); power <= axis.high + kSlack; ++power)
    for (int digit = 1; digit <= (powers < 7 ? 9 : 1); ++digit) {
      const double value = digit * std::pow(10, power), at = axis.at(value);
      if (std::log10(value) < axis.low - kSlack || std::log10(value) > axis.high + kSlack) continue;
      const char* style = digit == 1 ? "stroke='#d0d0d0'" : "stroke='#efefef'";
      svg += upright ? line(at, kTop, at, kBottom, style) : line(kLeft, at, kRight, at, style);
      const bool is_named = digit == 1 ? (power - static_cast<int>(first)) % every == 0
                                       : powers <= 2.5 && (digit == 2 || digit == 5);
      if (!is_named) continue;
      const std::string name = digit == 1 ? power_text(power) : text("%g", value);
      svg +=
          upright ? words(at, kBottom + 18, name, "middle") : words(kLeft - 8, at + 4, name, "end");
    }
  return svg;
}

std::string axes(const WorkPlot& plot, const Layout& layout) {
  constexpr const char* kEdge = "stroke='#888' stroke-dasharray='4 3'";
  constexpr const char* kSmall = " font-size='11' fill='#555'";
  std::string svg = grid(layout.x, true) + grid(layout.y, false);
  if (layout.has_none)
    svg += line(layout.x.from, kTop, layout.x.from, kBottom, kEdge) +
           words(kLeft + kStrip / 2, kTop - 7, plot.none, "middle", kSmall);
  if (layout.has_failed)
    svg += line(layout.x.to, kTop, layout.x.to, kBottom, kEdge) +
           words(kRight - kStrip / 2, kTop - 7, "failed", "middle", kSmall);
  svg += text("<rect x='%.0f' y='%.0f' width='%.0f' height='%.0f' fill='none' stroke='#888'/>\n",
              kLeft, kTop, kRight - kLeft, kBottom - kTop);
  svg += words((kLeft + kRight) / 2, kBottom + 44, plot.error_axis, "middle");
  svg += text("<text transform='translate(20 %.0f) rotate(-90)' text-anchor='middle'>%s</text>\n",
              (kTop + kBottom) / 2, escaped(plot.time_axis).c_str());
  svg += words(kLeft, kTop - 26, plot.title, "start", " font-size='14' font-weight='bold'");
  for (const WorkPlot::Mark& mark : plot.marks) {
    const double x = layout.x.at(mark.error);
    svg += line(x, kTop, x, kBottom, "stroke='#555' stroke-dasharray='7 4'");
    svg += words(x, kTop - 7, mark.text, "middle", kSmall);
  }
  return svg;
}

/// Beside a point where nothing is yet, if there is such a place; else none.
std::string label_of(const WorkPoint& p, double x, double y, const char* colour,
                     std::vector<Box>& taken) {
  const double width = kLetter * static_cast<double>(p.label.size()), height = 12;
  const Box places[] = {
      {x + 8, y - 14, width, height},         {x + 8, y + 3, width, height},
      {x - 8 - width, y - 14, width, height}, {x - 8 - width, y + 3, width, height},
      {x - width / 2, y - 21, width, height}, {x - width / 2, y + 9, width, height}};
  for (const Box& place : places) {
    const bool is_inside =
        place.x > kLeft && place.x + width < kRight && place.y > kTop && place.y + height < kBottom;
    if (!is_inside || std::ranges::any_of(taken, [&](const Box& b) { return b.meets(place); }))
      continue;
    taken.push_back(place);
    return words(place.x, place.y + 10, p.label, "start",
                 text(" font-size='11' fill='%s'", colour).c_str());
  }
  return "";
}

struct Style {
  const char *colour, *shape;
};
Style style_of(std::size_t method) {
  return {kColours[method % kColours.size()], kShapes[method % kShapes.size()]};
}

std::string mark_at(double x, double y, const Style& style, bool hollow) {
  return text(
      "<path transform='translate(%.1f %.1f)' d='%s' fill='%s' stroke='%s' "
      "stroke-width='1.6'/>\n",
      x, y, style.shape, hollow ? "#fff" : style.colour, style.colour);
}

std::string series(const WorkPlot& plot, const Layout& layout, std::size_t method,
                   std::vector<Box>& taken) {
  const Style style = style_of(method);
  std::string path, marks;
  for (const WorkPoint& p : plot.points) {
    if (p.method != layout.methods[method]) continue;
    const double x = x_of(plot, layout, p), y = layout.y.at(p.time.median);
    if (has_place(plot, p)) path += text("%c%.1f %.1f", path.empty() ? 'M' : 'L', x, y);
    const double low = layout.y.at(p.time.least), high = layout.y.at(p.time.most);
    if (low - high > 3) marks += line(x, low, x, high, text("stroke='%s'", style.colour).c_str());
    marks += mark_at(x, y, style, p.quoted);
    if (!p.label.empty()) marks += label_of(p, x, y, style.colour, taken);
  }
  return text("<path d='%s' fill='none' stroke='%s' stroke-width='1.6'/>\n",
              path.empty() ? "M0 0" : path.c_str(), style.colour) +
         marks;
}

std::string key_of(const WorkPlot& plot, const Layout& layout) {
  std::string svg;
  double y = kTop + 10;
  for (std::size_t i = 0; i < layout.methods.size(); ++i, y += 22)
    svg +=
        mark_at(kKey, y - 4, style_of(i), false) + words(kKey + 14, y, layout.methods[i], "start");
  y += 8;
  std::vector<std::string> notes{"bars: spread of the time"};
  if (std::ranges::any_of(plot.points, &WorkPoint::quoted)) notes.push_back("hollow: quoted");
  for (const std::string& note : notes) {
    svg += words(kKey - 6, y, note, "start", " font-size='11' fill='#555'");
    y += 17;
  }
  return svg;
}

std::string quoted(const std::string& field) {
  return "\"" + field + "\"";
}

std::string file_name(const WorkPlot& plot) {
  std::string name = plot.block;
  for (char& c : name)
    if (c == ' ' || c == '_') c = '-';
  return name;
}

}  // namespace

Spread spread_of(std::vector<double> ms) {
  std::ranges::sort(ms);
  return {ms[ms.size() / 2], ms.front(), ms.back()};
}

std::string svg_of(const WorkPlot& plot) {
  const Layout layout = layout_of(plot);
  std::string svg = text(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %.0f %.0f' font-family='DejaVu Sans, "
      "sans-serif' font-size='12' fill='#222'>\n<rect width='100%%' height='100%%' fill='#fff'/>\n",
      kWidth, kHeight);
  svg += axes(plot, layout);
  std::vector<Box> taken;
  for (const WorkPoint& p : plot.points)
    taken.push_back({x_of(plot, layout, p) - 6, layout.y.at(p.time.median) - 6, 12, 12});
  for (std::size_t i = 0; i < layout.methods.size(); ++i) svg += series(plot, layout, i, taken);
  return svg + key_of(plot, layout) + "</svg>\n";
}

std::string csv_of(const WorkPlot& plot) {
  std::string csv = "case,method,knobs,error,median,least,most,note,commit,machine,date\n";
  for (const WorkPoint& p : plot.points)
    csv += text("%s,%s,%s,%.6g,%.6g,%.6g,%.6g,%s,%s,%s,%s\n", quoted(plot.title).c_str(),
                quoted(p.method).c_str(), quoted(p.knobs).c_str(), p.error, p.time.median,
                p.time.least, p.time.most,
                p.failed   ? "failed"
                : p.quoted ? "quoted"
                           : "",
                commit().c_str(), quoted(processor()).c_str(), today().c_str());
  return csv;
}

void publish(const WorkPlot& plot) {
  const std::string name = file_name(plot);
  {
    const Block block(plot.block);
    std::printf(
        "<img src=\"pictures/%s.svg\" width=\"820\" alt=\"%s: %s against %s, by method\">\n\n",
        name.c_str(), plot.title.c_str(), plot.time_axis.c_str(), plot.error_axis.c_str());
    std::printf("Left out: %s Every point: [%s.csv](bench/%s.csv).\n", plot.omissions.c_str(),
                name.c_str(), name.c_str());
  }
  if (results_folder().empty()) return;
  std::ofstream(results_folder() + "/pictures/" + name + ".svg") << svg_of(plot);
  std::ofstream(results_folder() + "/bench/" + name + ".csv") << csv_of(plot);
}

}  // namespace sunder
