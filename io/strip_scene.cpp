// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/strip_scene.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

#include "fracture/chunk_mesh.hpp"
#include "io/strip_building.hpp"
#include "io/wall_view.hpp"

namespace sunder {
namespace {

constexpr StripColour kSkyTop{168, 192, 214}, kSkyLow{236, 240, 240};
constexpr StripColour kGroundFar{226, 225, 219}, kGroundNear{170, 165, 154};

void gradient(StripPaper& out, std::string_view id, const StripColour& top,
              const StripColour& bottom) {
  out.text("<linearGradient id=\"").text(id);
  out.text(R"(" x2="0" y2="1"><stop stop-color=")").colour(top);
  out.text(R"("/><stop offset="1" stop-color=")").colour(bottom);
  out.text("\"/></linearGradient>\n");
}

// Lines a metre apart (or 2, 5, 10 … where that is too dense), cut where they pass the camera.
void draw_grid(const StripScene& scene, StripPaper& out) {
  const StripCamera& camera = scene.camera;
  const double height = camera.eye.y - scene.params.ground_height;
  const double reach = std::min(12 * height / camera.back.y, 1e6);
  double spacing = 1;
  for (int i = 0; reach / spacing > 60; ++i) spacing *= i % 3 == 1 ? 2.5 : 2;
  const auto line = [&](Vec3 a, Vec3 b) {
    Vec3 p = camera.see(a), q = camera.see(b);
    const double near = 0.2 * height + camera.nearest;
    if (p.z < near && q.z < near) return;
    if (p.z < near) p = p + ((near - p.z) / (q.z - p.z)) * (q - p);
    if (q.z < near) q = q + ((near - q.z) / (p.z - q.z)) * (p - q);
    const Vec2 ends[] = {camera.project(p), camera.project(q)};
    out.line(ends, false);
  };
  const double x0 = std::floor((camera.eye.x - reach) / spacing) * spacing;
  const double z0 = std::floor((camera.eye.z - reach) / spacing) * spacing;
  const auto count = static_cast<int>(2 * reach / spacing) + 2;
  const double end = count * spacing, y = scene.params.ground_height;
  out.text(R"x(<path fill="none" stroke="url(#grid)" stroke-width="8" d=")x");
  for (int i = 0; i <= count; ++i) {
    line({x0 + i * spacing, y, z0}, {x0 + i * spacing, y, z0 + end});
    line({x0, y, z0 + i * spacing}, {x0 + end, y, z0 + i * spacing});
  }
  out.text("\"/>\n");
}

// A pane's tint with the sky's reflection across it, from corner to corner of its picture.
void draw_glass(const StripScene& scene, std::uint32_t w, StripPaper& out) {
  const WallAsset& asset = scene.recording.walls[w].asset;
  const Pose pose{asset.wall.position, asset.wall.rotation};
  Box box{{1e300, 1e300}, {-1e300, -1e300}};
  for (const Vec2 corner : asset.wall.region.outline) {
    const Vec3 seen = scene.camera.see(pose * Vec3{corner.x, corner.y, 0});
    if (!(seen.z > scene.camera.nearest)) continue;
    const Vec2 p = scene.camera.project(seen);
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
  }
  if (box.low.x > box.high.x) box = {{0, 0}, {kStripWidth, kStripHeight}};
  const auto rgb = look_of(asset.wall.material).outer;
  const StripColour tint{0.82 * rgb[0], 0.93 * rgb[1], 0.93 * rgb[2]};
  out.text("<linearGradient id=\"glass")
      .integer(w)
      .text("\" gradientUnits=\"userSpaceOnUse\" x1=\"");
  out.number(box.low.x).text("\" y1=\"").number(box.low.y);
  out.text("\" x2=\"").number(box.high.x).text("\" y2=\"").number(box.high.y).text("\">");
  struct Stop {
    double at, white, opacity;
  };
  constexpr Stop kStops[] = {{0, 0.35, 0.62},    {0.28, 0.1, 0.5}, {0.3, 0.75, 0.6},
                             {0.42, 0.65, 0.55}, {0.44, 0.1, 0.5}, {1, 0, 0.62}};
  for (const Stop& stop : kStops) {
    out.text("<stop offset=\"").number(stop.at).text("\" stop-color=\"");
    out.colour(mix_colours(tint, {255, 255, 255}, stop.white));
    out.text("\" stop-opacity=\"").number(stop.opacity).text("\"/>");
  }
  out.text("</linearGradient>\n");
}

}  // namespace

bool is_glass(std::string_view material) {
  return material.find("glass") != std::string_view::npos ||
         material.find("pmma") != std::string_view::npos;
}

std::vector<StripPart> strip_parts(const Recording& recording) {
  std::vector<StripPart> parts;
  for (std::uint32_t w = 0; w < recording.walls.size(); ++w) {
    const WallAsset& asset = recording.walls[w].asset;
    const Pattern& pattern = asset.pattern;
    for (std::uint32_t c = 0; c < pattern.cell_count(); ++c) {
      std::map<std::pair<std::uint32_t, std::uint32_t>, Across> edges;
      for (const LoopRange loop : loops_of(pattern, c)) {
        for (std::uint32_t k = loop.begin; k < loop.end; ++k) {
          edges[{pattern.corners[k], pattern.corners[loop.next(k)]}] = pattern.across[k];
        }
      }
      for (const std::vector<std::uint32_t>& corners : convex_parts(asset, c)) {
        StripPart& part = parts.emplace_back(StripPart{w, c, {}, {}, 0.5 * asset.wall.thickness});
        for (std::size_t i = 0; i < corners.size(); ++i) {
          part.outline.push_back(pattern.vertices[corners[i]]);
          const auto edge = edges.find({corners[i], corners[i + 1 == corners.size() ? 0 : i + 1]});
          part.across.push_back(edge == edges.end()        ? StripPart::kInside
                                : edge->second.is_border() ? StripPart::kBorder
                                                           : edge->second.cell());
        }
      }
    }
  }
  std::ranges::move(building_parts(recording), std::back_inserter(parts));
  return parts;
}

void draw_strip_defs(const StripScene& scene, StripPaper& out) {
  const StripCamera& camera = scene.camera;
  gradient(out, "sky", kSkyTop, kSkyLow);
  gradient(out, "land", kGroundFar, kGroundNear);
  for (std::uint32_t w = 0; w < scene.recording.walls.size(); ++w) {
    if (is_glass(scene.recording.walls[w].asset.wall.material)) draw_glass(scene, w, out);
  }
  out.text(R"(<radialGradient id="ball" cx=".36" cy=".3" r=".75"><stop stop-color="#e8ebee"/>)");
  out.text(R"(<stop offset=".35" stop-color="#9aa1a9"/><stop offset="1" stop-color="#33383e"/>)");
  out.text("</radialGradient>\n");
  out.text(R"(<filter id="soft"><feGaussianBlur stdDeviation="18"/></filter>)");
  // Where a level line of sight goes.
  const double flat = std::sqrt(1 - camera.back.y * camera.back.y);
  const double rise = camera.focal * camera.back.y / flat;
  const bool is_above = scene.params.has_ground && camera.eye.y > scene.params.ground_height;
  const double horizon =
      is_above ? std::clamp(0.5 * kStripHeight - rise, 0.0, kStripHeight) : kStripHeight;
  // The grid fades towards the horizon.
  out.text("\n<linearGradient id=\"grid\" gradientUnits=\"userSpaceOnUse\" x2=\"0\" y1=\"");
  out.number(horizon + 250).text("\" y2=\"").number(kStripHeight);
  out.text(R"("><stop stop-color="#fff" stop-opacity="0"/><stop offset=".5" stop-color="#fff" )");
  out.text(R"(stop-opacity=".34"/></linearGradient>)").text("\n<g id=\"scenery\">\n");
  const auto box = [&](std::string_view fill, double top, double bottom) {
    out.text("<rect fill=\"url(#").text(fill).text(")\" width=\"10000\" y=\"").number(top);
    out.text("\" height=\"").number(bottom - top).text("\"/>\n");
  };
  if (horizon > 0) box("sky", 0, horizon);
  if (is_above) {
    box("land", horizon, kStripHeight);
    draw_grid(scene, out);
  }
  out.text("</g>\n");
}

}  // namespace sunder
