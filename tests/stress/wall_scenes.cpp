// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numbers>

#include "tests/stress/scenes.hpp"

namespace sunder::stress {
namespace {

struct Size {
  double width = 0, height = 0;
  double least() const { return std::min(width, height); }
};

Json star(Dice& dice, Size size) {
  const int corners = dice.whole(3, 14);
  Json list = Json::array();
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * (i + dice.between(0, 0.7)) / corners;
    const double reach = dice.between(0.25, 0.5);
    list.push_back({size.width * (0.5 + reach * std::cos(angle)),
                    size.height * (0.5 + reach * std::sin(angle))});
  }
  return list;
}

Json openings(Dice& dice, Size size) {
  Json list = Json::array();
  // In cells of a coarse grid, so that they do not cross; they may touch.
  const int columns = dice.whole(1, 4), rows = dice.whole(1, 3);
  for (int x = 0; x < columns; ++x)
    for (int y = 0; y < rows; ++y) {
      if (!dice.chance(0.3)) continue;
      const double w = size.width / columns, h = size.height / rows;
      const bool touches = dice.chance(0.3);
      const double share = touches ? 1 : dice.between(0.1, 0.9);
      // A whole column of touching openings would leave nothing.
      if (touches && rows == 1) continue;
      list.push_back({{"rect", {w * share, h * std::min(share, 0.9)}}, {"at", {w * x, h * y}}});
    }
  return list.size() * 2 > static_cast<std::size_t>(columns * rows) ? Json::array() : list;
}

/// Sites as files have them: anywhere, on a line, on a lattice, on the border, nearly twice.
Json sites(Dice& dice, Size size) {
  Json list = Json::array();
  const int count = dice.whole(1, 60), how = dice.whole(0, 4);
  for (int i = 0; i < count; ++i) {
    double x = dice.unit(), y = dice.unit();
    if (how == 1) y = 0.5;
    if (how == 2) {
      x = std::round(x * 8) / 8;
      y = std::round(y * 8) / 8;
    }
    if (how == 3) x = dice.chance(0.5) ? 0 : 1;
    const auto add = [&](double u, double v) { list.push_back({size.width * u, size.height * v}); };
    add(x, y);
    if (how == 4) add(std::min(1.0, x * (1 + 1e-12)), y);
  }
  return list;
}

Json pattern(Dice& dice, Size size) {
  const double cell = size.least() / dice.between(1.5, 10);
  const double jitter = dice.pick({0.0, 1e-9, dice.unit(), 1.0});
  const auto inside = [&] {
    return Json{size.width * dice.between(0.3, 0.7), size.height * dice.between(0.3, 0.7)};
  };
  switch (dice.whole(0, 5)) {
    case 0: return {{"type", "voronoi-grid"}, {"cell", cell}, {"jitter", jitter}};
    case 1: return {{"type", "voronoi-sites"}, {"sites", sites(dice, size)}};
    case 2: return {{"type", "voronoi-random"}, {"count", dice.whole(1, 150)}};
    case 3:
      return {{"type", "voronoi-focus"},
              {"points", Json::array({inside()})},
              {"count", dice.whole(2, 150)},
              {"radius", cell * dice.log_between(0.01, 3)},
              {"share", dice.unit()}};
    case 4: return {{"type", "quad-grid"}, {"cell", cell}, {"jitter", jitter}};
    default:
      return {{"type", "spiderweb"},
              {"impacts", Json::array({inside()})},
              {"min_radius", 0.05 * size.least()},
              {"max_radius", dice.between(0.06, 0.3) * size.least()},
              {"rings", dice.whole(0, 4)},
              {"radial", dice.whole(0, 12)},
              {"reach", size.least()},
              {"rest_cell", cell}};
  }
}

Json wall(Dice& dice, Size size, double thickness) {
  Json made = {{"thickness", thickness}};
  if (dice.chance(0.35))
    made["outline"] = {{"polygon", star(dice, size)}};
  else {
    made["outline"] = {{"rect", {size.width, size.height}}};
    if (dice.chance(0.5)) made["openings"] = openings(dice, size);
  }
  made["pattern"] = pattern(dice, size);
  // Webs and focus points must lie inside: not sure in a star or beside openings.
  if (made["pattern"]["type"] == "spiderweb") {
    made["outline"] = {{"rect", {size.width, size.height}}};
    made.erase("openings");
  }
  return made;
}

Json turn(Dice& dice) {
  return {dice.between(-180, 180), dice.between(-180, 180), dice.between(-180, 180)};
}

}  // namespace

Scene wall_scene(Dice& dice) {
  const double scale = dice.log_between(1e-3, 1e3);
  const Size size{scale * dice.log_between(0.2, 5), scale * dice.log_between(0.2, 5)};
  Json made = wall(dice, size, std::clamp(scale * dice.log_between(1e-4, 1), 1e-6, 1e3));
  const double away = dice.pick({0.0, 1.0, 1e3, 9e5});
  made["position"] = {away * dice.unit(), away * dice.unit(), away * dice.unit()};
  made["rotation_deg"] = turn(dice);
  return {{{"sunder", 1}, {"seed", dice.whole(1, 1 << 30)}, {"walls", Json::array({made})}}, ""};
}

Scene impact_scene(Dice& dice) {
  const Size size{dice.log_between(0.5, 5), dice.log_between(0.5, 4)};
  const double thickness = size.least() * dice.log_between(0.004, 0.2);
  Json made = wall(dice, size, thickness);
  made["material"] = dice.pick({"concrete-c30", "brick", "float-glass", "toughened-glass", "gypsum",
                                "pmma", "concrete-c30-reinforced"});
  made["anchors"] =
      dice.pick<Json>({Json::array({"bottom"}), Json::array({"left", "right"}),
                       Json::array({"bottom", "left", "right", "top"}), Json::array()});
  Json balls = Json::array();
  for (int i = dice.whole(1, 3); i > 0; --i) {
    const double radius = dice.log_between(0.01, 0.4);
    const double density = dice.log_between(300, 20000);
    const double mass = density * 4.19 * radius * radius * radius;
    const double speed = dice.log_between(0.1, mass > 100 ? 30 : 300);
    balls.push_back(
        {{"radius", radius},
         {"mass", mass},
         {"position",
          {size.width * dice.unit(), std::max(size.height * dice.unit(), radius * 1.01),
           radius + thickness + dice.between(0.01, 0.5) + (i - 1)}},
         {"velocity", {speed * dice.between(-0.5, 0.5), speed * dice.between(-0.5, 0.5), -speed}},
         {"restitution", dice.unit()},
         {"friction", dice.unit()}});
  }
  const Json simulation = {
      {"duration", dice.between(0.2, 1)}, {"step", dice.log_between(5e-4, 0.05)},
      {"iterations", dice.whole(1, 60)},  {"max_error", dice.log_between(1e-3, 0.3)},
      {"break_depth", dice.whole(0, 2)},  {"sleep", dice.chance(0.8)}};
  return {{{"sunder", 1},
           {"seed", dice.whole(1, 1 << 30)},
           {"walls", Json::array({made})},
           {"projectiles", balls},
           {"simulation", simulation}},
          ""};
}

}  // namespace sunder::stress
