// SPDX-License-Identifier: GPL-3.0-or-later
// Texts and plots of report pages.
#include "io/svg_plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "meshing/random.hpp"

namespace sunder {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(PageText, NumbersHaveThreeDigits) {
  const std::pair<double, const char*> cases[] = {{0, "0"},
                                                  {1, "1"},
                                                  {0.276, "0.276"},
                                                  {24.66, "24.7"},
                                                  {999.6, "1000"},
                                                  {1234, "1230"},
                                                  {12345, "12\u202f300"},
                                                  {-0.5, "−0.5"},
                                                  {0.00012345, "0.000123"},
                                                  {2.84e-15, "2.84 × 10⁻¹⁵"},
                                                  {9.999e-15, "1 × 10⁻¹⁴"},
                                                  {1.5e7, "1.5 × 10⁷"},
                                                  {999999, "1 × 10⁶"},
                                                  {kInfinity, "–"},
                                                  {std::nan(""), "–"}};
  for (const auto& [value, text] : cases) EXPECT_EQ(digits_text(value), text) << value;
}

TEST(PageText, QuantitiesTakeThePrefixOfTheirSize) {
  EXPECT_EQ(quantity_text(0, "J"), "0\u00a0J");
  EXPECT_EQ(quantity_text(1.234e7, "J"), "12.3\u00a0MJ");
  EXPECT_EQ(quantity_text(999.9, "N"), "1\u00a0kN");
  EXPECT_EQ(quantity_text(-0.00196, "m"), "−1.96\u00a0mm");
  EXPECT_EQ(quantity_text(2e-12, "m"), "0.002\u00a0nm");
  EXPECT_EQ(quantity_text(3e16, "J"), "30\u202f000\u00a0TJ");
  EXPECT_EQ(quantity_text(kInfinity, "J"), "–");
  EXPECT_EQ(share_text(0.01), "1\u00a0%");
  EXPECT_EQ(share_text(2.84e-15), "2.84 × 10⁻¹⁵");
  EXPECT_EQ(count_text(1234567), "1\u202f234\u202f567");
  EXPECT_EQ(count_text(999), "999");
  EXPECT_EQ(time_text(0.00321), "3.21\u00a0ms");
  EXPECT_EQ(time_text(192.4), "3\u00a0min 12\u00a0s");
  EXPECT_EQ(moment_text(0.25), "0.25\u00a0s");
  EXPECT_EQ(moment_cell(0.25), "0.2500");
}

TEST(PageText, WhateverIsWrittenIsWithinHalfADigit) {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const double value = std::pow(10.0, 11 * random_unit(1, i) - 5);
    std::string text = digits_text(value);
    std::erase_if(text, [](char c) { return c < 0; });  // narrow spaces, "×", powers
    const double read = std::stod(text.substr(0, text.find(' ')));
    if (text.find(' ') != std::string::npos) continue;
    EXPECT_NEAR(read / value, 1, 0.00501) << value << " is " << text;
  }
}

TEST(PageText, MarkupInTextStaysText) {
  EXPECT_EQ(escaped(R"(<b>"a" & 'b'</b>)").text,
            "&lt;b&gt;&quot;a&quot; &amp; &#39;b&#39;&lt;/b&gt;");
}

