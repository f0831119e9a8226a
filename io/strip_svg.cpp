// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/strip_svg.hpp"

#include <algorithm>
#include <cmath>

#include "io/strip_camera.hpp"
#include "io/strip_paper.hpp"
#include "io/strip_picture.hpp"
#include "io/strip_scene.hpp"

namespace sunder {
namespace {

constexpr std::size_t kColumns = 3;
constexpr double kGap = 100;      // between pictures, picture units
constexpr double kAtRest = 0.95;  // share of the moving chunks that rest at the last picture

// First and last step worth showing.
TimeRange eventful_steps(const Recording& recording) {
  const auto last = static_cast<std::uint32_t>(recording.times.size()) - 1;
  std::vector<std::uint32_t> ends;
  std::uint32_t first = last;
  for (const RecordedWall& wall : recording.walls) {
    for (const std::uint32_t track : wall.track) {
      const TimeRange moving = moving_range(recording, track);
      if (moving.first >= moving.end) continue;
      first = std::min(first, moving.first);
      ends.push_back(moving.end - 1);
    }
  }
  if (ends.empty()) return {0, last};
  std::ranges::sort(ends);
  const auto at = static_cast<std::size_t>(kAtRest * static_cast<double>(ends.size() - 1));
  return {first > 0 ? first - 1 : 0, ends[at]};
}

bool anything_breaks(const Recording& recording) {
  return std::ranges::any_of(recording.walls, [](const RecordedWall& wall) {
    return std::ranges::any_of(wall.track, [](std::uint32_t t) { return t != kNoTrack; });
  });
}

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
  paper.text("<style>.seam{fill:none;stroke-opacity:.09}</style>\n<defs>\n");
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

std::vector<std::uint32_t> strip_steps(const Recording& recording, int frames) {
  const TimeRange range = eventful_steps(recording);
  const double begin = recording.times[range.first], end = recording.times[range.end];
  const bool grows = anything_breaks(recording);
  std::vector<std::uint32_t> steps;
  for (int i = 0; i < frames; ++i) {
    const double t = frames > 1 ? static_cast<double>(i) / (frames - 1) : 0.5;
    const double time = begin + (grows ? t * t : t) * (end - begin);
    const auto next = std::ranges::lower_bound(recording.times, time - 1e-12);
    auto step = static_cast<std::uint32_t>(next - recording.times.begin());
    step = std::min(step, static_cast<std::uint32_t>(recording.times.size()) - 1);
    if (steps.empty() || step > steps.back()) steps.push_back(step);
  }
  return steps;
}

std::string draw_strip(const Recording& recording, const StripParams& params) {
  const std::vector<std::uint32_t> steps = strip_steps(recording, params.frames);
  const StripScene scene{recording, params, strip_parts(recording), place_camera(recording, steps)};
  StripPaper paper;
  draw_page(scene, steps, paper);
  return paper.take();
}

}  // namespace sunder
