// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "bench/collapse_accuracy.hpp"

namespace sunder {
namespace {

// Axes in powers of ten, and the picture's frame in px.
constexpr int kLowSag = -6, kHighSag = 1, kLowMs = 1, kHighMs = 4;
constexpr double kLeft = 80, kRight = 640, kTop = 40, kBottom = 440, kWidth = 900, kHeight = 500;
constexpr double kElasticSag = 10.975e-3;  // of the roof's centre, m

std::string format(const char* text, auto... values) {
  std::array<char, 400> line{};
  std::snprintf(line.data(), line.size(), text, values...);
  return line.data();
}

double x_of(double sag) {
  const double power = std::clamp(std::log10(sag), double{kLowSag}, double{kHighSag});
  return kLeft + (kRight - kLeft) * (power - kLowSag) / (kHighSag - kLowSag);
}
double y_of(double ms) {
  const double power = std::clamp(std::log10(ms), double{kLowMs}, double{kHighMs});
  return kBottom - (kBottom - kTop) * (power - kLowMs) / (kHighMs - kLowMs);
}

std::string text_at(double x, double y, const std::string& text, const char* anchor,
                    const char* colour = "#222") {
  return format("<text x='%.1f' y='%.1f' text-anchor='%s' fill='%s'>%s</text>\n", x, y, anchor,
                colour, text.c_str());
}

std::string axes() {
  const std::array<const char*, 8> sags{"1 µm",  "10 µm", "0.1 mm", "1 mm",
                                        "10 mm", "0.1 m", "1 m",    "10 m"};
  std::string svg;
  const char* line = "<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='%s'%s/>\n";
  for (int power = kLowSag; power <= kHighSag; ++power) {
    const double x = x_of(std::pow(10, power));
    svg += format(line, x, kTop, x, kBottom, "#ddd", "");
    svg += text_at(x, kBottom + 18, sags[static_cast<std::size_t>(power - kLowSag)], "middle");
  }
  for (int power = kLowMs; power <= kHighMs; ++power) {
    const double y = y_of(std::pow(10, power));
    svg += format(line, kLeft, y, kRight, y, "#ddd", "");
    svg += text_at(kLeft - 8, y + 4, format("%.0f", std::pow(10, power)), "end");
  }
  svg += format(line, x_of(kElasticSag), kTop, x_of(kElasticSag), kBottom, "#999",
                " stroke-dasharray='6 4'");
  svg += format(line, kLeft, y_of(1000), kRight, y_of(1000), "#999", " stroke-dasharray='2 3'");
  svg += text_at(x_of(kElasticSag), kTop - 8, "elastic frame: 10.98 mm", "middle");
  svg += text_at(kLeft + 4, y_of(1000) - 5, "real time", "start");
  svg +=
      text_at((kLeft + kRight) / 2, kBottom + 42,
              "largest sag or rise of a roof post after 10 s; of rigid joints, solved exactly: 0",
              "middle");
  svg += format(
      "<text transform='translate(22 %.0f) rotate(-90)' text-anchor='middle'>ms per "
      "simulated second, one core</text>\n",
      (kTop + kBottom) / 2);
  return svg;
}

std::string marker(const SagPoint& p, const char* colour) {
  const double x = x_of(p.sag), y = y_of(p.ms);
  if (p.failed)
    return format("<path d='M%.1f %.1fl10 10m0 -10l-10 10' stroke='%s' stroke-width='2.5'/>\n",
                  kRight - 5, y - 5, colour);
  return format("<circle cx='%.1f' cy='%.1f' r='4.5' stroke='%s' fill='%s' stroke-width='2'/>\n", x,
                y, colour, p.quoted ? "#fff" : colour);
}

/// A method's points in order of iterations, joined; its name in the key.
std::string series(const std::vector<SagPoint>& points, std::size_t first, std::size_t end,
                   const char* colour, double key) {
  std::string path, marks;
  for (std::size_t i = first; i < end; ++i) {
    const SagPoint& p = points[i];
    const double x = p.failed ? kRight : x_of(p.sag), y = y_of(p.ms);
    path += format("%c%.1f %.1f", i == first ? 'M' : 'L', x, y);
    marks += marker(p, colour);
    marks += text_at(x + (p.failed ? -10 : 7), y - 7, p.label, p.failed ? "end" : "start", colour);
  }
  return format("<path d='%s' fill='none' stroke='%s' stroke-width='1.5'/>\n", path.c_str(),
                colour) +
         marks +
         format("<rect x='%.0f' y='%.1f' width='14' height='4' fill='%s'/>\n", kRight + 24, key - 6,
                colour) +
         text_at(kRight + 46, key, points[first].method, "start");
}

}  // namespace

std::string sag_plot(const std::vector<SagPoint>& points) {
  constexpr std::array kColours{"#c0392b", "#e67e22", "#8e5a2a", "#7f8c8d", "#2c3e50",
                                "#27ae60", "#2471a3", "#16a085", "#8e44ad", "#555555"};
  std::string svg = format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %.0f %.0f' font-family='DejaVu Sans, "
      "sans-serif' font-size='12' fill='#222'>\n<rect width='100%%' height='100%%' fill='#fff'/>\n",
      kWidth, kHeight);
  svg += axes();
  std::size_t colour = 0;
  for (std::size_t first = 0, end = 0; first < points.size(); first = end) {
    while (end < points.size() && points[end].method == points[first].method) ++end;
    svg += series(points, first, end, kColours[colour % kColours.size()],
                  kTop + 12 + 22 * static_cast<double>(colour));
    ++colour;
  }
  const double key = kTop + 12 + 22 * static_cast<double>(colour) + 12;
  svg += text_at(kRight + 24, key, "numbers: iterations", "start");
  svg += text_at(kRight + 24, key + 18, "✗: still sinking after 10 s", "start");
  svg += text_at(kRight + 24, key + 36, "hollow: quoted, another machine", "start");
  return svg + "</svg>\n";
}

}  // namespace sunder
