// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace sunder {

/// Times of several runs of the same work, ms.
struct Spread {
  double median = 0, least = 0, most = 0;
};
/// Of at least one time.
Spread spread_of(std::vector<double> ms);

/// One run of a method: how far off, at what cost.
struct WorkPoint {
  std::string method;   ///< points of one method are joined by a line, in their order
  std::string knobs;    ///< all settings that were chosen: "1/240 s, 20 iterations"
  std::string label;    ///< beside the point; short
  double error = 0;     ///< below the plot's least: drawn at its left edge
  Spread time;          ///< in the unit of the plot's axis
  bool failed = false;  ///< at the right edge: no result, or nothing like it
  bool quoted = false;  ///< hollow: not measured in this run
};

/// Error against time, both by logarithms, a line per method.
struct WorkPlot {
  std::string block;  ///< "pattern window": where docs/ have it, and with `-` its files' name
  std::string title;  ///< the case
  std::string error_axis, time_axis;
  double least_error = 1e-16;  ///< what is below counts as none
  std::string none = "none";   ///< what that is called
  std::string omissions;       ///< what is not in it, and why; Markdown
  std::vector<WorkPoint> points;
  struct Mark {
    double error = 0;
    std::string text;
  };
  std::vector<Mark> marks = {};  ///< upright lines
};

/// A picture on white, 900 × 520.
std::string svg_of(const WorkPlot& plot);
/// A line per point: case, method, knobs, error, median, least, most, note, commit, machine, date.
std::string csv_of(const WorkPlot& plot);
/// Prints the block that shows the picture; writes pictures/NAME.svg and bench/NAME.csv into the
/// folder of results, if there is one.
void publish(const WorkPlot& plot);

}  // namespace sunder
