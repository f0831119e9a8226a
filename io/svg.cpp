// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <string_view>
#include <vector>

#include "io/solid_picture.hpp"
#include "io/text_writer.hpp"
#include "io/tint.hpp"
#include "io/wall_view.hpp"
#include "meshing/random.hpp"

namespace sunder {
namespace {

// Chunks are drawn one by one in the oblique view up to this many, on all walls together.
constexpr std::uint64_t kMostExploded = 5000;
constexpr double kSpread = 0.22;    // how far chunks move away from the centre, of their distance
constexpr Vec2 kDepth{0.42, 0.30};  // where the z axis points on paper, back of the wall
constexpr double kMillimetres = 1000;
// A page higher than this, of its width, has its oblique views beside the flat ones.
constexpr double kSteepest = 2;

using Colour = std::array<double, 3>;  // sRGB, 0 … 255

Colour mixed(Colour a, Colour b, double t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

Colour colour_of(const std::array<std::uint8_t, 3>& rgb) {
  return {static_cast<double>(rgb[0]), static_cast<double>(rgb[1]), static_cast<double>(rgb[2])};
}

// Text of the picture; coordinates in tenths of a millimetre are finer than a printer's.
class Paper {
 public:
  void text(std::string_view part) { out_ += part; }
  void number(double value) {
    const double scaled = std::round(value * 10);
    const auto tenths = static_cast<std::int64_t>(scaled);
    if (tenths < 0) out_ += '-';
    const std::int64_t size = tenths < 0 ? -tenths : tenths;
    out_ += std::to_string(size / 10);
    if (size % 10 != 0) {
      out_ += '.';
      out_ += static_cast<char>('0' + size % 10);
    }
  }
  void point(Vec2 p) {
    number(p.x);
    out_ += ' ';
    number(p.y);
  }
  void colour(const Colour& c) {
    constexpr char kHex[] = "0123456789abcdef";
    out_ += '#';
    for (const double channel : c) {
      const int value = static_cast<int>(std::clamp(channel, 0.0, 255.0) + 0.5);
      out_ += kHex[value >> 4];
      out_ += kHex[value & 15];
    }
  }
  void attribute(std::string_view name, double value) {
    out_ += ' ';
    out_ += name;
    out_ += "=\"";
    number(value);
    out_ += '"';
  }
  // Closed subpath.
  void loop(std::span<const Vec2> points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      out_ += i == 0 ? 'M' : i == 1 ? 'L' : ' ';
      point(points[i]);
    }
    out_ += 'Z';
  }
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

// Wall metres to paper millimetres: the wall's lower left corner stands at `low_left`.
struct Placing {
  Vec2 origin, low_left;
  Vec2 operator()(Vec2 p) const {
    return {low_left.x + (p.x - origin.x) * kMillimetres,
            low_left.y - (p.y - origin.y) * kMillimetres};
  }
};

std::vector<Vec2> placed(const std::vector<Vec2>& loop, const Placing& place) {
  std::vector<Vec2> result;
  for (const Vec2 p : loop) result.push_back(place(p));
  return result;
}

std::vector<Vec2> corners_of(const Pattern& pattern, LoopRange loop) {
  std::vector<Vec2> result;
  for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
    result.push_back(pattern.vertices[pattern.corners[k]]);
  }
  return result;
}

// Typical width of a cell in millimetres, which lines and marks are measured by.
double cell_size(const WallAsset& wall, Box box) {
  const Vec2 size = box.high - box.low;
  const double cells = std::max<double>(1, wall.pattern.cell_count());
  return kMillimetres * std::sqrt(size.x * size.y / cells);
}

// --- flat view
// ------------------------------------------------------------------------------------

void draw_cells(const WallAsset& wall, const Placing& place, double line, Paper& paper) {
  const Colour base = colour_of(look_of(wall.wall.material).outer);
  paper.text("<g stroke=\"#3b3a38\" stroke-linejoin=\"round\" fill-rule=\"evenodd\"");
  paper.attribute("stroke-width", line);
  paper.text(">\n");
  for (std::uint32_t c = 0; c < wall.pattern.cell_count(); ++c) {
    paper.text("<path class=\"cell\" fill=\"");
    paper.colour(tinted(base, wall.pattern.origin_of(c)));
    paper.text("\" d=\"");
    for (const LoopRange loop : loops_of(wall.pattern, c)) {
      paper.loop(placed(corners_of(wall.pattern, loop), place));
    }
    paper.text("\"/>\n");
  }
  paper.text("</g>\n");
}

void draw_border(const WallAsset& wall, const Placing& place, double line, Paper& paper) {
  paper.text("<path fill=\"none\" stroke=\"#1d1c1b\" stroke-linejoin=\"miter\"");
  paper.attribute("stroke-width", 2.4 * line);
  paper.text(" d=\"");
  paper.loop(placed(wall.wall.region.outline, place));
  for (const Loop& opening : wall.wall.region.openings) paper.loop(placed(opening, place));
  paper.text("\"/>\n");
}

// Ground hatching along each anchored edge, outside the wall.
void draw_anchors(const WallAsset& wall, const Placing& place, double mark, Paper& paper) {
  paper.text("<path fill=\"none\" stroke=\"#c2452d\" stroke-linecap=\"round\"");
  paper.attribute("stroke-width", mark * 0.16);
  paper.text(" d=\"");
  for (const Bond& bond : wall.bonds) {
    if (bond.b != kWorld) continue;
    const double half = 0.5 * bond.area / wall.wall.thickness;
    const Vec2 at{bond.centroid.x, bond.centroid.y};
    const Vec2 along{-bond.normal.y, bond.normal.x};
    const Vec2 a = place(at - half * along), b = place(at + half * along);
    const Vec2 out{bond.normal.x * mark, -bond.normal.y * mark};
    const Vec2 step = b - a;
    paper.text("M");
    paper.point(a + 0.35 * out);
    paper.text("L");
    paper.point(b + 0.35 * out);
    const int count = std::max(1, static_cast<int>(length(step) / mark + 0.5));
    for (int i = 0; i < count; ++i) {
      const Vec2 foot = a + ((i + 0.75) / count) * step + 0.35 * out;
      paper.text("M");
      paper.point(foot);
      paper.text("L");
      paper.point(foot + out - (0.5 * mark / std::max(length(step), 1e-9)) * step);
    }
  }
  paper.text("\"/>\n");
}

// Where the blow fell, or what the pattern gathers around.
std::vector<Vec2> impact_points(const WallAsset& wall) {
  if (const auto* web = std::get_if<SpiderwebParams>(&wall.wall.pattern)) return web->impacts;
  if (const auto* focus = std::get_if<VoronoiFocusParams>(&wall.wall.pattern)) return focus->points;
  return {};
}

void draw_impacts(const WallAsset& wall, const Placing& place, double mark, Paper& paper) {
  for (const Vec2 impact : impact_points(wall)) {
    const Vec2 p = place(impact);
    paper.text("<circle fill=\"none\" stroke=\"#c2452d\"");
    paper.attribute("cx", p.x);
    paper.attribute("cy", p.y);
    paper.attribute("r", 0.7 * mark);
    paper.attribute("stroke-width", 0.22 * mark);
    paper.text("/>\n");
  }
}

// --- oblique view
// ---------------------------------------------------------------------------------

// One face to be painted.
struct Face {
  std::vector<std::vector<Vec2>> loops;
  Colour fill;
};

struct Oblique {
  const WallAsset& wall;
  Placing place;
  Vec2 centre;
  Colour outer, inner;

