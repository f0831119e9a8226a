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
#include "io/strip_stress.hpp"

namespace sunder {
namespace {

constexpr std::size_t kColumns = 3;
constexpr double kGap = 100;            // between pictures, picture units
constexpr double kCaptionHeight = 520;  // below a building's picture
constexpr double kLegendHeight = 1080;
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

// A building's, below its pictures: the time and how many joints have broken.
std::vector<std::string> captions_of(const Recording& recording,
                                     const std::vector<std::uint32_t>& steps) {
  std::vector<std::string> captions = labels_of(recording, steps);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::size_t broken = broken_joints(recording, recording.times[steps[i]]);
    captions[i] += ", " + std::to_string(broken) + (broken == 1 ? " joint" : " joints");
    captions[i] += " broken";
  }
  return captions;
}

// How pictures are laid out.
struct Page {
  std::size_t columns = 0, rows = 0;
  double picture = kStripWidth;  // width of one
  bool is_of_building = false;   // with captions below the pictures, and a legend
  double letters = 1;            // size of all words; a single picture is drawn larger

  double left(std::size_t i) const {
    return static_cast<double>(i % columns) * (picture + kGap) + kGap;
  }
  double top(std::size_t i) const { return row_top(i / columns); }
  double width() const { return static_cast<double>(columns) * (picture + kGap) + kGap; }
  double height() const { return row_top(rows) + (is_of_building ? letters * kLegendHeight : 0); }
  double row_top(std::size_t row) const {
    const double caption = is_of_building ? letters * kCaptionHeight : 0;
    return static_cast<double>(row) * (kStripHeight + caption + kGap) + kGap;
  }
};

Page page_of(const StripScene& scene, std::size_t pictures) {
  const std::size_t columns = std::min(kColumns, pictures);
  const std::size_t rows = (pictures + columns - 1) / columns;
  return {columns, rows, scene.camera.width, !scene.recording.parts.empty(),
          scene.params.only ? 0.5 : 1};
}

// A member's colours, explained below the pictures: drawn 9300 wide, shrunk where that is too much.
void draw_legend(const Page& page, StripPaper& paper) {
  struct Entry {
    EndLoad load;
    std::string_view words;
    double left;
  };
  constexpr Entry kEntries[] = {{{1, 0, false}, "force", 0},
                                {{0, 1, false}, "torque", 2000},
                                {{1, 1, false}, "both", 4200},
                                {{0, 0, true}, "failed joint", 6000}};
  paper.text("<g class=\"legend\" transform=\"translate(")
      .number(page.left(0) + 60 * page.letters)
      .text(" ");
  paper.number(page.height() - (kLegendHeight - 20) * page.letters);
  paper.text(") scale(").number(std::min(page.letters, (page.width() - 2 * kGap - 60) / 9300));
  paper.text(")\" font-size=\"420\" font-family=\"Helvetica, Arial, sans-serif\" ");
  paper.text("fill=\"#20262c\">\n");
  for (const Entry& entry : kEntries) {
    paper.text("<rect x=\"").number(entry.left).text("\" width=\"420\" height=\"420\" ");
    paper.text("rx=\"60\" fill=\"").colour(light_of(entry.load).colour);
    paper.text("\"/><text x=\"").number(entry.left + 560).text("\" y=\"355\">");
    paper.text(entry.words).text("</text>\n");
  }
  paper.text("<text y=\"900\" font-size=\"340\" fill=\"#5a626a\">");
  paper.text("at the ends of members, stronger the nearer to failure</text>\n</g>\n");
}

// In a corner of a wall's picture.
void draw_label(const std::string& label, double letters, StripPaper& paper) {
  paper.text("<g transform=\"translate(0 ").number(kStripHeight * (1 - letters));
  paper.text(") scale(")
      .number(letters)
      .text(")\">\n<rect x=\"160\" y=\"5680\" width=\"1500\" height=\"560\" rx=\"120\" ");
  paper.text("fill=\"#fff\" fill-opacity=\".72\"/>\n<text x=\"910\" y=\"6095\" ");
  paper.text("font-size=\"380\" font-weight=\"600\" text-anchor=\"middle\" ");
  paper.text("font-family=\"Helvetica, Arial, sans-serif\" fill=\"#20262c\">");
  paper.text(label).text("</text>\n</g>\n");
}

void draw_captions(const Page& page, const std::vector<std::string>& captions, StripPaper& paper) {
  paper.text("<g font-size=\"").number(380 * page.letters).text("\" font-weight=\"600\" ");
  paper.text("font-family=\"Helvetica, Arial, sans-serif\" fill=\"#20262c\">\n");
  for (std::size_t i = 0; i < captions.size(); ++i) {
    paper.text("<text x=\"").number(page.left(i) + 60 * page.letters).text("\" y=\"");
    paper.number(page.top(i) + kStripHeight + 410 * page.letters).text("\">").text(captions[i]);
    paper.text("</text>\n");
  }
  paper.text("</g>\n");
}

void draw_page(const StripScene& scene, const std::vector<std::uint32_t>& steps,
               StripPaper& paper) {
  const Page page = page_of(scene, steps.size());
  const double width = page.width(), height = page.height();
  const double size = scene.params.only ? 10 : 20;         // picture units of a pixel
  const double scale = kStripWidth / page.picture / size;  // all strips are as wide
  const double edge = 0.5 * (kStripWidth - page.picture);
  paper.text("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 ").number(width);
  paper.text(" ").number(height).text("\" width=\"").number(width * scale);
  paper.text("\" height=\"").number(height * scale).text("\">\n");
  paper.text("<style>").text(kGlassStyle).text("</style>\n<defs>\n");
  draw_strip_defs(scene, paper);
  paper.text("</defs>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n");
  const std::vector<std::string> labels = labels_of(scene.recording, steps);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    paper.text("<svg x=\"").number(page.left(i)).text("\" y=\"").number(page.top(i));
    paper.text("\" width=\"").number(page.picture).text("\" height=\"6400\" viewBox=\"");
    paper.number(edge).text(" 0 ").number(page.picture).text(" 6400\">\n");
    paper.text("<use href=\"#scenery\"/>\n<g stroke=\"#14181d\" stroke-opacity=\".42\" ");
    paper.text("stroke-width=\"7\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n");
    draw_strip_picture(scene, steps[i], paper);
    paper.text("</g>\n");
    if (!page.is_of_building) draw_label(labels[i], page.letters, paper);
    paper.text("</svg>\n");
  }
  if (page.is_of_building) {
    draw_captions(page, captions_of(scene.recording, steps), paper);
    draw_legend(page, paper);
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
  draw_page(scene, params.only ? std::vector{*params.only} : steps, paper);
  return paper.take();
}

}  // namespace sunder
