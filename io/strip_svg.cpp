// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/strip_svg.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "io/strip_camera.hpp"
#include "io/strip_paper.hpp"
#include "io/strip_picture.hpp"
#include "io/strip_scene.hpp"
#include "io/strip_steps.hpp"

namespace sunder {
namespace {

constexpr std::size_t kColumns = 3;
constexpr double kGap = 100;  // between pictures, picture units
// Cracks and edges of glass: a dark line with a bright one in it.
constexpr std::string_view kGlassStyle =
    ".pane{stroke:none;shape-rendering:crispEdges}"
    ".shard{stroke:none;fill-opacity:.6;shape-rendering:crispEdges}"
    ".crack{fill:none;stroke:#23494d;stroke-opacity:.75;stroke-width:15}"
    ".edge{fill:none;stroke:#23494d;stroke-opacity:.85;stroke-width:20}"
    ".glint{fill:none;stroke:#f4ffff;stroke-opacity:.9;stroke-width:7}";

// Time in seconds, with a digit more where pictures would have the same one.
std::string label_of(double time, int digits) {
  std::int64_t scale = 1;
  for (int i = 0; i < digits; ++i) scale *= 10;
  const auto value = static_cast<std::int64_t>(std::floor(time * static_cast<double>(scale) + 0.5));
  std::string rest = std::to_string(value % scale);
  rest.insert(0, static_cast<std::size_t>(digits) - rest.size(), '0');
  return std::to_string(value / scale) + "." + rest + " s";
}

std::vector<std::string> labels_of(const Recording& recording,
                                   const std::vector<std::uint32_t>& steps) {
  std::vector<std::string> labels;
  for (int digits = 2; digits <= 5; ++digits) {
    labels.clear();
    for (const std::uint32_t step : steps) {
      labels.push_back(label_of(recording.times[step], digits));
    }
    if (std::ranges::adjacent_find(labels) == labels.end()) break;
  }
  return labels;
}

void draw_page(const StripScene& scene, const std::vector<std::uint32_t>& steps,
               StripPaper& paper) {
  const std::size_t columns = std::min(kColumns, steps.size());
  const std::size_t rows = (steps.size() + columns - 1) / columns;
  const auto extent = [](std::size_t count, double size) {
    return static_cast<double>(count) * (size + kGap) + kGap;
  };
  const double width = extent(columns, kStripWidth), height = extent(rows, kStripHeight);
  paper.text("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 ").number(width);
  paper.text(" ").number(height).text("\" width=\"").number(width / 20);
  paper.text("\" height=\"").number(height / 20).text("\">\n");
  paper.text("<style>").text(kGlassStyle).text("</style>\n<defs>\n");
  draw_strip_defs(scene, paper);
  paper.text("</defs>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n");
  const std::vector<std::string> labels = labels_of(scene.recording, steps);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    paper.text("<svg x=\"").number(extent(i % columns, kStripWidth));
    paper.text("\" y=\"").number(extent(i / columns, kStripHeight));
    paper.text("\" width=\"10000\" height=\"6400\" viewBox=\"0 0 10000 6400\">\n");
    paper.text("<use href=\"#scenery\"/>\n<g stroke=\"#14181d\" stroke-opacity=\".42\" ");
    paper.text("stroke-width=\"7\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n");
    draw_strip_picture(scene, steps[i], paper);
    paper.text("</g>\n<rect x=\"160\" y=\"5680\" width=\"1500\" height=\"560\" rx=\"120\" ");
    paper.text("fill=\"#fff\" fill-opacity=\".72\"/>\n<text x=\"910\" y=\"6095\" ");
    paper.text("font-size=\"380\" font-weight=\"600\" text-anchor=\"middle\" ");
    paper.text("font-family=\"Helvetica, Arial, sans-serif\" fill=\"#20262c\">");
    paper.text(labels[i]).text("</text>\n</svg>\n");
  }
  paper.text("</svg>\n");
}

}  // namespace

std::string draw_strip(const Recording& recording, const StripParams& params) {
  const std::vector<std::uint32_t> steps = strip_steps(recording, params.frames);
  const std::optional<double> ground =
      params.has_ground ? std::optional(params.ground_height) : std::nullopt;
  const StripScene scene{recording, params, strip_parts(recording),
                         place_camera(recording, steps, ground)};
  StripPaper paper;
  draw_page(scene, steps, paper);
  return paper.take();
}

}  // namespace sunder