  Vec2 shift_of(std::uint32_t chunk) const {
    const Vec3 c = wall.chunks[chunk].centroid;
    return kSpread * (Vec2{c.x, c.y} - centre);
  }
  // The depth axis leads up and to the right, away from the eye.
  Vec2 project(Vec2 p, bool back) const {
    return place(back ? p + wall.wall.thickness * kDepth : p);
  }
};

// Sides whose outward normal faces the eye: against the depth axis on paper.
bool is_visible(Vec2 a, Vec2 b) {
  return dot(Vec2{b.y - a.y, a.x - b.x}, kDepth) > 0;
}

void draw_face(const std::vector<std::vector<Vec2>>& loops, const Colour& fill, Paper& paper) {
  paper.text("<path fill=\"");
  paper.colour(fill);
  paper.text("\" d=\"");
  for (const auto& loop : loops) paper.loop(loop);
  paper.text("\"/>");
}

void draw_prism(const Oblique& view, std::uint32_t chunk, Paper& paper) {
  const Pattern& pattern = view.wall.pattern;
  const Vec2 shift = view.shift_of(chunk);
  std::vector<std::vector<Vec2>> front;
  for (const LoopRange loop : loops_of(pattern, chunk)) {
    std::vector<Vec2>& points = front.emplace_back();
    for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
      const Vec2 a = pattern.vertices[pattern.corners[k]] + shift;
      const Vec2 b = pattern.vertices[pattern.corners[loop.next(k)]] + shift;
      points.push_back(view.project(a, false));
      if (!is_visible(a, b)) continue;
      const Colour side = pattern.across[k].is_border() ? view.outer : view.inner;
      const double size = std::max(length(b - a), 1e-300);
      const double light = 0.5 + 0.5 * (b.y - a.y > 0 ? 0.0 : (a.x - b.x) / size);
      draw_face({{view.project(a, false), view.project(b, false), view.project(b, true),
                  view.project(a, true)}},
                mixed({46, 42, 44}, side, 0.66 + 0.34 * light), paper);
    }
  }
  draw_face(front, tinted(view.outer, pattern.origin_of(chunk)), paper);
  paper.text("\n");
}

// Painter's order: the sides that show recede up and to the right, behind the fronts of the chunks
// there, so a chunk comes before those farther along the depth axis.
std::vector<std::uint32_t> painters_order(const Oblique& view) {
  std::vector<std::pair<double, std::uint32_t>> order;
  for (std::uint32_t c = 0; c < view.wall.pattern.cell_count(); ++c) {
    const Vec3 at = view.wall.chunks[c].centroid;
    order.emplace_back(dot(Vec2{at.x, at.y}, kDepth), c);
  }
  std::ranges::sort(order);
  std::vector<std::uint32_t> result;
  for (const auto& [key, chunk] : order) result.push_back(chunk);
  return result;
}

void draw_oblique(const Oblique& view, double line, Paper& paper) {
  paper.text("<g stroke=\"#2b2a29\" stroke-linejoin=\"round\" fill-rule=\"evenodd\"");
  paper.attribute("stroke-width", 0.7 * line);
  paper.text(">\n");
  for (const std::uint32_t chunk : painters_order(view)) draw_prism(view, chunk, paper);
  paper.text("</g>\n");
}

// --- page
// -----------------------------------------------------------------------------------------

// How much room a wall's column takes, millimetres.
struct Column {
  Box box;          // of the wall, metres
  double mark = 1;  // size of anchors' and impacts' marks
  double width = 0, flat_height = 0, oblique_height = 0, margin = 0;
};

Column column_of(const WallAsset& wall, bool exploded) {
  Column column;
  column.box = bounding_box(wall.wall.region.outline);
  const Vec2 size = kMillimetres * (column.box.high - column.box.low);
  const double largest = std::max(size.x, size.y);
  column.margin = 0.07 * largest;
  column.mark = std::min(0.35 * cell_size(wall, column.box), 0.03 * largest);
  const Vec2 depth = kMillimetres * wall.wall.thickness * kDepth;
  column.width = (exploded ? (1 + kSpread) * size.x + depth.x : size.x) + 2 * column.margin;
  column.flat_height = size.y + 2 * column.margin;
  if (exploded) column.oblique_height = (1 + kSpread) * size.y + depth.y + column.margin;
  return column;
}

// A solid's column has its two pictures, each in the middle.
Column column_of(const SolidPicture& picture) {
  Column column;
  const double scale = kMillimetres * picture.unit;
  const Vec2 whole = scale * picture.whole_size, exploded = scale * picture.exploded_size;
  column.margin = 0.07 * std::max({whole.x, whole.y, 1e-9});
  column.width = std::max(whole.x, exploded.x) + 2 * column.margin;
  column.flat_height = whole.y + 2 * column.margin;
  if (!picture.exploded.empty()) column.oblique_height = exploded.y + column.margin;
  return column;
}

// Where a column's two pictures stand: left edges and floors.
struct Places {
  double flat_left = 0, flat_floor = 0, oblique_left = 0, oblique_floor = 0;
};

void draw_solid(const SolidPicture& picture, const Column& column, const Places& places,
                Paper& paper) {
  const double scale = kMillimetres * picture.unit;
  const auto draw = [&](const std::string& text, double width, double left, double floor) {
    if (text.empty()) return;
    paper.text("<g transform=\"translate(");
    paper.point({left + 0.5 * (column.width - scale * width), floor});
    paper.text(") scale(");
    char number[kNumberRoom];
    paper.text({number, static_cast<std::size_t>(put_number(number, scale) - number)});
    paper.text(")\">\n");
    paper.text(text);
    paper.text("</g>\n");
  };
  draw(picture.whole, picture.whole_size.x, places.flat_left, places.flat_floor);
  draw(picture.exploded, picture.exploded_size.x, places.oblique_left, places.oblique_floor);
}

void draw_name(const std::string& name, Vec2 at, double size, Paper& paper) {
  paper.text(
      "<text text-anchor=\"middle\" font-family=\"Helvetica, Arial, sans-serif\" "
      "fill=\"#4a4947\"");
  paper.attribute("x", at.x);
  paper.attribute("y", at.y);
  paper.attribute("font-size", size);
  paper.text(">");
  for (const char c : name) {
    paper.text(c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string_view(&c, 1));
  }
  paper.text("</text>\n");
}

void draw_wall(const WallAsset& wall, const Column& column, const Places& places, Paper& paper) {
  const double line = std::clamp(0.012 * cell_size(wall, column.box), 0.1, 6.0);
  const Vec2 size = kMillimetres * (column.box.high - column.box.low);
  const Placing flat{column.box.low,
                     {places.flat_left + 0.5 * (column.width - size.x), places.flat_floor}};
  paper.text("<g>\n");
  draw_cells(wall, flat, line, paper);
  draw_border(wall, flat, line, paper);
  draw_anchors(wall, flat, column.mark, paper);
  draw_impacts(wall, flat, column.mark, paper);
  paper.text("</g>\n");
  if (column.oblique_height == 0) return;
  const MaterialLook look = look_of(wall.wall.material);
  const double corner = places.oblique_left + column.margin + 0.5 * kSpread * size.x;
  const Oblique view{wall,
                     {column.box.low, {corner, places.oblique_floor - 0.5 * kSpread * size.y}},
                     0.5 * (column.box.low + column.box.high),
                     colour_of(look.outer),
                     colour_of(look.inner)};
  draw_oblique(view, line, paper);
}

}  // namespace