TEST(SvgPlot, TicksAreRoundSpanTheRangeAndAreFew) {
  for (std::uint64_t i = 0; i < 500; ++i) {
    const double size = std::pow(10.0, 20 * random_unit(2, i) - 10);
    const double low = size * (random_unit(3, i) - 0.5), high = low + size * random_unit(4, i);
    const std::vector<double> ticks = nice_ticks(low, high);
    EXPECT_LE(ticks.front(), low + 1e-8 * size);
    EXPECT_GE(ticks.back(), high - 1e-8 * size);
    EXPECT_GE(ticks.size(), 3u);
    EXPECT_LE(ticks.size(), 8u);
    const double step = ticks[1] - ticks[0];
    const double digit = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
    const bool is_round = std::ranges::any_of(std::vector<double>{1, 2, 5},
                                              [&](double d) { return std::abs(digit - d) < 1e-6; });
    EXPECT_TRUE(is_round) << step;
  }
  EXPECT_EQ(nice_ticks(0, 3, true), (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(nice_ticks(0, 1, true), (std::vector<double>{0, 1}));
  EXPECT_EQ(decade_ticks(0.276, 24.7), (std::vector<double>{0.1, 1, 10, 100}));
  EXPECT_EQ(decade_ticks(1, 1), (std::vector<double>{1, 10}));
}

/// Points of the first polyline of a picture.
std::vector<std::pair<double, double>> line_of(const std::string& svg) {
  const std::size_t begin = svg.find("points=\"", svg.find("<polyline")) + 8;
  std::istringstream in(svg.substr(begin, svg.find('"', begin) - begin));
  std::vector<std::pair<double, double>> points;
  for (std::string each; in >> each;)
    points.emplace_back(std::stod(each), std::stod(each.substr(each.find(',') + 1)));
  return points;
}

Plot plot_of(std::vector<double> times, std::vector<double> values) {
  return {.title = "a <plot>",
          .times = std::move(times),
          .lines = {{"one", std::move(values), 3}},
          .unit = "J"};
}

TEST(SvgPlot, PointsLieWhereTheAxesSay) {
  const std::string svg = svg_plot(plot_of({0, 1, 2, 4}, {0, 2e6, 1e6, 4e6})).text;
  const auto points = line_of(svg);
  ASSERT_EQ(points.size(), 4u);
  const auto [x0, y0] = points[0];
  const auto [x4, y4] = points[3];
  EXPECT_NEAR((points[1].first - x0) / (x4 - x0), 0.25, 1e-3);
  EXPECT_NEAR((points[1].second - y0) / (y4 - y0), 0.5, 1e-3);
  EXPECT_NEAR((points[2].second - y0) / (y4 - y0), 0.25, 1e-3);
  EXPECT_LT(y4, y0) << "up is more";
  EXPECT_NE(svg.find(">MJ<"), std::string::npos);
  EXPECT_NE(svg.find(">4\u00a0s<"), std::string::npos);
  EXPECT_NE(svg.find("a &lt;plot&gt;"), std::string::npos);
  EXPECT_NE(svg.find("class=\"area c3\""), std::string::npos);
}

TEST(SvgPlot, CountsJumpAndDecadesAreEvenlySpaced) {
  Plot counts = plot_of({0, 1, 2}, {0, 0, 7});
  counts.is_count = true;
  const auto stairs = line_of(svg_plot(counts).text);
  ASSERT_EQ(stairs.size(), 4u);
  EXPECT_EQ(stairs[2].first, stairs[3].first);
  EXPECT_EQ(stairs[2].second, stairs[0].second);
  Plot decades = plot_of({0, 1, 2, 3}, {1, 10, 100, 0});
  decades.is_log = true;
  const auto points = line_of(svg_plot(decades).text);
  EXPECT_NEAR(points[0].second - points[1].second, points[1].second - points[2].second, 0.11);
  EXPECT_EQ(points[3].second, points[0].second) << "what is not positive lies at the bottom";
}

TEST(SvgPlot, LongLinesKeepTheirExtremesAndLittleElse) {
  std::vector<double> times, values;
  for (std::uint64_t i = 0; i < 100000; ++i) {
    times.push_back(static_cast<double>(i));
    values.push_back(random_unit(1, i));
  }
  values[54321] = 9, values[12345] = -9;
  const std::string svg = svg_plot(plot_of(times, values)).text;
  const auto points = line_of(svg);
  EXPECT_LT(points.size(), 7000u);
  const auto by_height = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto [top, bottom] = std::ranges::minmax_element(points, by_height);
  EXPECT_NEAR(top->first, points[0].first + 0.54321 * (points.back().first - points[0].first), 0.3);
  EXPECT_NEAR(bottom->first, points[0].first + 0.12345 * (points.back().first - points[0].first),
              0.3);
}

TEST(SvgPlot, OddValuesAreDrawnAsFarAsTheyGo) {
  EXPECT_EQ(line_of(svg_plot(plot_of({0, 1, 2}, {1, std::nan(""), 3})).text).size(), 2u);
  for (const double value : {0.0, -3.0, 1e300, 1e-300})
    EXPECT_EQ(svg_plot(plot_of({0}, {value})).text.find("nan"), std::string::npos) << value;
  EXPECT_EQ(svg_plot(plot_of({0, 1}, {kInfinity, -kInfinity})).text.find("polyline"),
            std::string::npos);
}

TEST(SvgPlot, ALegendNamesEachLine) {
  Plot plot = plot_of({0, 1}, {0, 1});
  EXPECT_EQ(plot_legend(plot).text, "");
  plot.lines.push_back({"a & b", {1, 2}, 5});
  const std::string legend = plot_legend(plot).text;
  EXPECT_NE(legend.find("<i class=\"c5\"></i>a &amp; b</li>"), std::string::npos);
}

}  // namespace
}  // namespace sunder
