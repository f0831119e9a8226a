// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/page_text.hpp"

namespace sunder {

/// One line of a plot.
struct PlotLine {
  std::string name;
  std::vector<double> values;  ///< one per abscissa; what is not finite is left out
  int colour = 0;              ///< of the page's style, 0 … 9
};

/// Lines over time.
struct Plot {
  std::string title;
  std::vector<double> times;  ///< s, ascending
  std::vector<PlotLine> lines;
  std::string unit;                 ///< of the values, "J": ticks get its prefix; "": plain numbers
  bool is_log = false;              ///< decades; what is not positive lies at the bottom
  bool is_count = false;            ///< whole numbers that jump: the value before holds until then
  std::optional<double> mark = {};  ///< a level to compare with
  double height = 270;              ///< by a width of 520
};

/// Ascending multiples of 1, 2 or 5 × 10ⁿ (with `whole`: n ≥ 0) that span the range and lie in it
/// or one step beyond: four to seven of them, unless the range is nothing.
std::vector<double> nice_ticks(double low, double high, bool whole = false);
/// Powers of ten from that at or below `low` to that at or above `high`; both > 0.
std::vector<double> decade_ticks(double low, double high);

/// The plot as an <svg> that a page's style colours (classes plot, grid, axis, c0 … c9, mark). Long
/// lines keep the extremes of each third of a unit of its width.
Html svg_plot(const Plot& plot);
/// Its legend as a list; nothing for one line.
Html plot_legend(const Plot& plot);

}  // namespace sunder