std::array<double, 3> tinted(const std::array<double, 3>& base, std::uint32_t cell) {
  constexpr Colour kHues[] = {{206, 160, 120}, {120, 150, 178}, {150, 172, 138},
                              {196, 184, 140}, {160, 144, 170}, {200, 150, 150}};
  const std::uint64_t bits = random_bits(0x5375'6E64'6572, cell);
  const Colour hue = kHues[bits % std::size(kHues)];
  const double light = static_cast<double>((bits >> 8) % 256) / 255 - 0.5;
  const Colour soft = mixed(base, hue, 0.30);
  return mixed(soft, light > 0 ? Colour{255, 255, 255} : Colour{40, 40, 48},
               std::abs(light) * 0.36);
}

std::string draw_svg(const Asset& asset, std::span<const SolidAsset> solids) {
  std::uint64_t cells = 0;
  for (const WallAsset& wall : asset.walls) cells += wall.pattern.cell_count();
  std::vector<Column> columns;
  double width = 0, flat = 0, oblique = 0;
  for (const WallAsset& wall : asset.walls) {
    columns.push_back(column_of(wall, cells <= kMostExploded));
    width += columns.back().width;
    flat = std::max(flat, columns.back().flat_height);
    oblique = std::max(oblique, columns.back().oblique_height);
  }
  std::vector<SolidPicture> pictures;
  for (const SolidAsset& solid : solids) {
    pictures.push_back(draw_solid(solid));
    columns.push_back(column_of(pictures.back()));
    width += columns.back().width;
    flat = std::max(flat, columns.back().flat_height);
    oblique = std::max(oblique, columns.back().oblique_height);
  }
  // One ground line for all, whatever each one's own margin.
  double margin = 0;
  for (const Column& column : columns) margin = std::max(margin, column.margin);
  const bool is_beside = oblique > 0 && flat + oblique > kSteepest * width;
  const double across = is_beside ? 2 : 1;  // pictures of a column side by side
  width *= across;
  const double letters = 0.018 * std::max(width, flat);
  const double bottom = is_beside ? std::max(flat, oblique + margin) : flat + oblique;
  const double height = bottom + 2.4 * letters;
  Paper paper;
  paper.text("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 ");
  paper.point({width, height});
  paper.text("\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fbfaf7\"/>\n");
  double left = 0;
  for (std::size_t w = 0; w < columns.size(); ++w) {
    const Column& column = columns[w];
    const bool is_wall = w < asset.walls.size();
    const std::size_t solid = w - asset.walls.size();
    const Places places = is_beside
                              ? Places{left, bottom - margin, left + column.width, bottom - margin}
                              : Places{left, flat - margin, left, bottom - 0.3 * margin};
    if (is_wall) {
      draw_wall(asset.walls[w], column, places, paper);
    } else {
      draw_solid(pictures[solid], column, places, paper);
    }
    draw_name(is_wall ? asset.walls[w].wall.name : solids[solid].solid.name,
              {left + 0.5 * across * column.width, height - letters}, letters, paper);
    left += across * column.width;
  }
  paper.text("</svg>\n");
  return paper.take();
}

}  // namespace sunder
